#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary logs are audited without flags, checked again and reported, each in a folder of its own; planned paths come
as dense tables for controllers.

Usage: logs_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import csv
import math
import os

import ordinary_logs
from command_line import CASES, CHECK, ROBOT1, TAUT, InFolder, main, run, text_of


class Logs(InFolder):
    def setUp(self):
        super().setUp()
        self.crane = self.path("crane.yaml")
        self.assertEqual(run(TAUT, "init", self.crane).returncode, 0)

    def write_log(self, name, **what):
        with open(self.path(name), "w", encoding="utf-8", newline="") as file:
            file.write(ordinary_logs.LOGS[name](**what))
        return self.path(name)

    def taut(self, *arguments, code=0):
        result = run(TAUT, *arguments, cwd=self.out)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout if code < 3 else result.stderr

    def check_log(self, name, rows, seconds, **what):
        said = self.taut("audit", self.crane, self.write_log(name, rows=rows, **what))
        self.assertIn(f"{rows} rows, lines ", said)
        self.assertIn(f"the motion takes {seconds} s\n", said)
        self.assertRegex(said, r"\d+ rows repeat the row before: the platform rests there, longest in lines \d+ to \d+")
        self.assertIn(f"everywhere between, {rows - 1} segments in", said)
        out = os.path.join("out", "crane-audit-" + os.path.splitext(name)[0])
        self.assertIn(f"Written to {out}: path.csv, certificate.json, report.html", said)
        self.assertLess(os.path.getsize(self.path(out, "report.html")), 3e6)
        for path in (self.path(name), self.path(out, "path.csv")):
            checked = run(CHECK, self.path(out, "certificate.json"), self.crane, "--path", path, "--expect", "proved")
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
            self.assertIn(f"accepted: an audit, proved again: {rows - 1} segments", checked.stdout)


class OrdinaryLogs(Logs):
    def test_six_seconds_at_100_hz_are_audited_checked_and_reported(self):
        self.check_log("angles.csv", 601, 6, rest_s=1)  # longer ones: long_logs_test.py

    def test_other_formats_are_too(self):
        for name in ("quaternions.csv", "winches.tsv", "trajectory.tum"):
            with self.subTest(log=name):
                self.check_log(name, 241, 24, hertz=10)

    def test_times_are_those_of_the_log_where_the_platform_rested_before(self):
        rows = ["t[s],phi[deg],theta[deg]"] + [f"{k},-88.9,80.2" for k in range(100)] + ["100,0,91.7", "101,0,91.7"]
        said = self.taut("audit", ROBOT1, self.write("log.csv", "\n".join(rows)), code=1)
        self.assertIn("100 rows repeat the row before: the platform rests there, longest in lines 2 to 101", said)
        self.assertRegex(said, r"from segment 99 at s = 0\.\d+ \(lines 101-102, t = 99\.\d+ s\)")
        self.assertRegex(said, r"to segment 100 at s = 1 \(line 103, t = 101 s\)")

    def test_opposite_quaternions_are_one_pose(self):
        self.taut("audit", self.crane, self.write("log.tum", "0 0 0 2 0 0 0 1\n1 0 0 2 0 0 0 -1\n2 0 0 2.1 0 0 0 1\n"))


class Folders(Logs):
    def out_of(self, *arguments, code=0):
        said = self.taut(*arguments, code=code)
        return said.split("Written to ")[1].split(":")[0]

    def test_results_of_two_inputs_never_share_a_folder(self):
        table = "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]\n0,0,2,0,0,0\n0,0,2.1,0,0,0\n"
        for folder in ("a", "b"):
            os.mkdir(self.path(folder))
            self.write(os.path.join(folder, "log.csv"), table)
        self.write("crane.csv", table)
        runs = [("plan", "crane.yaml"), ("audit", "crane.yaml", "crane.csv"), ("audit", "crane.yaml", "a/log.csv"),
                ("audit", "crane.yaml", "b/log.csv"),
                ("audit", "crane.yaml", "b/log.csv", "--interpolation", "geodesic")]
        outs = [self.out_of(*arguments) for arguments in runs]
        self.assertEqual(outs, ["out/crane", "out/crane-audit-crane", "out/crane-audit-log", "out/crane-audit-log-2",
                                "out/crane-audit-log-3"])
        self.assertEqual([self.out_of(*arguments) for arguments in runs], outs, "each has its own folder again")
        inputs = text_of(self.path("out/crane-audit-log-2/inputs.txt"))
        self.assertEqual(inputs, f"Results of taut audit\ncase: {os.path.realpath(self.crane)}\n"
                         f"path: {os.path.realpath(self.path('b/log.csv'))}\n")

    def test_folders_with_anything_else_are_left_alone(self):
        os.makedirs(self.path("out", "crane"))
        self.write(os.path.join("out", "crane", "path.csv"), "mine\n")
        os.symlink("nowhere", self.path("out", "crane-2"))
        self.assertEqual(self.out_of("plan", "crane.yaml"), "out/crane-3")
        self.assertEqual(os.listdir(self.path("out", "crane")), ["path.csv"])
        self.assertEqual(text_of(self.path("out", "crane", "path.csv")), "mine\n")

    def test_a_pipe_is_never_the_same_input_again(self):
        table = "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]\n0,0,2,0,0,0\n"
        for number in ("", "-2"):
            result = run(TAUT, "audit", self.crane, "/dev/stdin", cwd=self.out, input=table)
            self.assertIn(f"Written to out/crane-audit-stdin{number}:", result.stdout)

    def test_a_folder_that_is_named_is_taken_and_its_results_replaced(self):
        self.taut("plan", "crane.yaml")
        path = self.write("log.csv", "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]\n0,0,2,0,0,0\n")
        self.assertEqual(self.out_of("audit", "crane.yaml", path, "--out", "out/crane"), "out/crane")
        self.assertEqual(sorted(os.listdir(self.path("out", "crane"))), ["certificate.json", "path.csv", "report.html"])
        self.assertEqual(self.out_of("plan", "crane.yaml"), "out/crane-2")
        os.mkdir(self.path("mine"))
        for name in ("controller.csv", "inputs.txt"):
            self.write(os.path.join("mine", name), "mine\n")
        self.taut("audit", "crane.yaml", path, "--out", "mine")
        for name in ("controller.csv", "inputs.txt"):
            self.assertEqual(text_of(self.path("mine", name)), "mine\n", "what only has the name of a result stays")


class ControllerTables(Logs):
    def table(self, *folder):
        lines = text_of(self.path(*folder, "controller.csv")).splitlines()
        head = [line for line in lines if line.startswith("#")]
        rows = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(lines[len(head):])]
        return "\n".join(head), rows

    @staticmethod
    def points(row):
        """The platform's origin and the cables' ends on it."""
        p = [row[f"p{axis}[m]"] for axis in "xyz"]
        x, y, z, w = (row["q" + name] for name in "xyzw")
        turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        return [p] + [[p[i] + sum(turn[i][j] * b[j] for j in range(3)) for i in range(3)]
                      for b in ordinary_logs.PLATFORM]

    def test_a_plan_comes_as_a_dense_table(self):
        for step, metres in (("10 mm", 0.01), ("0.1m", 0.1), ("1 in", 0.0254)):
            with self.subTest(step=step):
                self.taut("plan", "crane.yaml", "--out", "plan", *(["--step", step] if metres != 0.01 else []))
                head, rows = self.table("plan")
                self.assertIn("Law of the path: straight: between two waypoints px, py, pz, phi, theta, sigma each go",
                              head)
                self.assertIn(f"Step: {step.replace('0.1m', '0.1 m')}.", head)
                self.assertIn("SHA-256 " + text_of(self.path("plan", "path.csv")).split()[-1], head)
                points = [self.points(row) for row in rows]
                for before, behind in zip(points, points[1:]):
                    self.assertLessEqual(max(map(math.dist, before, behind)), metres * (1 + 1e-12))
                self.assertLess(len(rows), 2.2 / metres + 3, "but not denser than that takes: 1.6 m and a turn")
                for row, (_, *ends) in zip(rows, points):
                    for i, (anchor, end) in enumerate(zip(ordinary_logs.BASE, ends)):
                        self.assertAlmostEqual(row[f"l{i + 1}[m]"], math.dist(anchor, end), delta=1e-12)
                with open(self.path("plan", "path.csv"), encoding="utf-8", newline="") as file:
                    waypoints = list(csv.DictReader(line for line in file if not line.startswith("#")))
                at_waypoints = [row for row in rows if row["s"] in (0, 1)]
                self.assertEqual(len(at_waypoints), len(waypoints))
                for row, waypoint in zip(at_waypoints, waypoints):
                    for name in ("px[m]", "py[m]", "pz[m]"):
                        self.assertAlmostEqual(row[name], float(waypoint[name]), delta=1e-12)

    def test_what_winches_do_between_its_rows_can_be_audited(self):
        self.taut("plan", "crane.yaml", "--step", "50mm")
        said = self.taut("audit", "crane.yaml", "out/crane/controller.csv")
        self.assertIn("Interpolation cable-lengths", said)
        self.assertIn("Written to out/crane-audit-controller:", said)
        self.assertEqual(run(CHECK, self.path("out/crane-audit-controller/certificate.json"), self.crane, "--path",
                             self.path("out/crane/controller.csv")).returncode, 0)

    def test_a_turn_in_one_segment_and_a_spline_are_dense_too(self):
        smooth = os.path.join(CASES, "tutorial", "03-a-smooth-move.yaml")
        self.taut("plan", smooth, "--out", "smooth")
        head, rows = self.table("smooth")
        self.assertIn("cubic B-spline", head)
        self.assertGreater(len(rows), 20)
        turn = self.write("turn.csv", "waypoint,x.px,x.py,x.pz,x.phi,x.theta,x.sigma,half_turns.px,half_turns.py,"
                          "half_turns.pz,half_turns.phi,half_turns.theta,half_turns.sigma\n"
                          "0,0,0,2,0,0.05,0,0,0,0,0,0,0\n1,0,0,2,0,0.05,0,0,0,0,2,0,0\n")
        self.taut("audit", "crane.yaml", turn, "--step", "5 mm", "--out", "turned")
        _, rows = self.table("turned")
        # The platform's tilt of 0.05 rad goes round once: the way of an end at 1 m is some 2 pi 0.05 m.
        self.assertGreater(len(rows), 2 * math.pi * 0.05 / 0.005)

    def test_an_audit_has_one_where_asked_with_its_times(self):
        log = self.write_log("winches.tsv", rows=61, hertz=10, rest_s=1)
        self.assertNotIn("controller.csv", self.taut("audit", "crane.yaml", log))
        said = self.taut("audit", "crane.yaml", log, "--step", "20 mm")
        self.assertIn("path.csv, controller.csv, certificate.json", said)
        _, rows = self.table("out", "crane-audit-winches")
        times = [row["t[s]"] for row in rows]
        self.assertEqual((times[0], times[-1]), (0, 6))
        self.assertEqual(times, sorted(set(times)))
        self.assertAlmostEqual(rows[-1]["pz[m]"], 3.5, delta=1e-4)

    def test_only_what_is_proved_has_one(self):
        refuted = self.write("log.tum", "0 0 0 -2 0 0 0 1\n1 0 0 -2.1 0 0 0 1\n")  # cables are too short
        self.assertNotIn("controller.csv", self.taut("audit", "crane.yaml", refuted, "--step", "1cm", code=1))
        self.assertFalse(os.path.exists(self.path("out", "crane-audit-log", "controller.csv")))

    def test_wrong_steps_are_refused_and_nothing_is_written(self):
        for step in ("0 mm", "-1 mm", "10", "mm", "10 kg", "10 deg", "1e1 mm", "1e-12 m", "1 mm 2", "nan mm",
                     "1.2.3 mm", "0.0000000001 m", "10000000 m"):
            with self.subTest(step=step):
                said = self.taut("plan", "crane.yaml", f"--step={step}", code=3)
                self.assertIn(f"--step: got '{step}', expected a length with its unit from 1 nm to 1000 km", said)
                self.assertFalse(os.path.exists(self.path("out")))
        said = self.taut("plan", "crane.yaml", "--step", "0.001 mm", "--out", "dense", code=3)
        self.assertIn("--step: got 0.001 mm, at which controller.csv takes more than 200000 rows, expected a longer "
                      "step", said)
        self.assertEqual(os.listdir(self.path("dense")), [])


if __name__ == "__main__":
    main()

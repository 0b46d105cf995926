#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audits of moves in time from the command line: tables with times, and certificates with a law.

Usage: timed_audit_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import math
import os
import re

from command_line import CASES, CHECK, TAUT, InFolder, main, run, text_of

CRANE = text_of(os.path.join(CASES, "cranes", "portal-20t.yaml"))
TIME = """time:
  winches: {speed: 1 m/s, acceleration: 0.5 m/s^2, power: 60 kW}
  load: {speed: 0.8 m/s, acceleration: 0.2 m/s^2, angular_speed: 5 deg/s}
"""
ROUNDING = ("--timed", "--rounding", "0.1mm,0.01deg")


def log(duration=20.0, rows=401, begin=0.0, digits=4, change=None, way=lambda u: u**3 * (10 - 15 * u + 6 * u * u)):
    """8 m along x while the load turns by 12 degrees, from rest to rest, as (t, x, y, z, yaw)."""
    result = []
    for i in range(rows):
        u = i / (rows - 1)
        s = way(u)
        result.append([begin + u * duration, round(-4 + 8 * s, digits), 0.0, 6.0, math.radians(-6 + 12 * s)])
    if change:
        change(result)
    return result


def quaternions(rows, separator=",", header="t[s],px[m],py[m],pz[m],qx,qy,qz,qw\n"):
    lines = [header] if header else []
    for t, x, y, z, yaw in rows:
        cells = [repr(t), repr(x), repr(y), repr(z), "0", "0", f"{math.sin(yaw / 2):.6f}", f"{math.cos(yaw / 2):.6f}"]
        lines.append(separator.join(cells) + "\n")
    return "".join(lines)


ANCHORS = [[[float(x) for x in point.split(",")] for point in re.findall(r"\[([^][]+)\]", line)]
           for line in re.findall(r"^  (?:base|platform)_anchors: (.*)$", CRANE, flags=re.M)]


def lengths_of(x, y, z, yaw):
    """Of the crane's six cables, from anchor to anchor [m]."""
    c, s = math.cos(yaw), math.sin(yaw)
    return [math.dist(a, (x + c * b[0] - s * b[1], y + s * b[0] + c * b[1], z + b[2]))
            for a, b in zip(*ANCHORS, strict=True)]


def lengths(rows, digits=4, start=True, change=None):
    pose = "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]"
    lines = ["t[s]," + ",".join(f"l{i}[m]" for i in range(1, 7)) + (f",{pose}\n" if start else "\n")]
    for n, (t, *place) in enumerate(rows):
        cells = [round(length, digits) for length in lengths_of(*place)]
        if change:
            change(n, cells)
        first = [*place[:3], 0, 0, math.degrees(place[3])] if n == 0 else [""] * 6
        lines.append(",".join([repr(t), *map(repr, cells), *(map(str, first) if start else ())]) + "\n")
    return "".join(lines)


class TimedAudits(InFolder):
    def setUp(self):
        super().setUp()
        case = re.sub(r"^(tolerances|decoration|query|space|planner):.*\n((  .*\n)*)", "", CRANE, flags=re.M)
        case = re.sub(r"^expect:.*\n", "", case, flags=re.M)
        self.at_rest = self.write("at-rest.yaml", case)
        self.case = self.write("crane.yaml", case + TIME)

    def audit(self, path, *options, case=None, code=0):
        said = run(TAUT, "audit", case or self.case, path, "--out", self.path("out"), "--no-report", *options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout if "--json" in options else said.stdout + said.stderr

    def audited(self, path, *options, **keys):
        return json.loads(self.audit(path, "--json", *options, **keys))

    def test_a_table_is_proved_within_its_rounding(self):
        table = self.write("log.csv", quaternions(log(begin=12.5)))
        found = self.audited(table, *ROUNDING)
        self.assertEqual(found["verdict"], "proved")
        self.assertAlmostEqual(found["move"]["duration_s"], 20, delta=1e-12)
        self.assertIsNone(found["stretches"])
        fitted = found["table"]
        self.assertEqual((fitted["rows"], fitted["lines"], fitted["begin_s"]), (401, [2, 402], "12.5"))
        self.assertLess(fitted["position_m"], 1e-4)
        self.assertGreater(fitted["position_m"], 2e-5)  # digits are not followed
        self.assertLess(fitted["angle_rad"], math.radians(0.01))
        self.assertIn("All 401 rows lie within 0.1 mm and 0.01 deg of this move", found["read"])
        self.assertIn("The move's time 0 is 12.5 s in the table.", found["read"])
        certificate = self.certificate("out")
        self.assertEqual((certificate["version"], certificate["path"]["interpolation"]), (6, "cubic-b-spline"))
        self.assertLessEqual(len(certificate["path"]["waypoints"]) - 3, 200)  # two rows a piece
        self.assertEqual(certificate["source"]["file"], "log.csv")
        poses = [line for line in text_of(self.path("out", "poses.csv")).splitlines() if line[0] not in "#t"]
        self.assertAlmostEqual(float(poses[1000].split(",")[1]), 0, delta=2e-4)  # halfway, after 10 s

        checked = run(CHECK, self.path("out", "certificate.json"), self.case, "--path", self.path("out", "path.csv"),
                      "--expect", "proved")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        self.assertIn("an audit, a move, proved again", checked.stdout)
        self.assertIn("the case's space", checked.stdout)
        refused = run(CHECK, self.path("out", "certificate.json"), self.case, "--path", table)
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertIn("fitted to this file's rows", refused.stdout)

    def test_rows_lie_where_the_table_says(self):
        """Independently of taut: the certificate's spline at each row's time."""
        rows = log()
        self.audited(self.write("log.csv", quaternions(rows)), *ROUNDING)
        path = self.certificate("out")["path"]
        control = [[float.fromhex(x) for x in waypoint["x"]] for waypoint in path["waypoints"]]
        step = float.fromhex(path["timing"]["step_s"])
        self.assertEqual([float.fromhex(c) for c in path["timing"]["controls"]],
                         [float(i - 1) for i in range(len(control))])
        self.assertTrue(control[0] == control[1] == control[2] and control[-1] == control[-2] == control[-3])
        for t, x, y, z, yaw in rows:
            k = min(int(t / step), len(control) - 4)
            u = t / step - k
            weights = [(1 - u)**3 / 6, (3 * u**3 - 6 * u**2 + 4) / 6, (-3 * u**3 + 3 * u**2 + 3 * u + 1) / 6, u**3 / 6]
            at = [sum(w * control[k + i][j] for i, w in enumerate(weights)) for j in range(6)]
            self.assertLess(math.dist(at[:3], (x, y, z)), 1e-4)
            self.assertLess(math.hypot(at[3], at[4], at[5] - yaw), math.radians(0.0101))

    def test_cable_lengths_are_proved_within_their_rounding(self):
        rows = log(begin=3.0)
        found = self.audited(self.write("winches.csv", lengths(rows)), "--timed", "--rounding", "0.2mm")
        self.assertEqual(found["verdict"], "proved")
        fitted = found["table"]
        self.assertEqual((fitted["rounding"], fitted["rows"]), ({"length": "0.2 mm"}, 401))
        self.assertTrue(2e-5 < fitted["length_m"] < 2e-4, fitted)
        self.assertNotIn("position_m", fitted)
        self.assertIn("The cable lengths of all 401 rows lie within 0.2 mm of those of this move", found["read"])
        # Independently of taut: the certificate's spline, in roll, pitch and yaw, at each row's time.
        path = self.certificate("out")["path"]
        control = [[float.fromhex(x) for x in waypoint["x"]] for waypoint in path["waypoints"]]
        step = float.fromhex(path["timing"]["step_s"])
        most = 0
        for t, *place in rows:
            k = min(int((t - 3) / step), len(control) - 4)
            u = (t - 3) / step - k
            weights = [(1 - u)**3 / 6, (3 * u**3 - 6 * u**2 + 4) / 6, (-3 * u**3 + 3 * u**2 + 3 * u + 1) / 6, u**3 / 6]
            at = [sum(w * control[k + i][j] for i, w in enumerate(weights)) for j in range(6)]
            self.assertLess(math.hypot(at[3], at[4]), 1e-3)  # it hardly rolls or pitches
            pairs = zip(lengths_of(*at[:3], at[5]), lengths_of(*place), strict=True)
            most = max(most, *(abs(a - b) for a, b in pairs))
        self.assertLess(most, 4e-4)
        checked = run(CHECK, self.path("out", "certificate.json"), self.case, "--expect", "proved")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        said = run(TAUT, "audit", self.case, self.path("winches.csv"), "--out", self.path("with-report"), "--timed",
                   "--rounding", "0.2mm")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("all 401 of its rows lie within 0.2 mm of its cable lengths at their times",
                      text_of(self.path("with-report", "report.html")))

        said = self.audit(self.write("fast.csv", lengths(log(duration=17, rows=341))), "--timed", "--rounding", "0.2mm",
                          code=1)
        self.assertIn("its limit is 0.8", re.sub(r"\s+", " ", said))

    def test_rows_of_the_table_are_those_that_drives_run_between(self):
        text = re.sub(r"^( *)(- \{name: wind.*)$", r"\1\2\n\1- {name: drives, acceleration: 0.02 m/s^2}",
                      text_of(self.case), flags=re.M)
        case = self.write("rows.yaml", text + "  between_rows: straight\n")
        anchors = ANCHORS[1]
        for table, rounding, off in (
                (quaternions(log()), "0.1mm,0.01deg", [1e-4 + math.radians(0.01) * math.hypot(*b) for b in anchors]),
                (lengths(log()), "0.2mm", [2e-4] * 6)):
            with self.subTest(rounding):
                options = ("--timed", "--rounding", rounding)
                found = self.audited(self.write("log.csv", table), *options, case=case)
                self.assertEqual(found["verdict"], "proved")
                self.assertIn("and lengths that run straight from row to row of such a table;", found["read"])
                jump = 0.5 * 0.05 + 4 * max(off) / 0.05
                said = float(re.search(r"their speed by up to ([0-9.]+) mm/s", found["read"])[1])
                self.assertTrue(1000 * jump <= said < 1010 * jump, (said, jump))
                self.assertNotIn("joins the rows", found["read"])
                rows = self.certificate("out")["problem"]["time"]["rows"]
                self.assertTrue(0.05 <= float(rows["step_s"]) < 0.0500000011, rows)
                for error, more in zip(rows["error_m"], off, strict=True):
                    self.assertTrue(0 < float(error) - (0.5 * 0.05**2 / 8 + more) < 2e-9, (error, more))
                checked = run(CHECK, self.path("out", "certificate.json"), case, "--expect", "proved")
                self.assertEqual(checked.returncode, 0, checked.stdout)
                checked = run(CHECK, self.path("out", "certificate.json"), self.case)
                self.assertIn("another problem", checked.stdout)
                said = run(TAUT, "audit", case, self.path("log.csv"), "--out", self.path("with-report"), *options)
                self.assertEqual(said.returncode, 0, said.stderr)
                report = text_of(self.path("with-report", "report.html"))
                self.assertIn("straight from row to row of such a table, too.", report)
                self.assertIn("at least 20 a second", re.sub(r"\s+", " ", said.stdout))
        # A denser table has the rows of the case, which the tables that are written have; coarser rows are others.
        self.audited(self.write("log.csv", quaternions(log(rows=4001, digits=6))), "--timed", "--rounding",
                     "0.01mm,0.001deg", case=case)
        self.assertEqual(self.certificate("out")["problem"]["time"]["rows"]["step_s"], "0.010000001")
        self.assertIn("holds for lengths that are so far off", text_of(self.path("out", "winches.csv")))
        coarse = self.write("coarse.yaml", text_of(case) + "  rate: 10 Hz\n")
        checked = run(CHECK, self.path("out", "certificate.json"), case, "--expect", "proved")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        checked = run(CHECK, self.path("out", "certificate.json"), coarse)
        self.assertEqual((checked.returncode, "another problem" in checked.stdout), (1, True), checked.stdout)
        # Rows that are far from each other: straight lengths between them make a cable slack, or may.
        sparse = self.write("sparse.csv", quaternions(log(rows=19)))
        for asked, code in ((case, (1, 2)), (self.case, (0,))):
            found = run(TAUT, "audit", asked, sparse, "--out", self.path("out"), "--no-report", "--timed", "--rounding",
                        "5mm,0.3deg")
            self.assertIn(found.returncode, code, found.stdout + found.stderr)

    def test_what_is_no_move_in_lengths_is_refused_with_its_line(self):
        rounding = ("--timed", "--rounding", "0.2mm")
        rows = log()

        def blunder(n, cells):
            cells[2] += 0.01 if n == 200 else 0

        def swapped(_, cells):
            cells[0], cells[4] = cells[4], cells[0]

        def lost(n, cells):
            cells[3] += 9 if n == 50 else 0

        said = self.audit(self.write("blunder.csv", lengths(rows, change=blunder)), *rounding, code=3)
        self.assertRegex(said, r"blunder\.csv:202: got a row that is [0-9.]+ mm in a cable's length off")
        self.assertRegex(said, r"would\s+do\s+for\s+this\s+row:\s+[0-9.]+\s+mm;")
        self.refused(lengths(rows, change=swapped), "wrong.csv:2: got a start pose", "l1 and l5 exchanged",
                     options=rounding)
        self.refused(lengths(rows, change=lost), "wrong.csv:52: got cable lengths for which no pose was found",
                     options=rounding)
        self.refused(lengths(rows, start=False), "expected the pose to start from", options=rounding)
        self.refused(lengths(rows), "got cable lengths and a rounding of poses")
        self.refused(quaternions(rows), "got poses and a rounding of cable lengths", options=rounding)
        self.refused(lengths(rows[:200]), "wrong.csv:201: got a platform that still goes at 0.7", options=rounding)

    def test_a_move_that_is_feasible_slowly_is_refuted_fast(self):
        said = self.audit(self.write("fast.csv", quaternions(log(duration=17, rows=341))), *ROUNDING, code=1)
        self.assertRegex(said, r"REFUTED[^:]*: at t = [0-9.]+ s \(lines? [0-9-]+\)")
        self.assertIn("its limit is 0.8", re.sub(r"\s+", " ", said))
        self.assertIn("about the fitted move", re.sub(r"\s+", " ", said))
        self.assertFalse(os.path.exists(self.path("out", "winches.csv")))
        found = self.audited(self.path("fast.csv"), *ROUNDING, code=1)
        self.assertEqual((found["verdict"], found["witness"]["kind"]), ("refuted", "load_speed"))
        # 30 u² (1 − u)² · 8 m / 17 s is above 0.8 m/s from u = 0.395 to 0.605.
        self.assertTrue(0.38 * 17 < found["move"]["witness_s"] < 0.62 * 17, found["move"])
        checked = run(CHECK, self.path("out", "certificate.json"), self.case, "--expect", "refuted")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        # At rest the same poses are proved.
        self.assertEqual(self.audited(self.path("fast.csv"), "--headroom", "0")["verdict"], "proved")

    def test_a_move_too_long_for_tables_is_audited_all_the_same(self):
        said = self.audit(self.write("long.csv", quaternions(log(duration=6000.0))), *ROUNDING)
        self.assertIn("PROVED", said)
        self.assertIn("warning: no tables of the move are written", said)
        self.assertFalse(os.path.exists(self.path("out", "winches.csv")))

    def test_other_forms_of_poses(self):
        rows = log()
        tum = self.write("log.tum", quaternions(rows, " ", ""))
        self.assertEqual(self.audited(tum, *ROUNDING)["verdict"], "proved")
        angles = "t[ms],px[mm],py[mm],pz[mm],phi[deg],theta[deg],sigma[deg]\n" + "".join(
            f"{1000 * t!r},{1000 * x:.1f},{y!r},6000,0,0,{math.degrees(yaw):.3f}\n" for t, x, y, z, yaw in rows)
        found = self.audited(self.write("angles.csv", angles), *ROUNDING)
        self.assertEqual(found["verdict"], "proved")
        self.assertEqual(found["table"]["rows"], 401)

    def test_the_certificate_of_a_move_is_proved_for_another_case(self):
        self.audited(self.write("log.csv", quaternions(log())), *ROUNDING)
        certificate = self.path("move.json")
        os.rename(self.path("out", "certificate.json"), certificate)
        found = self.audited(certificate, "--timed")
        self.assertEqual(found["verdict"], "proved")
        self.assertIsNone(found["table"])
        self.assertEqual(found["move"]["duration_s"], self.certificate("out")["path"]["timing"] and 20)
        slow = self.write("slow.yaml", text_of(self.case).replace("speed: 0.8 m/s", "speed: 0.7 m/s"))
        self.assertIn("its limit is 0.7", re.sub(r"\s+", " ", self.audit(certificate, "--timed", case=slow, code=1)))
        self.assertIn("expected no rounding", self.audit(certificate, *ROUNDING, code=3))
        self.audited(certificate, "--headroom", "0")  # at rest
        at_rest = self.path("rest.json")
        os.rename(self.path("out", "certificate.json"), at_rest)
        self.assertIn("expected the certificate of a move", self.audit(at_rest, "--timed", code=3))

    def test_a_case_may_ask_for_it(self):
        self.write("log.csv", quaternions(log()))
        text = text_of(self.case)
        keys = "audit: {path: log.csv, timed: true, rounding: {position: 0.1 mm, angle: 0.01 deg}}\nexpect: proved\n"
        case = self.write("own.yaml", text + keys)
        said = run(TAUT, "audit", case, "--out", self.path("out"), "--no-report")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertEqual(run(TAUT, "regress", case).returncode, 0)
        for wrong, expected in (
                ("timed: true, rounding: {position: 0.1 mm, angle: 0.01 deg}, interpolation: straight",
                 "none of a table"),
                ("rounding: {position: 0.1 mm, angle: 0.01 deg}", "without 'timed: true'"),
                ("timed: maybe", "true"),
                ("timed: true, rounding: {position: 0.1 mm}", "expected the key 'angle'"),
                ("timed: true, rounding: {length: 0.1 mm, angle: 1 deg}", "beside 'length'"),
                ("timed: true, rounding: {length: 0.1 deg}", "a length from"),
                ("timed: true, rounding: {length: 0.1 mm}", "got poses and a rounding of cable lengths"),
                ("timed: true, rounding: {position: 0.1 deg, angle: 0.1 deg}", "a length from"),
                ("timed: true, rounding: {position: 0.1 mm, angle: -1 deg}", "an angle from"),
                ("timed: true, rounding: {position: 0, angle: 1 deg}", "a length from")):
            with self.subTest(wrong):
                bad = self.write("bad.yaml", text + f"audit: {{path: log.csv, {wrong}}}\n")
                said = run(TAUT, "audit", bad, "--out", self.path("out2"))
                self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
                self.assertIn(expected, re.sub(r"\s+", " ", said.stderr))
        bad = self.write("bad.yaml", text_of(self.at_rest) + "audit: {path: log.csv, timed: true}\n")
        said = run(TAUT, "audit", bad)
        self.assertEqual(said.returncode, 3)
        self.assertIn("without the key 'time'", said.stderr)

    def refused(self, table, *expected, name="wrong.csv", options=ROUNDING, case=None):
        said = re.sub(r"\s+", " ", self.audit(self.write(name, table), *options, case=case, code=3))
        for text in expected:
            self.assertIn(text, said)
        self.assertFalse(os.path.exists(self.path("out", "certificate.json")))

    def test_what_is_no_move_is_refused_with_its_line(self):
        good = quaternions(log())
        lines = good.splitlines(keepends=True)

        def jump(rows):
            for row in rows[200:]:
                row[1] += 0.01

        def blunder(rows):
            rows[200][3] += 0.005

        said = self.audit(self.write("jump.csv", quaternions(log(change=jump))), *ROUNDING, code=3)
        self.assertRegex(said, r"jump\.csv:(199|20[0-4]): got a row that is [0-9.]+ mm and [0-9.e-]+ deg off")
        self.assertRegex(said, r"would\s+do\s+for\s+this\s+row:\s+[0-9.]+\s+mm,")
        said = self.audit(self.write("blunder.csv", quaternions(log(change=blunder))), *ROUNDING, code=3)
        self.assertRegex(said, r"blunder\.csv:202: got a row that is [0-9.]+ mm")
        self.refused(lines[0] + "".join(lines[200:]), "wrong.csv:2: got a platform that goes at 0.7",
                     "begins at rest")
        self.refused("".join(lines[:200]), "wrong.csv:200: got a platform that still goes at 0.7", "ends at rest")
        self.refused("".join(lines[:6]), "got 5 rows, expected at least 7")
        self.refused(lines[0] + "".join(lines[1:50] + lines[40:]), "wrong.csv:51: t: got")
        self.refused(good.replace("-4.0,", "nan,", 1), "wrong.csv:2: px: got 'nan'")
        self.refused(good.replace("-4.0,", "1e290,", 1), "wrong.csv:")
        self.refused(good[:-20], "wrong.csv:402")
        for duration in (1e-200, 1e200):
            self.refused(quaternions(log(duration=duration)), "expected a move of 0.001 s to")
        self.refused("".join(re.sub(r"^[^,]*,", "", line) for line in lines), "got no column t")
        self.refused("t[s],l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n0,9,9,9,9,9,9\n", "got cable lengths and a rounding of")
        self.refused("t[s],l1[m],l2[m],l3[m],l4[m],l5[m],l6[m],v1[m/s]\n0,9,9,9,9,9,9,0\n", "poses.csv beside it")

    def test_constraints_are_not_asked_of_poses(self):
        case = os.path.join(CASES, "moves", "hexacrane-on-equations.yaml")
        # Columns of the case's parameters mean the motion that the constraints imply, which is not fitted.
        own = "t[s],px[m],py[m],pz[m],phi[rad],theta[rad]\n"
        self.refused(own + "".join(f"{t},0.081,0.05,0.217,-2.59,0.82\n" for t in range(20)),
                     "in a case with constraints", case=case)
        rounding = ("--timed", "--rounding", "0.6mm,0.3deg")
        said = run(TAUT, "plan", case, "--out", self.path("planned"), "--no-report")
        self.assertEqual(said.returncode, 0, said.stderr)
        off = re.sub(r"^([\d.]+),([^,]+)", lambda m: f"{m[1]},{float(m[2]) + 0.002}",
                     text_of(self.path("planned", "poses.csv")), flags=re.M)
        for name, rows in (("poses.csv", text_of(self.path("planned", "poses.csv"))), ("off.csv", off)):
            with self.subTest(name):
                table = self.write(name, rows)
                said = run(TAUT, "audit", case, table, "--out", self.path("out"), *rounding)
                self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
                self.assertIn("constraints are NOT asked of these poses", said.stdout)
                self.assertIn("The constraints on poses that the case states", text_of(self.path("out", "report.html")))

    def test_use_that_makes_no_sense_is_refused(self):
        table = quaternions(log())
        self.refused(table, "got a table and no rounding", options=("--timed",))
        self.refused(table, "without the key 'time'", case=self.at_rest)
        self.refused(table, "--rounding: got it without --timed", options=ROUNDING[1:])
        self.refused(table, "a law between rows", options=(*ROUNDING, "--interpolation", "geodesic"))
        self.refused(table, "--step", options=(*ROUNDING, "--step", "1mm"))
        for rounding in ("0.1mm,", "0.1mm,0.01mm", "0.1,0.01", "0.01deg,0.1mm", "0mm,1deg", "-1mm,1deg", "2m,1deg",
                         "0.1mm,30deg", "0.1mm,0.01deg,1", "nanmm,1deg"):
            with self.subTest(rounding):
                self.refused(table, "--rounding: got", options=("--timed", f"--rounding={rounding}"))


if __name__ == "__main__":
    main()

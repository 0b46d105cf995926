#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves in time from the command line: what taut plan writes of them, and at which speed.

Usage: moves_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import csv
import json
import os
import re

from command_line import CASES, CHECK, TAUT, InFolder, main, run, text_of

CRANE = text_of(os.path.join(CASES, "cranes", "portal-20t.yaml"))
TIME = """time:
  winches: {speed: 1 m/s, acceleration: 0.5 m/s^2}
  load: {speed: 0.8 m/s, acceleration: 0.2 m/s^2, angular_speed: 5 deg/s}
  jerk: 1 m/s^3
  rate: 50 Hz
"""
TABLES = ("winches.csv", "poses.csv", "poses.tum")


class Moves(InFolder):
    def setUp(self):
        super().setUp()
        case = re.sub(r"^(tolerances|decoration):.*\n((  .*\n)*)", "", CRANE, flags=re.M)
        case = case.replace("cost: travel}", "cost: travel, smooth: spline}")
        self.at_rest = self.write("at-rest.yaml", case)
        self.case = self.write("crane.yaml", case + TIME)

    def plan(self, *options, case=None, code=0):
        said = run(TAUT, "plan", case or self.case, "--out", self.path("out"), "--no-report", *options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout + said.stderr

    def planned(self, *options):
        return json.loads(self.plan("--json", *options))

    def rows(self, name):
        lines = [line for line in text_of(self.path("out", name)).splitlines() if not line.startswith("#")]
        if name.endswith(".tum"):
            return [[float(cell) for cell in line.split(" ")] for line in lines]
        return [[float(cell) for cell in row] for row in list(csv.reader(lines))[1:]]

    def test_a_move_is_proved_and_written_as_tables(self):
        found = self.planned("--timed")
        self.assertEqual(found["verdict"], "proved")
        move = found["move"]
        self.assertIsNone(move["greatest_speed"])
        self.assertGreater(move["duration_s"], move["fastest_s"])
        self.assertGreater(move["duration_s"], 8 / 0.8 + 0.8 / 0.2)
        for name in TABLES:
            rows = self.rows(name)
            self.assertEqual(rows[-1][0], move["duration_s"])
            self.assertEqual(rows[1][0], 0.02)
            self.assertIn(self.path("out", name), found["files"])
        timing = self.certificate("out")["path"]["timing"]
        self.assertEqual((len(timing["controls"]) - 3) * float.fromhex(timing["step_s"]), move["duration_s"])
        checked = run(CHECK, self.path("out", "certificate.json"))
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        digest = re.search(r"SHA-256 (\w{64})", text_of(self.path("out", "winches.csv"))).group(1)
        self.assertIn(digest, text_of(self.path("out", "path.csv")))
        self.assertIn("0.025 mm of each cable, for 0.5 m/s^2", text_of(self.path("out", "winches.csv")))

    def test_says_how_long_it_takes(self):
        said = " ".join(self.plan().split())
        self.assertRegex(said, r"Move: [\d.]+ s; without a limit of jerk the fastest law on this path takes about "
                               r"[\d.]+ s \(in floating point\)\.")
        self.assertIn("winches.csv, poses.csv, poses.tum", said)

    def test_tables_of_an_earlier_move_do_not_stay(self):
        self.plan()
        self.write("out/poses.tum", "mine\n")
        printed = "%PDF-1.4\n1 0 obj\n<</Title (Motion report: proved)\n" + 300 * "x"
        self.write("out/report.pdf", printed)
        self.plan(case=self.at_rest)
        self.assertFalse(os.path.exists(self.path("out", "winches.csv")))
        self.assertFalse(os.path.exists(self.path("out", "poses.csv")))
        self.assertFalse(os.path.exists(self.path("out", "report.pdf")))
        self.write("out/report.pdf", printed.replace("Motion", "My"))
        self.plan(case=self.at_rest)
        self.assertTrue(os.path.exists(self.path("out", "report.pdf")))
        self.assertEqual(text_of(self.path("out", "poses.tum")), "mine\n")
        self.assertTrue(os.path.exists(self.path("out", "controller.csv")))

    def test_slower(self):
        planned = self.planned()["move"]["duration_s"]
        for share in ("40%", "40 %", "0.4"):
            move = self.planned("--speed", share)["move"]
            self.assertAlmostEqual(move["speed_share"], 0.4, 4)
            self.assertAlmostEqual(move["duration_s"], planned / 0.4, delta=0.01)
            self.assertEqual(move["planned_s"], planned)
        self.assertIn("at 40 % of the speed that was planned", " ".join(self.plan("--speed", "40%").split()))

    def test_as_fast_as_is_proved(self):
        move = self.planned("--max-speed")["move"]
        greatest = move["greatest_speed"]
        self.assertGreaterEqual(greatest["proved_share"], 1)
        self.assertGreater(greatest["refuted_share"], greatest["proved_share"])
        self.assertLess(greatest["refuted_share"], 1.01 * greatest["proved_share"])
        self.assertAlmostEqual(move["speed_share"], greatest["proved_share"], 9)
        said = " ".join(self.plan("--max-speed").split())
        self.assertRegex(said, r"Greatest speed of this law: [\d.]+ % of what was planned is proved, "
                               r"[\d.]+ % is refuted: on segment \d of the path ")

    def test_options_of_moves_need_one(self):
        for options in (["--timed"], ["--speed", "50%"], ["--max-speed"]):
            said = self.plan(*options, case=self.at_rest, code=3)
            self.assertIn(f"{options[0]}: got a case without the key 'time', expected", " ".join(said.split()))
        for share in ("0", "101%", "-1", "nan", "1e9", "half", "", "40%%", "0.01%"):
            said = self.plan(f"--speed={share}", code=3)
            self.assertIn("--speed", said)
        self.assertIn("--speed", self.plan("--max-speed", "--speed", "40%", code=3))
        self.assertFalse(os.path.exists(self.path("out", "path.csv")))

    def test_a_plan_at_rest_has_no_move(self):
        found = json.loads(self.plan("--json", case=self.at_rest))
        self.assertIsNone(found["move"])
        for name in TABLES:
            self.assertFalse(os.path.exists(self.path("out", name)))

    def test_too_many_rows(self):
        self.write("crane.yaml", text_of(self.case).replace("50 Hz", "10000 Hz").replace("0.8 m/s", "0.08 m/s"))
        said = " ".join(self.plan(code=3).split())
        self.assertIn("time.rate: got 10000 Hz, at which tables of a move of", said)
        self.assertFalse(os.path.exists(self.path("out", "path.csv")))


if __name__ == "__main__":
    main()

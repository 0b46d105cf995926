#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that choose the angles of their poses: planned, checked, shown, reported and audited in them.

Usage: angles_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import csv
import json
import os
import re
from math import cos, pi, radians, sin

from command_line import CASES, CHECK, ROBOT1, TAUT, InFolder, main, run, text_of

CASE = os.path.join(CASES, "robot1-roll-pitch-yaw.yaml")


def product(*quaternions):
    """Of quaternions x, y, z, w: the last turn is the first to be made."""
    result = (0.0, 0.0, 0.0, 1.0)
    for x, y, z, w in quaternions:
        a, b, c, d = result
        result = (d * x + w * a + b * z - c * y, d * y + w * b + c * x - a * z, d * z + w * c + a * y - b * x,
                  d * w - a * x - b * y - c * z)
    return result


def quaternion(roll, pitch, yaw):
    return product((0, 0, sin(yaw / 2), cos(yaw / 2)), (0, sin(pitch / 2), 0, cos(pitch / 2)),
                   (sin(roll / 2), 0, 0, cos(roll / 2)))


class Angles(InFolder):
    def taut(self, *arguments, code=0):
        result = run(TAUT, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout if code < 3 else result.stderr

    def check(self, *arguments, code=0):
        result = run(CHECK, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout if code < 3 else result.stderr

    def case(self, space, *waypoints):
        """Robot 1 with another space and query."""
        text = re.sub(r"(?s)\nspace:.*?\nplanner:",
                      f"\nspace: {space}\nquery: {{waypoints: [{', '.join(waypoints)}]}}\nplanner:", text_of(CASE))
        return self.write("case.yaml", re.sub(r"(?m)^expect:.*", "expect: proved", text))


class RollPitchAndYaw(Angles):
    def setUp(self):
        super().setUp()
        self.said = self.taut("plan", CASE, "--out", self.path("plan"))
        path = text_of(self.path("plan", "path.csv"))
        self.assertTrue(path.startswith("waypoint,x.roll,x.pitch,half_turns.roll,half_turns.pitch,px[m],py[m],pz[m],"
                                        "roll[rad],pitch[rad],yaw[rad]\n"))
        self.rows = list(csv.DictReader(line for line in path.splitlines() if not line.startswith("#")))

    def log(self, name, columns, row_of):
        lines = [",".join(columns)] + [",".join(str(x) for x in row_of(row)) for row in self.rows]
        return self.write(name, "\n".join(lines) + "\n")

    def angles(self, row):
        return [float(row[name]) for name in ("roll[rad]", "pitch[rad]", "yaw[rad]")]

    def position(self, row):
        return [row[name] for name in ("px[m]", "py[m]", "pz[m]")]

    def test_a_plan_is_shown_reported_and_checked_in_them(self):
        self.check(self.path("plan", "certificate.json"), CASE, "--path", self.path("plan", "path.csv"))
        report = text_of(self.path("plan", "report.html"))
        self.assertIn("R = Rz(yaw) Ry(pitch) Rx(roll)", report)
        for heading in ("roll [°]", "pitch [°]", "yaw [°]"):
            self.assertIn(f"{heading}</th>", report)
        self.assertIn('"angle_names":["roll","pitch","yaw"]', report)
        self.assertNotRegex(report.split("<script")[0], "torsion|[φθσ]", "no angles that the case does not have")
        self.assertIn("roll = 17.1887°, pitch = 28.6479°, yaw = 34°", self.taut("show", CASE))
        shown = json.loads(self.taut("show", CASE, "--json"))
        self.assertEqual(shown["problem"]["space"]["angles"], "roll-pitch-yaw")
        self.assertEqual(list(sorted(shown["waypoints"][1]["pose"])), ["pitch", "px", "py", "pz", "roll", "yaw"])

    def test_the_table_for_a_controller_has_the_same_rotations(self):
        lines = text_of(self.path("plan", "controller.csv")).splitlines()
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        self.assertGreater(len(rows), len(self.rows))
        for path_row in self.rows:
            q = quaternion(*self.angles(path_row))
            nearest = max(abs(sum(a * float(row[name]) for a, name in zip(q, ("qx", "qy", "qz", "qw"))))
                          for row in rows)
            self.assertAlmostEqual(nearest, 1, places=12)

    def test_a_log_of_these_angles_is_audited_as_the_same_path(self):
        log = self.log("log.csv", ["px[m]", "py[m]", "pz[m]", "roll[rad]", "pitch[rad]", "yaw[rad]"],
                       lambda row: self.position(row) + self.angles(row))
        said = self.taut("audit", CASE, log, "--out", self.path("audit"))
        self.assertIn("positions and roll-pitch-yaw angles", said)
        self.assertIn("the case's space",
                      self.check(self.path("audit", "certificate.json"), CASE, "--path", log, "--expect", "proved"))
        for waypoint, row in zip(self.certificate("audit")["path"]["waypoints"], self.rows, strict=True):
            self.assertEqual([float.fromhex(x) for x in waypoint["x"]],
                             [float(x) for x in self.position(row)] + self.angles(row))
        # The path of the certificate, again.
        self.taut("audit", CASE, self.path("audit", "certificate.json"), "--out", self.path("again"))
        self.assertEqual(self.certificate("again")["path"], self.certificate("audit")["path"])

    def test_a_log_of_quaternions_is_one_of_poses(self):
        log = self.log("log.csv", ["px[m]", "py[m]", "pz[m]", "qx", "qy", "qz", "qw"],
                       lambda row: self.position(row) + list(quaternion(*self.angles(row))))
        said = self.taut("audit", CASE, log, "--out", self.path("audit"))
        self.assertIn("geodesic", said)
        self.check(self.path("audit", "certificate.json"), CASE, "--path", log, "--expect", "proved")
        refused = self.taut("audit", CASE, log, "--interpolation", "straight", "--out", self.path("q"), code=3)
        self.assertIn("got quaternions to be joined straight in roll-pitch-yaw angles, expected columns of these "
                      "angles", refused)
        self.assertFalse(os.path.exists(self.path("q")))

    def test_angles_become_the_quaternions_of_the_same_poses(self):
        log = self.log("log.csv", ["roll[deg]", "px[m]", "py[m]", "pz[m]", "pitch[rad]", "yaw[rad]"],
                       lambda row: [self.angles(row)[0] * 180 / pi, *self.position(row), *self.angles(row)[1:]])
        for law in ("geodesic", "cable-lengths"):
            self.taut("audit", CASE, log, "--interpolation", law, "--out", self.path(law))
            self.check(self.path(law, "certificate.json"), CASE, "--path", self.path(law, "path.csv"),
                       "--expect", "proved")
            for waypoint, row in zip(self.certificate(law)["path"]["waypoints"], self.rows, strict=True):
                q = [float.fromhex(x) for x in waypoint["quaternion"]]
                inner = sum(a * b for a, b in zip(q, quaternion(*self.angles(row))))
                self.assertAlmostEqual(abs(inner), 1, places=14)

    def test_laws_between_poses_are_reported_in_the_angles_of_the_case(self):
        log = self.log("log.csv", ["px[m]", "py[m]", "pz[m]", "roll[rad]", "pitch[rad]", "yaw[rad]"],
                       lambda row: self.position(row) + self.angles(row))
        for law in ("geodesic", "cable-lengths"):
            self.taut("audit", CASE, log, "--interpolation", law, "--headroom", "0", "--out", self.path(law))
            report = text_of(self.path(law, "report.html"))
            for heading in ("roll [°]", "pitch [°]", "yaw [°]"):
                self.assertIn(f"{heading}</th>", report)
            self.assertIn('"angle_names":["roll","pitch","yaw"]', report)
            self.assertIn("R = Rz(yaw) Ry(pitch) Rx(roll). Floating-point samples", report)
            self.assertNotRegex(report.split("<script")[0], "torsion|[φθσ]", "no angles that the case does not have")
            text = self.taut("report", self.path(law, "certificate.json"), "--text")
            self.assertRegex(text, r"From p = [^=]*, roll = 0°, pitch = 0°, yaw = 34° to p = [^=]*, roll = 17\.189°, "
                                   r"pitch = 28\.648°, yaw = 34°")
            data = json.loads(re.search(r'(?s)<script[^>]*application/json[^>]*>(.*?)</script>', report)[1])
            first, *_, last = zip(*data["samples"]["angles"])
            for shown, row in ((first, self.rows[0]), (last, self.rows[-1])):
                for x, y in zip(shown, self.angles(row)):
                    self.assertAlmostEqual(x, y, places=5)

    def test_a_log_of_winches_starts_at_a_pose_in_them(self):
        shown = json.loads(self.taut("show", CASE, "--json"))
        lengths = [[cable["length_m"] for cable in waypoint["cables"]] for waypoint in shown["waypoints"]]
        start = shown["waypoints"][0]["pose"]
        names = ["px", "py", "pz", "roll", "pitch", "yaw"]
        titles = [f"l{i}[m]" for i in range(1, 7)] + [f"{n}[m]" for n in names[:3]] + [f"{n}[rad]" for n in names[3:]]
        middle = [(a + b) / 2 for a, b in zip(*lengths)]
        rows = [lengths[0] + [start[n] for n in names], middle + [""] * 6]
        log = self.write("winches.csv", "\n".join(",".join(str(x) for x in row) for row in [titles] + rows) + "\n")
        said = self.taut("audit", CASE, log, "--out", self.path("winches"))
        self.assertIn("PROVED", said)
        self.check(self.path("winches", "certificate.json"), CASE, "--path", log, "--expect", "proved")

    def test_a_refuted_path_is_described_in_them(self):
        log = self.write("tilt.csv", "px[mm],py[mm],pz[mm],roll[deg],pitch[deg],yaw[deg]\n"
                         "0,0,350,0,0,34\n0,0,350,0,170,34\n")
        self.taut("audit", CASE, log, "--out", self.path("tilt"), code=1)
        report = text_of(self.path("tilt", "report.html"))
        self.assertRegex(report, r"roll = [-\d.]+°, pitch = [-\d.]+°, yaw = [-\d.]+°")

    def test_columns_of_other_angles_are_refused_with_a_hint(self):
        log = self.write("tt.csv", "px[mm],py[mm],pz[mm],phi[deg],theta[deg],sigma[deg]\n"
                         "0,0,350,0,0,34\n0,0,350,0,1,34\n")
        self.assertIn("got the unknown column 'phi', which is understood with 'angles: tilt-and-torsion' under 'space' "
                      "of the case", self.taut("audit", CASE, log, "--out", self.path("x"), code=3))
        log = self.write("rpy.csv", "px[mm],py[mm],pz[mm],roll[deg],pitch[deg],yaw[deg]\n"
                         "0,0,350,0,0,34\n0,0,350,0,1,34\n")
        self.assertIn("got the unknown column 'roll', which is understood with 'angles: roll-pitch-yaw' under 'space' "
                      "of the case", self.taut("audit", ROBOT1, log, "--out", self.path("x"), code=3))
        self.assertFalse(os.path.exists(self.path("x")))


class Other(Angles):
    def planned(self, space, *waypoints):
        case = self.case(space, *waypoints)
        self.taut("plan", case, "--out", self.path("plan"))
        self.check(self.path("plan", "certificate.json"), case, "--path", self.path("plan", "path.csv"),
                   "--expect", "proved")
        return self.certificate("plan")["margins"]

    def test_the_same_turn_has_the_same_margins_in_all(self):
        place = "px: 0, py: 0, pz: 350 mm"
        spaces = [(f"{{slice: {{{place}, phi: 0, theta: 0}}}}", "sigma"),
                  (f"{{angles: roll-pitch-yaw, slice: {{{place}, roll: 0, pitch: 0}}}}", "yaw"),
                  (f"{{angles: zyz, slice: {{{place}, beta: 0, gamma: 0}}}}", "alpha"),
                  (f"{{angles: {{axis: [0, 0, 2.5]}}, slice: {{{place}}}}}", "turn")]
        margins = [self.planned(space, f"{{{name}: 20 deg}}", f"{{{name}: 40 deg}}") for space, name in spaces]
        for other in margins[1:]:
            for key, least in margins[0].items():
                self.assertAlmostEqual(float(other[key]) / float(least), 1, delta=0.05)

    def test_an_axis_the_other_way_is_another_path(self):
        place = "px: 0, py: 0, pz: 350 mm"
        one = self.planned(f"{{angles: {{axis: [0.1, 0, 1]}}, slice: {{{place}}}}}", "{turn: 20 deg}", "{turn: 40 deg}")
        case = self.case(f"{{angles: {{axis: [-0.1, 0, -1]}}, slice: {{{place}}}}}", "{turn: 20 deg}", "{turn: 40 deg}")
        self.assertIn("rejected: the certificate is about another problem",
                      self.check(self.path("plan", "certificate.json"), case, code=1))
        back = self.planned(f"{{angles: {{axis: [-0.1, 0, -1]}}, slice: {{{place}}}}}",
                            "{turn: -20 deg}", "{turn: -40 deg}")
        for key, least in one.items():
            self.assertAlmostEqual(float(back[key]) / float(least), 1, delta=0.05)

    def test_words_of_other_angles_are_understood_in_errors(self):
        text = text_of(ROBOT1)
        for wrong, word, angles in (("{phi: -2.3, yaw: 1.6}", "yaw", "roll-pitch-yaw"),
                                    ("{phi: -2.3, gamma: 1.6}", "gamma", "zyz"),
                                    ("{turn: 1}", "turn", "{axis: [x, y, z]}")):
            case = self.write("wrong.yaml", text.replace("{phi: -2.3, theta: 1.6}", wrong))
            self.assertNotEqual(text_of(case), text)
            said = self.taut("plan", case, "--out", self.path("x"), code=3)
            self.assertRegex(said, r"wrong.yaml:\d+:\d+: query.waypoints\[0\]: got the unknown key '" + word)
            self.assertIn(f"which is understood with 'angles: {angles}' under 'space' of the case (it has "
                          "tilt-and-torsion angles), expected phi, theta", said)
        self.assertFalse(os.path.exists(self.path("x")))

    def test_a_law_of_poses_in_other_angles_is_refused(self):
        log = self.write("q.csv", "px[m],py[m],pz[m],qx,qy,qz,qw\n" + "".join(
            f"0,0,0.35,0,0,{sin(radians(a) / 2)},{cos(radians(a) / 2)}\n" for a in (30, 35)))
        self.taut("audit", CASE, log, "--out", self.path("audit"))
        certificate = self.certificate("audit")
        names = ["px", "py", "pz", "roll", "pitch", "yaw"]
        certificate["problem"]["space"] = {
            "angles": "roll-pitch-yaw", "constants": {}, "constraints": [], "flip": None,
            "pose": dict(zip(names, names)),
            "parameters": [{"name": n, "kind": "real" if k < 3 else "periodic"} for k, n in enumerate(names)]}
        wrong = self.write("wrong.json", json.dumps(certificate))
        for command in (("audit", CASE, wrong, "--out", self.path("x")),
                        ("report", wrong, "--out", self.path("r.html"))):
            self.assertIn("wrong.json", self.taut(*command, code=3))
        self.check(wrong, CASE, code=3)


if __name__ == "__main__":
    main()

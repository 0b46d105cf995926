#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut show and taut explain, and that each code that is printed is explained.

Usage: show_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import glob
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

TAUT, CHECK, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:4])
CASES = os.path.join(SOURCE, "cases")
CASE = os.path.join(CASES, "robot1-slice-qs-qg.yaml")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


class Show(unittest.TestCase):
    def test_numbers_are_those_of_the_case_and_of_its_certificate(self):
        said = run(TAUT, "show", CASE)
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        for expected in ("(-190.5256, -110, 0)", "(-112.5833, 65, 0)", "0.05 to 0.5", "100 to 550", "phi = -2.3",
                         "floating point", "semi-axis of the force: 0.01 N", "semi-axis of the moment: 0.001 N·m",
                         "Nothing is proved here"):
            self.assertIn(expected, said.stdout)
        shown = json.loads(run(TAUT, "show", CASE, "--json").stdout)
        with tempfile.TemporaryDirectory() as folder:
            run(TAUT, "plan", CASE, "--out", folder)
            with open(os.path.join(folder, "certificate.json"), encoding="utf-8") as file:
                certificate = json.load(file)
        self.assertEqual(shown["problem"], certificate["problem"])

    def test_bodies_are_said_again_with_the_nearest_of_each_waypoint(self):
        case = os.path.join(CASES, "cranes", "portal-20t-stack.yaml")
        said = run(TAUT, "show", case)
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        for expected in ("Bodies that may not touch", "platform and obstacles, 2 pairs, 200 mm",
                         "cables among each other, 15 pairs, 20 mm", "28 mm thick",
                         "'stack', obstacle: a box of 2.4 × 6.1 × 2.6 m", "cable 1 / cable 2", "apart [m]"):
            self.assertIn(expected, said.stdout)
        self.assertNotIn("Not checked", said.stdout)
        shown = json.loads(run(TAUT, "show", case, "--json").stdout)
        for waypoint in shown["waypoints"]:
            nearest = waypoint["nearest_bodies"]
            left = [pair["left_m"] for pair in nearest]
            self.assertEqual((len(nearest), left), (5, sorted(left)))
            for pair in nearest:
                a, b = pair["points_m"]
                apart = sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5
                self.assertAlmostEqual(apart, pair["distance_m"], places=9)

    def test_an_audit_in_time_is_not_called_a_planned_move(self):
        said = run(TAUT, "show", os.path.join(CASES, "moves", "portal-20t-table.yaml"))
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        self.assertIn("Path between waypoints: a cubic spline of time, which is fitted to the rows", said.stdout)
        self.assertIn("Time (of the move of the audited file, with its times", said.stdout)
        self.assertIn("Audit of 'portal-20t-table.csv', as a move in time, each row within a rounding of 0.1 mm and "
                      "0.01 deg\n", said.stdout)
        for wrong in ("as the audited file suggests", "Planned with a jerk", "the move between the waypoints"):
            self.assertNotIn(wrong, said.stdout)

    def test_a_start_in_contact_is_named_with_the_pair_and_the_depth(self):
        with open(os.path.join(CASES, "cranes", "portal-20t-stack.yaml"), encoding="utf-8") as file:
            text = file.read()
        with tempfile.TemporaryDirectory() as folder:
            case = os.path.join(folder, "in.yaml")
            with open(case, "w", encoding="utf-8") as file:  # onto the container: its lower side is 3.5 m below p
                file.write(text.replace("at: [0, 1, 1.3], yaw: 10", "at: [-4, 0, 1.7]")
                           .replace("pair_clearances", "").replace("cables-platform: 10 mm}",
                                                                   "cables-platform: 10 mm}\n  pairs: "
                                                                   "[platform-obstacles, cables-obstacles]"))
            said = run(TAUT, "show", case)
            self.assertEqual(said.returncode, 0, said.stderr)
            # 6 − 2.2 − 1.3 = 2.5 m is the container's lower side, and 1.7 + 1.3 = 3 m the stack's upper one.
            self.assertIn("in contact, about 0.5 m deep in each other", said.stdout)
            self.assertIn("Not checked: cables among each other, cables and platform.", said.stdout)
            planned = run(TAUT, "plan", case, "--out", os.path.join(folder, "out"))
            self.assertEqual(planned.returncode, 1, planned.stdout)
            self.assertRegex(planned.stdout, r"(?s)Bodies: .*Not\s+checked: cables among.*REFUTED")
            self.assertRegex(planned.stdout, r"at\s+waypoint\s+0\s+of\s+the\s+query\s+'container'\s+and\s+'stack'")
            checked = run(CHECK, os.path.join(folder, "out", "certificate.json"))
            self.assertEqual(checked.returncode, 0, checked.stdout)
            self.assertIn("NOT CHECKED: cables-cables; cables-platform", checked.stdout)

    def test_tensions_balance_the_load(self):
        """With J and w0 computed here, from the exact problem and the pose."""
        self.check_balance(CASE, lambda pose: turn(pose["phi"], pose["theta"], pose["sigma"]))
        self.check_balance(os.path.join(CASES, "robot1-roll-pitch-yaw.yaml"), turn_of_roll_pitch_and_yaw)

    def check_balance(self, case, rotation_of):
        shown = json.loads(run(TAUT, "show", case, "--json").stdout)
        robot, load = shown["problem"]["robot"], shown["problem"]["load"]
        a = [[float(x) for x in p] for p in robot["base_anchors_m"]]
        b = [[float(x) for x in p] for p in robot["platform_anchors_m"]]
        for waypoint in shown["waypoints"]:
            pose = waypoint["pose"]
            rotation = rotation_of(pose)
            total = [0.0] * 3
            for i, cable in enumerate(waypoint["cables"]):
                end = [pose[c] + sum(rotation[k][j] * b[i][j] for j in range(3))
                       for k, c in enumerate(("px", "py", "pz"))]
                along = [end[k] - a[i][k] for k in range(3)]
                length = sum(x * x for x in along) ** 0.5
                self.assertAlmostEqual(length, cable["length_m"], places=12)
                total = [t + cable["f0_N"] * x / length for t, x in zip(total, along)]
            for have, want in zip(total, load["wrench"][:3]):
                self.assertAlmostEqual(have, float(want), places=9)

    def test_meshes_are_drawn_by_their_edges(self):
        with tempfile.TemporaryDirectory() as folder:
            drawing = os.path.join(folder, "crane.svg")
            case = os.path.join(CASES, "bodies", "hexacrane-sphere-mesh.yaml")
            self.assertEqual(run(TAUT, "show", case, "--out", drawing).returncode, 0)
            drawn = [element.get("class") or "" for element in xml.parse(drawing).getroot().iter()]
            self.assertEqual(sum(kind.split()[:1] == ["edges"] for kind in drawn), 3, "one a view")

    def test_every_case_is_shown_and_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            for case in sorted(glob.glob(os.path.join(CASES, "**", "*.yaml"), recursive=True)):
                with open(case, encoding="utf-8") as file:
                    if "\n  legs:\n" in file.read():
                        continue  # taut show takes one path
                with self.subTest(os.path.basename(case)):
                    drawing = os.path.join(folder, "robot.svg")
                    has_query = bool(json.loads(run(TAUT, "show", case, "--json").stdout)["waypoints"])
                    said = run(TAUT, "show", case, "--out", drawing)
                    self.assertEqual(said.returncode, 0 if has_query else 3, said.stderr)
                    if not has_query:
                        self.assertIn("no query", said.stderr)
                        continue
                    root = xml.parse(drawing).getroot()
                    words = [element.text for element in root.iter() if element.tag.endswith("text")]
                    tags = [element.text for element in root.iter() if element.get("class") == "number"]
                    self.assertEqual(sorted(tags), sorted("123456" * 3), "in each view")
                    measures = [element.text for element in root.iter() if element.get("class") == "measure"]
                    self.assertGreaterEqual(len(measures), 5, "widths of base and platform, and how far it hangs")
                    for measure in measures:
                        self.assertGreater(float(measure), 0)
                    self.assertTrue(any(word.endswith(("mm", " cm", " m", " ft")) for word in words), "a scale bar")
                    named = " ".join(words)
                    for name in [f"{side}{i}" for side in "AB" for i in range(1, 7)]:
                        self.assertGreaterEqual(named.split().count(name), 3)
                    self.assertNotRegex(xml.tostring(root, encoding="unicode"), r"nan|inf\b")

    def test_bodies_are_drawn_to_scale(self):
        """The stack is a box of 2.4 × 6.1 × 2.6 m, turned by 10 degrees about the vertical."""
        with tempfile.TemporaryDirectory() as folder:
            drawing = os.path.join(folder, "crane.svg")
            case = os.path.join(CASES, "cranes", "portal-20t-stack.yaml")
            self.assertEqual(run(TAUT, "show", case, "--out", drawing).returncode, 0)
            root = xml.parse(drawing).getroot()
            drawn = {}
            for element in root.iter():
                drawn.setdefault(element.get("class"), []).append(element)
            names = [element.text for element in drawn["body-name"]]
            self.assertEqual(sorted(names), ["floor", "floor", "stack", "stack", "stack"], "the floor from two sides")
            self.assertIn("Green: bodies on the platform", drawn["loaded"][0].text)
            scale = [float(x) for x in re.findall(r"[-\d.]+", drawn["scale"][0].get("d"))]
            words = [element.text for element in root.iter() if element.tag.endswith("text")]
            metres = next(float(word[:-2]) for word in words if re.fullmatch(r"\d+ m", word or ""))
            per_metre = (scale[2] - scale[0]) / metres
            sizes = []
            for element in drawn["body"]:
                numbers = [float(x) for x in re.findall(r"[-\d.]+", element.get("d"))]
                wide, high = max(numbers[0::2]) - min(numbers[0::2]), max(numbers[1::2]) - min(numbers[1::2])
                sizes.append((wide / per_metre, high / per_metre))
            cos, sin = math.cos(math.radians(10)), math.sin(math.radians(10))
            across, along = 2.4 * cos + 6.1 * sin, 6.1 * cos + 2.4 * sin
            for expected in ((across, 2.6), (along, 2.6), (across, along)):
                self.assertTrue(any(abs(w - expected[0]) < 0.05 and abs(h - expected[1]) < 0.05 for w, h in sizes),
                                f"{expected} in {sizes}")

    def test_wrong_use(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = os.path.join(folder, "broken.yaml")
            with open(broken, "w", encoding="utf-8") as file:
                file.write("taut: 1\nname: <b>\n")
            for arguments, code in (([broken], "E3"), ([os.path.join(folder, "none.yaml")], "E2"),
                                    ([CASE, "--out", "x.png"], "E1"), ([CASE, "--colour"], "E1")):
                said = run(TAUT, "show", *arguments)
                self.assertEqual((said.returncode, said.stdout), (3, ""))
                self.assertRegex(said.stderr, rf"\[{code}\]")


def turn(phi, theta, sigma):
    from math import cos, sin

    def about_z(t):
        return [[cos(t), -sin(t), 0], [sin(t), cos(t), 0], [0, 0, 1]]

    def times(x, y):
        return [[sum(x[i][k] * y[k][j] for k in range(3)) for j in range(3)] for i in range(3)]

    about_y = [[cos(theta), 0, sin(theta)], [0, 1, 0], [-sin(theta), 0, cos(theta)]]
    return times(times(about_z(phi), about_y), about_z(sigma - phi))


def turn_of_roll_pitch_and_yaw(pose):
    """The turn about x, then about y, then about z, of each of the platform's axes."""
    from math import cos, sin
    columns = []
    for k in range(3):
        x, y, z = (float(k == j) for j in range(3))
        y, z = y * cos(pose["roll"]) - z * sin(pose["roll"]), y * sin(pose["roll"]) + z * cos(pose["roll"])
        z, x = z * cos(pose["pitch"]) - x * sin(pose["pitch"]), z * sin(pose["pitch"]) + x * cos(pose["pitch"])
        x, y = x * cos(pose["yaw"]) - y * sin(pose["yaw"]), x * sin(pose["yaw"]) + y * cos(pose["yaw"])
        columns.append((x, y, z))
    return [list(row) for row in zip(*columns)]


class Explain(unittest.TestCase):
    def test_all_are_listed_and_explained(self):
        listed = re.findall(r"^(\w+) +\S", run(TAUT, "explain").stdout, re.M)
        self.assertEqual(len(listed), len(set(listed)))
        self.assertGreater(len(listed), 25)
        for code in listed:
            said = run(TAUT, "explain", code.lower())
            self.assertEqual(said.returncode, 0)
            for part in (code, "Usual causes: ", "What to do: ", "Example: "):
                self.assertRegex(said.stdout, part + r"\S*")
            self.assertIn(f"[{code}]", said.stdout, "the example is one of it")
        self.assertEqual(run(TAUT, "explain", "U999").returncode, 3)

    def test_the_document_is_the_table(self):
        with open(os.path.join(SOURCE, "docs", "errors.md"), encoding="utf-8") as file:
            self.assertEqual(file.read(), run(TAUT, "explain", "--markdown").stdout)

    def test_messages_have_the_codes_that_fit(self):
        listed = run(TAUT, "explain").stdout
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write("phi[rad],theta[rad]\n0,x\n")
            certificate = os.path.join(folder, "c.json")
            with open(certificate, "w", encoding="utf-8") as file:
                file.write("{}")
            tight = os.path.join(folder, "tight.yaml")
            with open(CASE, encoding="utf-8") as file:
                text = file.read()
            with open(tight, "w", encoding="utf-8") as file:
                file.write(re.sub(r"^planner: .*\n", "planner: {max_charts: 3}\n", text, flags=re.M))
            audited = os.path.join(CASES, "audits", "robot1-planned.yaml")
            for code, exit_code, *command in (
                    ("E1", 3, "plan"),
                    ("E2", 3, "plan", CASE, "--out", "/proc/none"),
                    ("E2", 3, "plan", folder + "/none.yaml"),
                    ("E2", 3, "plan", folder),
                    ("E2", 3, "audit", audited, folder + "/none.csv"),
                    ("E2", 3, "audit", audited, folder),
                    ("E2", 3, "report", folder + "/none.json"),
                    ("E2", 3, "plan", CASE, "--atlas", folder + "/none.atlas"),
                    ("E3", 3, "plan", path),
                    ("E4", 3, "audit", audited, path),
                    ("E5", 3, "report", certificate),
                    ("E6", 3, "plan", CASE, "--atlas", path),
                    ("E7", 3, "plan", CASE, "--sign", path),
                    ("E9", 3, "regress", folder + "/none"),
                    ("U14", 2, "plan", tight, "--out", folder)):
                said = run(TAUT, *command)
                self.assertEqual(said.returncode, exit_code, said.stdout + said.stderr)
                self.assertRegex(said.stdout + said.stderr, rf"\[{code}\]", command)
                self.assertRegex(listed, rf"(?m)^{code} ")


    def test_examples_of_wrong_input_are_what_is_printed(self):
        with tempfile.TemporaryDirectory() as folder:
            def write(name, text):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)

            with open(CASE, encoding="utf-8") as file:
                case = file.read()
            write("robot1.yaml", case)
            nan = re.sub(r"^  wrench: .*\n", "  mass: NaN\n  gravity: [0, 0, -9.81]\n", case, flags=re.M)
            write("crane.yaml", nan)
            write("path.csv", "phi[rad],theta[rad]\n0,x\n")
            os.mkdir(os.path.join(folder, "cases"))
            subprocess.run(["openssl", "genrsa", "-out", "key.pem"], cwd=folder, check=True, capture_output=True)
            for code, *command in (("E1", "audit", "robot1.yaml", "path.csv", "--bits", "12"),
                                   ("E3", "plan", "crane.yaml"),
                                   ("E4", "audit", "robot1.yaml", "path.csv"),
                                   ("E7", "plan", "robot1.yaml", "--sign", "key.pem"),
                                   ("E9", "regress", "cases")):
                said = subprocess.run([TAUT, *command], cwd=folder, capture_output=True, text=True, timeout=60)
                example = re.search(r"^Example: (.*)$", run(TAUT, "explain", code).stdout, re.M).group(1)
                # The place of a case is that of the example's own.
                place = re.compile(r"^(taut: \S+yaml):\d+:\d+")
                self.assertEqual(place.sub(r"\1", said.stderr.splitlines()[0]), place.sub(r"\1", example))
            os.remove(os.path.join(folder, "crane.yaml"))
            said = subprocess.run([TAUT, "plan", "crane.yaml"], cwd=folder, capture_output=True, text=True, timeout=60)
            self.assertIn("Example: " + said.stderr, run(TAUT, "explain", "E2").stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

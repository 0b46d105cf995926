#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads that consist of items, from the case to the verdict, and what is said of them.

Usage: loads_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import html
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

TAUT, CHECK, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:4])
CASES = os.path.join(SOURCE, "cases")

CRANE = """\
taut: 1
name: portal-crane
units: {length: m, force: kN, moment: kN*m, mass: t, angle: deg, time: s}
robot:
  base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]]
  platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], [-1.3, -0.75, 0]]
  tension: [2, 160]
  length: [3, 35]
LOAD
tolerances: {base_anchor: 10 mm, platform_anchor: 10 mm}
space:
  slice: {py: 0, pz: 6, phi: 0, theta: 0, sigma: 0}
query:
  waypoints: [{px: 0}, {px: 0.5}]
"""
ITEMS = """\
load:
  gravity: [0, 0, -9.81 m/s^2]
  items:
    - {name: platform, mass: 8, at: [0, 0, 0]}
    - {name: payload, mass: 12, mass_tolerance: 2 %, at: [0, 0, -1.2], at_tolerance: 50 mm}
    - {name: wind, force: 6, direction: horizontal, at: [0, 0, -1]}"""


def command(*arguments):
    return subprocess.run(list(arguments), capture_output=True, text=True, timeout=300, check=False)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def solve(matrix, right):
    """Gauss's elimination."""
    rows = [row + [x] for row, x in zip(matrix, right)]
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i, row in enumerate(rows):
            if i != k:
                rows[i] = [x - row[k] * y for x, y in zip(row, rows[k])]
    return [row[-1] for row in rows]


class Loads(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_on(self, load, *command):
        """taut COMMAND[0] CASE with this load, in an empty folder but for the case."""
        with open(os.path.join(self.folder.name, "crane.yaml"), "w", encoding="utf-8") as file:
            file.write(CRANE.replace("LOAD", load))
        return subprocess.run([TAUT, command[0], "crane.yaml", *command[1:]], cwd=self.folder.name, capture_output=True,
                              text=True, check=False, timeout=600)

    def margins(self, out):
        with open(os.path.join(self.folder.name, out, "certificate.json"), encoding="utf-8") as file:
            return json.load(file)["margins"]

    def test_an_ellipsoid_that_stands_in_the_way_of_provable_items_is_blamed(self):
        case = os.path.join(self.folder.name, "around.yaml")
        with open(os.path.join(CASES, "cranes", "portal-20t.yaml"), encoding="utf-8") as file:
            text = re.sub(r"(?m)^(expect|decoration):.*\n(  .*\n)*", "", file.read())
        with open(case, "w", encoding="utf-8") as file:
            file.write(text.replace("  items:", "  ellipsoid: around_items\n  items:"))
        out = os.path.join(self.folder.name, "out")
        said = command(TAUT, "plan", case, "--out", out, "--headroom", "5")
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        blame = "waypoint 0 of the query is proved: what stands in the way is the ellipsoid, not the items."
        self.assertIn(blame, said.stdout)
        self.assertIn(blame, command(TAUT, "report", os.path.join(out, "certificate.json"), "--text").stdout)
        audited = command(TAUT, "plan", os.path.join(CASES, "cranes", "portal-20t.yaml"), "--out", out)
        self.assertEqual(audited.returncode, 0)
        audit = os.path.join(self.folder.name, "audit")
        said = command(TAUT, "audit", case, os.path.join(out, "path.csv"), "--out", audit, "--headroom", "5", "--json")
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        as_items = json.loads(said.stdout)["as_items"]
        self.assertEqual((as_items["verdict"], as_items["of_ellipsoid"]), ("proved", None))
        with open(os.path.join(out, "certificate.json"), encoding="utf-8") as file:
            self.assertEqual(as_items["margins"]["tension_N"], json.load(file)["margins"]["tension_N"])

    def test_a_load_is_shown_in_tonnes_and_kilonewtons(self):
        said = self.run_on(ITEMS, "show")
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        for expected in ("In all 19.76 to 20.24 t", "a force of 196.2 kN along −z",
                         "force x ± 6 kN, y ± 6 kN, z -198.5 to",
                         "'payload': 11.76 to 12.24 t, centre of gravity within 50 mm of (0, 0, -1.2) m",
                         "'wind': a force of up to 6 kN in any horizontal direction, at (0, 0, -1) m"):
            self.assertIn(expected, said.stdout)
        shown = json.loads(self.run_on(ITEMS, "show", "--json").stdout)
        self.assertEqual([item["name"] for item in shown["load"]["items"]], ["platform", "payload", "wind"])
        self.assertEqual(shown["problem"]["load"]["items"][1]["weight"]["mass_kg"], ["11760", "12240"])
        self.assertEqual(shown["warnings"], [])

    def test_a_plan_says_the_load_before_the_verdict(self):
        said = self.run_on(ITEMS, "plan", "--out", "out")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertLess(said.stdout.index("Load: In all 19.76 to 20.24 t"), said.stdout.index("PROVED:"))
        with open(os.path.join(self.folder.name, "out", "report.html"), encoding="utf-8") as file:
            report = file.read()
        self.assertIn("centre of gravity within 50 mm of (0, 0, -1.2) m", report)
        self.assertNotIn("all at once, within an ellipsoid", report)
        summary = json.loads(self.run_on(ITEMS, "plan", "--out", "out", "--json").stdout)
        self.assertEqual(summary["load"]["mass_kg"], [19760, 20240])

    def test_semi_axes_in_place_of_a_diagonal_are_warned_of(self):
        load = "load: {mass: 20 t, gravity: [0, 0, -9.81], ellipsoid: {KIND: [6, 6, 1, 3, 3, 1]}}"
        said = self.run_on(load.replace("KIND", "diagonal"), "show")
        self.assertRegex(said.stderr, r"^taut: warning: crane\.yaml:9:\d+: load\.ellipsoid\.diagonal: .*only 0\.408")
        self.assertEqual(self.run_on(load.replace("KIND", "semi_axes"), "show").stderr, "")
        shown = json.loads(self.run_on(load.replace("KIND", "diagonal"), "show", "--json").stdout)
        self.assertEqual(len(shown["warnings"]), 1)

    def test_a_proved_crane_is_proved_again_for_its_case_and_path(self):
        case = os.path.join(CASES, "cranes", "portal-20t.yaml")
        out = os.path.join(self.folder.name, "out")
        said = command(TAUT, "plan", case, "--out", out)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertIn("19.76 to 20.24 t", said.stdout)
        again = command(CHECK, os.path.join(out, "certificate.json"), case, "--path", os.path.join(out, "path.csv"))
        self.assertEqual(again.returncode, 0, again.stdout)
        for old, new in (("mass_tolerance: 2 %", "mass_tolerance: 1 %"), ("force: 6,", "force: 5,"),
                         ("50 mm}", "49 mm}")):
            other = os.path.join(self.folder.name, "other.yaml")
            with open(case, encoding="utf-8") as file:
                text = file.read()
            self.assertIn(old, text)
            with open(other, "w", encoding="utf-8") as file:
                file.write(text.replace(old, new))
            self.assertEqual(command(CHECK, os.path.join(out, "certificate.json"), other).returncode, 1, new)

    def test_a_refutation_names_a_load_that_breaks_the_limit(self):
        case = os.path.join(CASES, "cranes", "portal-20t-gust.yaml")
        said = command(TAUT, "plan", case, "--out", os.path.join(self.folder.name, "out"))
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertRegex(said.stdout, r"A load that breaks the limit there: 'platform' 8 t; 'payload' 11\.76 t, its "
                                      r"centre of gravity off by \(-19\.\d+, 46\.\d+, 0\) mm; "
                                      r"'wind' \(28\.\d+, 7\.\d+, 0\) kN\.")
        report = command(TAUT, "report", os.path.join(self.folder.name, "out", "certificate.json"), "--text").stdout
        self.assertIn("A load that breaks the limit there", report)
        with open(os.path.join(self.folder.name, "out", "certificate.json"), encoding="utf-8") as file:
            certificate = json.load(file)
        witness, robot = certificate["witness"], certificate["problem"]["robot"]
        platform, payload, wind = witness["loads"]
        # Each part is in its set, exactly.
        self.assertEqual(platform, {"mass_kg": "8000", "offset_m": ["0", "0", "0"]})
        self.assertEqual(Fraction(payload["mass_kg"]), Fraction(12000) * 98 / 100)
        self.assertLessEqual(sum(Fraction(x) ** 2 for x in payload["offset_m"]), Fraction(50, 1000) ** 2)
        self.assertEqual(Fraction(wind["vector"][2]), 0)
        self.assertLessEqual(sum(Fraction(x) ** 2 for x in wind["vector"]), 30000 ** 2)
        # The tension that they cause at waypoint 0, (-4, 0, 6) m turned by -6 degrees, by moments about the origin.
        c, d = math.cos(math.radians(-6)), math.sin(math.radians(-6))

        def at(point):
            return [-4 + c * point[0] - d * point[1], d * point[0] + c * point[1], 6 + point[2]]

        def numbers(texts):
            return [float(Fraction(x)) for x in texts]

        columns = []
        for base, end in zip(robot["base_anchors_m"], robot["platform_anchors_m"]):
            base, end = numbers(base), at(numbers(end))
            length = math.dist(base, end)
            pull = [(end[k] - base[k]) / length for k in range(3)]
            columns.append(pull + cross(base, pull))
        centre = [x + y for x, y in zip(at([0, 0, -1.2]), numbers(payload["offset_m"]))]
        forces = [(at([0, 0, 0]), [0, 0, -9.81 * 8000]), (centre, [0, 0, -9.81 * float(payload["mass_kg"])]),
                  (at([0, 0, -1]), numbers(wind["vector"]))]
        wrench = [sum(column) for column in zip(*(force + cross(point, force) for point, force in forces))]
        tension = solve([list(row) for row in zip(*columns)], wrench)[witness["cable"] - 1]
        low, high = (float(x) for x in witness["value"])
        self.assertAlmostEqual(tension, low, delta=1e-6 * abs(low))
        self.assertLess(high, 2000)

    def test_an_audit_says_the_load_right_behind_the_gravest_violation(self):
        out = os.path.join(self.folder.name, "out")
        calm, gust = (os.path.join(CASES, "cranes", name) for name in ("portal-20t.yaml", "portal-20t-gust.yaml"))
        self.assertEqual(command(TAUT, "plan", calm, "--out", out, "--headroom", "0").returncode, 0)
        said = command(TAUT, "audit", gust, os.path.join(out, "path.csv"), "--out", os.path.join(out, "audit"),
                       "--headroom", "0")
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        lines = said.stdout.splitlines()
        gravest = next(k for k, line in enumerate(lines) if line.startswith("Gravest: "))
        self.assertRegex(lines[gravest + 1], r"^A load that breaks the limit there: 'platform' 8 t; 'payload' ")
        self.assertEqual(lines[gravest + 2], "Not proved:")

    def test_an_item_with_an_ellipsoid_keeps_its_name(self):
        sway = ITEMS.replace("name: wind, force: 6, direction: horizontal, at: [0, 0, -1]",
                             "name: sway <b>, wrench: [0, 0, 0, 0, 0, 0], "
                             "ellipsoid: {semi_axes: [6, 6, 1, 5, 5, 5]}")
        self.assertIn("'sway <b>': differs from zero in the components of the force by up to (6, 6, 1) kN, each "
                      "component of the moment by up to 5 kN·m;", self.run_on(sway, "show").stdout)
        of_its_own = sway.replace("wrench: [0, 0, 0, 0, 0, 0]", "wrench: [0, 1, 0, 0, 0, 2]")
        self.assertIn("'sway <b>': differs from a force of 1 kN along +y and a moment of 2 kN·m along +z in the "
                      "components of the force", self.run_on(of_its_own, "show").stdout)
        said = self.run_on(sway, "plan", "--out", "out")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        certificate = os.path.join(self.folder.name, "out", "certificate.json")
        with open(certificate, encoding="utf-8") as file:
            self.assertEqual(json.load(file)["problem"]["load"]["ellipsoid_name"], "sway <b>")
        case = os.path.join(self.folder.name, "crane.yaml")
        said = command(CHECK, certificate, case)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertIn('an ellipsoid "sway <b>", around', command(CHECK, certificate).stdout)
        with open(os.path.join(self.folder.name, "out", "report.html"), encoding="utf-8") as file:
            self.assertIn("sway &lt;b&gt;", file.read())
        said = self.run_on(sway.replace("sway <b>", "payload"), "plan", "--out", "twice")
        self.assertEqual(said.returncode, 3)
        self.assertRegex(said.stderr, r"^taut: crane\.yaml:14:\d+: .*'payload' twice")

    def test_an_ellipsoid_around_items_takes_their_place(self):
        around = ITEMS.replace("  items:", "  ellipsoid: around_items\n  items:")
        said = self.run_on(around, "show").stdout
        for words in ("In all 19.76 to 20.24 t", "'payload': 11.76 to 12.24 t",
                      "the load is one ellipsoid, the smallest",
                      "about the load point (0, 0, -720) mm", "'ellipsoid': differs from the nominal load in"):
            self.assertIn(words, said)
        load = json.loads(self.run_on(around, "show", "--json").stdout)["load"]
        self.assertEqual(load["around_items"]["mass_kg"], [19760, 20240])
        self.assertIsNone(load["mass_kg"])
        for outer, inner in zip(load["extreme_wrenches"], load["around_items"]["extreme_wrenches"]):
            self.assertLess(outer[0], inner[0])
            self.assertGreater(outer[1], inner[1])
        self.assertIsNone(json.loads(self.run_on(ITEMS, "show", "--json").stdout)["load"]["around_items"])
        said = self.run_on(around, "plan", "--out", "out")
        self.assertIn("In place of these items, the load is one ellipsoid", said.stdout)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        certificate = os.path.join(self.folder.name, "out", "certificate.json")
        with open(certificate, encoding="utf-8") as file:
            stated = json.load(file)["problem"]["load"]
        self.assertEqual(sorted(stated), ["ellipsoid", "point_m", "wrench"])
        case = os.path.join(self.folder.name, "crane.yaml")
        self.assertEqual(command(CHECK, certificate, case).returncode, 0)
        # The report lists the items, as what the case says and nobody checks.
        with open(os.path.join(self.folder.name, "out", "report.html"), encoding="utf-8") as file:
            page = html.unescape(file.read())
        note = "From the case, not checked: this ellipsoid was put around the items that follow."
        self.assertIn("What the case puts the ellipsoid around; not checked", page)
        text = command(TAUT, "report", certificate, "--text").stdout
        for shown in (page, text):
            self.assertLess(shown.index("differs from the nominal load in"), shown.index(note))
            self.assertIn("11.76 to 12.24 t, centre of gravity within 50 mm of (0, 0, -1.2) m",
                          shown[shown.index(note):])
        reported = json.loads(command(TAUT, "report", certificate, "--json").stdout)["load"]
        for key in ("mass_kg", "items", "extreme_wrenches", "nominal_wrench", "centre_of_gravity_m"):
            self.assertEqual(reported["around_items"][key], load["around_items"][key], key)
        # What the ellipsoid costs.
        cost = r"With the items in place of the ellipsoid around them, this path is proved with a tension margin of " \
               r"(\S+) kN in place of (\S+) kN, and the load's deviations may grow by the factor (\S+) " \
               r"in place of (\S+)\."
        for shown in (said.stdout, page, text):
            items_kN, ellipsoid_kN, items_growth, ellipsoid_growth = map(float, re.search(cost, shown).groups())
            self.assertGreater(items_kN, ellipsoid_kN)
            self.assertGreater(items_growth, ellipsoid_growth)
        as_items = json.loads(self.run_on(around, "plan", "--out", "out", "--json").stdout)["as_items"]
        self.assertEqual((as_items["subject"], as_items["verdict"]), ("this path", "proved"))
        plain = json.loads(self.run_on(ITEMS, "plan", "--out", "plain", "--json").stdout)
        self.assertIsNone(plain["as_items"])
        self.assertEqual(as_items["margins"]["tension_N"], self.margins("plain")["tension_N"])
        self.assertEqual(as_items["of_ellipsoid"], self.margins("out"))
        self.assertNotIn("With the items in place",
                         command(TAUT, "report", certificate, "--text", "--max-seconds", "0").stdout)
        self.run_on(ITEMS, "show")  # the items themselves are another problem
        self.assertEqual(command(CHECK, certificate, case).returncode, 1)

    def test_a_load_that_makes_no_sense_is_refused_and_nothing_is_written(self):
        for change, expected in (
                ((r"mass: 12,", "mass: -12,"),
                 r"crane\.yaml:13:\d+: load\.items\[payload\]\.mass: got '-12', expected a mass"),
                ((r"2 %", "200 %"),
                 r"load\.items\[payload\]\.mass_tolerance: got '200 %', expected a tolerance from 0 to"),
                ((r"name: wind", "name: payload"), r"load\.items\[2\]\.name: got 'payload' twice"),
                ((r"force: 6, direction", "force: 6, wrench: [0, 0, 1, 0, 0, 0], direction"),
                 r"got force, wrench in one"),
                ((r"direction", "directon"), r"did you mean 'direction'\?"),
                ((r"  gravity: .*\n", ""), r"load\.gravity: got none, expected gravity"),
                ((r"mass: 12, mass_tolerance: 2 %", "force: [200, 300], direction: [0, 0, 1]"),
                 "expected a downward load"),
                ((r"    - {name: p.*\n", ""), "got a load whose nominal force is zero"),
                ((r"name: wind, .*}",
                  "name: e, wrench: [0, 0, 0, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 0]}}"),
                 "expected a positive definite matrix")):
            load = re.sub(*change, ITEMS)
            self.assertNotEqual(load, ITEMS)
            said = self.run_on(load, "plan", "--out", "out")
            self.assertEqual(said.returncode, 3, said.stderr)
            place = r"^taut: crane\.yaml:\d+:\d+: load.*" if "gravity" not in change[0] else "^taut: "
            self.assertRegex(said.stderr, place)
            self.assertRegex(said.stderr, expected)
            self.assertEqual(os.listdir(self.folder.name), ["crane.yaml"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

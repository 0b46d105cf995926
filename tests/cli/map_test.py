#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut map: what it prints, its JSON and its picture; what it refuses.

Usage: map_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import subprocess
import xml.etree.ElementTree as xml

from command_line import CASES, ROBOT1, TAUT, InFolder, interrupt, main, run, text_of

SVG = "{http://www.w3.org/2000/svg}"


class Map(InFolder):
    def found(self, *arguments):
        said = run(TAUT, "map", *arguments, "--json")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        return json.loads(said.stdout)

    def test_the_slice_of_robot_1(self):
        found = self.found(ROBOT1)
        share = found["share"]
        self.assertEqual(sum(share[kind] for kind in ("inside", "tension", "length", "unbalanced", "undecided")), 1)
        self.assertLessEqual(share["undecided"], 0.01)
        # A raster has 49.55 % inside.
        self.assertLess(share["inside"], 0.4956)
        self.assertGreater(share["inside"] + share["undecided"], 0.4954)
        self.assertEqual((found["end"], found["connections"]), ("share", ["joined"]))
        self.assertEqual(found["inside"]["count"], len(found["inside"]["largest"]))
        self.assertEqual([axis["kind"] for axis in found["axes"]], ["turn", "tilt"])

    def test_text_restates_the_load_and_says_what_is_proved(self):
        said = run(TAUT, "map", ROBOT1, "--undecided", "5 %")
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        for expected in ("Load: ", "phi [rad] from -3.1416 to 3.1416, a whole turn", "which is every tilt",
                         "inside, proved", "outside, proved", "undecided", "from waypoint 0 to 1 of the query: joined"):
            self.assertIn(expected, said.stdout)

    def test_the_same_map_on_any_number_of_threads(self):
        def without_times(document):
            return {key: value for key, value in document.items() if not key.endswith("seconds")}
        one = without_times(self.found(ROBOT1, "--undecided", "0.03"))
        said = subprocess.run(["taskset", "-c", "0", TAUT, "map", ROBOT1, "--undecided", "0.03", "--json"],
                              capture_output=True, text=True, timeout=300, check=True)
        self.assertEqual(without_times(json.loads(said.stdout)), one)

    def test_waypoints_that_are_apart_or_infeasible(self):
        """The regions of Fig. 7: one at small tilts, and three more at large ones."""
        def connections(*waypoints):
            lines = "".join(f"    - {{phi: {phi}, theta: {theta}}}\n" for phi, theta in waypoints)
            changed, times = re.subn(r"(?<=waypoints:\n)(    - .*\n)+", lines, text_of(ROBOT1))
            self.assertEqual(times, 1)
            changed = re.sub(r"^expect:.*\n", "", changed, flags=re.M)
            return self.found(self.write("case.yaml", changed))["connections"]
        main_region, others = (-2.3, 1.6), [(-1.2, 2.0), (0.8, 1.8), (2.6, 2.6)]
        self.assertEqual(connections(main_region, others[0], others[1], others[2], others[0]), ["apart"] * 4)
        self.assertEqual(connections(main_region, (0.3, 1.5)), ["outside"])
        # Across phi = 180 degrees, and over theta = 0, beyond which phi is half a turn further.
        self.assertEqual(connections((3.1, 0.5), (-3.1, 0.5), (0.0, -0.5), (1.0, 0.0)), ["joined"] * 3)

    def test_the_picture_has_all_kinds_and_marks(self):
        said = run(TAUT, "map", ROBOT1, "--undecided", "5%", "--out", self.path("map"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(os.listdir(self.path("map")), ["map.svg"])
        picture = xml.fromstring(text_of(self.path("map", "map.svg")))
        classes = {path.get("class") for path in picture.iter(SVG + "path")}
        self.assertLessEqual({"inside", "tension", "unbalanced", "undecided", "singular"}, classes)
        texts = {text.text for text in picture.iter(SVG + "text")}
        self.assertLessEqual({"start", "goal", "phi [rad]", "theta [rad]", "encloses det J = 0"}, texts)

    def test_budgets_end_it(self):
        self.assertEqual(self.found(ROBOT1, "--budget", "0.001")["end"], "time")
        self.assertEqual(self.found(ROBOT1, "--cells", "10000")["end"], "cells")
        self.assertEqual(self.found(ROBOT1, "--cell", "0.02", "--undecided", "0.001")["end"], "width")

    def test_an_interruption_is_said(self):
        process = subprocess.Popen([TAUT, "map", os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml"),
                                    "--undecided", "0.001", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        interrupt(process, 0.5)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, err)
        self.assertEqual(json.loads(out)["error"]["code"], "U11")

    def test_three_coordinates(self):
        case = os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml")
        found = self.found(case, "--undecided", "60 %")
        self.assertEqual(len(found["axes"]), 3)
        self.assertGreater(found["share"]["inside"], 0)
        said = run(TAUT, "map", case, "--out", self.path("x"))
        self.assertEqual(said.returncode, 3)
        self.assertIn("expected two, because the picture is flat", said.stderr)
        self.assertFalse(os.path.exists(self.path("x")))

    def test_what_has_no_map_is_refused(self):
        for name, expected in (("robot1-free-box-qs-qg", "(px, py, pz, phi, theta, sigma), expected two or three"),
                               ("robot2-implicit-rail", "expected")):
            said = run(TAUT, "map", os.path.join(CASES, name + ".yaml"))
            self.assertEqual(said.returncode, 3, said.stdout)
            self.assertIn(expected, said.stderr)
            self.assertIn("[E3]", said.stderr)
        unbounded = text_of(ROBOT1).replace("slice: {px: 0, py: 0,", "slice: {py: 0, theta: 0.3,")
        unbounded = re.sub(r"\{phi: [-\d.]+, theta: [-\d.]+\}", "{phi: 0, px: 0}", unbounded)
        said = run(TAUT, "map", self.write("unbounded.yaml", unbounded))
        self.assertEqual(said.returncode, 3)
        self.assertIn("px: got a coordinate without bounds, expected a range", said.stderr)
        for share in ("0", "100%", "x", "-1%"):
            self.assertEqual(run(TAUT, "map", ROBOT1, f"--undecided={share}").returncode, 3)
        self.assertEqual(run(TAUT, "map", ROBOT1, "--cell", "2").returncode, 3)
        self.assertEqual(run(TAUT, "map", ROBOT1, "--cells", "5").returncode, 3)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a newcomer reads when a case, a path or a command line is not what was meant, and in which units.

Usage: messages_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import math
import os
import re

from command_line import CHECK, TAUT, InFolder, main, run, text_of


class Messages(InFolder):
    """All of it is about the case that taut init writes."""

    def setUp(self):
        super().setUp()
        self.case = self.path("crane.yaml")
        self.assertEqual(run(TAUT, "init", self.case).returncode, 0)
        self.text = text_of(self.case)

    def altered(self, *changes):
        text = self.text
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        return self.write("altered.yaml", text)

    def plan(self, *changes, code, options=()):
        said = run(TAUT, "plan", self.altered(*changes) if changes else self.case, "--out", self.path("out"), *options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout

    def wide(self):
        """The case with ranges that nothing leaves."""
        return self.altered(("px: [-1500, 1500], py: [-1500, 1500], pz: [1000, 6000]",
                             "px: [-9000, 9000], py: [-9000, 9000], pz: [-9000, 20000]"))

    def audit(self, path, code, case=None):
        said = run(TAUT, "audit", case or self.case, path, "--out", self.path("audit"))
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout

    def report(self, *options):
        return run(TAUT, "report", self.path("out", "certificate.json"), "--text", *options).stdout

    # --- What may be wrong with the case ---

    def test_a_start_that_is_singular_but_for_rounding_is_called_singular(self):
        turned = ("theta: 0, sigma: 0}", "theta: 0, sigma: 90}")
        said = self.plan(turned, code=1)
        self.assertRegex(said, r"(?m)^REFUTED - DO NOT RUN: at waypoint 0 of the query the platform is at a singular "
                         r"pose, or so "
                               r"near one")
        self.assertNotRegex(said, r"\d{9}")
        report = self.report()
        self.assertIn("singular pose, or so near one", report)
        self.assertNotRegex(re.sub(r"[0-9a-f]{64}", "", report), r"(?<![.\d])\d{9}|e\+1\d")
        shown = run(TAUT, "show", self.path("altered.yaml")).stdout
        self.assertIn("The force Jacobian is singular here, or nearly so", shown)
        self.assertNotRegex(shown, r"e\+1\d")

    def test_a_waypoint_out_of_range_names_parameter_value_and_range(self):
        said = self.plan(("px: [-1500, 1500]", "px: [-1500, 1100]"), ("px: 500, py", "px: 1100, py"), code=2)
        self.assertRegex(said, r"waypoint 1 of the query: .*: px is 1\.1 and so, but for rounding, at an end of its "
                               r"range, its range is from -1\.5 to 1\.1 \(SI: m, rad\) \[U1\]")

    def test_a_reversed_gravity_is_suspected(self):
        reversed_gravity = ("gravity: [0, 0, -9.81]", "gravity: [0, 0, 9.81]")
        question = "does gravity point the wrong way, or the z axis?"
        self.assertIn(question, self.plan(reversed_gravity, code=1))
        self.assertIn(question, self.report())
        self.assertIn(question, run(TAUT, "show", self.path("altered.yaml")).stdout)
        table = self.table("px,py,pz,phi,theta,sigma", (0, 0, 2, 0, 0, 0), (.1, 0, 2, 0, 0, 0))
        self.assertIn(question, self.audit(table, 1, self.path("altered.yaml")))
        self.assertNotIn(question, self.plan(("mass: 300 kg", "mass: 50 t"), code=1), "too heavy is another fault")
        self.assertNotIn(question, run(TAUT, "show", self.case).stdout)

    def test_tabs_in_indentation_are_named(self):
        for old, new, line in (("  tension: [50 N", "\ttension: [50 N", 26),
                               ("    - [0, 3000, 8000]", "  \t- [0, 3000, 8000]", 13)):
            said = run(TAUT, "show", self.altered((old, new)))
            self.assertEqual(said.returncode, 3)
            line = self.text[:self.text.index(old)].count("\n") + 1
            self.assertRegex(said.stderr,
                             rf"altered\.yaml:{line}:\d: got a tab .* YAML forbids tabs in indentation \[E3\]")
        elsewhere = self.altered(("tension: [50 N", "tension:\t[50 N"))
        self.assertEqual(run(TAUT, "show", elsewhere).returncode, 0, "elsewhere they may be")

    # --- What may be wrong with a path ---

    def table(self, names, *rows):
        units = {"p": "[m]", "t": "[deg]", "s": "[deg]", "q": ""}
        units["ph"] = "[deg]"
        head = ", ".join(name + units.get(name[:2], units[name[0]]) for name in names.split(","))
        return self.write("path.csv", "\n".join([head] + [", ".join(map(str, row)) for row in rows]) + "\n")

    def test_quaternions_with_w_first_are_suspected(self):
        half = math.radians(2)
        right, wrong = [0, 0, math.sin(half), math.cos(half)], [math.cos(half), 0, 0, math.sin(half)]
        names = "px,py,pz,qx,qy,qz,qw"
        said = self.audit(self.table(names, [0, 0, 2] + wrong, [.1, 0, 2] + wrong), 1)
        self.assertRegex(said, r"In line 2 the quaternion, read as x, y, z, w, turns the platform by \d+ degrees .* "
                               r"Read as w, x, y, z it would turn it by 4 degrees: is the file's w its first number\?")
        tum = self.write("path.tum", "".join(f"{t} {t} 0 2 {' '.join(map(str, wrong))}\n" for t in (0, 0.1)))
        self.assertIn("is the file's w its first number?", self.audit(tum, 1))
        self.assertNotIn("w its first", self.audit(self.table(names, [0, 0, 2] + right, [.1, 0, 2] + right), 0))

    def test_swapped_columns_are_named(self):
        names = "px,py,pz,phi,theta,sigma"
        said = self.audit(self.table(names, (2, .1, 0, 0, 0, 0), (2, .1, .1, 0, 0, 0)), 1, self.wide())
        self.assertIn("In line 2 the pose is outside the limits. With px and pz exchanged it would be within all of "
                      "them: are these two columns swapped?", said)
        self.assertNotIn("swapped", self.audit(self.table(names, (0, .1, 2, 0, 0, 0), (.1, .1, 2, 0, 0, 0)), 0))

    def test_swapped_lengths_are_named(self):
        cables = json.loads(run(TAUT, "show", self.altered(("px: 0, py: 0, pz: 2000", "px: 300, py: 200, pz: 2500")),
                                "--json").stdout)["waypoints"][0]["cables"]
        lengths = [cable["length_m"] for cable in cables]
        swapped = " (With l{} and l{} exchanged they would agree: are these columns swapped?)"

        def audit(a, b):
            row = list(lengths)
            row[a - 1], row[b - 1] = row[b - 1], row[a - 1]
            text = ", ".join(f"l{i}[m]" for i in range(1, 7)) + "\n"
            for off in (0, .01):
                text += ", ".join(repr(x + off) for x in row) + "\n"
            return run(TAUT, "audit", self.path("altered.yaml"), self.write("l.csv", text), "--out", self.path("audit"))

        self.assertGreater(abs(lengths[0] - lengths[3]), 0.1)
        said = audit(1, 4)
        self.assertEqual(said.returncode, 3, said.stdout)
        self.assertIn(swapped.format("1", "4"), said.stderr)
        self.assertLess(abs(lengths[1] - lengths[4]), 0.02)
        self.assertIn(swapped.format("2", "5"), audit(2, 5).stdout, "a difference that is let pass")
        self.assertNotIn("swapped", audit(2, 2).stdout)

    def test_the_rest_is_proved_only_where_there_is_a_rest(self):
        names = "px,py,pz,phi,theta,sigma"
        part = self.audit(self.table(names, (0, 0, 2, 0, 0, 0), (0, 0, 8.5, 0, 0, 0)), 1, self.wide())
        self.assertIn("REFUTED - DO NOT RUN: 1 stretch of the path has proved violations; all the rest is proved.",
                      part)
        whole = self.audit(self.table(names, (0, 0, 9, 0, 0, 0), (.1, 0, 9, 0, 0, 0)), 1, self.wide())
        self.assertIn("REFUTED - DO NOT RUN: 1 stretch of the path has proved violations; no part of the path is "
                      "proved.", whole)
        said = run(TAUT, "report", self.path("audit", "certificate.json"), "--text").stdout
        self.assertIn("1 stretch of the path has proved violations; no part of it is proved.", said)

    # --- The command line ---

    def test_the_nearest_command_and_option_are_suggested(self):
        for arguments, expected in (
                (["pln", self.case], "got 'pln', did you mean 'plan'? Expected a command: plan audit"),
                (["frobnicate"], "got 'frobnicate', expected a command: plan audit"),
                (["plan", self.case, "--buget", "3"], "got the unknown option '--buget', did you mean '--budget'?"),
                (["audit", self.case, "--jsno"], "got the unknown option '--jsno', did you mean '--json'?"),
                (["show", self.case, "--rainbow"], "got the unknown option '--rainbow', expected one that"),
                (["show", self.case, "more"], "got 'more', expected no further argument")):
            said = run(TAUT, *arguments)
            self.assertEqual((said.returncode, said.stdout), (3, ""))
            self.assertTrue(said.stderr.startswith(expected), said.stderr)
            self.assertIn("[E1]", said.stderr)

    # --- Words and units ---

    def test_one_is_not_many(self):
        said = self.plan(("px: 500, py: -300, pz: 3500, phi: 0, theta: 5, sigma: 10",
                          "px: 1, py: 0, pz: 2000, phi: 0, theta: 0, sigma: 1"), code=0)
        self.assertIn("1 segment in 1 box.", said)
        for noun in ("segment", "boxe", "chart", "edge", "waypoint", "row", "stretche"):
            self.assertNotRegex(said, rf"(?<!\d)1 {noun}s\b")
        path = self.path("out", "certificate.json")
        said = run(TAUT, "audit", self.path("altered.yaml"), path, "--out", self.path("again"))
        self.assertIn("a certificate's path, 2 waypoints", said.stdout)
        self.assertIn("everywhere between, 1 segment in 1 box.", said.stdout)

    def test_results_are_in_the_units_of_the_case(self):
        base = json.loads(self.plan(code=0, options=["--json"]))["margins"]
        said = self.plan(code=0)
        self.assertRegex(said, r"Closest to going slack +Cable \d: \+[\d.]+ % +[\d.]+ N, limit 50 N")
        millimetres = re.search(r"Least length left +Cable \d: ([\d.]+) mm ", said).group(1)
        self.assertGreaterEqual(float(millimetres), float(base["length_m"]) * 990, "as sharp as the margin")
        self.assertRegex(said, r"origin moves 1609 mm, and the platform turns 11\.18 deg\.")
        in_kN = (("length: mm, force: N, moment: N*m", "length: m, force: kN, moment: kN*m"),)
        metres = self.text
        for numbers in re.findall(r"\[-?\d[^\]\[]*\]", metres.split("load:")[0]):
            if "N" not in numbers and " m" not in numbers:
                in_metres = ", ".join(f"{float(x) / 1000:g}" for x in numbers[1:-1].split(","))
                metres = metres.replace(numbers, "[" + in_metres + "]")
        for old, new in (("[0, 0, -200]", "[0, 0, -0.2]"),
                         ("[0, 0, -333], at_tolerance: 10}", "[0, 0, -0.333], at_tolerance: 0.01}"),
                         ("px: [-1500, 1500], py: [-1500, 1500], pz: [1000, 6000]",
                          "px: [-1.5, 1.5], py: [-1.5, 1.5], pz: [1, 6]")):
            self.assertIn(old, metres)
            metres = metres.replace(old, new)
        metres = metres.replace("pz: 2000", "pz: 2")
        metres = metres.replace("px: 500, py: -300, pz: 3500", "px: 0.5, py: -0.3, pz: 3.5")
        self.text = metres
        said = self.plan(*in_kN, code=0)
        self.assertRegex(said, r"Closest to going slack +Cable \d: \+[\d.]+ % +[\d.]+ kN, limit 0\.05 kN")
        self.assertRegex(said, rf"Least length left +Cable \d: {float(millimetres) / 1000:g} m ")
        self.assertRegex(said, r"origin moves 1\.609 m, ")
        report = self.report()
        self.assertRegex(report, r"Closest to going slack: Cable \d: \+\d+ % \([\d.]+ kN, limit 0\.05 kN")
        for expected in ("Every tension above 0.05 kN and below 4 kN",
                         "every cable length above 1 m and below 9 m", "Tension from [kN]",
                         "Least length left: Cable "):
            self.assertIn(expected, report)
        shown = run(TAUT, "show", self.path("altered.yaml")).stdout
        for expected in ("tension [kN]", "0.05 to 4", "length [m]", "tension f0 ± v [kN]", "force x ± 0.08 kN"):
            self.assertIn(expected, shown)
        page = text_of(self.path("out", "report.html"))
        for expected in ("Tension [kN]", "Base anchor a [m]", "px [m]"):
            self.assertIn(expected, page)
        again = run(CHECK, self.path("out", "certificate.json"), self.path("altered.yaml"))
        self.assertEqual(again.returncode, 0, "what is proved is the same")

    # --- Growing an atlas ---

    def test_growing_says_what_it_may_cost_and_ends_with_its_budget(self):
        atlas = self.path("crane.atlas")
        said = self.plan(code=0, options=["--save-atlas", atlas, "--grow", "--grow-seconds", "1"])
        self.assertRegex(said, r"Growing the atlas to all charts that can be reached, 200000 at most "
                               r"\(planner\.max_charts\): as it begins, these would take about [\d.e+]+ s and a file "
                               r"of [\d.e+]+ MB\. It ends after 1 s")
        self.assertRegex(said, r"Atlas of \d+ charts, NOT all that can be reached, written to .*: growing ended after "
                               r"[\d.]+ s \(--grow-seconds\), with \d+ charts complete")
        self.assertTrue(os.path.isfile(atlas))
        again = self.plan(code=0, options=["--atlas", atlas, "--json"])
        self.assertGreater(json.loads(again)["charts_stored"], 0, "what was saved is of use")
        said = run(TAUT, "plan", self.case, "--grow-seconds", "1")
        self.assertEqual(said.returncode, 3, "of use with --grow alone")


if __name__ == "__main__":
    main()

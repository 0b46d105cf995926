#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut init --from caspr:…`: robots of CASPR become cases, digit by digit, or an error says where the file is wrong.

Usage: init_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import math
import os
import random
import re

from command_line import CASES, CHECK, InFolder, TAUT, main, run, text_of

CRANE = os.path.join(CASES, "robots", "nist-robocrane")
FAST = os.path.join(CASES, "robots", "fast")
UNITS = ("--units", "length=m,force=N")


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turn(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    result = [[float(a == b) for b in range(3)] for a in range(3)]
    result[i][i] = result[j][j] = c
    result[i][j], result[j][i] = -s, s
    return result


class Init(InFolder):
    def setUp(self):
        super().setUp()
        self.cables = text_of(os.path.join(CRANE, "NIST_RoboCrane_cables.xml"))
        self.bodies = text_of(os.path.join(CRANE, "NIST_RoboCrane_bodies.xml"))
        self.case = self.path("crane.yaml")

    def init(self, *options, cables=None, bodies=None, units=UNITS, name="r"):
        """Imports the robot, as it is or as edited."""
        with open(self.path(name + "_cables.xml"), "w", encoding="utf-8") as file:
            file.write(self.cables if cables is None else cables)
        with open(self.path(name + "_bodies.xml"), "w", encoding="utf-8") as file:
            file.write(self.bodies if bodies is None else bodies)
        if os.path.exists(self.case):
            os.remove(self.case)
        return run(TAUT, "init", self.case, "--from", "caspr:" + self.path(name + "_cables.xml"), *units, *options)

    def shown(self, **edits):
        made = self.init(**edits)
        self.assertEqual(made.returncode, 0, made.stderr)
        result = run(TAUT, "show", self.case, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def edited(self, text, old, new, count=1):
        self.assertIn(old, text)
        return text.replace(old, new, count)

    def refused(self, message, *options, **edits):
        made = self.init(*options, **edits)
        self.assertEqual(made.returncode, 3, made.stdout + made.stderr)
        self.assertIn(message, made.stderr)
        self.assertEqual(made.stderr.count("\n"), 1, made.stderr)
        self.assertFalse(os.path.exists(self.case))
        return made.stderr

    def test_the_numbers_are_the_files_own(self):
        for folder, name in ((CRANE, "NIST_RoboCrane"), (FAST, "FAST")):
            with self.subTest(name):
                self.case = self.path(name + ".yaml")
                cables = os.path.join(folder, name + "_cables.xml")
                made = run(TAUT, "init", self.case, "--from", "caspr:" + cables, *UNITS)
                self.assertEqual(made.returncode, 0, made.stderr)
                self.assertIn("limits of cable length", made.stdout)
                problem = json.loads(run(TAUT, "show", self.case, "--json").stdout)["problem"]
                places = re.findall(r"<location>(.*)</location>", text_of(cables))
                points = [[float(x) for x in place.split()] for place in places]
                for kind, expected in (("base", points[::2]), ("platform", points[1::2])):
                    have = [[float(x) for x in point] for point in problem["robot"][kind + "_anchors_m"]]
                    self.assertEqual(have, expected)
                self.assertEqual(len(points), 12)
                highest = re.findall(r"<force_max>(.*)</force_max>", text_of(cables))
                have = [float(pair[1]) for pair in problem["robot"]["tension_N"]]
                self.assertEqual(have, [float(x) for x in highest])
                mass = float(re.search(r"<mass>(.*)</mass>", text_of(cables.replace("cables", "bodies"))).group(1))
                self.assertAlmostEqual(float(problem["load"]["wrench"][2]), -9.81 * mass, delta=1e-9 * mass)
                published = text_of(os.path.join(folder, "as-published.yaml"))
                published = re.sub(r"expect:.*\n", "", published[published.index("robot:"):])
                ours = text_of(self.case)
                self.assertEqual(ours[ours.index("robot:"):], published)

    def test_a_made_case_plans_and_is_checked(self):
        self.assertEqual(self.init().returncode, 0)
        planned = run(TAUT, "plan", self.case, "--out", self.path("out"))
        self.assertEqual(planned.returncode, 0, planned.stdout + planned.stderr)
        checked = run(CHECK, self.path("out", "certificate.json"), self.case, "--expect", "proved")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_units_are_asked_for_and_restated(self):
        metres = self.shown()
        made = self.init(units=("--units", "force=kN,length=mm,mass=g"))
        self.assertIn("lengths in mm, forces in kN, masses in g", made.stdout)
        self.assertNotIn("the unit of masses", made.stdout)
        self.assertIn("the unit of masses: kg", self.init().stdout)
        self.assertEqual(self.init(units=("--units", "force=kN,length=mm,mass=g")).returncode, 0)
        self.assertIn("lengths in mm, forces in kN, masses in g", text_of(self.case))
        small = self.shown(units=("--units", "force=kN,length=mm,mass=g"))
        self.assertEqual(float(metres["problem"]["robot"]["base_anchors_m"][0][0]), -3)
        self.assertEqual(float(small["problem"]["robot"]["base_anchors_m"][0][0]), -0.003)
        self.assertEqual(float(small["problem"]["robot"]["tension_N"][0][1]), 1e6)
        self.assertEqual(float(small["problem"]["load"]["wrench"][2]), -9.81e-3)
        for units, message in (((), "--units: got none"), (("--units", "length=m"), "both length=UNIT and force=UNIT"),
                               (("--units", "length=N,force=N"), "'N' for length"),
                               (("--units", "length=m,force=N,force=N"), "'force' twice"),
                               (("--units", "length=m,force=N,angle=deg"), "'angle=deg'"),
                               (("--units", "metres"), "'metres'"),
                               (("--units", "length=m,force=N,mass=kN"), "'kN' for mass")):
            with self.subTest(units):
                self.refused(message, units=units)

    def test_attachments_from_the_centre_of_mass_are_added_exactly(self):
        bodies = self.edited(self.bodies, "<com_location>0 0 0<", "<com_location>0.1 -2e-3 0.30000000000000000001<")
        cables = self.cables.replace('attachment_reference="joint"', 'attachment_reference="com"')
        made = self.init(cables=cables, bodies=bodies)
        self.assertEqual(made.returncode, 0, made.stderr)
        text = text_of(self.case)
        self.assertIn("point: [0.1, -2e-3, 0.30000000000000000001]", text)
        self.assertIn("- [-0.65, 0.431, 0.30000000000000000001]", text)
        self.assertEqual(self.init(bodies=bodies).returncode, 0)
        self.assertNotIn("0.431", text_of(self.case), "from the joint, nothing is added")

    def test_the_start_is_q_initial(self):
        a, b, c = 0.1, -0.2, 0.3
        bodies = self.edited(self.bodies, 'q_initial="0 0 1.5 0 0 0"', f'q_initial="0.1 0.2 1.5 {a} {b} {c}"')
        bodies = self.edited(bodies, "<location>0.0 0.0 0.0<", "<location>0.01 0.02 -0.03<")
        pose = self.shown(bodies=bodies)["waypoints"][0]["pose"]
        for have, want in zip((pose["px"], pose["py"], pose["pz"]), (0.11, 0.22, 1.47)):
            self.assertAlmostEqual(have, want, places=14)
        tilt = product(turn("z", pose["phi"]), turn("y", pose["theta"]))
        have = product(tilt, turn("z", pose["sigma"] - pose["phi"]))
        want = product(product(turn("x", a), turn("y", b)), turn("z", c))
        for row, expected in zip(have, want):
            for x, y in zip(row, expected):
                self.assertAlmostEqual(x, y, places=13)

    def test_what_is_missing_is_said(self):
        made = self.init(bodies=self.edited(self.bodies, 'q_initial="0 0 1.5 0 0 0" ', ""))
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("where to start (q_initial)", made.stdout)
        self.assertIn("expected the key 'query'", run(TAUT, "plan", self.case, "--out", self.path("out")).stderr)
        made = self.init(bodies=re.sub(' q_m(in|ax)="[^"]*"', "", self.bodies))
        self.assertIn("where the platform may go", made.stdout)
        self.assertIn("pz: [-3, 3]", text_of(self.case))
        self.assertEqual(run(TAUT, "plan", self.case, "--out", self.path("out")).returncode, 0)
        made = self.init(bodies=self.edited(self.bodies, "3.0 3.0 3.0 3.1416 3.1416 3.1416", "3 3 3 0.5 0.5 0.5"))
        self.assertIn("its range of angles, -3.1416 -3.1416 -3.1416 to 0.5 0.5 0.5: here they are free", made.stdout)

    def test_other_writings_of_the_same_robot(self):
        want = self.shown()["problem"]
        old = re.sub(r"</?bodies_system>|<!DOCTYPE[^>]*>", "", self.bodies)
        self.assertEqual(self.shown(bodies=old)["problem"], want)
        loose = self.cables.replace("<location>0 -0.8660 0<", "<location>\r\n 0  <!-- x -->\t-0.8660 0 <")
        self.assertEqual(self.shown(cables="\ufeff" + loose)["problem"], want)
        swapped = re.sub(r"(?s)(<attachment>\s*<link>0.*?</attachment>)(\s*)(<attachment>\s*<link>1.*?</attachment>)",
                         r"\3\2\1", self.cables)
        self.assertEqual(self.shown(cables=swapped)["problem"], want)

    def test_another_cable_set_and_other_bodies(self):
        start, end = self.cables.index("  <cable_set"), self.cables.index("</cables>")
        other = self.cables[start:end].replace('id="original"', 'id="strong"').replace(">1000<", ">2000<")
        both = self.cables[:end] + other + self.cables[end:]
        self.assertEqual(self.shown(cables=both)["problem"]["robot"]["tension_N"][0][1], "1000")
        self.assertEqual(self.init("--cable-set", "strong", cables=both).returncode, 0)
        self.assertIn("[0.0, 2000]", text_of(self.case))
        self.refused("no cable_set 'weak', expected 'original', 'strong'", "--cable-set", "weak", cables=both)
        self.refused("a second cable_set 'original'", cables=both.replace("strong", "original"))
        elsewhere = self.write("elsewhere.xml", self.edited(self.bodies, ">1.0</mass>", ">2.5</mass>"))
        self.assertEqual(self.init("--bodies", elsewhere).returncode, 0)
        self.assertIn("mass: 2.5", text_of(self.case))

    def test_wrong_robots_are_refused_with_their_place(self):
        """(the message, what is replaced, by what), in the cables' file."""
        for message, old, new in (
                ("_cables.xml:9: cables.cable_set.cable_ideal[1].properties.force_max: got '1e3x'", ">1000<", ">1e3x<"),
                ("_cables.xml:9: ", ">1000<", ">NaN<"), ("got ''", ">1000<", "><"),
                ("3 numbers, expected 1", ">1000<", ">1 2 3<"), ("2 numbers, expected 3", "-3.0 -1.7321 3.0", "-3.0 1"),
                ("_cables.xml:14: ", "-3.0 -1.7321 3.0", "-3.0 -1.7321"),
                ("got '&lol;'", ">1000<", ">&lol;<"),
                ("7 cables, expected 6", "  </cable_set>", "<cable_ideal name='7'/></cable_set>"),
                ("got <cable_linear_spring>", "<cable_ideal name=\"cable 1\" attachment_reference=\"joint\">",
                 "<cable_linear_spring/><cable_ideal name=\"cable 1\" attachment_reference=\"joint\">"),
                ("points, not pulleys", "<attachments>", "<attachments><base_rotating_pulley/>"),
                ("3 attachments, expected 2", "<attachments>",
                 "<attachments><attachment><link>0</link><location>1 1 1</location></attachment>"),
                ("both ends on one link", "<link>1</link>", "<link>0</link>"),
                ("got '2', expected 0 (base) or 1", "<link>1</link>", "<link>2</link>"),
                ("attachment_reference 'end'", '"joint"', '"end"'),
                ("no attribute 'attachment_reference'", ' attachment_reference="joint"', ""),
                ("<stiffness>, which taut does not read", "<properties>", "<properties><stiffness>5</stiffness>"),
                ("a second <force_min>", "<force_min>", "<force_min>0</force_min><force_min>"),
                ("no <force_min>", "<force_min>0.0</force_min>", ""),
                ("the text 'loose'", "<attachments>", "<attachments>loose"),
                ("the element <b>, expected text only", ">1000<", ">10<b/>00<"),
                ("the attribute 'name' twice", 'name="cable 1"', 'name="cable 1" name="x"'),
                ("the attribute 'colour'", 'name="cable 1"', 'name="cable 1" colour="red"'),
                ("the root element <cabins>", "<cables ", "<cabins "),
                ("no cable_set 'new', its default", 'default_cable_set="original"', 'default_cable_set="new"'),
                ("no attribute 'default_cable_set'", ' default_cable_set="original"', ""),
                ("robot.tension[0]: got [-1, 1000]", "<force_min>0.0<", "<force_min>-1<"),
                ("robot.tension[0]: got [2000, 1000]", "<force_min>0.0<", "<force_min>2000<")):
            with self.subTest(message):
                cables = self.edited(self.cables, old, new)
                if "cabins" in new:
                    cables = cables.replace("</cables>", "</cabins>")
                self.assertIn("r_cables.xml:", self.refused(message, cables=cables))
        same = self.cables.replace("-0.75 0.4330 0.0", "0 -0.8660 0")
        self.refused("the same two anchors for cables 1 and 2", cables=same)
        self.refused("cable_ideal[2].properties.force_max: got 'x'", cables=self.cables.replace(">5000<", ">x<"))

    def test_wrong_bodies_are_refused_with_their_place(self):
        for message, old, new in (
                ("_bodies.xml:6: bodies_system.links.link_rigid.joint: got type 'PLANAR_XY'", "SPATIAL_EULER_XYZ",
                 "PLANAR_XY"),
                ("an actuated joint", "<joint ", '<joint actuated="true" '),
                ("5 numbers, expected 6", "0 0 1.5 0 0 0", "0 0 1.5 0 0"), ("q_max '", "3.0 3.0 3.0 3.1416", "3.0 3.0"),
                ("expected a mass above 0", ">1.0</mass>", ">0</mass>"), ("got '-1'", ">1.0</mass>", ">-1</mass>"),
                ("2 links, expected one", "</links>", "<link_rigid/></links>"), ("num '2'", 'num="1"', 'num="2"'),
                ("the parent '1'", "<num>0</num>", "<num>1</num>"), ("no <mass>", "<mass>1.0</mass>", ""),
                ("<springs>", "<links ", "<springs/><links "),
                ("the case made from it", 'q_initial="0 0 1.5', 'q_initial="0 0 9'),
                ("got '1e999'", ">1.0</mass>", ">1e999</mass>"),
                ("the case made from it", ">1.0</mass>", ">1e299</mass>")):
            with self.subTest(message):
                self.refused(message, bodies=self.edited(self.bodies, old, new))
        self.refused("no attribute 'q_max'", bodies=re.sub(' q_max="[^"]*"', "", self.bodies))

    def test_files_that_are_no_xml_or_too_much_of_it(self):
        bomb = "<!DOCTYPE cables [<!ENTITY a 'lol'>" + "".join(
            f"<!ENTITY {chr(98 + k)} '&{chr(97 + k)};&{chr(97 + k)};&{chr(97 + k)};'>" for k in range(20)) + "]>"
        self.refused("_cables.xml:2: got a declaration of entities",
                     cables=re.sub(r"<!DOCTYPE[^>]*>", lambda _: bomb, self.cables))
        outside = "<!DOCTYPE cables [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>"
        self.refused("a declaration of entities", cables=re.sub(r"<!DOCTYPE[^>]*>", outside, self.cables))
        deep = "<a>" * 100_000
        closed = deep + "</a>" * 100_000
        self.refused("<a>, which taut does not read", cables=self.cables.replace("<cable_set ", closed + "<cable_set "))
        self.refused("got no XML", cables=deep)
        self.refused("got more than 1048576 bytes", cables=self.cables + " " * (1 << 20))
        self.refused("a byte that is not UTF-8", cables=self.edited(self.cables, "original", "ori\0ginal"))
        self.refused("the encoding 'utf-16'", cables=self.edited(self.cables, "utf-8", "utf-16"))
        self.refused("the second root element <cables>", cables=self.cables + "<cables/>")
        self.refused("text outside of the root element", cables=self.cables + "more")
        for empty in ("", " ", "<!-- -->", "<?xml version='1.0'?>"):
            self.refused("r_cables.xml:1: ", cables=empty)
        with open(self.path("u_cables.xml"), "wb") as file:
            file.write(self.cables.encode("utf-16"))
        made = run(TAUT, "init", self.case, "--from", "caspr:" + self.path("u_cables.xml"), "--bodies",
                   self.path("r_bodies.xml"), *UNITS)
        self.assertEqual(made.returncode, 3)
        self.assertIn("u_cables.xml:1: got a byte that is not UTF-8", made.stderr)

    def test_names_can_not_leave_their_comments(self):
        name = 'name="x&#10;expect: proved&#27;[31m ' + "y" * 5000 + '"'
        bodies = self.edited(self.bodies, 'name="NIST ROBOCRANE"', name)
        made = self.init(bodies=bodies)
        self.assertEqual(made.returncode, 0, made.stderr)
        text = text_of(self.case)
        self.assertNotRegex(text, r"(?m)^expect:")
        self.assertNotIn("\x1b", text + made.stdout)
        self.assertLess(max(len(line) for line in text.splitlines()), 400)

    def test_damaged_files_end_as_bad_input_or_as_a_case(self):
        """Cut and changed at random: never a crash, never a case that can't be read."""
        source = random.Random(18)
        for trial in range(150):
            texts = [self.cables, self.bodies]
            which = source.randrange(2)
            text = texts[which]
            at = source.randrange(len(text))
            texts[which] = source.choice((text[:at], text[:at] + source.choice("<>&\"'=/ 0-x!") + text[at + 1:],
                                          text[:at] + text[at + source.randrange(40):],
                                          text[:at] + text[source.randrange(len(text)):]))
            with self.subTest(trial):
                made = self.init(cables=texts[0], bodies=texts[1])
                self.assertIn(made.returncode, (0, 3), made.stderr)
                self.assertEqual(os.path.exists(self.case), made.returncode == 0)
                if made.returncode == 0:
                    self.assertEqual(run(TAUT, "show", self.case, "--json").returncode, 0)
                else:
                    self.assertRegex(made.stderr, r"r_(cables|bodies)\.xml:\d+: ")

    def test_wrong_use(self):
        self.assertEqual(self.init().returncode, 0)
        again = run(TAUT, "init", self.case, "--from", "caspr:" + self.path("r_cables.xml"), *UNITS)
        self.assertEqual(again.returncode, 3)
        self.assertIn("got a file that exists", again.stderr)
        new = self.path("new.yaml")
        for message, arguments in (
                ("expected caspr:PATH", ["--from", self.path("r_cables.xml"), *UNITS]),
                ("expected caspr:PATH", ["--from", "caspr:", *UNITS]), ("--from", [*UNITS]),
                ("could not read", ["--from", "caspr:" + self.path("no_cables.xml"), *UNITS]),
                ("expected a file whose name ends in cables.xml", ["--from", "caspr:" + self.case, *UNITS])):
            with self.subTest(message):
                result = run(TAUT, "init", new, *arguments)
                self.assertEqual(result.returncode, 3, result.stdout)
                self.assertIn(message, result.stderr)
                self.assertFalse(os.path.exists(new))


if __name__ == "__main__":
    main()

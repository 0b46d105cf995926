#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut-verify, the checker extracted from Coq, which formal/build has made: what it accepts is true.

.ci/run runs it; it takes some minute.

Usage: verify_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import copy
import functools
import json
import os
import re
import sys
import unittest

from command_line import AUDITS, CASES, CHECK, InFolder, ROBOT1, SOURCE, TAUT, certify, main, run, text_of

sys.path.insert(0, os.path.join(SOURCE, "tests", "certificates"))
import expand  # noqa: E402

VERIFY = os.path.join(SOURCE, "formal", "taut-verify")
CORPUS = os.path.join(os.path.dirname(os.path.dirname(TAUT)), "tests", "certificates")
ITEMS = os.path.join(SOURCE, "tests", "cli", "formal_items.yaml")
TOLERANCES = os.path.join(SOURCE, "tests", "cli", "formal_tolerances.yaml")
OBLIQUE = os.path.join(SOURCE, "tests", "cli", "formal_oblique.yaml")
GEODESIC, LENGTHS = (os.path.join(AUDITS, f"robot1-{law}.yaml") for law in ("geodesic", "cable-lengths"))
PLANNED = [ROBOT1, ITEMS, TOLERANCES, OBLIQUE, GEODESIC, LENGTHS, *(os.path.join(CASES, name + ".yaml") for name in
                            ("robot1-roll-pitch-yaw", "robot1-free-box-qs-qg", "robot2-sphere-q1-q2",
                             "robot2-sphere-q2-q3", "robot2-free-q2-q3", "tutorial/03-a-smooth-move"))]
# Of the corpus: rejected or malformed for what the statement does not say, so it is true all the same.
TRUE = {"roll_pitch_yaw_read_as_zyz": "a margin that is less", "start_one_ulp_off": "the query",
        "leg_on_an_ulp_off": "the query",
        "range_left": "ranges of parameters", "periodic_position": "which values are one pose",
        "flip_of_euler_angles": "which values are one pose", "flip_of_others": "which values are one pose",
        "flip_theta_periodic": "which values are one pose", "flip_phi_real": "which values are one pose",
        "range_with_a_name": "ranges of parameters", "limit_negative": "signs of limits",
        **dict.fromkeys(("times_too_few", "times_equal", "times_fall"), "times of poses"),
        **dict.fromkeys(("geodesic_in_other_angles", "poses_of_another_space"), "parameters, which a geodesic has not"),
        "waypoint_rounded": "that waypoints are of 53 bits", "loads_of_the_same_name": "names",
        **{f"tight_{what}_raised": "a margin that is less" for what in
           ("base_anchor", "platform_anchor", "load_point", "position", "orientation", "wrench")}}


def verify(certificate, boxes):
    return run(VERIFY, certificate, boxes, errors="replace")


class Verify(InFolder):
    def boxes(self, certificate, name="boxes.json"):
        """The boxes of a certificate's path; none where Coq is not told what it states."""
        file = self.path(name)
        said = run(TAUT, "formal", certificate, "--no-coq", "--out", self.path("path.v"), "--boxes", file)
        self.assertIn(said.returncode, (0, 3), said.stderr)
        return file if said.returncode == 0 else None

    def plan(self, case):
        said = certify(case, self.out)
        self.assertEqual(said.returncode, 0, said.stderr)
        return self.path("certificate.json")


class Planned(Verify):
    def test_paths_are_verified(self):
        for case in PLANNED:
            with self.subTest(case):
                certificate = self.plan(case)
                said = verify(certificate, self.boxes(certificate))
                self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
                self.assertTrue(said.stdout.startswith("verified: everywhere along the path ("), said.stdout)

    def test_what_is_not_true_is_refused(self):
        certificate = self.plan(ITEMS)
        boxes = self.boxes(certificate)
        stated = json.loads(text_of(certificate))
        items = {item["name"]: k for k, item in enumerate(stated["problem"]["load"]["items"])}

        def item(name, kind, key, value):
            def edit(c):
                c["problem"]["load"]["items"][items[name]][kind][key] = value
            return edit

        def put(*keys, value):
            def edit(c):
                for key in keys[:-1]:
                    c = c[key]
                c[keys[-1]] = value
            return edit
        edits = [item("platform", "weight", "mass_kg", ["8000", "80000"]),
                 item("payload", "weight", "at_m", ["9", "0", "-1.2"]),
                 item("payload", "weight", "at_tolerance_m", "5"),
                 item("wind", "force", "disc", {"radius": "60000", "normal": ["0", "0", "1"]}),
                 item("gust", "force", "ball", {"radius": "50000"}),
                 item("hose", "force", "segment", {"direction": ["1", "2", "-2"], "range": ["500", "90000"]}),
                 item("drive", "moment", "segment", {"direction": ["0", "0", "1"], "range": ["0", "2e5"]}),
                 item("pumps", "load_cases", "wrenches", [["0", "90000", "0", "0", "0", "0"]]),
                 item("pumps", "load_cases", "wrenches", []),
                 put("problem", "robot", "tension_N", 0, value=["2000", "9000"]),
                 put("problem", "robot", "length_m", 3, value=["3", "12"]),
                 put("problem", "robot", "base_anchors_m", 0, value=["5", "10", "15"]),
                 put("problem", "space", "pose", "pz", value="pz + 9*sin(pi/2)"),
                 put("problem", "load", "gravity_m_s2", value=["0", "0", "9.81"]),
                 put("path", "waypoints", 1, "x", 0, value="0x1.8p+3")]
        for k, edit in enumerate(edits):
            with self.subTest(k):
                mutant = copy.deepcopy(stated)
                edit(mutant)
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual((said.returncode, said.stdout[:7]), (1, "REFUSED"), said.stderr)
        # Of a load that is nothing, everything would be true.
        nothing = [item("platform", "weight", "mass_kg", ["80000", "8000"]),
                   item("payload", "weight", "at_tolerance_m", "-1e-9"),
                   item("wind", "force", "disc", {"radius": "-1", "normal": ["0", "0", "1"]}),
                   item("gust", "force", "ball", {"radius": "-1"}),
                   item("drive", "moment", "segment", {"direction": ["0", "0", "1"], "range": ["2", "1"]})]
        for k, edit in enumerate(nothing):
            with self.subTest(f"nothing {k}"):
                mutant = copy.deepcopy(stated)
                edit(mutant)
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
                self.assertRegex(said.stderr, "below 0|ends before it begins")

    def test_another_geodesic_is_refused(self):
        certificate = self.plan(GEODESIC)
        boxes = self.boxes(certificate)
        stated = json.loads(text_of(certificate))
        poses = stated["path"]["waypoints"]
        self.assertGreater(len(poses), 20)

        def at(key, k, value):
            def edit(c):
                c["path"]["waypoints"][10][key][k] = value
            return edit
        edits = [at("position", k, "0x1p-1") for k in range(2)] + [at("quaternion", k, "0x1.8p-1") for k in range(3)]
        for k, edit in enumerate(edits):
            with self.subTest(k):
                mutant = copy.deepcopy(stated)
                edit(mutant)
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        for quaternion, code in ((["0x0p+0"] * 4, 1), (["0x0p+0"] * 3, 3), (["0x0p+0"] * 5, 3),
                                 (["1", "0", "0", "0"], 3), (self.opposite(poses[9]["quaternion"]), 1)):
            with self.subTest(quaternion):
                mutant = copy.deepcopy(stated)
                mutant["path"]["waypoints"][10]["quaternion"] = quaternion
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        # Minus a quaternion is the same turn, and so is one of twice the length.
        for factor in (-1, 2):
            mutant = copy.deepcopy(stated)
            pose = mutant["path"]["waypoints"][10]
            pose["quaternion"] = [(factor * float.fromhex(x)).hex() for x in pose["quaternion"]]
            said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
            self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def opposite(self, quaternion):
        """Half a turn away: no geodesic leads there."""
        x, y, z, w = quaternion
        return [y, self.minus(x), w, self.minus(z)]

    def minus(self, x):
        return x[1:] if x.startswith("-") else "-" + x

    def test_other_lengths_are_refused(self):
        certificate = os.path.join(CORPUS, "accepted", "lengths_inner.json")
        boxes = self.boxes(certificate)
        self.assertEqual(verify(certificate, boxes).returncode, 0)
        stated = json.loads(text_of(certificate))
        path = stated["path"]
        k = next(k for k, tube in enumerate(path["pose_tubes"]) if "inner" in tube)

        def put(where, key, value):
            def edit(c):
                where(c["path"])[key] = value
            return edit

        def first(p):
            return p["pose_tubes"][k]

        def inner(p):
            return first(p)["inner"][0]
        def other(x, factor):
            return (factor * float.fromhex(x)).hex()
        tube = path["pose_tubes"][k]
        edits = [(put(lambda p: p["waypoints"][0]["lengths"], i, other(path["waypoints"][0]["lengths"][i], 1.01)), 1)
                 for i in (0, 5)]
        edits += [(put(lambda p: inner(p)["position"], 0, "0x1p-1"), 1),
                  (put(lambda p: inner(p)["quaternion"], 1, "0x1p-1"), 1),
                  (put(inner, "quaternion", ["0x0p+0"] * 4), 1),
                  (put(lambda p: p["waypoints"][1], "quaternion", ["0x0p+0"] * 4), 1),
                  (put(first, "position", other(tube["position"], 1e-6)), 1),
                  (put(first, "turn", other(tube["turn"], 1e6)), 1), (put(first, "position", "0x0p+0"), 1),
                  (put(first, "position", "-0x1p-10"), 1), (put(inner, "s", "0"), 3), (put(inner, "s", "1"), 3),
                  (put(inner, "s", "-1/2"), 3), (put(lambda p: p, "pose_tubes", path["pose_tubes"][1:]), 3),
                  (put(lambda p: p, "pose_tubes", []), 3), (put(lambda p: p, "interpolation", "geodesic"), 3)]
        for n, (edit, code) in enumerate(edits):
            with self.subTest(n):
                mutant = copy.deepcopy(stated)
                edit(mutant)
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, code, said.stdout + said.stderr)

    def test_other_numbers_of_a_tube(self):
        """Whatever is said of how lengths are held, nothing is believed of it."""
        certificate = os.path.join(CORPUS, "accepted", "lengths.json")
        stated = json.loads(text_of(self.boxes(certificate)))
        tube = stated["boxes"][0][0]["tube"]
        for key, value in (("left", "1/1"), ("left", "2/1"), ("left", "1/1024"), ("within", "0/1"),
                           ("within", "-1/1024"), ("within", "1/1"), ("guess", ["1023/1024"] * 6),
                           ("inverse", [[0] * 6] * 6),
                           ("scale", tube["scale"] + 1)):
            with self.subTest(key, value=value):
                mutant = copy.deepcopy(stated)
                mutant["boxes"][0][0]["tube"][key] = value
                self.assertEqual(verify(certificate, self.write("other.json", json.dumps(mutant))).returncode, 1)
        del stated["boxes"][0][0]["tube"]
        self.assertEqual(verify(certificate, self.write("other.json", json.dumps(stated))).returncode, 1)

    def test_another_ellipsoid_is_refused(self):
        certificate = self.plan(OBLIQUE)
        boxes = self.boxes(certificate)
        stated = json.loads(text_of(certificate))
        matrix = stated["problem"]["load"]["ellipsoid"]

        def entries(*changes):
            rows = copy.deepcopy(matrix)
            for i, j, value in changes:
                rows[i][j] = value
            return rows
        for rows, code in ((entries((0, 1, "0"), (1, 0, "0")), 0), (entries((0, 1, "0")), 1), (entries((0, 0, "1")), 1),
                           (entries((3, 4, "-1000001"), (4, 3, "-1000001")), 1), (entries((5, 5, "1e3")), 1),
                           (entries((0, 0, "-1e4")), 1), (entries((3, 3, "1/0")), 3), (matrix[:5], 3)):
            with self.subTest(rows):
                mutant = copy.deepcopy(stated)
                mutant["problem"]["load"]["ellipsoid"] = rows
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        for axis, code in ((["0", "0", "0"], 1), (["30", "0", "0"], 1), (["-2", "4", "-60"], 0), (["1", "2"], 3)):
            with self.subTest(axis):
                mutant = copy.deepcopy(stated)
                mutant["problem"]["space"]["angles"] = {"axis": axis}
                said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                self.assertEqual(said.returncode, code, said.stdout + said.stderr)

    def test_larger_tolerances_are_refused(self):
        certificate = self.plan(TOLERANCES)
        boxes = self.boxes(certificate)
        stated = json.loads(text_of(certificate))
        tolerances = stated["problem"]["tolerances"]
        edits = [(key, k) for key in ("base_anchor_m", "platform_anchor_m", "wrench") for k in range(6)]
        for key, k in [*edits, *((key, None) for key in ("load_point_m", "position_m", "orientation_rad"))]:
            for large, code in (("0.99", 1), ("-0.99", 1 if key in ("wrench", "orientation_rad") else 3)):
                large = large.replace("0.", "") if key == "wrench" else large
                with self.subTest(key, k=k, large=large):
                    mutant = copy.deepcopy(stated)
                    value = large if k is None else [large if i == k else x for i, x in enumerate(tolerances[key])]
                    mutant["problem"]["tolerances"][key] = value
                    said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
                    self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        for value in (["0"] * 6, "0", 0, []):
            mutant = copy.deepcopy(stated)
            mutant["problem"]["tolerances"]["cable_length_m"] = value
            said = verify(self.write("mutant.json", json.dumps(mutant)), boxes)
            self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
            self.assertIn("cables' lengths", said.stderr)

    def test_a_tolerance_of_the_load_beside_items(self):
        certificate = self.plan(ITEMS)
        boxes = self.boxes(certificate)
        stated = json.loads(text_of(certificate))
        exact = {"base_anchor_m": ["0"] * 6, "platform_anchor_m": ["0"] * 6, "load_point_m": "0", "wrench": ["0"] * 6,
                 "position_m": "0", "orientation_rad": "0", "cable_length_m": None}
        for edit, code in (({}, 0), ({"wrench": ["0"] * 5 + ["1e9"]}, 3), ({"load_point_m": "1e-9"}, 3),
                           ({"orientation_rad": "sqrt(0)"}, 1), ({"orientation_rad": "px"}, 3)):
            stated["problem"]["tolerances"] = {**exact, **edit}
            said = verify(self.write("mutant.json", json.dumps(stated)), boxes)
            self.assertEqual(said.returncode, code, said.stdout + said.stderr)

    def test_a_site_far_from_its_origin(self):
        text = text_of(ITEMS).replace("x: [-8, 8]", "x: [499992, 500008]")
        text = re.sub(r"\[(-?15|0), (-?10), 15\]", lambda m: f"[{int(m.group(1)) + 500000}, {m.group(2)}, 15]", text)
        text = re.sub(r"px: (-?4),", lambda m: f"px: {int(m.group(1)) + 500000},", text)
        certificate = self.plan(self.write("far.yaml", text))
        said = verify(certificate, self.boxes(certificate))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_other_boxes(self):
        certificate = self.plan(ROBOT1)
        stated = json.loads(text_of(self.boxes(certificate)))
        boxes, bits = stated["boxes"], stated["bits"]
        for name, other in [("none", []), ("of fewer segments", boxes[:-1]), ("of more", boxes + boxes[-1:]),
                            ("a gap", [boxes[0][:-1], *boxes[1:]]), ("none on a segment", [[], *boxes[1:]]),
                            ("zeros", [[{**box, "inverse": [[0] * 6] * 6} for box in segment] for segment in boxes])]:
            with self.subTest(name):
                said = verify(certificate, self.write("other.json", json.dumps({"boxes": other, "bits": bits})))
                self.assertEqual(said.returncode, 1, said.stderr)

    def test_what_it_does_not_know(self):
        certificate = self.plan(ITEMS)
        boxes, text = self.boxes(certificate), text_of(certificate)
        for name, old, new in [
                ("a new key of the problem", '"robot":', '"wind_m_s": "3", "robot":'),
                ("a new key of an item", '"at_tolerance_m":', '"spread": "1", "at_tolerance_m":'),
                ("a key twice", '"point_m":', '"point_m": ["0","0","0"], "point_m":'),
                ("a missing key", '"point_m"', '"point"'),
                ("tolerances without keys", '"tolerances":null', '"tolerances":{}'),
                ("another law", "straight-in-parameters", "geodesic"),
                ("a law without proof", "straight-in-parameters", "straight-in-cable-lengths"),
                ("a function", '"pz":"pz"', '"pz":"tan(pz)"'),
                ("a tower of powers", '"pz":"pz"', '"pz":"0*((pz^99)^99)^99"'),
                ("not a number", '"9.81"', '"nan"'), ("not a number", '"-9.81"', '"-9,81"'),
                ("another version", '"version":4', '"version":99'),
                ("another verdict", '"verdict":"proved"', '"verdict":"refuted"'),
                ("not JSON", '"robot":', '"robot"'), ("another file", "taut-certificate", "taut-atlas")]:
            with self.subTest(name):
                mutant = text.replace(": ", ":").replace(old, new, 1) if old in text.replace(": ", ":") else None
                if mutant is None:
                    self.assertEqual(old, '"9.81"')  # gravity points down
                    continue
                said = verify(self.write("mutant.json", mutant), boxes)
                self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
                self.assertTrue(said.stderr.startswith("taut-verify: "), said.stderr)
        for arguments in ([], [certificate], [certificate, "nothing.json"], [certificate, self.write("empty", "")],
                          [self.write("deep", "[" * 10**6), boxes]):
            self.assertEqual(run(VERIFY, *arguments).returncode, 3)


class Corpus(Verify):
    """What taut-check does not accept is not verified either, but for what the statement does not say."""

    @functools.cache
    def boxes_for(self, name):
        case = self.cases[name]
        found = self.boxes(self.file(name), name + ".json") if case["expect"] == "accepted" else None
        return found or (self.boxes_for(case["base"]) if "base" in case else None)

    def file(self, name):
        return os.path.join(CORPUS, self.cases[name]["expect"], name + ".json")

    def origin(self, name):
        while self.cases[name]["expect"] != "accepted":
            name = self.cases[name]["base"]
        return name

    def statement(self, name):
        """What of a certificate the statement is made of; nothing where it can't be read."""
        try:
            with open(self.file(name), encoding="utf-8") as file:
                c = json.load(file)
            return [c["problem"][key] for key in ("robot", "load", "space", "tolerances")], c["path"]
        except (ValueError, KeyError, TypeError):
            return None

    def test_it_accepts_nothing_that_is_false(self):
        self.cases = {name: case for name, case in expand.read_cases().items()}
        altered, refused = set(), 0
        for name, case in self.cases.items():
            if expand.is_of_legs(self.cases, name) or not self.boxes_for(name):
                continue
            said = verify(self.file(name), self.boxes_for(name))
            self.assertIn(said.returncode, (0, 1, 3), name + said.stderr)
            if said.returncode != 0:
                refused += 1
            elif case["expect"] != "accepted" and self.statement(name) != self.statement(self.origin(name)):
                altered.add(name)
        self.assertEqual(altered, set(TRUE))
        self.assertGreater(refused, 50)


if __name__ == "__main__":
    unittest.TestCase.maxDiff = None
    main()

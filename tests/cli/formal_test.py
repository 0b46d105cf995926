#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut formal without Coq: what is written is what the certificate states, and what it can't write it refuses by name.

formal_proofs_test.py has Coq read such files.

Usage: formal_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import copy
import functools
import hashlib
import json
import math
import os
import re
import tempfile
from fractions import Fraction

from command_line import AUDITS, CASES, InFolder, ROBOT1, TAUT, certify, main, run, text_of
from coq_data import read

SPHERE = os.path.join(CASES, "robot2-sphere-q1-q2.yaml")
ROLL_PITCH_YAW = os.path.join(CASES, "robot1-roll-pitch-yaw.yaml")
ITEMS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "formal_items.yaml")
TOLERANCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "formal_tolerances.yaml")
OBLIQUE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "formal_oblique.yaml")
GEODESIC, LENGTHS = (os.path.join(AUDITS, f"robot1-{law}.yaml") for law in ("geodesic", "cable-lengths"))
SPLINE = os.path.join(CASES, "tutorial", "03-a-smooth-move.yaml")
NO_PATH = os.path.join(CASES, "tutorial", "02-a-slack-start.yaml")
# What says nothing of which motions are feasible: Coq is not told of it.
NOT_STATED = re.compile(r"/(name|query|space/flip|space/angles$|space/parameters|load/items/\d+/name)\b")


def digest(value):
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def sealed(certificate):
    """With the digests that belong to the rest."""
    certificate["problem_sha256"] = digest(certificate["problem"])
    certificate["path_sha256"] = digest(certificate["path"])
    footer = certificate.pop("footer")
    certificate.pop("signature", None)
    certificate["footer"] = {**footer, "sha256": digest(certificate)}
    return certificate


@functools.cache
def planned(case):
    """The certificate of the case; not to be altered in place."""
    with tempfile.TemporaryDirectory() as out:
        said = certify(case, out)
        assert said.returncode == 0, said.stdout + said.stderr
        return json.loads(text_of(os.path.join(out, "certificate.json")))


def leaves(value, path=""):
    """(JSON pointer, text) of every text inside."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, (dict, list)):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(part, f"{path}/{key}")


def put(value, path, text):
    *keys, last = [int(key) if key.isdigit() else key for key in path.split("/")[1:]]
    for key in keys:
        value = value[key]
    value[last] = text


def texts(numbers):
    return tuple(Fraction(text) for text in numbers)


def vec(numbers):
    return ("Vec", *texts(numbers))


def vectors(stated):
    """A set of vectors as Coq reads it."""
    if "ball" in stated:
        return ("Ball", Fraction(stated["ball"]["radius"]))
    if "disc" in stated:
        return ("Disc", Fraction(stated["disc"]["radius"]), vec(stated["disc"]["normal"]))
    return ("Along", vec(stated["segment"]["direction"]), *texts(stated["segment"]["range"]))


EXACT = {"base_anchor_m": ["0"] * 6, "platform_anchor_m": ["0"] * 6, "load_point_m": "0", "wrench": ["0"] * 6,
         "position_m": "0", "orientation_rad": "0"}


def load_of(load, shift):
    """The items as Coq reads them."""
    items = []
    if "ellipsoid" in load:
        items.append(("Ellipsoid", ("Six", *texts(load["wrench"])), ("Six", *texts(shift)),
                      ("Six", *(("Six", *texts(row)) for row in load["ellipsoid"]))))
    axes = {"W": "OfWorld", "P": "OfPlatform"}
    for item in load.get("items", []):
        (kind, what), = ((key, value) for key, value in item.items() if key != "name")
        if kind == "weight":
            items.append(("Weight", *texts(what["mass_kg"]), vec(load["gravity_m_s2"]), vec(what["at_m"]),
                          Fraction(what["at_tolerance_m"])))
        elif kind == "force":
            items.append(("Force", vectors(what), axes[what["axes"]], vec(what["at_m"])))
        elif kind == "moment":
            items.append(("Moment", vectors(what), axes[what["axes"]]))
        else:
            items.append(("LoadCases", [(vec(w[:3]), vec(w[3:])) for w in what["wrenches"]], axes[what["axes"]],
                          vec(what["at_m"])))
    return items


def held(path):
    """Waypoints and inner poses where lengths are straight: each with its lengths and its tube, and no half turns."""
    def exactly(numbers):
        return [Fraction(float.fromhex(x)) for x in numbers]
    points, poses = path["waypoints"], []
    for begin, end, tube in zip(points, points[1:], path["pose_tubes"]):
        lengths = list(zip(exactly(begin["lengths"]), exactly(end["lengths"])))
        inner = [(pose, pose["s"], pose["tube"]) for pose in tube.get("inner", [])]
        for place, s, size in [(begin, "0", tube), *inner]:
            poses.append(exactly(place["position"] + place["quaternion"]) +
                         [a + Fraction(s) * (b - a) for a, b in lengths] + exactly([size["position"], size["turn"]]))
    poses.append(exactly(points[-1]["position"] + points[-1]["quaternion"] + points[-1]["lengths"]) + [0, 0])
    return [[(x, 0) for x in pose] for pose in poses]


class Formal(InFolder):
    def formal(self, certificate, *arguments, name="certificate.json", **options):
        file = self.write(name, json.dumps(certificate, sort_keys=True))
        return run(TAUT, "formal", file, *arguments, **options)

    def refused(self, certificate, words, *arguments):
        said = self.formal(certificate, *arguments)
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertIn(words, said.stderr)
        self.assertEqual(os.listdir(self.out), ["certificate.json"])

    def written(self, certificate, *arguments):
        said = self.formal(certificate, "--no-coq", *arguments)
        self.assertEqual(said.returncode, 0, said.stderr)
        return text_of(self.path("certificate.v"))


class WhatIsWritten(Formal):
    def compare(self, case):
        certificate = planned(case)
        problem, path = certificate["problem"], certificate["path"]
        data = read(self.written(certificate))
        robot = data["robot"]
        limits = {key: [texts(pair) for pair in problem["robot"][key]] for key in ("tension_N", "length_m")}
        for i, cable in enumerate(robot["cables"][1:]):
            self.assertEqual(cable, ("Cable", ("Vec", *texts(problem["robot"]["base_anchors_m"][i])),
                                     ("Vec", *texts(problem["robot"]["platform_anchors_m"][i])),
                                     limits["tension_N"][i], limits["length_m"][i]))
        self.assertEqual(robot["load_point"], ("Vec", *texts(problem["load"]["point_m"])))
        tolerances = problem["tolerances"] or EXACT
        self.assertEqual(robot["load"], load_of(problem["load"], tolerances["wrench"]))
        name, anchors, load_point, position, orientation = robot["tolerance"]
        anchors_of = zip(texts(tolerances["base_anchor_m"]), texts(tolerances["platform_anchor_m"]))
        self.assertEqual((name, anchors), ("Tolerances", ("Six", *anchors_of)))
        self.assertEqual([load_point, position], list(texts([tolerances["load_point_m"], tolerances["position_m"]])))
        self.same_expression(orientation, tolerances["orientation_rad"], [], problem["space"]["constants"])
        names = [parameter["name"] for parameter in problem["space"]["parameters"]]
        kind, *angles = robot["pose_angles"]
        stated, keys = {"TiltTorsion": (None, ["phi", "theta", "sigma"]),
                        "RollPitchYaw": ("roll-pitch-yaw", ["roll", "pitch", "yaw"]),
                        "About": (problem["space"].get("angles"), ["turn"])}[kind]
        self.assertEqual(problem["space"].get("angles"), stated)
        if kind == "About":
            self.assertEqual(angles.pop(0), vec(stated["axis"]))
        for key, expression in zip(["px", "py", "pz", *keys], [*robot["pose_position"][1:], *angles], strict=True):
            self.same_expression(expression, problem["space"]["pose"][key], names, problem["space"]["constants"])
        cert = data["cert"]
        self.assertEqual(cert["subject"], "robot")
        self.assertEqual([cert["tension_margin"], cert["length_margin"]], [0, 0])
        law = {"straight-in-parameters": "Straight", "cubic-b-spline": "Spline", "geodesic": "Geodesic",
               "straight-in-cable-lengths": "Lengths"}[path["interpolation"]]
        self.assertEqual(cert["motion"], law)
        self.assertEqual(cert["path"], held(path) if law == "Lengths" else [
            [(Fraction(float.fromhex(x)), turns) for x, turns in
             (zip(point["x"], point["half_turns"], strict=True) if "x" in point else
              ((x, 0) for x in point["position"] + point["quaternion"]))] for point in path["waypoints"]])
        self.assertEqual(len(cert["boxes"]), len(cert["path"]) - (3 if law == "Spline" else 1))
        for boxes in cert["boxes"]:
            self.assertEqual(boxes[-1][1], 1)
        return certificate

    def same_expression(self, written, typed, names, constants):
        """Compares values at some places, in floating point; formal_proofs_test.py does so with 50 digits."""
        def value(tree, at):
            if tree == "Pi":
                return math.pi
            name, *parts = tree
            if name in ("Number", "Param"):
                return float(parts[0]) if name == "Number" else at[int(parts[0])]
            parts = [value(part, at) for part in parts]
            return {"Minus": lambda d: -d, "Plus": lambda d, e: d + e, "Sub": lambda d, e: d - e,
                    "Times": lambda d, e: d * e, "Over": lambda d, e: d / e, "Sqrt": math.sqrt, "Sin": math.sin,
                    "Cos": math.cos}[name](*parts)
        for k in range(5):
            at = [0.3 + 0.17 * k + 0.05 * j for j in range(len(names))]
            known = {**{name: getattr(math, name) for name in ("pi", "sqrt", "sin", "cos")},
                     **{name: float(text) for name, text in constants.items()}, **dict(zip(names, at))}
            self.assertAlmostEqual(value(written, at), eval(typed.replace("^", "**"), {"__builtins__": {}}, known),
                                   delta=1e-12)

    def test_it_is_what_the_certificate_states(self):
        for case in (ROBOT1, SPHERE, ROLL_PITCH_YAW, ITEMS, TOLERANCES, OBLIQUE, GEODESIC, LENGTHS, SPLINE):
            with self.subTest(case):
                self.compare(case)

    def test_whatever_is_altered_is_written_or_refused(self):
        """Nothing of the problem is left out: each alteration of a number shows, or there is no file."""
        for case in (SPHERE, ROLL_PITCH_YAW, ITEMS, TOLERANCES, OBLIQUE):
            base = copy.deepcopy(planned(case))
            if case == ITEMS:  # its pose is not that of a machine that flips, once it is altered
                base["problem"]["space"]["flip"] = None
            for margins in (base["margins"], *(segment["margins"] for segment in base["segments"])):
                margins.update(length_m="1e-9", tension_N="1e-9", wrench_scale="1.0")
            original = read(self.written(sealed(base)))
            count = 0
            for path, text in leaves(base["problem"]):
                if NOT_STATED.match(path):
                    continue
                mutant = copy.deepcopy(base)
                put(mutant["problem"], path, self.altered(path, text))
                os.unlink(self.path("certificate.v"))
                said = self.formal(sealed(mutant), "--no-coq")
                with self.subTest(path, said=said.stderr):
                    off = re.match(r"/load/ellipsoid/(\d)/(\d)", path)
                    if off and off.group(1) != off.group(2):  # not symmetric
                        self.assertEqual(said.returncode, 3)
                    else:
                        self.assertEqual(said.returncode, 0)
                        self.assertNotEqual(read(text_of(self.path("certificate.v"))), original)
                        count += 1
                if not os.path.exists(self.path("certificate.v")):
                    self.write("certificate.v", "")
            self.assertGreater(count, 75)

    def altered(self, path, text):
        if path.endswith("/axes"):
            return "P" if text == "W" else "W"
        if path.endswith("/mass_kg/0"):
            return f"{float(Fraction(text) - Fraction(1, 10**7)):.9f}"
        if path.startswith("/space/pose") or path.endswith("/orientation_rad"):
            return f"{text} + 1e-7"
        if path.startswith("/load/ellipsoid") and text == "0":
            return "1"
        share = Fraction(1, 10**6) if path.startswith("/load/ellipsoid") else 0
        return f"{float(Fraction(text) * (1 + share) + Fraction(1, 10**7)):.9f}"


class WhatIsRefused(Formal):
    def altered(self, *edits):
        certificate = copy.deepcopy(planned(ROBOT1))
        for path, value in edits:
            put(certificate, path, value)
        return sealed(certificate)

    def test_what_coq_is_not_told_is_named(self):
        zeros = {**EXACT, "cable_length_m": ["0"] * 6}
        problem = planned(ROBOT1)["problem"]
        pose = problem["space"]["pose"]
        for edits, words in [
                ([("/problem/tolerances", zeros)], "controlled by its cables' lengths"),
                ([("/problem/space/flip", None), ("/problem/space/pose", {**pose, "px": "0*exp(theta)"})], "tan, exp"),
                ([("/problem/space/flip", None), ("/problem/space/pose", {**pose, "px": "0*tan(theta)"})], "tan, exp"),
                ([("/claim", "The claim.")], "a claim of more")]:
            with self.subTest(words):
                self.refused(self.altered(*edits), words)

    def test_an_orientation_that_coq_does_not_enclose(self):
        certificate = copy.deepcopy(planned(TOLERANCES))
        put(certificate["problem"], "/tolerances/orientation_rad", "sqrt(0)")
        self.refused(sealed(certificate), "roots of 0")

    def test_other_kinds_of_certificates(self):
        for arguments, words in [
                (["plan", NO_PATH], "certificate"),
                (["plan", os.path.join(CASES, "robot2-implicit-sphere-q1-q2-q3.yaml")], "constraints"),
                (["audit", os.path.join(AUDITS, "robot1-straight-qs-qg.yaml")], "'refuted'"),
                (["audit", os.path.join(AUDITS, "robot1-cable-lengths-tolerances.yaml")], "cables' lengths")]:
            with self.subTest(words), tempfile.TemporaryDirectory() as out:
                run(TAUT, *arguments, "--out", out, "--no-report", "--headroom", "0")
                self.refused(json.loads(text_of(os.path.join(out, "certificate.json"))), words)

    def test_a_certificate_that_the_checker_rejects(self):
        limits = [["0.05", "0.1"]] * 6
        self.refused(self.altered(("/problem/robot/tension_N", limits)), "REJECTED")

    def test_a_certificate_that_was_not_checked(self):
        said = self.formal(planned(ROBOT1), "--max-seconds", "0")
        self.assertEqual(said.returncode, 2)
        self.assertIn("Nothing was written", said.stderr)
        self.assertEqual(os.listdir(self.out), ["certificate.json"])

    def test_names_that_coq_would_not_take(self):
        for name in ("proof.txt", "1.v", "a-b.v", ".v", "certificate.json"):
            with self.subTest(name):
                self.refused(planned(ROBOT1), "--out", "--out", self.path(name))
        said = self.formal(planned(ROBOT1), "--no-coq", name="2-a b.json")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertTrue(os.path.exists(self.path("path_2_a_b.v")))


class WithoutCoq(Formal):
    def test_a_missing_coq_is_named_and_the_file_is_there(self):
        said = self.formal(planned(ROBOT1), env={**os.environ, "PATH": self.out})
        self.assertEqual(said.returncode, 2)
        self.assertIn("coqc is not installed", said.stderr)
        self.assertIn("libcoq-interval", said.stderr)
        self.assertNotIn("kernel", said.stdout)
        self.assertIn("Theorem feasible : statement cert.", text_of(self.path("certificate.v")))

    def test_a_checker_that_is_not_compiled(self):
        os.mkdir(self.path("bin"))
        self.write("bin/coqc", "")
        os.mkdir(self.path("library"))
        self.write("library/Verify.v", "")
        environment = {**os.environ, "PATH": self.path("bin")}
        said = self.formal(planned(ROBOT1), "--library", self.path("library"), env=environment)
        self.assertEqual(said.returncode, 2)
        self.assertIn("not compiled", said.stderr)
        said = self.formal(planned(ROBOT1), "--library", self.out, env=environment)
        self.assertEqual(said.returncode, 3)
        self.assertIn("--library", said.stderr)


if __name__ == "__main__":
    main()

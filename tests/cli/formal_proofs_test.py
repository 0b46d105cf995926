#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut formal with Coq, which formal/build has made ready: what is true is proved, and what is not is refused.

.ci/nightly runs it; it takes some ten minutes.

Usage: formal_proofs_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import math
import os
import re
from fractions import Fraction
from random import Random

from command_line import AUDITS, CASES, InFolder, ROBOT1, SOURCE, TAUT, certify, main, run, text_of
from coq_data import read

LIBRARY = os.path.join(SOURCE, "formal")
SPHERE = os.path.join(CASES, "robot2-sphere-q1-q2.yaml")
ROLL_PITCH_YAW = os.path.join(CASES, "robot1-roll-pitch-yaw.yaml")
SPLINE = os.path.join(CASES, "tutorial", "03-a-smooth-move.yaml")
ITEMS = os.path.join(SOURCE, "tests", "cli", "formal_items.yaml")
TOLERANCES = os.path.join(SOURCE, "tests", "cli", "formal_tolerances.yaml")
OBLIQUE = os.path.join(SOURCE, "tests", "cli", "formal_oblique.yaml")
GEODESIC, LENGTHS = (os.path.join(AUDITS, f"robot1-{law}.yaml") for law in ("geodesic", "cable-lengths"))
EXACT = "tolerance := Tolerances (Six (0, 0) (0, 0) (0, 0) (0, 0) (0, 0) (0, 0)) 0 0 (Number 0)"
AXIOMS = {"sig_not_dec", "sig_forall_dec", "functional_extensionality_dep", "epsilon_statement", "classic"}
POSES = 12          # of each robot
SCALE = 44
ROOM = Fraction(1, 10**10)
OVERSTATED = Fraction(1, 10**12)


class Proofs(InFolder):
    def plan(self, case):
        said = certify(case, self.out)
        self.assertEqual(said.returncode, 0, said.stderr)
        return self.path("certificate.json")

    def written(self, case):
        """What is written of the path of a case, for computing in floating point."""
        said = run(TAUT, "formal", self.plan(case), "--no-coq", "--fast", "--out", self.path("written.v"))
        self.assertEqual(said.returncode, 0, said.stderr)
        return text_of(self.path("written.v"))

    def coqc(self, text):
        return run("coqc", "-q", "-Q", LIBRARY, "Taut", self.write("asked.v", text))


class WhatIsTrue(Proofs):
    def test_the_kernel_proves_what_is_written(self):
        for case, options in ((ROBOT1, []), (SPHERE, ["--fast"]), (ROLL_PITCH_YAW, ["--fast"]),
                              (ITEMS, ["--fast"]), (ITEMS, []), (SPLINE, ["--fast"]),
                              (TOLERANCES, ["--fast"]), (TOLERANCES, []), (OBLIQUE, ["--fast"]), (OBLIQUE, []),
                              (GEODESIC, ["--fast"]), (LENGTHS, [])):
            with self.subTest(case):
                said = run(TAUT, "formal", self.plan(case), *options)
                self.assertEqual(said.returncode, 0, said.stderr)
                self.assertIn("Checked by Coq's kernel in", said.stdout)
                if not options:
                    names = re.search(r"rests on these axioms: ([^:]*)\.\s*$", said.stdout).group(1)
                    self.assertEqual({name.strip().split(".")[-1] for name in names.split(",")}, AXIOMS)
                self.assertFalse([name for name in os.listdir(self.out) if name.endswith((".vo", ".glob", ".aux"))])
        self.assertEqual(len(re.findall("^Theorem", text_of(self.path("certificate.v")), re.M)), 1)


class WhatIsNotTrue(Proofs):
    def refused(self, case, edits):
        text = self.written(case).replace("Print Assumptions feasible.\n", "")
        self.assertEqual(self.coqc(text).returncode, 0)
        for name, pattern, edit in edits:
            with self.subTest(name):
                mutant = re.sub(pattern, edit, text, count=1)
                self.assertNotEqual(mutant, text)
                said = self.coqc(mutant)
                self.assertNotEqual(said.returncode, 0)
                self.assertIn("eq_refl", said.stderr)

    def test_the_kernel_refuses_it(self):
        self.refused(ROBOT1, [
                ("a forged box", r"(Box \(\d+ # \d+\) \d+ \(Six\s+)\(Six (?:[^()]|\(-\d+\))*\)",
                 r"\1(Six 0 0 0 0 0 0)"),
                ("forged densities", r"(\)%Z\s+\(Six )(?:-?\d+|\(-\d+\))", r"\g<1>1000000000000"),
                ("boxes that end too early", r"Box \(4 # 4\)", "Box (3 # 4)"),
                ("a tighter limit of tension", r"\(0\.05, 0\.5\)", "(0.05, 0.1)"),
                ("a tighter limit of length", r"\(0\.1, 0\.55\)", "(0.1, 0.4)"),
                ("another anchor", r"\(Vec 0 0\.22 0\)", "(Vec 0 0.12 0)"),
                ("the machine of another case", r"\(Number 0\.35\)", "(Number 0.15)"),
                ("a larger margin", "length_margin := 0;", "length_margin := 0.1;")])

    def test_it_refuses_a_spline_that_is_elsewhere(self):
        self.refused(SPLINE, [
                ("straight from control point to control point", "motion := Spline", "motion := Straight"),
                ("a control point elsewhere", r"(path := \[(?:\[[^]]*\];\s*){4}\[)\([^,]*,", r"\g<1>(9,")])

    def test_it_refuses_a_geodesic_that_is_elsewhere(self):
        self.refused(GEODESIC, [
                ("a pose elsewhere", r"(path := \[(?:\[[^]]*\];\s*){4}\[)\([^,]*,", r"\g<1>(1,"),
                ("no quaternion", r"(path := \[(?:\[[^]]*\];\s*){4}\[(?:\([^)]*%Z\); ){3}).*", r"\1(0, 0%Z)];"),
                ("another law", "motion := Geodesic", "motion := Straight")])

    def test_it_refuses_other_axes_and_ellipsoids(self):
        self.refused(OBLIQUE, [
                ("another axis", r"About \(Vec \(-1\) 2 \(-30\)\)", "About (Vec 30 2 (-1))"),
                ("no axis", r"About \(Vec \(-1\) 2 \(-30\)\)", "About (Vec 0 0 0)"),
                ("not symmetric", r"\(Six 10000 3000 1000", "(Six 10000 3000 1001"),
                ("not positive", r"\(Six 10000 3000 1000", "(Six (-10000) 3000 1000"),
                ("a larger load", r"\(Six 20000 \(-30000\) 0 0 0 2000000\)", "(Six 20000 (-30000) 0 0 0 100000)")])

    def test_it_refuses_larger_tolerances(self):
        self.refused(TOLERANCES, [
                ("of a base anchor", r"\(0\.0001, 0\.00015\)", "(0.1, 0.00015)"),
                ("of a platform anchor", r"\(0\.0003, 0\.00035\)", "(0.0003, 0.1)"),
                ("of the load point", r"\) 0\.0007 0\.001", ") 0.1 0.001"),
                ("of the position", r"\) 0\.0007 0\.001", ") 0.0007 0.1"),
                ("of the orientation", r"\(Over \(Times \(Number 0\.1\) Pi\) \(Number 180\)\)\s*\|", "(Number 0.5) |"),
                ("of any orientation", r"\(Over \(Times \(Number 0\.1\) Pi\) \(Number 180\)\)\s*\|", "(Number 7) |"),
                ("of the wrench", r"\(Six 0\.01 \(-0\.02\)", "(Six 0.01 (-9)")])

    def test_it_refuses_more_of_each_item(self):
        self.refused(ITEMS, [
                ("a heavier weight", "Weight 8000 8000", "Weight 8000 80000"),
                ("a weight elsewhere", r"\(Vec 0 0 \(-1\.2\)\) 0\.05", "(Vec 9 0 (-1.2)) 0.05"),
                ("a weight anywhere", r"\(Vec 0 0 \(-1\.2\)\) 0\.05", "(Vec 0 0 (-1.2)) 5"),
                ("more wind", "Disc 6000", "Disc 60000"),
                ("wind from below", r"Disc 6000 \(Vec 0 0 \(-9\.81\)\)", "Disc 60000 (Vec 1 0 0)"),
                ("more of a gust", "Ball 1000", "Ball 50000"),
                ("a longer hose", r"\(Vec 1 2 \(-2\)\) 500 1500", "(Vec 1 2 (-2)) 500 90000"),
                ("a stronger drive", r"\(Vec 0 0 1\) 0 2000", "(Vec 0 0 1) 0 200000"),
                ("more swirl", r"Moment \(Ball 1000\)", "Moment (Ball 100000)"),
                ("another load case", r"\(Vec 0 200 \(-1000\)\)", "(Vec 0 90000 (-1000))"),
                ("no case at all", r"LoadCases \[[^]]*\]", "LoadCases []")])


def turned(angles, v):
    """Rz(phi) Ry(theta) Rz(sigma - phi) v."""
    phi, theta, sigma = angles

    def about_z(t, u):
        return (math.cos(t) * u[0] - math.sin(t) * u[1], math.sin(t) * u[0] + math.cos(t) * u[1], u[2])
    x, y, z = about_z(sigma - phi, v)
    return about_z(phi, (math.cos(theta) * x + math.sin(theta) * z, y, math.cos(theta) * z - math.sin(theta) * x))


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def inverse(matrix):
    """By Gauss and Jordan."""
    size = len(matrix)
    rows = [list(row) + [float(i == j) for j in range(size)] for i, row in enumerate(matrix)]
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        rows = [row if i == k else [x - row[k] * y for x, y in zip(row, rows[k])] for i, row in enumerate(rows)]
    return [row[size:] for row in rows]


def exact(x):
    x = Fraction(x)
    return f"({x.numerator} # {x.denominator})"


def six(numbers):
    return f"(Six {' '.join(f'({round(x * 2**SCALE)})' for x in numbers)})"


class TheStatement(Proofs):
    """Its lengths and tensions are those of tests/oracle, which are computed otherwise, and with 50 digits.

    A cable's limits are set about its length at a pose, and about the least and largest tension there: Coq proves what
    is stated when they are 1e-10 apart from these, and refuses it when one of them is overstated by 1e-12.
    """

    def box(self, problem, pose):
        columns = []
        for base, platform in zip(problem["robot"]["base_anchors_m"], problem["robot"]["platform_anchors_m"]):
            b = [float(Fraction(x)) for x in platform]
            arm = turned(pose[3:], [x - float(Fraction(y)) for x, y in zip(b, problem["load"]["point_m"])])
            d = [p + x - float(Fraction(a)) for p, x, a in zip(pose, turned(pose[3:], b), base)]
            columns.append((*d, *cross(arm, d)))
        rows = inverse(list(zip(*columns)))
        center = [float(Fraction(x)) for x in problem["load"]["wrench"]]
        densities = [sum(x * w for x, w in zip(row, center)) for row in rows]
        return f"[[Box 1 {SCALE} (Six {' '.join(map(six, rows))})%Z {six(densities)}%Z None]]"

    def goal(self, text, problem, line, answer, edit=None):
        """A goal in Coq: whether the checker accepts these limits, of which one may be overstated."""
        pairs = {"tension": [[Fraction(f) - Fraction(v), Fraction(f) + Fraction(v)]
                             for f, v in zip(line["f0_N"], line["v_N"])],
                 "length": [[Fraction(x), Fraction(x)] for x in line["length_m"]]}
        for kind, limits in pairs.items():
            for i, pair in enumerate(limits):
                for side, sign in enumerate((-1, 1)):
                    pair[side] += sign * (-OVERSTATED if (kind, i, side) == edit else ROOM)
        cables = iter(zip(pairs["tension"], pairs["length"]))
        text = re.sub(r"\(([^()]+), ([^()]+)\) \(([^()]+), ([^()]+)\)\)", lambda _: " ".join(
            f"({exact(low)}, {exact(high)})" for low, high in next(cables)) + ")", text)
        point = f"[{'; '.join(f'({exact(x)}, 0%Z)' for x in line['pose'])}]"
        return (f"Goal Fast.check {{| subject := {text}; {EXACT} |}};\n"
                f"  motion := Straight; path := [{point}; {point}];\n"
                "  tension_margin := 0; length_margin := 0; bits := 60;\n"
                f"  boxes := {self.box(problem, line['pose'])} |}} = {answer}.\n"
                "Proof. vm_compute. reflexivity. Qed.\n")

    def test_it_is_of_the_poses_of_50_digits(self):
        lines = [json.loads(line) for line in text_of(os.path.join(SOURCE, "tests/oracle/poses.jsonl")).splitlines()]
        for robot, case in (("robot1", ROBOT1), ("robot2", SPHERE)):
            text = self.written(case)
            problem = self.certificate()["problem"]
            head, machine = re.match(r"(.*?)Definition robot : machine := (.*?)\.\n\n", text, re.S).groups()
            machine = re.sub(r"pose_position.*", "pose_position := Vec (Param 0) (Param 1) (Param 2);\n"
                             "  pose_angles := TiltTorsion (Param 3) (Param 4) (Param 5)", machine, flags=re.S)
            chosen = [line for line in lines if line["robot"] == robot and abs(float(line["det_J"])) > 1e-3][:POSES]
            self.assertEqual(len(chosen), POSES)
            places = [(kind, i, side) for kind in ("tension", "length") for i in range(6) for side in (0, 1)]
            goals = [self.goal(machine, problem, line, "true") for line in chosen]
            goals += [self.goal(machine, problem, line, "false", place)
                      for k, line in enumerate(chosen) for place in places[k % 4::4]]
            said = self.coqc(head + "".join(goals))
            self.assertEqual(said.returncode, 0, said.stderr)


class WithinTolerances(Proofs):
    """Machines that deviate, chosen at random and computed otherwise: none may break limits that Coq takes for kept.

    Where one of them is at a limit, Coq has to refuse it; limits that are a little further away than any of many of
    them get have to be accepted.
    """
    MACHINES = 300
    ROOM = 2.5  # times as far as they get: none of them deviates by all that it may in the worst direction at once
    SET = {"base": 2e-4, "platform": 3e-4, "point": 5e-4, "position": 4e-4, "angle": 1e-3}
    SHIFT = (0.01, -0.02, 0.015, 0.0002, 0.0001, -0.0003)

    def direction(self, random, radius):
        while True:
            v = [random.uniform(-1, 1) for _ in range(3)]
            if 0.1 < math.hypot(*v) <= 1:
                return [radius * x / math.hypot(*v) for x in v]

    def ranges(self, problem, pose, random=None):
        """[(least, greatest)] of each cable's tension, and its length, of one machine; with none, as stated."""
        def off(v, key):
            return [x + y for x, y in zip(v, self.direction(random, self.SET[key]))] if random else v
        numbers = {key: [[float(Fraction(x)) for x in v] for v in problem["robot"][key]]
                   for key in ("base_anchors_m", "platform_anchors_m")}
        point = off([float(Fraction(x)) for x in problem["load"]["point_m"]], "point")
        position = off(list(pose[:3]), "position")
        w = self.direction(random, self.SET["angle"]) if random else [0, 0, 0]
        angle = math.hypot(*w)

        def turn(v):  # a quaternion's turn
            u, s, c = turned(pose[3:], v), math.sin(angle / 2), math.cos(angle / 2)
            q = [s * x / angle for x in w] if angle else w
            t = [2 * x for x in cross(q, u)]
            return [x + c * y + z for x, y, z in zip(u, t, cross(q, t))]
        columns, lengths = [], []
        for base, platform in zip(numbers["base_anchors_m"], numbers["platform_anchors_m"]):
            a, b = off(base, "base"), off(platform, "platform")
            d = [p + x - y for p, x, y in zip(position, turn(b), a)]
            columns.append((*d, *cross(turn([x - y for x, y in zip(b, point)]), d)))
            lengths.append(math.hypot(*d))
        share = random.choice((-1, 1)) if random else 0
        center = [float(Fraction(x)) + share * y for x, y in zip(problem["load"]["wrench"], self.SHIFT)]
        diagonal = [float(Fraction(row[k])) for k, row in enumerate(problem["load"]["ellipsoid"])]
        found = []
        for row, length in zip(inverse(list(zip(*columns))), lengths):
            middle = length * sum(x * y for x, y in zip(row, center))
            reach = length * math.sqrt(sum(x * x / e for x, e in zip(row, diagonal)))
            found.append((middle - reach, middle + reach))
        return found, lengths

    def test_no_machine_breaks_what_is_proved(self):
        random = Random(1)
        text = self.written(SPHERE)
        problem = self.certificate()["problem"]
        head, machine = re.match(r"(.*?)Definition robot : machine := (.*?)\.\n\n", text, re.S).groups()
        machine = re.sub(r"pose_position.*", "pose_position := Vec (Param 0) (Param 1) (Param 2);\n"
                         "  pose_angles := TiltTorsion (Param 3) (Param 4) (Param 5)", machine, flags=re.S)
        machine, count = re.subn(r"Ellipsoid (\(Six [^()]*\)) \(Six 0 0 0 0 0 0\)",
                                 rf"Ellipsoid \1 (Six {' '.join(exact(str(x)) for x in self.SHIFT)})", machine)
        self.assertEqual(count, 1)
        each = f"({exact(str(self.SET['base']))}, {exact(str(self.SET['platform']))})"
        tolerance = (f"tolerance := Tolerances (Six {' '.join([each] * 6)}) {exact(str(self.SET['point']))} "
                     f"{exact(str(self.SET['position']))} (Number {exact(str(self.SET['angle']))})")
        goals = []
        for pose in ((0.01, -0.02, 0.3, 0.4, 0.2, 0.1), (-0.03, 0.02, 0.33, -1.1, 0.3, -0.05)):
            stated, lengths = self.ranges(problem, pose)
            machines = [self.ranges(problem, pose, random) for _ in range(self.MACHINES)]
            reached = {"tension": [[f(m[0][i][side] for m in machines) for side, f in ((0, min), (1, max))]
                                   for i in range(6)],
                       "length": [[f(m[1][i] for m in machines) for f in (min, max)] for i in range(6)]}
            start = {"tension": stated, "length": [(x, x) for x in lengths]}
            box = TheStatement.box(self, problem, pose)
            for edit in [None] + [(kind, i, side) for kind in reached for i in range(6) for side in (0, 1)]:
                def limit(kind, i, side):
                    far = start[kind][i][side] + self.ROOM * (reached[kind][i][side] - start[kind][i][side])
                    return exact(reached[kind][i][side] if edit == (kind, i, side) else far)
                cables = iter(range(6))
                limited = re.sub(r"\(([^()]+), ([^()]+)\) \(([^()]+), ([^()]+)\)\)", lambda _: " ".join(
                    f"({limit(kind, i, 0)}, {limit(kind, i, 1)})" for i in [next(cables)]
                    for kind in ("tension", "length")) + ")", machine)
                at = f"[{'; '.join(f'({exact(x)}, 0%Z)' for x in pose)}]"
                goals.append(f"Goal Fast.check {{| subject := {limited}; {tolerance} |}}; motion := Straight;\n"
                             f"  path := [{at}; {at}]; tension_margin := 0; length_margin := 0; bits := 60;\n"
                             f"  boxes := {box} |}} = {'true' if edit is None else 'false'}.\n"
                             "Proof. vm_compute. reflexivity. Qed.\n")
        said = self.coqc(head + "".join(goals))
        self.assertEqual(said.returncode, 0, said.stderr)


class AlongMotions(Proofs):
    """Poses of geodesics, of turns about an axis and of lengths, computed otherwise, under an oblique ellipsoid.

    As WithinTolerances, of short ways, so that one box is enough: Coq accepts limits that are just beyond what is
    reached at any of many places, and refuses each that is reached.
    """
    PLACES = 201
    ROOM, ROOM_OF_LENGTHS = 1.05, 1.3  # times as far from the middle of what is reached
    MATRIX = ((1e4, 3e3, 1e3, 0, 0, 2e4), (3e3, 2e4, 0, 0, 0, -3e4), (1e3, 0, 1e4, 0, 4e4, 0),
              (0, 0, 0, 1e6, -3e5, 0), (0, 0, 4e4, -3e5, 1e6, 0), (2e4, -3e4, 0, 0, 0, 2e6))

    def reached(self, problem, position, quaternion):
        """[(least, greatest)] of tensions, and lengths, at a pose: by the matrix of a quaternion."""
        x, y, z, w = (c / math.hypot(*quaternion) for c in quaternion)
        rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))

        def turn(v):
            return [dot(row, v) for row in rows]
        robot, load = problem["robot"], problem["load"]
        columns, lengths = [], []
        for base, platform in zip(robot["base_anchors_m"], robot["platform_anchors_m"]):
            b = [float(Fraction(c)) for c in platform]
            d = [p + u - float(Fraction(a)) for p, u, a in zip(position, turn(b), base)]
            arm = turn([u - float(Fraction(c)) for u, c in zip(b, load["point_m"])])
            columns.append((*d, *cross(arm, d)))
            lengths.append(math.hypot(*d))
        center, spread = [float(Fraction(c)) for c in load["wrench"]], inverse(self.MATRIX)
        tensions = []
        for row, length in zip(inverse(list(zip(*columns))), lengths):
            reach = math.sqrt(dot(row, [dot(line, row) for line in spread]))
            tensions.append([length * (dot(row, center) + sign * reach) for sign in (-1, 1)])
        return tensions, lengths, columns

    def goals(self, machine, problem, law, path, poses, tube="None", room=ROOM):
        """One that the checker accepts, and for each limit one that it refuses: a pose is beyond it."""
        all_of = [self.reached(problem, *pose) for pose in poses]
        ends = {"tension": [[f(found[0][i][side] for found in all_of) for side, f in ((0, min), (1, max))]
                            for i in range(6)],
                "length": [[f(found[1][i] for found in all_of) for f in (min, max)] for i in range(6)]}
        rows = inverse(list(zip(*all_of[self.PLACES // 2][2])))
        center = [float(Fraction(c)) for c in problem["load"]["wrench"]]
        box = f"[[Box 1 {SCALE} (Six {' '.join(map(six, rows))})%Z {six([dot(row, center) for row in rows])}%Z {tube}]]"
        for edit in [None] + [(kind, i, side) for kind in ends for i in range(6) for side in (0, 1)]:
            def limit(kind, i, side):
                end, middle = ends[kind][i][side], sum(ends[kind][i]) / 2
                return exact(end if edit == (kind, i, side) else middle + room * (end - middle))
            cables = iter(range(6))
            limited = re.sub(r"\(([^()]+), ([^()]+)\) \(([^()]+), ([^()]+)\)\)", lambda _: " ".join(
                f"({limit(kind, i, 0)}, {limit(kind, i, 1)})" for i in [next(cables)]
                for kind in ("tension", "length")) + ")", machine)
            points = "; ".join(f"[{'; '.join(f'({exact(x)}, 0%Z)' for x in point)}]" for point in path)
            yield (f"Goal Fast.check {{| subject := {limited}; {EXACT} |}}; motion := {law};\n"
                   f"  path := [{points}]; tension_margin := 0; length_margin := 0; bits := 60;\n"
                   f"  boxes := {box} |}} = {'true' if edit is None else 'false'}.\n"
                   "Proof. vm_compute. reflexivity. Qed.\n")

    def of_lengths(self, machine, problem, shares):
        """By Newton's method from the chord, with a derivative from differences."""
        size = (2e-5, 2e-4)

        def pose(x, tube):
            """The pose of the chord at x, changed by coordinates in the tube: a product of quaternions."""
            u, v, (a, b) = [size[1] * c for c in tube[3:]], x[3:6], (1, x[6])
            return ([c + size[0] * y for c, y in zip(x, tube)],
                    [a * c + b * y + z for c, y, z in zip(v, u, cross(u, v))] + [a * b - dot(u, v)])

        def lengths(x, tube):
            return self.reached(problem, *pose(x, tube))[1]

        def derivative(x):  # of half the squares
            def half(tube):
                return [c * c / 2 for c in lengths(x, tube)]
            step = 1e-2
            columns = [[(a - b) / (2 * step) for a, b in
                        zip(half([step * (i == j) for i in range(6)]), half([-step * (i == j) for i in range(6)]))]
                       for j in range(6)]
            return list(zip(*columns))
        first, last = (0, 0, 0.35, 0.01, -0.02, 0.29, 0.95), (2e-5, 5e-5, 0.35, 0.0102, -0.0202, 0.2901, 0.9498)
        ends = [lengths(x, [0] * 6) for x in (first, last)]
        poses, farthest = [], 0
        for s in shares:
            x = [a + s * (b - a) for a, b in zip(first, last)]
            target = [a + s * (b - a) for a, b in zip(*ends)]
            solve, tube = inverse(derivative(x)), [0] * 6
            for _ in range(5):
                off = [(a * a - b * b) / 2 for a, b in zip(lengths(x, tube), target)]
                tube = [c - dot(row, off) for c, row in zip(tube, solve)]
            farthest = max(farthest, *map(abs, tube))
            poses.append(pose(x, tube))
        self.assertTrue(1e-5 < farthest < 1e-2, farthest)
        middle = inverse(derivative([(a + b) / 2 for a, b in zip(first, last)]))
        tube = (f"(Some (TubeBox {SCALE} (Six {' '.join(map(six, middle))})%Z (1 # 32) (Six 0 0 0 0 0 0) "
                "(1 # 256)))")
        path = [(*x, *length, *size) for x, length in zip((first, last), ends)]
        yield from self.goals(machine, problem, "Lengths", path, poses, tube, self.ROOM_OF_LENGTHS)

    def test_poses_and_loads_are_those_of_the_statement(self):
        text = self.written(OBLIQUE)
        problem = self.certificate()["problem"]
        self.assertEqual([[float(Fraction(x)) for x in row] for row in problem["load"]["ellipsoid"]],
                         [list(row) for row in self.MATRIX])
        head, machine = re.match(r"(.*?)Definition robot : machine := (.*?);\n  tolerance := ", text, re.S).groups()
        shares = [k / (self.PLACES - 1) for k in range(self.PLACES)]

        def between(a, b, s):
            return [x + s * (y - x) for x, y in zip(a, b)]
        goals = []
        # By the sines of shares of the angle between quaternions: of any length, and of the other sign.
        for first, last in (((0, 0, 0.35, 0.01, -0.02, 0.29, 0.95), (1e-4, 2e-4, 0.35, 0.011, -0.021, 0.2905, 0.949)),
                            ((0, 0, 0.36, 0.02, -0.04, 0.58, 1.9), (0, 2e-4, 0.36, -0.011, 0.02, -0.29, -0.949))):
            p, q = ([c / math.hypot(*pose[3:]) for c in pose[3:]] for pose in (first, last))
            if dot(p, q) < 0:
                q = [-c for c in q]
            angle = math.acos(dot(p, q))
            poses = [(between(first[:3], last[:3], s),
                      [(math.sin((1 - s) * angle) * x + math.sin(s * angle) * y) / math.sin(angle)
                       for x, y in zip(p, q)]) for s in shares]
            goals += self.goals(machine, problem, "Geodesic", (first, last), poses)
        # About the case's axis, which is not of length 1.
        axis = [c / math.hypot(-1, 2, -30) for c in (-1, 2, -30)]
        first, last = (0.001, -0.6), (0.0012, -0.603)
        poses = [((x, 0, 0.35), [math.sin(turn / 2) * c for c in axis] + [math.cos(turn / 2)])
                 for x, turn in (between(first, last, s) for s in shares)]
        self.assertIn("About (Vec (-1) 2 (-30)) (Param 1)", machine)
        goals += self.goals(machine, problem, "Straight", (first, last), poses)
        goals += self.of_lengths(machine, problem, shares)
        said = self.coqc(head + "".join(goals))
        self.assertEqual(said.returncode, 0, said.stderr)


def dot(u, v):
    return sum(x * y for x, y in zip(u, v))


def floats(vector):
    return [float(x) for x in vector[1:]]


def range_over_vectors(stated, h):
    """The least and the greatest h.v."""
    kind, *data = stated
    if kind == "Ball":
        most = float(data[0]) * math.hypot(*h)
    elif kind == "Disc":
        n = floats(data[1])
        share = dot(h, n) / dot(n, n)
        most = float(data[0]) * math.hypot(*(x - share * y for x, y in zip(h, n)))
    else:
        along = dot(h, floats(data[0])) / math.hypot(*floats(data[0]))
        return sorted(float(f) * along for f in data[1:])
    return -most, most


class TheLoad(Proofs):
    """At a pose, Coq's ranges of tensions over the items are those of the items' definitions.

    A weight has a range of masses or a tolerance of place here, and not both: of both together Coq takes a little more.
    """
    ROOM = Fraction(1, 10**5)

    def setUp(self):
        super().setUp()
        text = self.written(ITEMS)
        text = text.replace("Weight 8000 8000", "Weight 7900 8100").replace("Weight 11760 12240", "Weight 12000 12000")
        self.machine = re.search(r"Definition robot : machine := (.*?)\.\n\n", text, re.S).group(1)
        self.head = text[:text.index("Definition cert")]
        self.robot = read(text)["robot"]

    def range_over_item(self, item, pose, y):
        kind, *data = item
        force, moment = y[:3], y[3:]
        h = [x + m for x, m in zip(force, cross(moment, turned(pose[3:], self.point(item))))]

        def seen(u):
            """u in the axes in which the item is stated."""
            if "OfWorld" in data:
                return u
            return [dot(u, turned(pose[3:], [float(i == j) for j in range(3)])) for i in range(3)]
        if kind == "Weight":
            gravity, off = floats(data[2]), float(data[4]) * math.hypot(*cross(floats(data[2]), moment))
            all_of = [float(mass) * (dot(h, gravity) + sign * off) for mass in data[:2] for sign in (-1, 1)]
        elif kind == "LoadCases":
            all_of = [dot(seen(h), floats(f)) + dot(seen(moment), floats(m)) for f, m in data[0]]
        else:
            return range_over_vectors(data[0], seen(h if kind == "Force" else moment))
        return min(all_of), max(all_of)

    def point(self, item):
        at = {"Weight": 4, "Force": 3, "LoadCases": 3}.get(item[0])
        return [0, 0, 0] if at is None else [x - y for x, y in zip(floats(item[at]), floats(self.robot["load_point"]))]

    def test_it_is_what_the_items_are(self):
        self.assertEqual({item[0] for item in self.robot["load"]}, {"Weight", "Force", "Moment", "LoadCases"})
        goals = []
        for k, pose in enumerate([(-4, 0.5, 6, 0.3, 0.1, -0.1), (2, -1, 5, -0.2, 0.05, 0.2)]):
            columns, lengths = [], []
            for _, base, platform, *_ in self.robot["cables"][1:]:
                arm = turned(pose[3:], floats(platform))
                d = [p + x - a for p, x, a in zip(pose, arm, floats(base))]
                columns.append((*d, *cross(arm, d)))
                lengths.append(math.hypot(*d))
            self.assertEqual(floats(self.robot["load_point"]), [0, 0, 0])
            rows = inverse(list(zip(*columns)))
            ranges = [[sum(ends) for ends in zip(*(self.range_over_item(item, pose, y) for item in self.robot["load"]))]
                      for y in rows]
            middles = [(low + high) / 2 for low, high in ranges]
            box = f"[[Box 1 {SCALE} (Six {' '.join(map(six, rows))})%Z {six(middles)}%Z None]]"
            edits = [None] + [(i, side) for i in range(6) for side in (0, 1)]
            for edit in edits[:1] + edits[1 + k::2]:
                def limit(i, side):
                    room = -self.ROOM if edit == (i, side) else self.ROOM
                    return exact(Fraction(lengths[i] * ranges[i][side]) + (room if side == 1 else -room))
                limits = iter([(limit(i, 0), limit(i, 1)) for i in range(6)])
                machine = re.sub(r"\(2000, 160000\)", lambda _: "({}, {})".format(*next(limits)), self.machine)
                machine = re.sub(r"pose_position.*", "pose_position := Vec (Param 0) (Param 1) (Param 2);\n"
                                 "  pose_angles := TiltTorsion (Param 3) (Param 4) (Param 5)", machine, flags=re.S)
                point = f"[{'; '.join(f'({exact(x)}, 0%Z)' for x in pose)}]"
                goals.append(f"Goal Fast.check {{| subject := {machine}; {EXACT} |}}; motion := Straight;\n"
                             f"  path := [{point}; {point}]; tension_margin := 0; length_margin := 0; bits := 60;\n"
                             f"  boxes := {box} |}} = "
                             f"{'true' if edit is None else 'false'}.\nProof. vm_compute. reflexivity. Qed.\n")
        said = self.coqc(self.head + "".join(goals))
        self.assertEqual(said.returncode, 0, said.stderr)


if __name__ == "__main__":
    main()

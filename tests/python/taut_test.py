#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module. Usage: taut_test.py TAUT SOURCE_DIR, with the module in PYTHONPATH."""
import copy
import dataclasses
import hashlib
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import taut

TAUT, SOURCE = sys.argv[1:3]
CASES = os.path.join(SOURCE, "cases")
ROBOT1 = os.path.join(CASES, "robot1-slice-qs-qg.yaml")
BRIDGING = os.path.join(CASES, "audits", "robot1-bridging.yaml")

# The same robot as ROBOT1, in numbers.
ROBOT = {
    "taut": 1,
    "name": "robot1",
    "units": {"length": "mm", "force": "N", "moment": "N*m", "mass": "kg", "angle": "rad"},
    "robot": {
        "base_anchors": np.array([[0, 220, 0], [0, 220, 0], [-190.5256, -110, 0], [-190.5256, -110, 0],
                                  [190.5256, -110, 0], [190.5256, -110, 0]]),
        "platform_anchors": [[-112.5833, 65, 0], [112.5833, 65, 0], [0, -130, 0]] * 2,
        "tension": np.array([0.05, 0.5]),
        "length": [100, 550],
    },
    "load": {"point": [30, 14, -21], "wrench": [0, 0, 1, 0, 0, 0],
             "ellipsoid": {"diagonal": np.array([1e4, 1e4, 1e4, 1e6, 1e6, 1e6])}},
    "space": {"slice": {"px": 0, "py": 0, "pz": 350, "sigma": "34 deg"}},
    "query": {"waypoints": [{"phi": -2.3, "theta": 1.6}, {"phi": np.float64(1.7), "theta": 1.7}]},
}

# A crane that moves its load by 8 m in time.
CRANE = {
    "taut": 1,
    "name": "crane",
    "units": {"length": "m", "force": "kN", "moment": "kN*m", "mass": "t", "angle": "deg", "time": "s"},
    "robot": {
        "base_anchors": [[15, 10, 15]] * 2 + [[-15, 10, 15]] * 2 + [[0, -10, 15]] * 2,
        "platform_anchors": np.array([[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0],
                                      [-1.3, -0.75, 0]]),
        "tension": [2, 160],
        "length": [3, 35],
    },
    "load": {"gravity": [0, 0, "-9.81 m/s^2"], "items": [{"name": "payload", "mass": 20, "at": [0, 0, -1]}]},
    "space": {"slice": {"px": [-8, 8], "py": 0, "pz": [3, 10], "phi": 0, "theta": 0, "sigma": 0}},
    "query": {"waypoints": [{"px": -4, "pz": 6}, {"px": 4, "pz": 6}]},
    "planner": {"strategy": "greedy", "smooth": "spline"},
    "time": {"winches": {"speed": 1, "acceleration": 0.5}, "load": {"speed": 0.8, "acceleration": 0.2}},
}


def command(*arguments):
    """The certificate that a command of taut writes."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([TAUT, *arguments, "--max-seconds", "0", "--out", out], capture_output=True, check=False,
                       timeout=300)
        with open(os.path.join(out, "certificate.json"), encoding="utf-8") as file:
            return file.read()


def long_case():
    """A case whose search lasts as long as its budget: pulled taut, its path would soon be as short as can be."""
    with open(os.path.join(CASES, "robot2-free-q2-q3-astar.yaml"), encoding="utf-8") as file:
        return file.read().replace("strategy: astar,", "strategy: astar, smooth: none,")


class Cases(unittest.TestCase):
    def test_of_a_file(self):
        case = taut.Case.load(ROBOT1)
        self.assertEqual((case.name, case.parameters, case.query_waypoints),
                         ("robot1-slice-qs-qg", ["phi", "theta"], 2))
        self.assertEqual(case.tension_limits_N.tolist(), [[0.05, 0.5]] * 6)
        self.assertEqual(case.length_limits_m.shape, (6, 2))

    def test_is_shown_as_by_the_command(self):
        case = taut.Case.load(ROBOT1)
        with tempfile.TemporaryDirectory() as folder:
            drawing = os.path.join(folder, "robot.svg")
            said = subprocess.run([TAUT, "show", ROBOT1], capture_output=True, text=True, check=True, timeout=60)
            self.assertEqual(case.summary(), said.stdout)
            said = subprocess.run([TAUT, "show", ROBOT1, "--json", "--out", drawing], capture_output=True, text=True,
                                  check=True, timeout=60)
            self.assertEqual({"command": "show", **case.summary_data()}, json.loads(said.stdout))
            with open(drawing, encoding="utf-8") as file:
                self.assertEqual(case._repr_svg_(), file.read())
            for line in case.load_statement:
                self.assertIn(line, case.summary())
            self.assertEqual(case.load_statement, case.summary_data()["load"]["text"])
        self.assertEqual(case.warnings, [])
        bridging = taut.Case.load(BRIDGING)
        self.assertIsNone(bridging._repr_svg_())
        self.assertRaises(taut.InputError, bridging.drawing_svg)

    def test_of_a_dict_with_arrays(self):
        case = taut.Case(ROBOT)
        planned = taut.plan(case)
        reference = taut.plan(taut.Case.load(ROBOT1))
        self.assertEqual(planned.path.waypoints.tolist(), reference.path.waypoints.tolist())
        self.assertEqual(planned.theorem.margins, reference.theorem.margins)

    def test_warns_of_what_may_not_be_meant(self):
        robot = copy.deepcopy(ROBOT)
        robot["units"]["force"] = "mN"
        robot["load"] = {"mass": 0.1, "gravity": [0, 0, 9.81], "ellipsoid": {"diagonal": [20, 20, 20, 1, 1, 1]}}
        warnings = taut.Case(robot, "crane").warnings
        self.assertEqual(len(warnings), 1)
        self.assertRegex(warnings[0], r"^crane:\d+:\d+: load\.ellipsoid\.diagonal: these numbers look like semi-axes")

    def test_in_other_angles(self):
        slice_of_poses = {"px": 0, "py": 0, "pz": 350, "yaw": "34 deg"}
        case = taut.Case({**ROBOT, "space": {"angles": "roll-pitch-yaw", "slice": slice_of_poses},
                          "query": {"waypoints": [{"roll": 0, "pitch": 0}, {"roll": 0.3, "pitch": 0.5}]}})
        self.assertEqual(case.parameters, ["roll", "pitch"])
        certificate = taut.plan(case)
        self.assertEqual(certificate.verdict, "proved")
        self.assertEqual(json.loads(certificate.text)["problem"]["space"]["angles"], "roll-pitch-yaw")
        audited = taut.audit(case, {"roll[rad]": [0, 0.1], "pitch[rad]": [0, 0.1]})
        self.assertEqual(audited.verdict, "proved")
        half = (0.1 / 2, 0.1 / 2, np.deg2rad(34) / 2)  # roll, pitch, yaw
        (a, b, c), (x, y, z) = np.cos(half), np.sin(half)
        expected = [x * b * c - a * y * z, a * y * c + x * b * z, a * b * z - x * y * c, a * b * c + x * y * z]
        self.assertAlmostEqual(abs(np.dot(audited.samples().quaternion[-1], expected)), 1, places=14)
        with self.assertRaisesRegex(taut.InputError, "'yaw', which is understood with 'angles: roll-pitch-yaw'"):
            taut.Case({**ROBOT, "query": {"waypoints": [{"phi": 0, "yaw": 0}, {"phi": 1, "theta": 0}]}})

    def test_of_text(self):
        with open(ROBOT1, encoding="utf-8") as file:
            self.assertEqual(taut.Case(file.read()).name, "robot1-slice-qs-qg")

    def test_that_is_wrong_says_where(self):
        wrong = copy.deepcopy(ROBOT)
        wrong["robot"]["tension"] = [0.5, 0.05]
        with self.assertRaisesRegex(taut.InputError, r"crane:\d+:\d+: robot\.tension\[0\]: got \[0\.5, 0\.05\], "
                                                     r"expected") as caught:
            taut.Case(wrong, "crane")
        self.assertEqual((caught.exception.file, caught.exception.field), ("crane", "robot.tension[0]"))
        self.assertGreater(caught.exception.line, 20)
        self.assertIsInstance(caught.exception, ValueError)
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(again), again.line, again.code), (str(caught.exception), caught.exception.line, "E3"))
        wrong["robot"]["tension"] = object()
        self.assertRaises(TypeError, taut.Case, wrong)
        self.assertRaises(taut.InputError, taut.Case.load, "/no/such/file")


    def test_messages_are_the_commands(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "crane.yaml")
            with open(ROBOT1, encoding="utf-8") as good, open(file, "w", encoding="utf-8") as bad:
                bad.write(good.read().replace("point: [30, 14, -21]", "point: [30, 14, far]"))
            rows = os.path.join(folder, "rows.csv")
            with open(rows, "w", encoding="utf-8") as table:
                table.write("phi[rad],theta[rad]\n1,2\n1,x\n")
            for arguments, call in ((("plan", file), lambda: taut.Case.load(file)),
                                    (("audit", ROBOT1, rows), lambda: taut.audit(taut.Case.load(ROBOT1), rows))):
                said = subprocess.run([TAUT, *arguments, "--out", folder], capture_output=True, text=True, check=False,
                                      timeout=60)
                with self.assertRaises(taut.InputError) as caught:
                    call()
                self.assertEqual((said.returncode, said.stderr),
                                 (3, f"taut: {caught.exception} [{caught.exception.code}]\n"))
                self.assertTrue(str(caught.exception).startswith(f"{caught.exception.file}:{caught.exception.line}:"))


class Certificates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = taut.Case.load(ROBOT1)
        cls.planned = taut.plan(cls.case)

    def test_are_those_of_the_commands(self):
        self.assertEqual(self.planned.text, command("plan", ROBOT1))
        self.assertEqual(taut.audit(taut.Case.load(BRIDGING)).text, command("audit", BRIDGING))

    def test_say_what_is_proved(self):
        self.assertTrue(self.planned.is_proved)
        self.assertEqual(self.planned.case_name, "robot1-slice-qs-qg")
        self.assertEqual(self.planned.document_fields["title"], "Turn the platform in place, 174°, Robot 1")
        self.assertEqual(self.planned.document_fields, self.case.document_fields)
        self.assertGreater(self.planned.theorem.margins.tension_N, 0)
        self.assertIsNone(self.planned.theorem.witness)
        self.assertEqual(self.planned.stretches, [])
        self.assertEqual(self.planned.data["verdict"], "proved")
        self.assertEqual(len(self.planned.path.waypoints), self.planned.segments + 1)
        self.assertIn("proved", repr(self.planned))

    def test_have_a_theorem_where_the_checker_made_one(self):
        self.assertEqual(self.planned.theorem.verdict, "proved")
        self.assertEqual(self.planned.theorem.certificate_sha256,
                         hashlib.sha256(self.planned.text.encode()).hexdigest())
        loaded = taut.Certificate(self.planned.text)
        self.assertEqual((loaded.verdict, loaded.theorem, loaded.is_proved), ("unchecked", None, False))
        self.assertEqual(taut.check(loaded).theorem, self.planned.theorem)
        unchecked = taut.plan(self.case, max_check_seconds=0)
        self.assertEqual((unchecked.verdict, unchecked.theorem, unchecked.text), ("unchecked", None, self.planned.text))
        self.assertIn("UNCHECKED: ", taut.report(loaded, "text", max_check_seconds=0))
        self.assertEqual(taut.check(loaded, self.case).not_compared, ("path file",))
        with open(os.path.join(CASES, "..", "tests", "attacks", "f1.json"), encoding="utf-8") as file:
            forged = taut.Certificate(file.read())
        self.assertIsNone(taut.check(forged).theorem)
        self.assertRaises(taut.InputError, taut.report, forged)

    def test_are_saved_loaded_and_pickled(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "certificate.json")
            self.planned.save(file)
            self.assertEqual(taut.Certificate.load(file).text, self.planned.text)
            self.assertTrue(taut.check(file, self.case).is_accepted)
        self.assertEqual(pickle.loads(pickle.dumps(self.planned)).text, self.planned.text)
        altered = self.planned.text.replace('"0.05"', '"0.04"', 1)
        self.assertRaises(taut.InputError, taut.Certificate, altered)
        self.assertEqual(taut.check(altered.encode()).outcome, "malformed")

    def test_are_checked_against_the_case(self):
        self.assertEqual(taut.check(self.planned, self.case).outcome, "accepted")
        other = taut.Case.load(os.path.join(CASES, "robot1-slice-qs1-qg.yaml"))
        result = taut.check(self.planned, other)
        self.assertEqual((result.outcome, result.is_accepted), ("rejected", False))
        self.assertRaises(taut.InputError, taut.check, self.planned, trusted_keys=["no key"])

    def test_have_samples(self):
        samples = self.planned.samples(100)
        n = len(samples.position)
        self.assertEqual([samples.p_m.shape, samples.quaternion.shape, samples.tension_lower_N.shape],
                         [(n, 3), (n, 4), (n, 6)])
        self.assertTrue((samples.tension_lower_N > 0.05).all() and (samples.tension_upper_N < 0.5).all())
        self.assertTrue(np.allclose(np.linalg.norm(samples.quaternion, axis=1), 1))

    def test_have_a_table_for_a_controller(self):
        self.assertIn("# Step: 10 mm.", self.planned.controller_csv())
        coarse, fine = (self.planned.controller_csv(step).count("\n") for step in (0.1, 0.001))
        self.assertLess(coarse, fine)
        self.assertRaises(taut.InputError, self.planned.controller_csv, 0)
        self.assertRaises(taut.InputError, taut.Certificate(self.planned.text).controller_csv)

    def test_are_reported(self):
        self.assertTrue(taut.report(self.planned, document="LIFT-1").startswith("<!DOCTYPE html>"))
        self.assertIn("confirmed", taut.report(self.planned, "json"))
        self.assertRaises(taut.InputError, taut.report, self.planned, "pdf")


    def test_are_signed(self):
        with tempfile.TemporaryDirectory() as folder:
            key, public = os.path.join(folder, "key.pem"), os.path.join(folder, "public.pem")
            subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", key], check=True)
            os.chmod(key, 0o600)
            subprocess.run(["openssl", "pkey", "-in", key, "-pubout", "-out", public], check=True)
            with open(key, encoding="utf-8") as secret, open(public, encoding="utf-8") as known:
                secret, known = secret.read(), known.read()
            planned = taut.plan(self.case, signing_key=secret)
            self.assertEqual(planned.text, command("plan", ROBOT1, "--sign", key))
            audited = taut.audit(taut.Case.load(BRIDGING), signing_key=secret)
            self.assertEqual(audited.text, command("audit", BRIDGING, "--sign", key))
            proved = taut.prove(self.case, planned.path, signing_key=secret)
        for certificate in (planned, audited, proved):
            result = taut.check(certificate, trusted_keys=[known])
            self.assertEqual((result.outcome, result.is_trusted, len(result.signer)), ("accepted", True, 64))
        self.assertEqual(taut.check(self.planned, trusted_keys=[known]).outcome, "rejected")
        with self.assertRaisesRegex(taut.InputError, "signing_key_pem"):
            taut.plan(self.case, signing_key="no key")


class Proofs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = taut.Case.load(ROBOT1)
        cls.path = taut.plan(cls.case).path

    def test_of_arrays_bit_for_bit(self):
        waypoints = self.path.waypoints[:4] + np.array([[0, 0], [1e-16, 0], [0, np.spacing(1.0)], [0, 0]])
        proved = taut.prove(self.case, waypoints, half_turns=self.path.half_turns[:4],
                            times=[0, 0.1, "0.25", np.float64(1) / 3])
        self.assertEqual(proved.path.waypoints.tobytes(), waypoints.tobytes())
        self.assertEqual(proved.path.times, ("0.0", "0.1", "0.25", repr(1 / 3)))
        self.assertTrue(proved.is_proved)
        self.assertTrue(taut.check(proved).is_accepted)

    def test_of_paths_and_views(self):
        self.assertTrue(taut.prove(self.case, self.path).is_proved)
        backwards = taut.prove(self.case, self.path.waypoints[::-1], half_turns=self.path.half_turns[::-1])
        self.assertTrue(backwards.is_proved)
        fortran = np.asfortranarray(self.path.waypoints)
        self.assertEqual(taut.prove(self.case, fortran, half_turns=self.path.half_turns).text,
                         taut.prove(self.case, self.path.waypoints, half_turns=self.path.half_turns).text)

    def test_of_poses(self):
        audited = taut.audit(taut.Case.load(os.path.join(CASES, "audits", "robot1-geodesic.yaml")))
        proved = taut.prove(self.case, audited.path.waypoints, interpolation="geodesic")
        self.assertEqual(proved.path.interpolation, "geodesic")
        self.assertIsNone(proved.path.half_turns)
        self.assertEqual(proved.verdict, audited.verdict)

    def test_that_refute(self):
        refuted = taut.prove(self.case, [[-2.3, 1.6], [1.7, 1.7]])
        self.assertEqual(refuted.verdict, "refuted")
        witness = refuted.theorem.witness
        self.assertIn(witness.kind, ("tension_min", "tension_max"))
        self.assertTrue(witness.value[1] <= witness.limit or witness.value[0] >= witness.limit)
        self.assertIsNone(refuted.theorem.margins)

    def test_of_what_does_not_fit(self):
        for waypoints, message in (([1.0, 2.0], "shape"), ([[1.0, 2.0, 3.0]] * 2, "got 3 numbers, expected 2"),
                                   ([[1.0, np.nan]] * 2, "finite")):
            with self.assertRaisesRegex(taut.InputError, message):
                taut.prove(self.case, waypoints)
        with self.assertRaises(TypeError):
            taut.prove(self.case, np.ones((2, 2), dtype=np.longdouble))
        with self.assertRaises(TypeError):
            taut.prove(self.case, self.path, interpolation="straight")
        with self.assertRaisesRegex(taut.InputError, "interpolation"):
            taut.prove(self.case, [[1.0, 1.0]] * 2, interpolation="crooked")


class Audits(unittest.TestCase):
    case = taut.Case.load(ROBOT1)

    def test_of_tables(self):
        phi, theta = np.linspace(-114.9, 0, 20), np.linspace(72, 85, 20)
        of_mapping = taut.audit(self.case, {"phi[deg]": phi, "theta[deg]": theta})
        of_array = taut.audit(self.case, np.column_stack([phi, theta]), columns=["phi[deg]", "theta[deg]"])
        self.assertEqual(of_mapping.text, of_array.text)
        self.assertEqual(of_mapping.verdict, "refuted")
        stretch = of_mapping.stretches[0]
        self.assertLess(stretch.begin.position, stretch.end.position)
        self.assertEqual(stretch.violations[0].kind[:7], "tension")

    def test_of_radians_keep_the_bits(self):
        values = np.random.default_rng(1).uniform(-2, 2, (10, 2))
        audited = taut.audit(self.case, values, columns=["phi[rad]", "theta[rad]"])
        self.assertEqual(audited.path.waypoints.tobytes(), values.tobytes())

    def test_of_what_is_wrong_says_where(self):
        with self.assertRaisesRegex(taut.InputError, "arc:3: theta") as caught:
            taut.audit(self.case, {"phi[rad]": [0.1, 0.2], "theta[rad]": [0.1, np.inf]}, name="arc")
        self.assertEqual((caught.exception.line, caught.exception.field), (3, "theta"))
        with self.assertRaises(TypeError):
            taut.audit(self.case, np.ones((2, 2)))
        with self.assertRaises(taut.InputError):
            taut.audit(self.case, np.ones((2, 2)), columns=["phi[rad]"])
        with self.assertRaises(taut.InputError):
            taut.audit(self.case)  # which names no path


class MovesInTime(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = taut.Case(CRANE)
        cls.planned = taut.plan(cls.case)

    def test_have_a_law_and_a_duration(self):
        path = self.planned.path
        self.assertEqual(self.planned.verdict, "proved", self.planned.reason)
        self.assertEqual(path.timing.duration_s, self.planned.duration_s)
        self.assertGreater(self.planned.duration_s, 8 / 0.8 + 0.8 / 0.2)
        self.assertEqual(path.timing.controls[:3] @ [1, 4, 1], 0)
        self.assertTrue((np.diff(path.timing.controls) >= 0).all())
        self.assertLess(self.planned.move_plan.fastest_s, self.planned.duration_s)
        self.assertEqual((self.planned.move_plan.speed_share, self.planned.move_plan.witness), (1, None))
        loaded = pickle.loads(pickle.dumps(self.planned))
        self.assertEqual((loaded.duration_s, loaded.move_plan), (self.planned.duration_s, None))
        self.assertIn("0.8 m/s", self.case.time_statement)
        still = taut.Case.load(ROBOT1)
        self.assertEqual(still.time_statement, "")
        self.assertIsNone(taut.plan(still).duration_s)

    def test_are_proved_with_the_law_or_without(self):
        path = self.planned.path
        proved = taut.prove(self.case, path)
        self.assertTrue(proved.is_proved)
        self.assertEqual(proved.path.timing.controls.tobytes(), path.timing.controls.tobytes())
        same = taut.prove(self.case, path.waypoints, interpolation=path.interpolation, half_turns=path.half_turns,
                          timing=taut.TimeLaw(path.timing.step_s, list(path.timing.controls)))
        self.assertEqual(same.text, proved.text)
        slowly = taut.prove(self.case, path.waypoints, interpolation=path.interpolation, half_turns=path.half_turns)
        self.assertEqual((slowly.verdict, slowly.duration_s, slowly.path.timing), ("proved", None, None))
        with self.assertRaises(TypeError):
            taut.prove(self.case, path, timing=path.timing)
        with self.assertRaisesRegex(taut.InputError, "timing") as caught:
            taut.prove(self.case, dataclasses.replace(path, timing=taut.TimeLaw(0.0, path.timing.controls)))
        self.assertEqual(caught.exception.field, "timing")

    def test_between_poses_and_in_lengths(self):
        samples = taut.prove(self.case, self.planned.path.waypoints[[0, -1]]).samples()
        poses = np.hstack([samples.p_m, samples.quaternion])[[0, -1]]
        lengths = np.hstack([poses, samples.length_m[[0, -1]]])
        controls = np.array([0, 0, 0, *np.linspace(0, 1, 9)[1:-1], 1, 1, 1])
        for interpolation, rows in (("geodesic", poses), ("cable-lengths", lengths)):
            for seconds, verdict in ((120, "proved"), (12, "refuted")):
                with self.subTest(interpolation=interpolation, seconds=seconds):
                    law = taut.TimeLaw(seconds / (len(controls) - 3), controls)
                    said = taut.prove(self.case, rows, interpolation=interpolation, timing=law)
                    self.assertEqual((said.verdict, said.duration_s), (verdict, law.duration_s), said.reason)
            middle = np.vstack([rows[:1], (rows[:1] + rows[1:]) / 2, rows[1:]])
            if interpolation == "geodesic":
                middle[1, 3:] /= np.linalg.norm(middle[1, 3:])
            else:
                middle[1, 7:] = np.mean(rows[:, 7:], axis=0)  # a pose near it is all that is asked for
            slow_then_fast = [0, 0, 0, *np.linspace(0, 1, 61)[1:-1], 1, 1, 1, *np.linspace(1, 2, 7)[1:-1], 2, 2, 2]
            law = taut.TimeLaw(1.0, slow_then_fast)
            said = taut.prove(self.case, middle, interpolation=interpolation, timing=law)
            self.assertEqual((said.verdict, said.theorem.witness.at.index), ("refuted", 1), said.reason)

    def test_that_are_too_fast_are_refuted(self):
        path = self.planned.path
        fast = taut.TimeLaw(path.timing.step_s / 2, path.timing.controls)
        refuted = taut.prove(taut.Case({**CRANE, "time": {"load": {"speed": "0.8 m/s"}}}),
                             dataclasses.replace(path, timing=fast))
        witness = refuted.theorem.witness
        self.assertEqual((refuted.verdict, witness.kind, witness.cable, witness.limit),
                         ("refuted", "load_speed", None, 0.8))
        self.assertTrue(0.8 <= witness.value[0] <= witness.value[1] < 2)

    def test_have_tables_and_samples(self):
        winches, poses = self.planned.winches(50), self.planned.poses(50)
        n = len(winches.time_s)
        self.assertEqual([winches.length_m.shape, winches.speed_m_s.shape, winches.acceleration_m_s2.shape,
                          poses.p_m.shape, poses.quaternion.shape], [(n, 6)] * 3 + [(n, 3), (n, 4)])
        self.assertEqual((winches.time_s[0], winches.time_s[1], winches.time_s[-1]), (0, 0.02, self.planned.duration_s))
        slopes = np.diff(winches.length_m, axis=0)[:-1] / 0.02
        means = (winches.speed_m_s[:-2] + winches.speed_m_s[1:-1]) / 2
        self.assertTrue(np.allclose(slopes, means, atol=1e-4))
        self.assertEqual(poses.p_m[-1].tolist(), [4, 0, 6])
        rows = [line for line in self.planned.winches_csv(50).splitlines() if not line.startswith("#")]
        self.assertEqual([float(x) for x in rows[7].split(",")][13:19], winches.acceleration_m_s2[6].tolist())
        self.assertEqual([float(x) for x in rows[7].split(",")][25:], winches.greatest_tension_N[6].tolist())
        self.assertTrue((winches.least_tension_N < winches.greatest_tension_N).all())
        self.assertEqual(len(rows), n + 1)
        self.assertIn(self.planned.theorem.certificate_sha256, self.planned.poses_csv(50))
        self.assertIn("# t px py pz qx qy qz qw", self.planned.poses_tum())
        with self.assertRaisesRegex(taut.InputError, "rate_Hz"):
            self.planned.poses(0)
        with self.assertRaisesRegex(taut.InputError, "not for a machine"):
            taut.Certificate(self.planned.text).winches()
        samples = self.planned.samples(100)
        self.assertEqual((samples.time_s[0], samples.time_s[-1]), (0, self.planned.duration_s))
        self.assertEqual(samples.time_s.shape, samples.position.shape)

    def test_run_at_other_speeds(self):
        seen = set()
        slow = taut.plan(self.case, speed_share=0.5, progress=lambda stage, *_: seen.add(stage))
        self.assertTrue(slow.is_proved)
        self.assertAlmostEqual(slow.duration_s / self.planned.duration_s, 2, 3)
        self.assertLessEqual(seen, {"planning", "proving the move"})
        fast = taut.plan(self.case, greatest_speed=True)
        self.assertLessEqual(fast.duration_s, self.planned.duration_s)
        self.assertGreater(fast.move_plan.refuted_share, fast.move_plan.speed_share)
        self.assertIsInstance(fast.move_plan.witness, taut.Witness)
        with self.assertRaisesRegex(taut.InputError, "speed_share: got 2"):
            taut.plan(self.case, speed_share=2)
        with self.assertRaisesRegex(taut.InputError, "without the key 'time'"):
            taut.plan(taut.Case.load(ROBOT1), greatest_speed=True)

    def test_are_audited_within_the_rounding_of_a_table(self):
        poses = self.planned.poses(50)
        table = {"t[s]": poses.time_s, **{f"{name}[m]": poses.p_m[:, k] for k, name in enumerate(("px", "py", "pz"))},
                 **{name: poses.quaternion[:, k] for k, name in enumerate(("qx", "qy", "qz", "qw"))}}
        audited = taut.audit(self.case, table, timed=True, rounding=(1e-5, 1e-5))
        self.assertTrue(audited.is_proved, audited.reason)
        self.assertAlmostEqual(audited.duration_s, self.planned.duration_s, 9)
        self.assertEqual(audited.stretches, [])
        fast = taut.audit(taut.Case({**CRANE, "time": {"load": {"speed": "0.8 m/s"}}}),
                          {**table, "t[s]": poses.time_s / 2}, timed=True, rounding=(1e-5, 1e-5))
        self.assertEqual((fast.verdict, fast.theorem.witness.kind), ("refuted", "load_speed"))
        with self.assertRaisesRegex(taut.InputError, "rounding"):
            taut.audit(self.case, table, timed=True)
        with self.assertRaisesRegex(taut.InputError, "rounding: got it without timed"):
            taut.audit(self.case, table, rounding=(1e-5, 1e-5))
        with self.assertRaises(taut.InputError) as caught:
            taut.audit(self.case, table, timed=True, rounding=(1e-5, 0.0))
        self.assertEqual(caught.exception.field, "rounding.angle_rad")
        winches = self.planned.winches(50)
        lengths = {"t[s]": winches.time_s, **{f"l{i + 1}[m]": winches.length_m[:, i] for i in range(6)}}
        self.assertTrue(taut.audit(self.case, lengths, timed=True, rounding=2e-5).is_proved)
        with self.assertRaisesRegex(taut.InputError, "got cable lengths and a rounding of poses"):
            taut.audit(self.case, lengths, timed=True, rounding=(1e-5, 1e-5))
        # Rows that are rounded to 1 mm are not within 10 um of any smooth move.
        with self.assertRaises(taut.InputError):
            taut.audit(self.case, {**table, "px[m]": np.round(table["px[m]"], 3)}, timed=True, rounding=(1e-5, 1e-5))


class Legs(unittest.TestCase):
    def test_are_planned_and_proved_as_one_and_each(self):
        load = {**CRANE["load"], "items": [{"name": "platform", "mass": 8},
                                           {"name": "payload", "mass": 12, "at": [0, 0, -1], "legs": ["carry"]}]}
        case = taut.Case({**CRANE, "load": load, "query": {"legs": [
            {"name": "fetch", "waypoints": [{"px": 0, "pz": 6}, {"px": -4, "pz": 6}]},
            {"name": "carry", "waypoints": [{"px": -4, "pz": 6}, {"px": 4, "pz": 6}]}]}})
        self.assertEqual((list(case.legs), case.query_waypoints), (["fetch", "carry"], 0))
        self.assertEqual(case.legs["carry"].query_waypoints, 2)
        self.assertTrue(any(line.startswith("leg carry: ") for line in case.load_statement))
        whole = taut.plan(case, headroom_seconds=0)
        self.assertTrue(whole.is_proved, whole.reason)
        self.assertEqual((list(whole.legs), whole.case_name), (["fetch", "carry"], "crane"))
        self.assertEqual([leg.verdict for leg in whole.legs.values()], ["proved"] * 2)
        self.assertIsNone(whole.theorem.margins)
        self.assertGreater(whole.legs["carry"].theorem.margins.tension_N, 0)
        self.assertAlmostEqual(whole.duration_s, sum(leg.duration_s for leg in whole.legs.values()), 12)
        self.assertEqual(whole.poses(10).time_s[-1], whole.duration_s)
        self.assertEqual(taut.check(whole, case=case).outcome, "accepted")
        self.assertIn("All 2 legs are proved", taut.report(whole))
        loaded = pickle.loads(pickle.dumps(whole))
        self.assertEqual(({name: leg.verdict for name, leg in loaded.legs.items()}, loaded.theorem),
                         ({"fetch": "unchecked", "carry": "unchecked"}, None))
        with self.assertRaisesRegex(taut.InputError, "legs"):
            taut.audit(case, "path.csv")


class NoPath(unittest.TestCase):
    def test_is_proved_saved_loaded_checked_and_reported(self):
        case = taut.Case.load(os.path.join(CASES, "maps", "robot1-sigma34-apart.yaml"))
        planned = taut.plan(case)
        self.assertEqual((planned.verdict, planned.theorem.verdict, planned.no_path_from), ("no path", "no path", 0))
        self.assertIn("No path exists", planned.theorem.claim)
        self.assertEqual((planned.segments, len(planned.path.waypoints), planned.headroom), (0, 0, None))
        self.assertGreater(planned.boxes, 100)
        self.assertEqual(planned.samples().p_m.shape, (0, 3))
        with self.assertRaisesRegex(taut.InputError, "no path exists"):
            planned.path_csv
        loaded = pickle.loads(pickle.dumps(planned))
        self.assertEqual((loaded.verdict, loaded.no_path_from, loaded.text), ("unchecked", 0, planned.text))
        self.assertEqual(taut.check(loaded, case).theorem.verdict, "no path")
        self.assertIn("NO PATH EXISTS", taut.report(loaded, format="text"))

    def test_need_not_be_tried(self):
        case = taut.Case.load(os.path.join(CASES, "maps", "robot1-sigma34-apart.yaml"))
        planned = taut.plan(case, no_path_seconds=0)
        self.assertEqual((planned.verdict, planned.no_path_from), ("undecided", None))


class Sensitivities(unittest.TestCase):
    def test_are_those_of_the_command(self):
        for case, arguments, path in ((ROBOT1, [], None), (BRIDGING, [], None),
                                      (ROBOT1, ["--audit", os.path.join(CASES, "audits", "robot1-planned.csv")],
                                       os.path.join(CASES, "audits", "robot1-planned.csv"))):
            said = json.loads(subprocess.run([TAUT, "sensitivity", case, *arguments, "--json"], capture_output=True,
                                             check=True, timeout=300).stdout)
            for key in ("command", "elapsed_seconds", "exit_code", "files"):
                del said[key]
            self.assertEqual(taut.sensitivity(taut.Case.load(case), path), said)

    def test_of_what_is_wrong_says_where(self):
        with self.assertRaisesRegex(taut.InputError, "budget_seconds: got -1"):
            taut.sensitivity(taut.Case.load(ROBOT1), budget_seconds=-1)
        with self.assertRaisesRegex(taut.InputError, "nowhere.csv"):
            taut.sensitivity(taut.Case.load(ROBOT1), "nowhere.csv")

    def test_shares_are_sought_as_long_as_is_asked(self):
        case = taut.Case.load(os.path.join(CASES, "tutorial", "04-tolerances.yaml"))
        self.assertEqual(taut.plan(case).headroom["shares"][0]["of"], "all")
        self.assertIsNone(taut.plan(case, headroom_seconds=0).headroom)
        self.assertIsNone(taut.audit(taut.Case.load(BRIDGING), headroom_seconds=0).headroom)


class Documents(unittest.TestCase):
    def test_what_the_documents_show_runs(self):
        for document, count in ((os.path.join("docs", "library.md"), 1), ("README.md", 1)):
            with open(os.path.join(SOURCE, document), encoding="utf-8") as file:
                blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.M | re.S)
            self.assertEqual(len(blocks), count)
            for block in blocks:
                with tempfile.TemporaryDirectory() as folder:
                    shutil.copy(ROBOT1, os.path.join(folder, "crane.yaml"))
                    here = os.getcwd()
                    os.chdir(folder)
                    try:
                        exec(block, self.names_of_the_reader())  # pylint: disable=exec-used
                    finally:
                        os.chdir(here)

    def names_of_the_reader(self):
        """What the reader of a document has already."""
        return {"taut": taut, "waypoints": [[0.1, 0.2], [0.2, 0.3]],
                "phi": np.linspace(0, 10, 5), "theta": np.linspace(5, 20, 5)}


class Running(unittest.TestCase):
    def test_progress_comes_and_may_raise(self):
        values = np.repeat([[-2.3, 1.6], [-2.29, 1.61]], 2000, axis=0)[::1] + np.linspace(0, 1e-3, 4000)[:, np.newaxis]
        seen = []
        case = taut.Case.load(ROBOT1)
        taut.audit(case, values, columns=["phi[rad]", "theta[rad]"],
                   progress=lambda *at: seen.append((threading.get_ident(), *at)))
        self.assertTrue(seen)
        for thread, stage, done, total in seen:
            self.assertEqual((thread, stage, total), (threading.get_ident(), "auditing", 3999))
            self.assertLessEqual(done, total)

        def fail(*_):
            raise KeyError("mine")
        with self.assertRaises(KeyError):
            taut.audit(case, values, columns=["phi[rad]", "theta[rad]"], progress=fail)

    def test_the_interpreter_is_released(self):
        case = taut.Case(long_case())
        counted = 0
        finished = threading.Event()

        def count():
            nonlocal counted
            while not finished.is_set():
                counted += 1
                time.sleep(0.001)
        thread = threading.Thread(target=count)
        thread.start()
        taut.plan(case, budget_seconds=1)
        finished.set()
        thread.join()
        self.assertGreater(counted, 100)

    def test_threads(self):
        case = taut.Case.load(ROBOT1)
        reference = taut.plan(case).text
        texts = []
        threads = [threading.Thread(target=lambda: texts.append(taut.plan(case).text)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(texts, [reference] * 4)

    def test_interruption(self):
        script = ("import sys, taut\n"
                  "case = taut.Case(sys.argv[1])\n"
                  "print('ready', flush=True)\n"
                  "try:\n"
                  "    taut.plan(case, budget_seconds=100)\n"
                  "except KeyboardInterrupt:\n"
                  "    print('interrupted', flush=True)\n")
        with subprocess.Popen([sys.executable, "-c", script, long_case()],
                              stdout=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "ready\n")
            time.sleep(0.5)
            begin = time.monotonic()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.stdout.read(), "interrupted\n")
            self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(process.returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

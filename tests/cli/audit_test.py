#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut audit` through the command line: what is read, what is proved, what is listed, and with which exit code.

Usage: audit_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import glob
import hashlib
import json
import math
import os
import re
import subprocess

from command_line import (AUDITS, CASES, CHECK, EXIT, ROBOT1, SOURCE, TAUT, Audits, expected, interrupt, main, run,
                          text_of)


def fraction(text):
    numerator, _, denominator = text.partition("/")
    return int(numerator) / int(denominator or 1)


def position(place):
    return place["segment"] + fraction(place["s"])


MACHINE = """taut: 1
name: constrained
units: {length: mm}
robot:
  base_anchors: [[0,300,0], [0,300,0], [-259.8076,-150,0], [-259.8076,-150,0], [259.8076,-150,0], [259.8076,-150,0]]
  platform_anchors: [[-129.9038,75,0], [129.9038,75,0], [0,-150,0], [-129.9038,75,0], [129.9038,75,0], [0,-150,0]]
  tension: %s
  length: [200, 600]
load:
  mass: 0.6
  gravity: [0, 0, 9.81]
  ellipsoid: {diagonal: [1e4, 1e4, 1e4, 1e4, 1e4, 1e4]}
space: %s
"""
COLUMNS = "px[mm],py[mm],pz[mm],phi[rad],theta[rad],sigma[rad]\n"


def digest(value):
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def sealed(certificate):
    """With the digests of what it says."""
    certificate["path_sha256"] = digest(certificate["path"])
    footer = certificate.pop("footer")
    footer["sha256"] = digest(certificate)
    return json.dumps({**certificate, "footer": footer})


class Audit(Audits):
    def refused(self, text, *expected, name="path.csv", options=()):
        result = run(TAUT, "audit", ROBOT1, self.write(name, text), "--out", self.path("refused"), *options)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        for message in expected:
            self.assertIn(message, result.stderr)
        self.assertFalse(os.path.exists(self.path("refused", "certificate.json")))

    def cover(self, certificate, segments):
        """Proved boxes and outer intervals are the whole path, and don't overlap."""
        pieces = [(segment["from"] + fraction(a), segment["from"] + fraction(b))
                  for segment in certificate["segments"] for a, b in (box["s"] for box in segment["boxes"])]
        pieces += [tuple(position(place) for place in stretch["outer"]) for stretch in certificate["stretches"] or []]
        pieces.sort()
        self.assertEqual(pieces[0][0], 0)
        self.assertEqual(pieces[-1][1], segments)
        for before, behind in zip(pieces, pieces[1:]):
            self.assertEqual(before[1], behind[0])

    def test_every_case_ends_as_it_declares_and_its_certificate_is_accepted(self):
        laws = set()
        for case in sorted(glob.glob(os.path.join(CASES, "**", "*.yaml"), recursive=True)):
            name = os.path.relpath(case, CASES).replace(os.sep, "-")
            if not re.search("^audit:", text_of(case), re.M):
                continue  # planned: end_to_end_test.py
            if re.search("^ +timed: true", text_of(case), re.M):
                continue  # moves: timed_audit_test.py
            if "TAUT_SAMPLED" in os.environ and "\ntolerances:" in text_of(case):
                continue  # how far each can grow takes minutes
            with self.subTest(case=name):
                path = re.search(r"^audit: \{path: (.*)\}$", text_of(case), re.M).group(1)
                summary = self.audit(case, os.path.join(os.path.dirname(case), path), out=name)
                self.assertEqual(summary["verdict"], expected(case))
                laws.add((summary["verdict"], summary["interpolation"]))
                self.cover(self.certificate(name), summary["segments"])
                self.assertGreater(os.path.getsize(self.path(name, "report.html")), 10000)
                checked = run(CHECK, self.path(name, "certificate.json"), case)
                self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        for law in ["straight-in-parameters", "cubic-b-spline", "geodesic", "straight-in-cable-lengths"]:
            self.assertIn(("proved", law), laws)

    def test_the_bridge_is_between_two_samples_that_are_fine(self):
        case, path = (os.path.join(AUDITS, "robot1-bridging" + end) for end in (".yaml", ".csv"))
        summary = self.audit(case, path)
        self.assertEqual(summary["stretches_violated"], 1)
        stretch = summary["stretches"][0]
        begin, end = (position(place) for place in stretch["outer"])
        self.assertTrue(2 < begin < end < 3, "no sample is in it")
        self.assertEqual(stretch["outer"][0]["lines"], [5, 6])

    def test_the_gravest_violation_is_the_witness(self):
        case, path = (os.path.join(AUDITS, "robot1-bridging" + end) for end in (".yaml", ".csv"))
        summary = self.audit(case, path)
        witness = summary["witness"]
        self.assertEqual(witness["kind"], "singular", "tensions are violated at both ends of the stretch, but slightly")
        first, last = position(witness["at"]), position(witness["to"])
        begin, end = (position(place) for place in summary["stretches"][0]["outer"])
        self.assertTrue(begin <= first < last <= end)
        self.assertLess(last - first, 1e-4)
        self.assertEqual(self.certificate()["witness"], witness)
        self.assertEqual(self.certificate()["illustration"]["lines"], {"runs": [[0, 3]], "waypoints": 6})
        said = run(TAUT, "audit", case, path, "--out", self.out).stdout
        self.assertRegex(said, r"\nGravest: segment 2 at s = \S+ \(lines 5-6\): the platform passes a singular pose")

    def test_the_gravest_limit_is_the_witness_where_no_pose_is_singular(self):
        rows = "phi[deg],theta[deg]\n-131.8,91.7\n-151.8,91.7\n-131.8,91.7\n"
        summary = self.audit(ROBOT1, self.write("path.csv", rows))
        self.assertEqual(summary["verdict"], "refuted")
        witness = summary["witness"]
        inner = [end["witness"] for stretch in summary["stretches"] for end in stretch["inner"] or []]

        def severity(w):
            width = 0.45  # 0.05 to 0.5 N, 0.1 to 0.55 m
            low, high = map(float, w["value"])
            return (low - float(w["limit"]) if w["kind"].endswith("max") else float(w["limit"]) - high) / width

        self.assertGreater(severity(witness), 0.2)
        self.assertLess(min(map(severity, inner)), 0.01)
        self.assertGreaterEqual(severity(witness), max(map(severity, inner)))
        self.assertEqual(run(CHECK, self.path("out", "certificate.json"), ROBOT1).returncode, 0)

    def test_path_csv_reads_back_bit_for_bit(self):
        rows = ["t[ms],phi[deg],theta[deg]"] + [f"{10 * k},{-131.7 + k / 7},{91.7 + k / 9}" for k in range(8)]
        first = self.audit(ROBOT1, self.write("path.csv", "\n".join(rows)))
        again = self.audit(ROBOT1, self.path("out", "path.csv"), out="again")
        *rows, last = text_of(self.path("out", "path.csv")).splitlines()
        self.assertEqual(text_of(self.path("again", "path.csv")).splitlines()[:-1], rows)
        with open(self.path("out", "certificate.json"), "rb") as file:
            self.assertEqual(last, "# certificate.json SHA-256: " + hashlib.sha256(file.read()).hexdigest())
        for key in ["path_sha256", "segments", "stretches", "margins", "witness"]:
            self.assertEqual(self.certificate()[key], self.certificate("again")[key])
        self.assertEqual(self.certificate()["path"]["times"][1], "0.01")
        from_certificate = self.audit(ROBOT1, self.path("out", "certificate.json"), out="third")
        self.assertEqual(self.certificate()["path"], self.certificate("third")["path"])
        self.assertEqual(from_certificate["verdict"], first["verdict"])

    def test_a_planned_path_is_proved_again(self):
        for case in [ROBOT1, os.path.join(SOURCE, "cases", "tutorial", "03-a-smooth-move.yaml")]:
            self.assertEqual(run(TAUT, "plan", case, "--out", self.path("plan")).returncode, 0)
            for name in ["path.csv", "certificate.json"]:
                self.assertEqual(self.audit(case, self.path("plan", name))["verdict"], "proved")
                self.assertEqual(self.certificate()["path"], self.certificate("plan")["path"])

    def test_other_laws_convert_the_waypoints_and_say_so(self):
        text = "phi[deg],theta[deg]\n-88.9,80.2\n-88,80.4\n-87.5,80.4\n"
        path = self.write("path.csv", text)
        said = run(TAUT, "audit", ROBOT1, path, "--out", self.out, "--interpolation", "geodesic")
        self.assertIn("Interpolation geodesic: between two waypoints", said.stdout)
        self.assertIn("converted to this form in floating point", said.stdout)
        for law in ["geodesic", "cable-lengths"]:
            summary = self.audit(ROBOT1, path, "--interpolation", law, out=law)
            self.assertEqual(summary["verdict"], "proved", law)
            again = self.audit(ROBOT1, self.path(law, "path.csv"), out="again")
            self.assertEqual(again["verdict"], "proved", law)
        back = self.audit(ROBOT1, self.path("geodesic", "path.csv"), "--interpolation", "straight", out="back")
        self.assertEqual(back["verdict"], "proved")
        angles = [[float.fromhex(x) for x in w["x"][3:5]] for w in self.certificate("back")["path"]["waypoints"]]
        for (phi, theta), row in zip(angles, text.splitlines()[1:]):
            typed = [math.radians(float(cell)) for cell in row.split(",")]
            self.assertAlmostEqual(phi, typed[0], places=13)
            self.assertAlmostEqual(theta, typed[1], places=13)

    def test_a_long_step_of_cable_lengths_is_proved_along_inner_poses(self):
        # Between the two rows the platform turns by 40 degrees, and bends far from any straight line.
        table = """px[mm],py[mm],pz[mm],qx,qy,qz,qw,l1[mm],l2[mm],l3[mm],l4[mm],l5[mm],l6[mm]
0,0,350,0.371820859,-0.613472909,0.203697328,0.666263940,308.4463,515.9140,427.9979,333.5792,539.3413,333.3060
,,,,,,,414.1204,483.4030,382.5360,352.7146,504.7667,294.1618
"""
        summary = self.audit(os.path.join(AUDITS, "robot1-cable-lengths.yaml"), self.write("long.csv", table))
        self.assertEqual(summary["verdict"], "proved")
        certificate = self.certificate()
        inner = certificate["path"]["pose_tubes"][0]["inner"]
        self.assertGreater(len(inner), 2)
        places = [fraction(pose["s"]) for pose in inner]
        self.assertEqual(places, sorted(places))
        self.assertEqual(run(CHECK, self.path("out", "certificate.json")).returncode, 0)
        # Audited again from its certificate it has the same path.
        again = self.audit(os.path.join(AUDITS, "robot1-cable-lengths.yaml"), self.path("out", "certificate.json"),
                           out="again")
        self.assertEqual(again["verdict"], "proved")
        self.assertEqual(self.certificate("again")["path"], certificate["path"])

    def test_where_poses_are_implied_it_is_said_which_of_them_is_meant(self):
        case = text_of(os.path.join(AUDITS, "robot1-cable-lengths.yaml")).replace("tension: [0.05, 0.5]",
                                                                                  "tension: [0.05, 0.39]")
        path = os.path.join(AUDITS, "robot1-cable-lengths.csv")
        done = run(TAUT, "audit", self.write("case.yaml", case), path, "--out", self.path("out"), "--headroom", "0")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        said = " ".join(done.stdout.split())
        scope = ("this is about the only pose in each tube that the certificate states; outside of these stretches, "
                 "limits are proved to be kept at those poses. It is proved that the move passes these poses up to the "
                 "certificate's own witness")
        self.assertIn("2 stretches of the path have proved violations. As poses are implied here, " + scope, said)
        self.assertIn("Proved of the move: segment 1 at s = ", said)
        self.assertNotIn("all the rest is proved", said)
        checked = run(CHECK, self.path("out", "certificate.json"), self.path("case.yaml"))
        self.assertIn("no violation outside of them at the poses in the stated tubes, which the motion is shown to "
                      "pass up to the witness", checked.stdout)
        self.assertNotIn("nothing outside of them", checked.stdout)
        page = text_of(self.path("out", "report.html"))
        self.assertIn(scope.replace("'", "&#39;"), page)
        self.assertNotIn("the path is proved", page)
        self.assertIn("sampled at poses found next to the reference; shaded", page)
        self.assertIn("proved of the pose in its tube, not that the move leads there", page)
        certificate = self.certificate()
        own, other = certificate["witness"], certificate["stretches"][1]["inner"][1]
        self.assertGreater(float(other["value"][0]), float(own["value"][0]), "graver, but the move may not get there")
        text = run(TAUT, "report", self.path("out", "certificate.json"), "--text").stdout
        self.assertRegex(text, rf"Where: [^.]*\.?[^.]* into the move \(segment {own['at']['segment']},")

    def test_one_pose_is_a_platform_that_stays(self):
        summary = self.audit(ROBOT1, self.write("path.csv", "phi[deg],theta[deg]\n-88.9,80.2\n"))
        self.assertEqual((summary["verdict"], summary["segments"]), ("proved", 1))
        slack = self.audit(ROBOT1, self.write("path.csv", "phi[deg],theta[deg]\n0,91.7\n"))
        self.assertEqual(slack["verdict"], "refuted")

    def test_a_path_may_come_through_a_pipe(self):
        path = os.path.join(AUDITS, "robot1-bridging.csv")
        result = run(TAUT, "audit", ROBOT1, "/dev/stdin", "--out", self.path("piped"), input=text_of(path))
        self.assertEqual(result.returncode, EXIT["refuted"], result.stderr)
        self.audit(ROBOT1, path, out="read")
        self.assertEqual(self.certificate("piped")["path_sha256"], self.certificate("read")["path_sha256"])

    def test_one_pose_takes_no_time(self):
        for name, text in [("row.csv", "t[s],phi[deg],theta[deg]\n1,-88.9,80.2\n"),
                           ("row.tum", "0 0 0 0.35 0 0 0 1\n"),
                           ("repeated.csv", "t[s],phi[deg],theta[deg]\n1,-88.9,80.2\n2,-88.9,80.2\n")]:
            self.assertEqual(self.audit(ROBOT1, self.write(name, text))["segments"], 1, name)
            times = ["1", "2"] if name.startswith("repeated") else None
            self.assertEqual(self.certificate()["path"]["times"], times)
            self.assertIn(run(CHECK, self.path("out", "certificate.json")).returncode, (0, 2))

    def test_what_is_read_is_not_overwritten(self):
        text = "phi[deg],theta[deg]\n-88.9,80.2\n-88,80.2\n"
        for folder in (".", "link"):
            os.symlink(self.out, self.path("link")) if folder == "link" else None
            path = self.write("path.csv", text)
            result = run(TAUT, "audit", ROBOT1, path, "--out", self.path(folder))
            self.assertEqual(result.returncode, 3, result.stdout)
            self.assertIn("path.csv: got the file that is read, expected another to be written", result.stderr)
            self.assertEqual(text_of(path), text)
            self.assertFalse(os.path.exists(self.path("certificate.json")))

        os.unlink(self.path("link"))
        case = self.write("report.html", text_of(ROBOT1))
        os.rename(self.path("path.csv"), self.path("other.csv"))
        for command in (("audit", case, self.path("other.csv")), ("plan", case)):
            self.assertEqual(run(TAUT, *command, "--out", self.out).returncode, 3)
            self.assertEqual(sorted(os.listdir(self.out)), ["other.csv", "report.html"])
        self.assertEqual(text_of(case), text_of(ROBOT1))
        key = self.path("key.pem")
        subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", key], check=True)
        before = text_of(key)
        said = run(TAUT, "plan", ROBOT1, "--out", self.path("out"), "--sign", key, "--save-atlas", key)
        self.assertEqual((said.returncode, text_of(key)), (3, before))

    def test_bad_paths_are_refused_with_their_place(self):
        self.refused("phi[deg],theta[deg]\n1,2\n3,nan\n", "path.csv:3: theta: got 'nan', expected a decimal number")
        self.refused("phi[deg],theta\n1,2\n", "path.csv:1: theta: got no unit")
        self.refused("", "got no rows")
        self.refused("{}", "certificate.json: footer.sha256", name="certificate.json")
        self.refused("phi[deg],theta[deg]\n1,2\n", "wobbly not in", options=["--interpolation", "wobbly"])
        self.refused("l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n1,1,1,1,1,1\n", "expected the law cable-lengths",
                     options=["--interpolation", "straight"])
        missing = run(TAUT, "audit", ROBOT1, self.path("nowhere.csv"), "--out", self.path("refused"))
        self.assertEqual(missing.returncode, 3)
        self.assertIn("nowhere.csv", missing.stderr)
        self.assertFalse(os.path.exists(self.path("refused")))

    def test_waypoints_are_on_the_constraints(self):
        # What is proved is the motion on them: it must not be of other poses than those of the file.
        case = self.write("case.yaml", MACHINE % ("[0.01, 60]", '{implicit: ["pz - 272"]}'))
        rows = "0,-2,{z},0,0.1,0\n0,40,{z},0,0.1,0\n"
        path = self.write("path.csv", COLUMNS + rows.format(z=276))
        refused = run(TAUT, "audit", case, path, "--out", self.path("refused"))
        self.assertEqual(refused.returncode, 3, refused.stdout)
        self.assertIn("path.csv, line 2: got a pose off the constraints, by 0.0267 of the platform's size",
                      refused.stderr)
        near = self.audit(case, self.write("near.csv", COLUMNS + rows.format(z="272.5")))
        self.assertEqual(near["verdict"], "proved")
        # A certificate chooses its normals. These lead aside.
        certificate = self.certificate()
        for waypoint in certificate["path"]["waypoints"]:
            waypoint["normals"][:3] = ["0x1p+3", "0x0p+0", "0x1p+0"]
        certificate["path"]["tubes"] = ["0x1p-6"]
        for segment in certificate["segments"]:
            for margin, value in (("tension_N", "1e-9"), ("length_m", "1e-9"), ("wrench_scale", "1")):
                segment["margins"][margin] = certificate["margins"][margin] = value
        forged = self.write("forged.json", sealed(certificate))
        checked = run(CHECK, forged)
        self.assertEqual(checked.returncode, 1, checked.stdout + checked.stderr)
        self.assertIn("the pose on the constraints may not be next to what the path states at a waypoint",
                      checked.stdout)
        self.assertEqual(run(TAUT, "audit", case, forged, "--out", self.path("forged")).returncode, 3)

    def test_witnesses_are_where_parameters_are_in_their_ranges(self):
        # The straight line stays in the range of px, the motion on the cylinder does not, and is violated inside and
        # outside.
        case = self.write("case.yaml", MACHINE % (
            "[[0.01, 1.59]" + ", [0.01, 60]" * 5 + "]",
            '{free: {px: [-100, 59], py: [-300, 300], pz: [50, 600]}, implicit: ["px^2 + py^2 - 60^2"]}'))
        rows = "58,-15.362291495737216,272,0,0.1,0\n58,15.362291495737216,272,0,0.1,0\n"
        summary = self.audit(case, self.write("path.csv", COLUMNS + rows))
        self.assertEqual(summary["verdict"], "refuted")
        checked = run(CHECK, self.path("out", "certificate.json"), case)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_numbers_of_a_certificate_are_taken_as_they_stand_or_not_at_all(self):
        path = self.write("path.csv", COLUMNS + "0,0,350,-2.3,1.6,0\n0,1,350,-2.3,1.6,0\n")
        self.audit(ROBOT1, path)
        turns = "path.waypoints[1].half_turns[3]: got {}, expected a whole number from -1000000 to 1000000"
        number = 'path.waypoints[1].x[3]: got {}, expected a finite binary64 as %a prints it, such as "0x1.8p+1"'
        for key, value, said in [("half_turns", 2**32, turns.format(2**32)),
                                 ("half_turns", 2**64 - 1, turns.format(2**64 - 1)),
                                 ("half_turns", 0.5, "got a number that is no integer, expected a certificate"),
                                 ("half_turns", True, turns.format("true")),
                                 ("x", "0.1", number.format('"0.1"')),
                                 ("x", "0X1P+0", number.format('"0X1P+0"')),
                                 ("x", "0x1p+0\0", number.format('"0x1p+0\\u0000"')),
                                 ("x", None, "path.waypoints[1].x[3]: got null, expected a string")]:
            with self.subTest(key=key, value=value):
                certificate = self.certificate()
                certificate["path"]["waypoints"][1][key][3] = value
                self.refused(sealed(certificate), said, name="certificate.json")
        certificate = self.certificate()
        certificate["path"]["waypoints"][1]["half_turns"][0] = 1
        self.refused(sealed(certificate), "path.waypoints[1].half_turns: got 1 of 'px'", name="certificate.json")
        for times, said in ((["1", "0"], 'path.times[1]: got "0", expected a time later than the one before'),
                            (["1", "x"], 'path.times[1]: got "x", expected a decimal number in a string'),
                            (["1", "1e400"], 'path.times[1]: got "1e400", expected a decimal number in a string'),
                            (["1"], 'path.times: got ["1"], expected a list of 2')):
            certificate = self.certificate()
            certificate["path"]["times"] = times
            self.refused(sealed(certificate), said, name="certificate.json")
        self.audit(ROBOT1, path, "--interpolation", "geodesic")
        certificate = self.certificate()
        quaternion = certificate["path"]["waypoints"][1]["quaternion"]
        quaternion[:] = [(float.fromhex(x) * 1.008).hex().replace("0x0.0p+0", "0x0p+0") for x in quaternion]
        self.refused(sealed(certificate), "of length 1.008, expected 1 within 0.001", name="certificate.json")

    def test_cable_lengths_are_above_0(self):
        table = text_of(os.path.join(AUDITS, "robot1-cable-lengths.csv"))
        first = table.splitlines()[2].split(",")[8]
        for seen, line in ((first, 3), ("427.4781", 4)):
            for wrong in ("0", "-5", "-0.0"):
                with self.subTest(line=line, wrong=wrong):
                    self.refused(table.replace(f",{seen},", f",{wrong},"),
                                 f"path.csv:{line}: l1: got '{wrong}', expected a cable length above 0 [E4]")
        # Poses that are converted to lengths: at this one an anchor of the platform meets one of the base.
        anchors = ["[0, 300, 0]", "[0, 300, 0]", "[0, -150, 0]", "[-259.8076, -150, 0]",
                   "[259.8076, -150, 0]", "[259.8076, -150, 0]"]
        machine = MACHINE % ("[0.01, 60]", "{}")
        machine = re.sub(r"base_anchors: .*", f"base_anchors: [{', '.join(anchors)}]", machine)
        machine = machine.replace("space: {}\n", "")
        case = self.write("case.yaml", machine)
        path = self.write("met.csv", COLUMNS + "0,0,272,0,0,0\n0,0,0,0,0,0\n")
        said = run(TAUT, "audit", case, path, "--interpolation", "cable-lengths", "--out", self.path("refused"))
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertIn("met.csv:3: got a pose in which cable", said.stderr)

    def test_reserves_are_those_of_the_plan(self):
        planned = json.loads(run(TAUT, "plan", ROBOT1, "--out", self.path("plan"), "--json").stdout)
        audited = self.audit(ROBOT1, self.path("plan", "path.csv"))
        self.assertEqual(audited["margins"], planned["margins"])

    def test_a_robot_that_is_singular_everywhere_is_given_up_soon(self):
        case = text_of(ROBOT1)
        anchors = re.search(r"^  platform_anchors:.*?(?=^  \w)", case, re.M | re.S).group(0)
        line = ", ".join(f"[{10 * k}, 0, 0]" for k in range(6))
        path = self.write("path.csv", COLUMNS + "0,0,350,-2.3,1.6,0\n0,1,350,-2.2,1.6,0\n")
        case = self.write("case.yaml", case.replace(anchors, f"  platform_anchors: [{line}]\n"))
        summary = self.audit(case, path)
        self.assertEqual(summary["verdict"], "undecided")
        self.assertLess(summary["boxes_judged"], 20000)

    def test_absurd_distances_are_refuted_like_others(self):
        path = self.write("path.csv", "px[mm],py[mm],pz[mm],phi[rad],theta[rad],sigma[rad]\n"
                          "0,0,350,0,0,0.59\n1e160,0,350,0,0,0.59\n")
        said = run(TAUT, "audit", ROBOT1, path, "--out", self.path("out"))
        self.assertEqual(said.returncode, 1, said.stderr)
        self.assertIn("the origin's way is 1e+157 m long", said.stdout)
        self.assertIn("Checked by taut-check", said.stdout)
        self.assertIn("accepted", said.stdout)
        self.assertTrue(os.path.exists(self.path("out", "report.html")))

    def test_rows_that_repeat_are_a_rest(self):
        path = self.write("path.csv", "phi[deg],theta[deg]\n-88.9,80.2\n-88.9,80.2\n-88,80.2\n")
        summary = self.audit(ROBOT1, path)
        self.assertEqual(summary["segments"], 2)
        self.assertIn("1 row repeats the row before: the platform rests there\n", summary["read"])

    def test_an_interrupted_audit_leaves_nothing(self):
        def rows():
            yield "phi[deg],theta[deg]"
            for k in range(900000):
                yield f"{-88.9 + 0.3 * math.sin(k / 100)},{80.2 + 0.3 * math.cos(k / 100)}"
        path = self.write("path.csv", "\n".join(rows()))
        process = subprocess.Popen([TAUT, "audit", ROBOT1, path, "--out", self.path("out")], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        interrupt(process, 0.3)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2)
        self.assertIn("interrupted: nothing was written", said)
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_a_certificate_is_signed_where_asked(self):
        key = self.path("key.pem")
        self.assertEqual(run("openssl", "genpkey", "-algorithm", "ed25519", "-out", key).returncode, 0)
        run("openssl", "pkey", "-in", key, "-pubout", "-out", self.path("key.pub"))
        self.audit(ROBOT1, self.write("path.csv", "phi[deg],theta[deg]\n-88.9,80.2\n-88,80.2\n"), "--sign", key)
        checked = run(CHECK, self.path("out", "certificate.json"), "--trust", self.path("key.pub"))
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)


if __name__ == "__main__":
    main()

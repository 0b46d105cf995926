#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut-check` says what it compared a certificate with: case, path file, verdict, key; and refuses empty arguments.

Usage: compare_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import hashlib
import json
import os
import shutil
import subprocess
import sys
import threading

from command_line import AUDITS, CASES, CHECK, InFolder, ROBOT1, SOURCE, TAUT, main, run, text_of

sys.path.insert(0, os.path.join(SOURCE, "tests", "certificates"))
from sealing import hex64, seal  # noqa: E402

ROWS = ["phi[deg],theta[deg]", "-88.9,80.2", "-88,80.4", "-87.5,80.4", "-87,80.1"]


def sealed(certificate):
    """With the digest of what it says."""
    footer = certificate.pop("footer")
    body = json.dumps(certificate, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    footer["sha256"] = hashlib.sha256(body.encode()).hexdigest()
    return json.dumps({**certificate, "footer": footer}, sort_keys=True)


class Compare(InFolder):
    def check(self, *options, code, case=ROBOT1, certificate="certificate.json"):
        said = run(CHECK, self.path(certificate), *([case] if case else []), *options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout + said.stderr

    def audit(self, *options, rows=tuple(ROWS), case=ROBOT1):
        path = self.write("asked.csv", "\n".join(rows))
        audited = run(TAUT, "audit", case, path, "--out", self.out, *options)
        self.assertEqual(audited.returncode, 0, audited.stdout + audited.stderr)
        return path

    def test_an_audit_is_compared_with_its_path_file(self):
        path = self.audit()
        self.assertIn("; path file not compared;", self.check(code=0))
        self.assertIn("; case not compared; path file not compared;", self.check(code=0, case=None))
        for file in (path, self.path("path.csv")):
            said = self.check("--path", file, code=0)
            self.assertNotIn("path file not compared", said)
            self.assertIn("not compared: the case's query;", said)
        self.assertEqual(json.loads(self.check("--path", path, "--json", code=0))["not_compared"], ["the case's query"])

    def test_without_a_case_it_says_what_the_load_is(self):
        self.audit()
        self.assertTrue(self.check(code=0, case=None).endswith(
            "\nload: an ellipsoid around (0, 0, 1) N and (0, 0, 0) N m about (0.03, 0.014, -0.021) m\n"))
        self.assertNotIn("load: ", self.check(code=0))
        self.assertNotIn("load: ", self.check("--json", code=0, case=None))
        crane = os.path.join(SOURCE, "cases", "cranes", "portal-20t.yaml")
        path = self.write("crane.csv", "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]\n"
                                       "-0.2,0,6,0,0,-0.3\n0.2,0,6,0,0,0.3")
        audited = run(TAUT, "audit", crane, path, "--out", self.out)
        self.assertEqual(audited.returncode, 0, audited.stdout + audited.stderr)
        self.assertTrue(self.check(code=0, case=None).endswith(
            '\nload: "platform" 8000 kg at (0, 0, 0) m; "payload" 11760 to 12240 kg at (0, 0, -1.2) m within 0.05 m; '
            '"wind" up to 6000 N at right angles to (0, 0, -9.81) at (0, 0, -1) m; under (0, 0, -9.81) m/s^2. '
            'Names are not checked\n'))

    def test_another_path_is_rejected(self):
        self.audit()
        other = ROWS[:2] + ["-88.00000000000003,80.4"] + ROWS[3:]
        reversed_rows = ROWS[:1] + ROWS[:0:-1]
        for rows, said in ((other, "waypoint 1 differs from line 3"), (reversed_rows, "waypoint 0 differs from line 2"),
                           (ROWS[:-1], "the certificate has 4 waypoints, the file has 3"),
                           (ROWS + ["-86,80"], "the certificate has 4 waypoints, the file has 5"),
                           (["# a remark"] + ROWS, "the file that was audited has another SHA-256")):
            message = self.check("--path", self.write("other.csv", "\n".join(rows)), code=1)
            self.assertTrue(message.startswith("rejected: the path is not that of "), message)
            self.assertIn(said, message)

    def alter(self, change):
        certificate = json.loads(text_of(self.path("certificate.json")))
        change(certificate)
        seal(certificate)
        self.write("certificate.json", json.dumps(certificate, sort_keys=True))

    def test_the_same_numbers_as_other_angles_are_another_path(self):
        """Of a table of tilt and torsion: a right proof of what the same numbers mean as roll, pitch and yaw."""
        rows = ["0,0,350,0.6,0.9,0.6", "0,0,350,0.62,0.9,0.6"]
        slice = "  slice: {px: 0, py: 0, pz: 350, sigma: 34 deg}"
        turned = "  angles: roll-pitch-yaw\n  slice: {px: 0, py: 0, pz: 350, yaw: 0}"
        turned = text_of(ROBOT1).split("\nquery:")[0].replace(slice, turned)
        turned = self.write("turned.yaml", turned)
        self.audit(rows=["px[mm],py[mm],pz[mm],roll[rad],pitch[rad],yaw[rad]"] + rows, case=turned)
        asked = self.write("asked.csv", "\n".join(["px[mm],py[mm],pz[mm],phi[rad],theta[rad],sigma[rad]"] + rows))
        with open(asked, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()
        self.alter(lambda certificate: certificate["source"].update(sha256=digest))
        self.check(code=0)
        self.assertIn("the certificate's parameters are not those of the file's rows",
                      self.check("--path", asked, code=1))

    def test_other_normals_are_another_path(self):
        """Between rows on constraints the motion depends on the normals that a certificate states."""
        case = os.path.join(CASES, "robot2-implicit-rail.yaml")
        self.assertEqual(run(TAUT, "plan", case, "--out", self.path("planned")).returncode, 0)
        path = self.path("planned", "path.csv")
        audited = run(TAUT, "audit", case, path, "--out", self.out)
        self.assertEqual(audited.returncode, 0, audited.stdout + audited.stderr)
        rows = self.write("rows.csv", "".join(line for line in text_of(path).splitlines(True) if line[0] != "#"))
        with open(rows, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()
        self.alter(lambda certificate: certificate["source"].update(sha256=digest))
        self.check("--path", rows, code=0, case=case)

        def turn(by):
            def change(certificate):
                normals = certificate["path"]["waypoints"][1]["normals"]
                normals[0] = hex64(float.fromhex(normals[0]) + by)
            return change

        self.alter(turn(1e-12))
        self.check("--path", rows, code=0, case=case)
        self.alter(turn(1e-7))
        self.check(code=0, case=case)
        self.assertIn("the normals of waypoint 1 are not those of the constraints at line 3 of the file",
                      self.check("--path", rows, code=1, case=case))

    def test_another_law_is_rejected(self):
        path = self.audit("--interpolation", "geodesic")
        self.assertIn("the certificate's interpolation is geodesic, the file's is straight-in-parameters",
                      self.check("--path", path, code=1))
        self.check("--path", path, "--interpolation", "geodesic", code=0)
        self.check("--path", self.path("path.csv"), code=0)
        self.audit()
        self.assertIn("the file's is geodesic", self.check("--path", path, "--interpolation", "geodesic", code=1))

    def test_path_csv_of_another_certificate_is_rejected(self):
        self.audit()
        name = "# certificate.json SHA-256: "
        text = text_of(self.path("path.csv"))
        rows, digest = text.split(name)
        self.assertRegex(digest, r"^[0-9a-f]{64}\n$")
        other = ("00" if digest[:2] != "00" else "11") + digest[2:]
        altered = self.write("altered.csv", rows + name + other)
        self.assertIn("the file names another certificate's SHA-256", self.check("--path", altered, code=1))

    def test_cable_lengths_are_compared_bit_for_bit(self):
        case, path = (os.path.join(AUDITS, "robot1-cable-lengths" + end) for end in (".yaml", ".csv"))
        self.assertEqual(run(TAUT, "audit", case, "--out", self.out).returncode, 0)
        self.check("--path", path, code=0, case=case)
        self.check("--path", self.path("path.csv"), code=0, case=case)
        lines = text_of(self.path("path.csv")).splitlines()
        cells = lines[2].split(",")
        cells[-1] = repr(float(cells[-1]) * (1 + 1e-15))
        changed = self.write("changed.csv", "\n".join(lines[:2] + [",".join(cells)] + lines[3:]))
        self.assertIn("waypoint 1 differs", self.check("--path", changed, code=1, case=case))

    def test_a_plan_is_compared_with_its_path_csv(self):
        self.assertEqual(run(TAUT, "plan", ROBOT1, "--out", self.out).returncode, 0)
        said = self.check("--path", self.path("path.csv"), code=0)
        self.assertNotIn("not compared", said)
        lines = text_of(self.path("path.csv")).splitlines()
        swapped = self.write("swapped.csv", "\n".join([lines[0], "0" + lines[2][1:], "1" + lines[1][1:]] + lines[3:]))
        self.assertIn("waypoint 0 differs from line 2", self.check("--path", swapped, code=1))

    def test_path_csv_never_stands_beside_another_certificate(self):
        self.assertEqual(run(TAUT, "plan", ROBOT1, "--out", self.out).returncode, 0)
        first = text_of(self.path("path.csv"))
        os.remove(self.path("report.html"))
        os.mkdir(self.path("report.html"))  # so that nothing can be put in place
        os.mkdir(self.path("report.html", "full"))
        failed = run(TAUT, "plan", os.path.join(SOURCE, "cases", "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        self.assertEqual(failed.returncode, 3)
        self.assertEqual(text_of(self.path("path.csv")), first)
        self.check("--path", self.path("path.csv"), code=0)

    def test_the_verdict_that_is_expected(self):
        self.audit()
        self.check("--expect", "proved", code=0)
        self.assertIn("rejected: the certificate says proved, expected refuted",
                      self.check("--expect", "refuted", code=1))
        self.check("--expect", "undecided", code=3)

    def test_time_runs_out(self):
        self.audit()
        said = self.check("--max-seconds", "0", code=2)
        self.assertTrue(said.startswith("unchecked: nothing was proved, as no time was allowed for it"), said)
        self.assertIsNone(json.loads(self.check("--max-seconds", "0", "--json", code=2))["verdict"])
        case = os.path.join(AUDITS, "robot1-cable-lengths-tolerances.yaml")
        run(TAUT, "audit", case, "--out", self.path("long"), "--max-seconds", "0")
        said = self.check("--max-seconds", "0.05", code=2, case=case, certificate="long/certificate.json")
        self.assertTrue(said.startswith("unchecked: the budget of 0.05 s ran out"), said)
        said = self.check("--max-seconds", "1e-9", code=2, case=case, certificate="long/certificate.json")
        self.assertTrue(said.startswith("unchecked: the budget of less than 1 ms ran out"), said)
        for wrong in ("-1", "nan", "inf", "soon", ""):
            self.check("--max-seconds", wrong, code=3)

    def test_an_audit_that_was_not_checked_says_so(self):
        path = self.write("asked.csv", "\n".join(ROWS))
        said = run(TAUT, "audit", ROBOT1, path, "--out", self.out, "--max-seconds", "0")
        self.assertEqual(said.returncode, 2, said.stderr)
        self.assertIn("\nUNCHECKED: nothing was proved, as no time was allowed for it. Nothing is claimed of the "
                      "path.\n", said.stdout)
        self.assertNotIn("PROVED", said.stdout)
        self.assertNotIn("margin", said.stdout)
        self.assertIn('<div class="band unchecked">', text_of(self.path("report.html")))
        summary = json.loads(run(TAUT, "audit", ROBOT1, path, "--out", self.out, "--max-seconds", "0", "--json").stdout)
        self.assertEqual((summary["verdict"], summary["margins"], summary["stretches"]), ("unchecked", {}, None))

    def test_empty_arguments_are_errors(self):
        self.audit()
        certificate, path = self.path("certificate.json"), self.path("path.csv")
        for arguments in (["", ROBOT1], [certificate, ""], [certificate, ROBOT1, "--path", ""],
                          [certificate, ROBOT1, "--path", path, "--interpolation", ""], [certificate, "--expect", ""],
                          [certificate, "--trust", ""], [certificate, "--threads", ""],
                          [certificate, "--max-seconds", ""]):
            said = run(CHECK, *arguments)
            self.assertEqual((said.returncode, said.stdout), (3, ""), arguments)
        before = sorted(os.listdir(self.out))
        for arguments in (["plan", ""], ["audit", ROBOT1, ""], ["report", ""], ["init", ""], ["show", ""],
                          ["regress", ""], ["explain", ""]):
            self.assertEqual(run(TAUT, *arguments).returncode, 3, arguments)
        for command, options in ((["plan", ROBOT1], ["--out", "--atlas", "--save-atlas", "--budget", "--sign"]),
                                 (["audit", ROBOT1, path], ["--out", "--interpolation", "--bits", "--sign"]),
                                 (["report", certificate], ["--out", "--document", "--revision", "--date"]),
                                 (["show", ROBOT1], ["--out"])):
            for option in options:
                said = run(TAUT, *command, option, "", cwd=self.out)
                self.assertEqual((said.returncode, said.stdout), (3, ""), (command, option))
                self.assertIn(option, said.stderr, (command, option))
        self.assertEqual(sorted(os.listdir(self.out)), before, "nothing was written")

    def test_a_certificate_is_read_once_also_from_a_pipe(self):
        self.audit()
        pipe = self.path("pipe")
        os.mkfifo(pipe)

        def feed():
            with open(self.path("certificate.json"), "rb") as source, open(pipe, "wb") as file:
                shutil.copyfileobj(source, file)
        feeder = threading.Thread(target=feed)
        feeder.start()
        said = subprocess.run([CHECK, pipe, ROBOT1, "--path", self.path("path.csv")], capture_output=True, text=True,
                              timeout=60, check=False)
        feeder.join()
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_the_forged_source_of_an_audit_is_noticed(self):
        case, path = (os.path.join(AUDITS, "robot1-planned" + end) for end in (".yaml", ".csv"))
        out = self.path("audited")
        self.assertEqual(run(TAUT, "audit", case, path, "--out", out).returncode, 0)
        with open(os.path.join(out, "certificate.json"), encoding="utf-8") as file:
            certificate = json.load(file)
        certificate["source"]["sha256"] = "0" * 64
        forged = self.path("forged.json")
        with open(forged, "w", encoding="utf-8") as file:
            file.write(sealed(certificate))
        said = run(CHECK, forged, case, "--path", path)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn("the file that was audited has another SHA-256", said.stdout)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""taut report: pages, PDF and summaries of certificates, re-checked.

    report_test.py TAUT TAUT_CHECK SOURCE_DIRECTORY
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from command_line import interrupt

TAUT, CHECK, SOURCE = sys.argv[1:4]
CASE = os.path.join(SOURCE, "cases", "robot1-slice-qs-qg.yaml")


def run(*command, **environment):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          env={**os.environ, **environment})


def digest(value):
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.certificate = os.path.join(cls.folder, "certificate.json")
        cls.planned = run(TAUT, "plan", CASE, "--out", cls.folder, SOURCE_DATE_EPOCH="86400")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def changed(self, name, change):
        """The certificate after `change`, with digests that fit."""
        with open(self.certificate, encoding="utf-8") as file:
            certificate = json.load(file)
        change(certificate)
        footer = certificate.pop("footer")
        footer["sha256"] = digest(certificate)
        certificate["footer"] = footer
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump(certificate, file)
        return self.path(name)

    def forged(self):
        """A certificate that claims too much."""
        def exaggerate(certificate):
            for segment in certificate["segments"]:
                segment["margins"]["tension_N"] = "1e-1"
            certificate["margins"]["tension_N"] = "1e-1"
        return self.changed("forged.json", exaggerate)

    def test_of_a_certificate_of_another_version_that_is_the_reason(self):
        def age(certificate):
            certificate["version"] = 1
            del certificate["illustration"]
        old = self.changed("old.json", age)
        said = run(TAUT, "report", old, "--text")
        self.assertEqual((said.returncode, said.stdout), (3, ""))
        self.assertRegex(said.stderr, "version: got 1, expected ([0-9]+, )*[0-9]+ or [0-9]+:")

    def test_what_is_malformed_has_its_place(self):
        def without(key):
            return lambda certificate: certificate.pop(key)

        def with_(value, *keys):
            def change(certificate):
                for key in keys[:-1]:
                    certificate = certificate[key]
                certificate[keys[-1]] = value
            return change

        for change, said in [
                (without("problem"), "certificate: expected the key 'problem'"),
                (with_(None, "claim"), "claim: got null, expected a string"),
                (with_({}, "problem", "load", "wrench"), "problem.load.wrench: got {}, expected a list of 6"),
                (with_("abc", "margins", "tension_N"),
                 'margins.tension_N: got "abc", expected a decimal number in a string'),
                (with_("2/3", "segments", 0, "boxes", 0, "s", 1),
                 'segments[0].boxes[0].s[1]: got "2/3", expected a dyadic from 0 to 1'),
                (with_(-1, "segments", 0, "from"),
                 "segments[0].from: got -1, expected a whole number from 0 to 2147483647"),
                (with_([], "path", "waypoints"), "path.waypoints: got [], expected at least two of a proved path"),
                (with_([], "segments"), "segments: got [], expected some of a proved path"),
                (with_(["x"] * 3, "path", "times"), None),
                (with_(["\x1b[31mred\n"], "problem", "load", "wrench"), None),
                (with_("\x1b[31mred\n\u009b\u202e", "problem", "load", "wrench", 0), "problem.load.wrench[0]: got "
                 "'\\x1b[31mred\\x0a\\xc2\\x9b\\xe2\\x80\\xae', expected a decimal number such as 0.05 or 1e-4"),
                (with_(None, "illustration", "charts", 0, "c", 0),
                 "illustration.charts[0].c[0]: got null, expected a string")]:
            with self.subTest(said=said):
                odd = self.changed("odd.json", change)
                result = run(TAUT, "report", odd)
                self.assertEqual((result.returncode, result.stdout), (3, ""))
                self.assertEqual(result.stderr.count("\n"), 1)
                self.assertNotIn("\x1b", result.stderr)
                if said:
                    self.assertEqual(result.stderr, f"taut: {odd}: {said} [E5]\n")

    def test_what_is_no_json_has_its_line(self):
        deep = "[" * 100_000 + "]" * 100_000
        for text, said in (("", "line 1"), ("hello", "line 1"), ('{"a": 1}\n\nb', "line 3"), ('{\n"a":', "line 2"),
                           ('{"a": "\\ud800"}', "line 1"), ('{"a": 1e999}', "no JSON"), ("\ufeff{}", "byte order mark"),
                           ('{"a": 1, "a": 1}', "twice"), ('{"a": 0.5}', "no integer"), (deep, "nested too deeply")):
            with self.subTest(text=text[:20]):
                path = self.path("odd.json")
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
                for command in (("report", path), ("audit", CASE, path)):
                    result = run(TAUT, *command)
                    self.assertEqual((result.returncode, result.stdout), (3, ""))
                    self.assertRegex(result.stderr,
                                     rf"^taut: {re.escape(path)}: got .*{said}.*, expected a certificate \[E\d\]\n$")
                    self.assertNotIn("exception", result.stderr)

    def test_text_for_its_head_comes_from_the_certificate_and_is_no_part_of_the_claim(self):
        told = json.loads(run(TAUT, "report", self.certificate, "--json").stdout)
        self.assertEqual(told["title"], "Turn the platform in place, 174°, Robot 1")
        self.assertEqual(told["machine"], "Robot 1 (reconstructed)")
        self.assertIsNone(told["site"])

        def rename(certificate):
            certificate["illustration"]["document_fields"] = {"document": "LP-3", "site": "Hall C", "title": "Lift 2"}
        renamed = self.changed("renamed.json", rename)
        self.assertEqual(run(CHECK, renamed, CASE).returncode, 0)
        other = json.loads(run(TAUT, "report", renamed, "--json").stdout)
        self.assertEqual((other["title"], other["document"], other["site"]), ("Lift 2", "LP-3", "Hall C"))
        self.assertEqual(other["verdict"], "proved")
        self.assertEqual(other["sha256"]["problem"], told["sha256"]["problem"])
        self.assertIn("content: \"PROVED · LP-3\"", self.page(renamed))
        asked = json.loads(run(TAUT, "report", renamed, "--json", "--document", "LP-17").stdout)
        self.assertEqual(asked["document"], "LP-17")

    def page(self, certificate):
        self.assertEqual(run(TAUT, "report", certificate, "--out", self.path("page.html")).returncode, 0)
        with open(self.path("page.html"), encoding="utf-8") as file:
            return file.read()

    def test_plan_has_its_certificate_checked(self):
        self.assertIn("Checked by taut-check", self.planned.stdout)
        with open(self.path("report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn("an independent program with other arithmetic, accepted the certificate", page)
        self.assertIn("1970-01-02", page)
        said = run(TAUT, "plan", CASE, "--out", self.path("out"), "--json")
        self.assertEqual(json.loads(said.stdout)["recheck"]["result"], "confirmed")

    def test_what_was_not_checked_has_no_verdict_and_no_path_to_follow(self):
        out = self.path("unchecked")
        self.assertEqual(run(TAUT, "plan", CASE, "--out", out).returncode, 0)
        self.assertTrue(os.path.exists(os.path.join(out, "path.csv")))
        said = run(TAUT, "plan", CASE, "--out", out, "--max-seconds", "0")
        self.assertEqual(said.returncode, 2, said.stderr)
        self.assertRegex(said.stdout, r"(?m)^UNCHECKED: nothing was proved, as no time was allowed for it. Nothing is ")
        self.assertNotIn("PROVED", said.stdout)
        self.assertNotIn("margins", said.stdout)
        self.assertFalse(os.path.exists(os.path.join(out, "path.csv")), "that of an earlier plan is gone, too")
        summary = json.loads(run(TAUT, "plan", CASE, "--out", out, "--max-seconds", "0", "--json").stdout)
        self.assertEqual((summary["verdict"], summary["margins"], summary["witness"]), ("unchecked", {}, None))
        with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn('<div class="band unchecked">', page)
        for claim in ("PROVED", "Closest to going slack", 'id="margins"'):
            self.assertNotIn(claim, page)
        said = run(TAUT, "report", os.path.join(out, "certificate.json"), "--text", "--max-seconds", "0")
        self.assertEqual(said.returncode, 2)
        self.assertIn("UNCHECKED: ", said.stdout)
        self.assertIn("UNCHECKED by taut-check", said.stderr)

    def test_the_page_says_whose_works_it_contains(self):
        with open(self.path("report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn("Output of taut, with the parts of taut that it contains, is not covered by the GPL", page)
        with open(os.path.join(SOURCE, "package-lock.json"), encoding="utf-8") as file:
            packages = json.load(file)["packages"]
        for name, licence in (("three", "MIT"), ("@observablehq/plot", "ISC"), ("d3-scale", "ISC")):
            self.assertIn(f"{name} {packages['node_modules/' + name]['version']} ({licence})", page)
        self.assertIn("THE SOFTWARE IS PROVIDED", page)

    def test_summaries_go_to_standard_output(self):
        text = run(TAUT, "report", self.certificate, "--text")
        self.assertEqual(text.returncode, 0, text.stderr)
        self.assertTrue(text.stdout.startswith("PROVED: Everywhere on this move, for every load"), text.stdout[:80])
        self.assertRegex(text.stdout, r"(?m)^TAUT-[0-9A-F]{4}-[0-9A-F]{4}-[0-9A-F]{4}, \d{4}-\d\d-\d\d: "
                         r"Turn the platform in place, 174°, Robot 1 \(as the case says, not checked\)$")
        markdown = run(TAUT, "report", self.certificate, "--markdown")
        self.assertTrue(markdown.stdout.startswith("## Turn the platform in place, 174°, Robot 1 (as the "))
        summary = json.loads(run(TAUT, "report", self.certificate, "--json", "--document", "LP-1").stdout)
        self.assertEqual((summary["verdict"], summary["document"], len(summary["cables"])), ("proved", "LP-1", 6))
        self.assertEqual(summary["recheck"]["result"], "confirmed")
        for cable in summary["cables"]:
            self.assertLess(cable["tension_N"]["greatest"], cable["tension_N"]["upper_limit"])
            self.assertGreater(cable["length_m"]["least"], cable["length_m"]["lower_limit"])
        said = run(TAUT, "report", self.certificate, "--text", "--out", self.path("summary.txt"))
        self.assertIn("Written: ", said.stdout)
        self.assertTrue(os.path.exists(self.path("summary.txt")))

    def test_of_a_rejected_certificate_there_is_no_report(self):
        for form in ([], ["--text"], ["--markdown"], ["--json"]):
            said = run(TAUT, "report", self.forged(), "--out", self.path("forged.html"), *form)
            self.assertEqual((said.returncode, said.stdout), (1, ""))
            self.assertIn("REJECTED by taut-check", said.stderr)
            self.assertFalse(os.path.exists(self.path("forged.html")))

    def test_forged_certificates_mislead_nobody(self):
        attacks = os.path.join(SOURCE, "tests", "attacks")
        for name, code, said in (("f1.json", 1, "REJECTED by taut-check"), ("f3.json", 3, r"\[E5\]")):
            for form in ("--text", "--markdown", "--json", "--pdf"):
                report = run(TAUT, "report", os.path.join(attacks, name), form, "--out", self.path("forged"))
                self.assertEqual((report.returncode, report.stdout), (code, ""), name)
                self.assertRegex(report.stderr, said)
                self.assertFalse(os.path.exists(self.path("forged")))
        report = run(TAUT, "report", os.path.join(attacks, "f4.json"), "--text")
        self.assertEqual(report.returncode, 0, report.stderr)
        for forged in ("50 N", "20 mm", "as re-checked", "1d8ec40f"):
            self.assertNotIn(forged, report.stdout)
        report = run(TAUT, "report", os.path.join(attacks, "f4.json"), "--out", self.path("f4.html"))
        self.assertEqual(report.returncode, 0, report.stderr)
        with open(self.path("f4.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertNotIn("as re-checked", page[:page.index("</header>")])
        self.assertRegex(page, r"made by \(not checked\)</td>\s*<td><bdi>taut 0.1.0 \(this move is also proved")

    def test_what_is_shown_is_what_was_checked_also_of_a_pipe(self):
        with open(self.certificate, "rb") as file:
            true = file.read()
        with open(self.forged(), "rb") as file:
            forged = file.read()
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        for first, code in ((true, 0), (forged, 1)):
            with subprocess.Popen([TAUT, "report", pipe, "--text"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True) as process:
                with open(pipe, "wb") as file:
                    file.write(first)
                said, _ = process.communicate(timeout=60)
            self.assertEqual(process.returncode, code)
            self.assertEqual("PROVED: " in said, code == 0)
            self.assertEqual("Closest to going slack: Cable 1: +2.15 %" in said, code == 0, "no forged margin")

    def test_a_footer_that_counts_many_boxes_does_not_keep_the_checker_away(self):
        with open(self.forged(), encoding="utf-8") as file:
            forged = json.load(file)
        forged["footer"]["boxes"] = 10**12  # no digest covers this
        with open(self.path("many.json"), "w", encoding="utf-8") as file:
            json.dump(forged, file)
        said = run(TAUT, "report", self.path("many.json"), "--text")
        self.assertEqual((said.returncode, said.stdout), (3, ""))
        self.assertIn("footer", said.stderr)

    def test_a_report_never_replaces_its_certificate(self):
        said = run(TAUT, "report", self.certificate, "--out", self.certificate)
        self.assertEqual(said.returncode, 3)
        self.assertEqual(run(TAUT, "report", self.certificate, "--text").returncode, 0)

    def test_wrong_use_is_refused(self):
        for extra in (["--pdf", "--text"], ["--no-check"], ["--max-seconds", "-1"], ["--max-seconds", "nan"],
                      ["--max-seconds", ""], ["--document", 'a"b'], ["--revision", "x" * 41],
                      ["--date", "<b>"]):
            self.assertEqual(run(TAUT, "report", self.certificate, *extra).returncode, 3, extra)
        for command in (("report", self.certificate, "--text"), ("plan", CASE, "--out", self.path("late")),
                        ("audit", CASE, self.certificate, "--out", self.path("late"))):
            said = run(TAUT, *command, SOURCE_DATE_EPOCH="soon")
            self.assertEqual((said.returncode, said.stdout), (3, ""))
            self.assertIn("SOURCE_DATE_EPOCH: got 'soon', expected seconds since 1970 [E1]", said.stderr)
        self.assertFalse(os.path.exists(self.path("late")))

    def test_without_a_browser_it_says_what_to_install(self):
        said = run(TAUT, "report", self.certificate, "--pdf", TAUT_BROWSER="/no/such/browser")
        self.assertEqual(said.returncode, 3)
        self.assertIn("install Debian's package chromium", said.stderr)
        self.assertFalse(os.path.exists(self.path("report.pdf")))

    def test_a_browser_that_fails_leaves_nothing(self):
        for browser in ("/bin/false", "/bin/true"):
            said = run(TAUT, "report", self.certificate, "--pdf", "--out", self.path("none.pdf"),
                       TAUT_BROWSER=browser)
            self.assertEqual(said.returncode, 4, browser)
            self.assertIn("no PDF", said.stderr)
            self.assertFalse(os.path.exists(self.path("none.pdf")))

    @unittest.skipUnless(shutil.which("chromium"), "needs chromium")
    def test_an_interrupt_ends_the_browser_and_what_it_has_started(self):
        mark = f"{os.getpid()}.25"  # seconds: tells our sleep from others
        browser = self.path("browser")
        with open(browser, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\nsleep {mark} &\nwait\n")
        os.chmod(browser, 0o755)
        with subprocess.Popen([TAUT, "report", self.certificate, "--pdf"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env={**os.environ, "TAUT_BROWSER": browser}) as process:
            interrupt(process, 0.5)
            _, said = process.communicate(timeout=30)
        self.assertEqual((process.returncode, said), (2, "taut: interrupted: nothing was written\n"))
        self.assertEqual(subprocess.run(["pgrep", "-f", f"sleep {mark}"], capture_output=True, check=False).stdout, b"")

    def test_a_pdf_has_pages_and_nothing_of_it_stays_behind(self):
        scratch = self.path("scratch")
        os.mkdir(scratch)
        said = run(TAUT, "report", self.certificate, "--pdf", "--out", self.path("page.pdf"), TMPDIR=scratch)
        self.assertEqual(said.returncode, 0, said.stderr)
        with open(self.path("page.pdf"), "rb") as file:
            pdf = file.read()
        self.assertTrue(pdf.startswith(b"%PDF-"))
        self.assertGreater(len(re.findall(rb"/Type\s*/Page\b", pdf)), 2)
        self.assertEqual([name for name in os.listdir(scratch) if name.startswith("taut-")], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut regress` through the command line: what runs, what counts as a difference, what is written, and the exit code.

Usage: regress_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import shutil
import subprocess
import time
import xml.etree.ElementTree

from command_line import CASES, InFolder, TAUT, interrupt, main, run, text_of

QUICK = "robot2-sphere-q1-q2.yaml"
# Pulled taut, a path ends the search soon, since it can hardly be shorter.
LONG = "{strategy: astar, max_seconds: 100, smooth: none}"


class Regress(InFolder):
    def setUp(self):
        super().setUp()
        self.cases = self.path("cases")
        os.mkdir(self.cases)

    def add(self, name, source=QUICK, **replacements):
        """A case of ours; each replacement is a whole line that begins with that key."""
        text = text_of(os.path.join(CASES, source))
        for key, value in replacements.items():
            text, count = re.subn(rf"^{key}:.*$", f"{key}: {value}" if value else "", text, flags=re.M)
            self.assertEqual(count, 1, key)
        path = os.path.join(self.cases, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def regress(self, *options, code):
        result = run(TAUT, "regress", self.cases, *options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout

    def test_every_case_runs_and_audits_take_their_path_from_beside_the_case(self):
        self.add("a.yaml")
        self.add("below/b.yaml", "audits/robot1-bridging.yaml")
        shutil.copy(os.path.join(CASES, "audits", "robot1-bridging.csv"), self.path("cases", "below"))
        self.add(".hidden/c.yaml")
        summary = json.loads(self.regress("--json", code=0))
        self.assertEqual([c["case"] for c in summary["cases"]], ["a.yaml", "below/b.yaml"])
        self.assertEqual([c["verdict"] for c in summary["cases"]], ["proved", "refuted"])
        self.assertEqual(summary["cases"][1]["measured"]["stretches"], 1)
        self.assertEqual(summary["as_declared"], 2)

    def test_another_verdict_is_a_difference(self):
        self.add("a.yaml", expect="refuted")
        self.assertIn("proved, expected refuted", self.regress(code=1))

    def test_a_number_out_of_its_bounds_is_a_difference_and_units_count(self):
        self.add("a.yaml", expect="{verdict: proved, length: [106 mm, 107 mm], segments: [1, 1]}")
        self.regress(code=0)
        self.add("a.yaml", expect="{verdict: proved, length: [null, 0.1 m]}")
        self.assertIn("expected at most 0.1\n", self.regress(code=1))
        self.add("a.yaml", expect="{verdict: proved, tension_margin: [1 kN, null]}")
        self.assertRegex(self.regress(code=1), r"tension_margin is 0\.\d+, expected at least 1000")
        self.add("a.yaml", expect="{verdict: proved, stretches: [0, 0]}")
        self.assertIn("stretches was not measured", self.regress(code=1))

    def test_bad_cases_are_bad_input_and_the_others_run_all_the_same(self):
        self.add("a.yaml")
        self.add("none.yaml", expect="")
        for wrong in ("{verdict: proved, length: [2 m, 1 m]}", "{verdict: proved, length: 3 m}",
                      "{verdict: proved, lenght: [1, 2]}", "{length: [1, 2]}", "{verdict: proved, segments: [a, b]}",
                      "{verdict: proved, length: [1 N, 2 N]}"):
            with self.subTest(wrong):
                self.add("bad.yaml", expect=wrong)
                said = self.regress(code=3)
                self.assertRegex(said, r"bad\.yaml:\d+:\d+: .*expected")
                self.assertIn("none.yaml: got no 'expect'", said)
                self.assertIn("1 of 3 cases as declared", said)

    def test_links_hide_no_case(self):
        self.add("a.yaml")
        self.add("../elsewhere/wrong.yaml", expect="refuted")
        os.symlink(self.path("elsewhere"), os.path.join(self.cases, "link"))
        os.symlink(self.cases, os.path.join(self.cases, "loop"))
        self.assertIn("1 of 2 cases as declared", self.regress(code=1))
        os.symlink(self.path("nowhere.yaml"), os.path.join(self.cases, "dangling.yaml"))
        self.assertIn("1 of 3 cases as declared", self.regress(code=3))

    def test_any_file_name_will_do(self):
        self.add("a.yaml")
        os.rename(os.path.join(self.cases, "a.yaml"), os.path.join(os.fsencode(self.cases), b"\xff.yaml"))
        self.assertEqual(json.loads(self.regress("--json", code=0))["as_declared"], 1)

    def test_a_folder_without_cases_is_bad_input(self):
        self.regress(code=3)
        self.assertEqual(run(TAUT, "regress", self.path("nowhere")).returncode, 3)

    def test_certificates_are_proved_again(self):
        self.add("a.yaml")
        self.add("b.yaml", "tutorial/02-a-slack-start.yaml")
        self.regress("--check", "--out", self.path("out"), code=0)
        for name in ("path.csv", "certificate.json", "report.html"):
            self.assertTrue(os.path.getsize(self.path("out", "a", name)))

    def test_a_baseline_notes_what_is_worse_and_lets_pass_what_is_better(self):
        self.add("a.yaml")
        self.add("b.yaml")
        baseline = self.path("baseline.json")
        self.regress("--baseline", baseline, "--update", code=0)
        self.regress("--baseline", baseline, code=0)
        content = json.loads(text_of(baseline))

        def changed(quantity, factor, code):
            then = json.loads(json.dumps(content))
            then["cases"]["a.yaml"][quantity] *= factor
            with open(baseline, "w", encoding="utf-8") as file:
                json.dump(then, file)
            return self.regress("--baseline", baseline, code=code)

        self.assertRegex(changed("tension_margin", 1.1, 1), r"tension_margin is \S+, in the baseline")
        changed("tension_margin", 0.5, 0)
        changed("tension_margin", 1.04, 0)
        self.assertRegex(changed("length", 0.9, 1), r"length is \S+, in the baseline")
        changed("length", 1.5, 0)
        self.regress("--baseline", baseline, "--tolerance", "nan", code=3)
        with open(baseline, "w", encoding="utf-8") as file:
            json.dump(content, file)
        os.remove(self.path("cases", "b.yaml"))
        self.assertIn("b.yaml: is in the baseline, and is no more", self.regress("--baseline", baseline, code=1))
        for text in ("", "{}", '{"format": "taut-baseline", "version": 1}',
                     '{"format": "taut-baseline", "version": 2}'):
            self.write("baseline.json", text)
            self.regress("--baseline", baseline, code=3)

    def test_junit_has_a_test_case_for_each_case(self):
        self.add("good.yaml")
        self.add("differs <&>.yaml", expect="refuted")
        self.add("bad.yaml", robot="{}")
        self.regress("--junit", self.path("j.xml"), code=3)
        suite = xml.etree.ElementTree.parse(self.path("j.xml")).getroot().find("testsuite")
        self.assertEqual((suite.get("tests"), suite.get("failures"), suite.get("errors")), ("3", "1", "1"))
        cases = {c.get("name"): c for c in suite.findall("testcase")}
        self.assertIsNotNone(cases["differs <&>.yaml"].find("failure"))
        self.assertIn("expected", cases["bad.yaml"].find("error").get("message"))
        properties = {p.get("name"): p.get("value") for p in cases["good.yaml"].find("properties")}
        self.assertEqual(properties["verdict"], "proved")
        self.assertGreater(float(properties["tension_margin"]), 0)

    def test_no_case_is_written_over(self):
        self.add("good.yaml")
        before = text_of(self.path("cases", "good.yaml"))
        self.write("path.csv", "px[mm]\n1\n")
        for option in (["--junit"], ["--update", "--baseline"]):
            self.regress(*option, self.path("cases", "good.yaml"), code=3)
            self.assertEqual(text_of(self.path("cases", "good.yaml")), before)
            self.regress(*option, self.path("cases", "new.yaml"), code=3)
            self.regress(*option, self.path("path.csv"), code=3)
            self.assertEqual(text_of(self.path("path.csv")), "px[mm]\n1\n")
        new = self.path("new")
        self.regress("--update", "--baseline", new, "--junit", new, code=3)
        self.write("new", "")
        self.regress("--update", "--baseline", new, "--junit", new, code=3)
        for _ in range(2):
            self.regress("--update", "--baseline", new, "--junit", self.path("j.xml"), code=0)
        self.regress("--update", "--baseline", self.path("j.xml"), code=3)
        self.regress("--junit", new, code=3)

    def test_names_that_are_no_text_are_in_the_baseline(self):
        self.add("good.yaml")
        os.rename(self.path("cases", "good.yaml"), os.fsencode(self.path("cases", "good")) + b"\xff.yaml")
        baseline = self.path("baseline.json")
        self.regress("--update", "--baseline", baseline, code=0)
        self.assertEqual(list(json.loads(text_of(baseline))["cases"]), ["good\\xff.yaml"])
        self.regress("--baseline", baseline, code=0)

    def test_a_damaged_baseline_is_refused_with_the_place(self):
        self.add("good.yaml")
        self.regress("--update", "--baseline", self.path("baseline.json"), code=0)
        good = json.loads(text_of(self.path("baseline.json")))
        for cases, said in (([], "baseline.cases: got [], expected an object"),
                            ({"a": 3}, "cases.a: got 3, expected an object"),
                            ({"a": {"verdict": 1}}, "cases.a.verdict: got 1, expected a string"),
                            ({"a": {"verdict": "proved", "angle": "x"}}, 'cases.a.angle: got "x", expected a number')):
            damaged = self.write("damaged.json", json.dumps({**good, "cases": cases}))
            result = run(TAUT, "regress", self.cases, "--baseline", damaged)
            self.assertEqual((result.returncode, result.stderr), (3, f"taut: {damaged}: {said} [E9]\n"))

    def test_what_takes_too_long_is_ended(self):
        self.add("long.yaml", "robot2-free-q2-q3-astar.yaml", planner=LONG)
        begin = time.monotonic()
        self.assertIn("took longer than 0.2 s", self.regress("--timeout", "0.2", code=4))
        self.assertLess(time.monotonic() - begin, 20)

    def test_an_interrupt_ends_all_and_writes_nothing(self):
        for number in range(3):
            self.add(f"{number}.yaml", "robot2-free-q2-q3-astar.yaml", planner=LONG)
        with subprocess.Popen([TAUT, "regress", self.cases, "--junit", self.path("j.xml")], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
            interrupt(process, 0.5)  # taut alone, as a CI runner would
            _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, said)
        self.assertIn("interrupted", said)
        self.assertFalse(os.path.exists(self.path("j.xml")))
        left = subprocess.run(["pgrep", "-f", self.cases], capture_output=True, text=True, check=False)
        self.assertEqual(left.stdout, "")


if __name__ == "__main__":
    main()

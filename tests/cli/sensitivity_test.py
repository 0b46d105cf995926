#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the way, and taut sensitivity: changes that it states as proved are proved when they are typed.

Usage: sensitivity_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

TAUT, CHECK, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:4])
CASES = os.path.join(SOURCE, "cases")
TUTORIAL = os.path.join(CASES, "tutorial", "04-tolerances.yaml")
GUST = os.path.join(CASES, "cranes", "portal-20t-gust.yaml")
LOOSE = os.path.join(CASES, "audits", "robot1-cable-lengths-too-loose.yaml")


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def run(*command):
    said = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    said.stdout = said.stdout.replace("\n  ", " ")  # long sentences are wrapped
    return said


def anchors(text, key):
    """The six rows of numbers of a case, and where they are."""
    found = re.search(key + r":[^\n\[-]*((?:[^\[]*\[[^\]]*\]){6}\]?)", text)
    rows = [[x.strip() for x in row.split(",")] for row in re.findall(r"\[\[?([^\[\]]+)\]", found.group(1))]
    return found, rows


def changed(text, change):
    """The case with a change typed as a person would."""
    kind, value = change["change"], change["value"]
    if kind in ("tension_lower", "tension_upper"):
        value = f"{float(value) / (1000 if 'force: kN,' in text else 1):.12g}"
        lower, upper = re.search(r"  tension: \[([^,]*), ([^\]]*)\]", text).groups()
        limits = f"[{value}, {upper}]" if kind == "tension_lower" else f"[{lower}, {value}]"
        return re.sub(r"  tension: \[[^\]]*\]", f"  tension: {limits}", text)
    if kind == "weight":
        if "  mass: 102" in text:
            return text.replace("  mass: 102", f"  mass: {102 * float(value):.12g}")
        return re.sub(r"wrench: \[0, 0, 1, 0, 0, 0\]  ", f"wrench: [0, 0, {value}, 0, 0, 0]  ", text)
    if kind == "mass":
        mass = rf"(name: {change['item']}, mass: )([\d.]+)"
        return re.sub(mass, lambda found: found.group(1) + f"{float(found.group(2)) * float(value):.12g}", text)
    found, rows = anchors(text, kind + "s")
    to_units = 1 if "length: m," in text else 1000
    rows[change["cable"] - 1]["xyz".index(change["axis"])] = f"{to_units * float(value):.10g}"
    typed = kind + "s: [" + ", ".join("[" + ", ".join(row) + "]" for row in rows) + "]"
    return text[:found.start()] + typed + text[found.end():]


class Sensitivity(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, text):
        path = os.path.join(self.folder.name, "case.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def json(self, *arguments):
        said = run(TAUT, *arguments, "--json")
        return said.returncode, json.loads(said.stdout)

    def test_changes_prove_the_path_when_they_are_typed(self):
        text = text_of(TUTORIAL).replace("mass: 0.5}", "mass: 25}").replace("base_anchors: 0.1,", "base_anchors: 1,")
        code, found = self.json("sensitivity", self.write(text))
        self.assertEqual(code, 0)
        self.assertNotEqual(found["verdict"], "proved")
        proved = [change for change in found["changes"] if change["value"] is not None]
        self.assertGreaterEqual(len(proved), 1, found["changes"])
        for change in proved:
            case = self.write(changed(text, change))
            said = run(TAUT, "plan", case, "--out", self.folder.name, "--headroom", "0")
            self.assertEqual(said.returncode, 0, f"{change}\n{said.stdout}{said.stderr}")

    def test_shares_of_a_plan_are_proved_when_they_are_typed(self):
        text = text_of(TUTORIAL).replace("mass: 0.5}", "mass: 25}")
        code, found = self.json("plan", self.write(text), "--out", self.folder.name)
        self.assertNotEqual(code, 0)
        headroom = found["headroom"]
        load = next(share for share in headroom["shares"] if share["of"] == "load")
        self.assertLess(float(load["share"]), 1)
        self.assertGreater(float(load["share"]), 0)
        self.assertLess(float(headroom["tightest"]["left"]), 0)
        if headroom["subject"] == "waypoint":  # the others may have less
            return
        tighter = text.replace("mass: 25}", f"mass: {25 * float(load['share']):.9g}}}")
        self.assertEqual(run(TAUT, "plan", self.write(tighter), "--out", self.folder.name).returncode, 0)

    def test_shares_and_changes_of_load_items_are_proved_when_they_are_typed(self):
        text = text_of(GUST)
        code, found = self.json("sensitivity", self.write(text), "--rows", "100")
        self.assertEqual((code, found["verdict"], found["headroom"]["subject"]), (0, "refuted", "straight way"))
        shares = {(share["of"], share["item"]): float(share["share"]) for share in found["headroom"]["shares"]}
        self.assertEqual(set(shares), {("all", None), ("wrench_set", None), ("load_item", "payload"),
                                       ("load_item", "wind")})
        self.assertEqual(shares["load_item", "payload"], 0)

        def with_deviations(payload, wind):
            return (text.replace("force: 30", f"force: {30 * wind:.9g}")
                    .replace("mass_tolerance: 2 %", f"mass_tolerance: {2 * payload:.9g} %")
                    .replace("at_tolerance: 50 mm", f"at_tolerance: {50 * payload:.9g} mm"))

        together, wind = shares["all", None], shares["load_item", "wind"]
        for typed, code in ((with_deviations(together, together), 0), (with_deviations(1, wind), 0),
                            (with_deviations(1, 1.1 * wind), 1)):
            self.assertNotEqual(typed, text)
            said = run(TAUT, "plan", self.write(typed), "--out", self.folder.name, "--headroom", "0")
            self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        slight = with_deviations(1, 1.1 * wind)
        _, found = self.json("sensitivity", self.write(slight))
        proved = [change for change in found["changes"] if change["value"] is not None]
        self.assertIn("mass", {change["change"] for change in proved})
        for change in proved:
            said = run(TAUT, "plan", self.write(changed(slight, change)), "--out", self.folder.name, "--headroom", "0")
            self.assertEqual(said.returncode, 0, f"{change}\n{said.stdout}{said.stderr}")

    def test_an_audit_says_what_stands_in_its_way_and_so_does_its_report(self):
        path = os.path.join(CASES, "audits", "robot1-cable-lengths.csv")
        text = text_of(LOOSE)
        said = run(TAUT, "audit", self.write(text), path, "--out", self.folder.name)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        found = re.search(r"The path is provable at ([\d.]+) % of all tolerances and deviations of the load",
                          said.stdout)
        self.assertTrue(found, said.stdout)
        self.assertRegex(said.stdout,
                         r"In the way: the (tension|length) of cable \d at s = [\d.e-]+ of segment \d+, limit")
        share = float(found.group(1)) / 100
        self.assertLess(share, 1)
        report = text_of(os.path.join(self.folder.name, "report.html"))
        self.assertIn("What stands in the way", report)
        self.assertIn(found.group(0), report)
        summary = json.loads(run(TAUT, "report", os.path.join(self.folder.name, "certificate.json"), "--json").stdout)
        self.assertTrue(any(found.group(0) in sentence for sentence in summary["headroom"]))
        # Typed: tolerance and semi-axes, which are 1/sqrt(E).
        e = 1 / share ** 2
        diagonal = ", ".join(f"{x * e * (1 - 1e-9):.9f}" for x in (1e4, 1e4, 1e4, 1e6, 1e6, 1e6))
        typed = re.sub(r"diagonal: \[[^\]]*\]", f"diagonal: [{diagonal}]", text)
        typed = typed.replace("wrench: [0, 0, 0.35,", f"wrench: [0, 0, {0.35 * share:.12f},")
        said = run(TAUT, "audit", self.write(typed), path, "--out", self.folder.name, "--headroom", "0")
        self.assertEqual(said.returncode, 0, said.stdout)

    def test_a_nominal_machine_that_breaks_a_limit_is_named(self):
        said = run(TAUT, "plan", os.path.join(CASES, "tutorial", "02-a-slack-start.yaml"), "--out", self.folder.name)
        self.assertEqual(said.returncode, 1)
        self.assertRegex(said.stdout, r"Waypoint 0 of the query is provable at no share of all")
        self.assertRegex(said.stdout, r"The nominal machine itself breaks a limit: the (tension|length) of cable \d")

    def test_proved_cases_say_how_far_the_proof_reaches_and_what_it_depends_on(self):
        code, found = self.json("sensitivity", TUTORIAL)
        self.assertEqual((code, found["verdict"], found["changes"]), (0, "proved", []))
        self.assertGreater(float(found["headroom"]["shares"][0]["share"]), 1)
        gains = [abs(d["gain"]) for d in found["derivatives"]]
        self.assertEqual(gains, sorted(gains, reverse=True))
        self.assertGreater(len(gains), 40)
        own = next(d for d in found["derivatives"] if d["parameter"] == found["headroom"]["tightest"]["margin"]
                   .replace("_min", "_lower").replace("_max", "_upper"))
        self.assertEqual(abs(own["derivative"]), 1)

    def test_bad_input_is_refused(self):
        for arguments, words in ((["--budget", "-1"], "seconds above 0"), (["--audit", "nowhere.csv"], "nowhere.csv"),
                                 (["--interpolation", "wavy"], "wavy")):
            said = run(TAUT, "sensitivity", TUTORIAL, *arguments)
            self.assertEqual(said.returncode, 3, said.stdout)
            self.assertIn(words, said.stderr)
        timed = os.path.join(CASES, "moves", "portal-20t-table.yaml")
        said = run(TAUT, "sensitivity", timed)
        self.assertEqual(said.returncode, 3, said.stdout)
        self.assertIn("audit.timed: got true, expected a path at rest", said.stderr)
        said = run(TAUT, "plan", TUTORIAL, "--headroom", "-1", "--out", self.folder.name)
        self.assertEqual(said.returncode, 3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

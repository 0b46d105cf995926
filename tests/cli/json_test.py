#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/output.schema.json holds of what every command prints with --json, by a validator that is not ours.

Usage: json_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import glob
import json
import os
import re
import warnings

import jsonschema

from command_line import AUDITS, CASES, CHECK, ROBOT1, SOURCE, TAUT, InFolder, expected, main, run, text_of


DOCS = "file://" + os.path.abspath(os.path.join(SOURCE, "docs")) + "/"
SCHEMAS = {DOCS + name: json.loads(text_of(os.path.join(SOURCE, "docs", name)))
           for name in ("output.schema.json", "certificate.schema.json")}
OUTPUT = SCHEMAS[DOCS + "output.schema.json"]
with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)  # newer ones have another resolver, which Debian 12's has not
    RESOLVER = jsonschema.RefResolver(DOCS + "output.schema.json", OUTPUT, store=SCHEMAS)
REFUTED = os.path.join(CASES, "tutorial", "02-a-slack-start.yaml")


class Json(InFolder):
    def printed(self, *command, code, form=None):
        """Holds what a command prints to the schema of that command, or of another form of its output."""
        said = run(*command, "--json")
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        document = json.loads(said.stdout)
        name = "failure" if "error" in document else form or document["command"]
        faults = jsonschema.Draft202012Validator({"$ref": f"#/$defs/{name}"}, resolver=RESOLVER).iter_errors(document)
        self.assertEqual([f"{list(fault.absolute_path)}: {fault.message[:300]}" for fault in faults], [])
        if document["command"] not in ("report", "show"):
            self.assertEqual(document["exit_code"], code)
        return document

    def test_the_schema_is_one_and_tells_the_commands_apart(self):
        jsonschema.Draft202012Validator.check_schema(OUTPUT)
        shown = self.printed(TAUT, "show", ROBOT1, code=0)
        validator = jsonschema.Draft202012Validator(OUTPUT, resolver=RESOLVER)
        self.assertTrue(validator.is_valid(shown))
        self.printed(TAUT, "show", os.path.join(CASES, "robot1-roll-pitch-yaw.yaml"), code=0)
        self.assertFalse(validator.is_valid({**shown, "weather": "fine"}))
        self.assertFalse(validator.is_valid({key: value for key, value in shown.items() if key != "waypoints"}))

    def test_plans(self):
        proved = self.printed(TAUT, "plan", ROBOT1, "--out", self.path("a"), code=0)
        self.assertEqual(sorted(os.path.basename(file) for file in proved["files"]),
                         ["certificate.json", "controller.csv", "path.csv", "report.html"])
        self.assertTrue(all(os.path.isfile(file) for file in proved["files"]))
        self.assertGreater(proved["elapsed_seconds"], proved["prove_seconds"])
        self.assertEqual(proved["messages"], [])
        self.assertEqual(sorted(proved["margins"]), ["length_m", "tension_N", "wrench_scale"])
        refuted = self.printed(TAUT, "plan", REFUTED, "--out", self.path("b"), code=1)
        self.assertIn("not above its lower limit", refuted["messages"][0]["text"])
        undecided = self.printed(TAUT, "plan", ROBOT1, "--out", self.path("c"), "--budget", "1e-9", code=2)
        self.assertRegex(undecided["messages"][0]["code"], r"^U1[0-9]$")
        self.assertNotIn("[U", undecided["messages"][0]["text"])
        self.printed(TAUT, "plan", ROBOT1, "--out", self.path("d"), "--max-seconds", "0", code=2)
        grown = self.printed(TAUT, "plan", ROBOT1, "--out", self.path("e"), "--save-atlas", self.path("atlas"),
                             "--grow", code=0)
        self.assertTrue(grown["growth"]["whole"])

    def test_legs(self):
        """A plan of a case of legs, and what taut-check says of its certificate."""
        case = os.path.join(CASES, "moves", "pick-and-place.yaml")
        planned = self.printed(TAUT, "plan", case, "--out", self.path("legs"), "--no-report", code=0,
                               form="plan_of_legs")
        self.assertEqual([leg["name"] for leg in planned["legs"]], ["fetch", "carry", "return"])
        self.printed(TAUT, "show", case, code=0, form="show_of_legs")
        checked = self.printed(CHECK, self.path("legs", "certificate.json"), case, code=0)
        self.assertEqual([leg["verdict"] for leg in checked["legs"]], ["proved"] * 3)
        self.printed(TAUT, "plan", case, "--out", self.path("legs"), "--no-report", "--budget", "1e-9", code=2,
                     form="plan_of_legs")
        self.printed(TAUT, "sensitivity", case, code=3)

    def test_bodies(self):
        """Plans, audits, shown cases and reports of cases with bodies; refuted ones, too."""
        case = os.path.join(CASES, "cranes", "portal-20t-stack.yaml")
        shown = self.printed(TAUT, "show", case, code=0)
        self.assertEqual([c["class"] for c in shown["bodies"]["checked"]],
                         ["platform-obstacles", "cables-obstacles", "cables-cables", "cables-platform"])
        self.assertEqual(shown["bodies"]["not_checked"], [])
        self.assertEqual(shown["waypoints"][0]["nearest_bodies"][0]["pair"], ["cable 1", "cable 2"])
        planned = self.printed(TAUT, "plan", case, "--out", self.path("stack"), code=0)
        self.assertEqual(planned["bodies"], shown["bodies"])
        self.assertGreater(float(planned["margins"]["clearance_m"]), 0)
        report = self.printed(TAUT, "report", self.path("stack", "certificate.json"), code=0)
        self.assertEqual(report["bodies"]["proved_left_m"], float(planned["margins"]["clearance_m"]))
        self.assertEqual([n["key"] for n in report["key_numbers"]], ["slack", "top", "length", "clearance", "growth"])
        for pair in report["bodies"]["nearest"]:
            self.assertAlmostEqual(pair["left_m"], pair["distance_m"] - pair["clearance_m"], places=12)
            # What is proved is of all deviations; samples are of the machine as stated.
            self.assertGreater(pair["left_m"], report["bodies"]["proved_left_m"])
        plate = os.path.join(CASES, "bodies", "thin-plate")
        audited = self.printed(TAUT, "audit", plate + ".yaml", plate + ".csv", "--out", self.path("plate"), code=1)
        self.assertEqual(audited["witness"]["kind"], "contact")
        report = self.printed(TAUT, "report", self.path("plate", "certificate.json"), code=0)
        self.assertIsNone(report["bodies"]["proved_left_m"])
        self.assertIn("'hook' and 'plate'", report["headline"])

    def test_audits(self):
        for case in sorted(glob.glob(os.path.join(AUDITS, "robot1-*.yaml"))):
            if "tolerances" in case or "too-loose" in case:
                continue  # these take minutes
            with self.subTest(os.path.basename(case)):
                code = {"proved": 0, "refuted": 1, "undecided": 2}[expected(case)]
                self.printed(TAUT, "audit", case, "--out", self.path("out"), code=code)
        for name, code in (("portal-20t-table", 0), ("portal-20t-table-fast", 1)):
            case = os.path.join(CASES, "moves", name + ".yaml")
            audited = self.printed(TAUT, "audit", case, "--out", self.path(name), "--no-report", code=code)
            self.assertEqual(audited["table"]["lines"][0], 3)
            self.assertEqual(audited["move"]["witness_s"] is None, code == 0)

    def test_sensitivities(self):
        self.assertEqual(self.printed(TAUT, "sensitivity", ROBOT1, code=0)["verdict"], "proved")
        refuted = self.printed(TAUT, "sensitivity", REFUTED, "--budget", "20", code=0)
        self.assertEqual(refuted["verdict"], "refuted")
        self.assertIsNotNone(refuted["headroom"]["tightest"])

    def test_maps(self):
        found = self.printed(TAUT, "map", ROBOT1, "--undecided", "5%", "--out", self.path("map"), code=0)
        self.assertEqual(found["files"], [self.path("map", "map.svg")])

    def test_documents_and_checks(self):
        self.printed(TAUT, "plan", ROBOT1, "--out", self.path("out"), code=0)
        certificate = self.path("out", "certificate.json")
        report = self.printed(TAUT, "report", certificate, code=0)
        self.assertEqual(report["verdict"], "proved")
        self.assertEqual(report, self.printed(TAUT, "report", certificate, code=0), "a document has no times")
        checked = self.printed(CHECK, certificate, ROBOT1, code=0)
        self.assertEqual(checked["verdict"], "proved")
        self.printed(CHECK, self.write("no.json", "{"), code=3)

    def test_no_path(self):
        case = os.path.join(CASES, "maps", "robot1-sigma34-apart.yaml")
        planned = self.printed(TAUT, "plan", case, "--out", self.path("out"), code=1)
        self.assertEqual(planned["no_path"]["answer"], "apart")
        report = self.printed(TAUT, "report", self.path("out", "certificate.json"), code=0, form="report_of_no_path")
        self.assertEqual((report["verdict"], report["waypoints"], report["machine"]),
                         ("no path", [0, 1], "Robot 1 (reconstructed)"))
        self.assertEqual(report["cells"], planned["boxes"])
        unchecked = self.printed(TAUT, "report", self.path("out", "certificate.json"), "--max-seconds", "0", code=2,
                                 form="report_of_no_path")
        self.assertEqual((unchecked["verdict"], unchecked["claim"], unchecked["cells"]), ("unchecked", None, None))

    def test_regressions(self):
        os.mkdir(self.path("cases"))
        for case in (ROBOT1, REFUTED):
            self.write(os.path.join("cases", os.path.basename(case)), text_of(case))
        self.write(os.path.join("cases", "broken.yaml"), "taut: 1\n")
        self.printed(TAUT, "regress", self.path("cases"), code=3)

    def test_what_is_wrong_is_said_as_json(self):
        broken = self.write("broken.yaml", text_of(ROBOT1).replace("tension: [0.05, 0.5]", "tension: [0.05, x]"))
        for command in (("plan", broken, "--out", self.path("x")), ("show", broken), ("audit", broken, broken)):
            said = self.printed(TAUT, *command, code=3)["error"]
            self.assertEqual((said["code"], said["file"]), ("E3", broken))
            self.assertGreater(said["line"], 20)
            self.assertIn("tension", said["field"])
        self.assertEqual(self.printed(TAUT, "plan", "--colour", code=3)["error"]["code"], "E1")
        self.assertEqual(self.printed(TAUT, "report", self.path("none"), code=3)["error"]["code"], "E2")

    def test_the_page_about_it_names_every_command_and_common_key(self):
        page = text_of(os.path.join(SOURCE, "docs", "json.md"))
        for name, part in OUTPUT["$defs"].items():
            if "command" in part.get("properties", {}) and name != "failure":
                self.assertRegex(page, rf"`{name}`")
        common = set(OUTPUT["$defs"]["plan"]["properties"]) & set(OUTPUT["$defs"]["audit"]["properties"])
        missing = {key for key in common if not re.search(rf"`{key}`", page)}
        self.assertEqual(missing - {"out"}, set())


if __name__ == "__main__":
    main()

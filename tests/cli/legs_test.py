#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of legs from the command line: take, carry and put down, with one certificate over all.

Usage: legs_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import hashlib
import json
import os
import shutil
import subprocess

from command_line import CASES, CHECK, TAUT, InFolder, interrupt, main, run, text_of

ROBOT = """taut: 1
name: legs
units: {length: mm, force: N, moment: N*m, mass: kg, angle: deg}
robot:
  base_anchors:     [[0, 220, 0], [0, 220, 0], [-190.5256, -110, 0],
                     [-190.5256, -110, 0], [190.5256, -110, 0], [190.5256, -110, 0]]
  platform_anchors: [[-112.5833, 65, 0], [112.5833, 65, 0], [0, -130, 0],
                     [-112.5833, 65, 0], [112.5833, 65, 0], [0, -130, 0]]
  tension: [0.05, 0.8]
  length: [100, 550]
load:
  gravity: [0, 0, 9.81]
  point: [30, 14, -21]
  items:
    - {name: platform, mass: 0.1}
    - {name: payload, mass: PAYLOAD, legs: [carry]}
    - {name: any, force: 0.001, direction: any}
space:
  slice: {px: 0, py: 0, phi: 0, theta: 0, sigma: 34}
query:
  legs:
    - {name: fetch, waypoints: [{pz: 350}, {pz: 330}]}
    - {name: carry, waypoints: [{pz: 330}, {pz: 340}]}
    - {name: return, waypoints: [{pz: 340}, {pz: 350}]}
planner: {strategy: astar, cost: parameters}
expect: proved
"""
BODIES = """bodies:
  clearance: 5
  platform:
    - {name: payload, ball: {radius: 10, at: [0, 0, 40]}, legs: [carry]}
    - {name: plate, ball: {radius: 20}}
  obstacles:
    - {name: payload before, ball: {radius: 10, at: [0, 150, 330]}, legs: [fetch]}
    - {name: mast, capsule: {from: [-300, 300, 0], to: [-300, 300, 900], radius: 30}}
    - {name: block, mesh: block.obj, unit: mm, at: [PLACE, 0, 350], legs: [return]}
"""
BLOCK = "".join(f"v {x} {y} {z}\n" for x in (0, 20) for y in (0, 20) for z in (0, 20)) + "".join(
    f"f {a} {b} {c}\nf {a} {c} {d}\n" for a, b, c, d in
    ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)))
FOLDERS = ("1-fetch", "2-carry", "3-return")


class Legs(InFolder):
    def setUp(self):
        super().setUp()
        self.case = self.write("legs.yaml", ROBOT.replace("PAYLOAD", "10 g"))
        self.overloaded = self.write("overloaded.yaml", ROBOT.replace("PAYLOAD", "1"))

    def plan(self, *options, case=None, code=0):
        said = run(TAUT, "plan", case or self.case, "--out", self.path("out"), "--headroom", "0", *options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout

    def check(self, *arguments, code=0):
        said = run(CHECK, *arguments)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said.stdout + said.stderr

    def test_all_legs_are_planned_and_proved_by_one_certificate(self):
        said = self.plan()
        self.assertIn("all 3 legs are proved, each with its own load", " ".join(said.split()))
        for name in ("fetch", "carry", "return"):
            self.assertIn(name, said)
        whole = self.path("out", "certificate.json")
        self.assertIn("proved again: 3 legs", self.check(whole, self.case))
        self.assertIn('leg 2: load: "platform"', self.check(whole))
        legs = self.certificate("out")["legs"]
        self.assertEqual([leg["problem"]["name"] for leg in legs],
                         ["legs, leg fetch", "legs, leg carry", "legs, leg return"])
        for leg, folder in zip(legs, FOLDERS):
            alone = self.path("out", folder, "certificate.json")
            self.assertEqual(json.loads(text_of(alone)), leg)
            self.assertIn(text_of(alone), text_of(whole), "byte by byte")
            self.assertIn("the case's other legs", self.check(alone, self.case))
            path = self.path("out", folder, "path.csv")
            self.assertIn(hashlib.sha256(text_of(alone).encode()).hexdigest(), text_of(path))
            self.check(alone, self.case, "--path", path)
            for name in ("controller.csv", "report.html"):
                self.assertTrue(os.path.exists(self.path("out", folder, name)))

    def test_json_has_each_leg(self):
        found = json.loads(self.plan("--json", "--no-report"))
        self.assertEqual((found["verdict"], found["exit_code"]), ("proved", 0))
        self.assertEqual([leg["name"] for leg in found["legs"]], ["fetch", "carry", "return"])
        least = min(float(leg["plan"]["margins"]["tension_N"]) for leg in found["legs"])
        self.assertEqual(float(found["margins"]["tension_N"]), least)
        self.assertEqual(found["boxes"], sum(leg["plan"]["boxes"] for leg in found["legs"]))
        self.assertFalse(os.path.exists(self.path("out", "1-fetch", "report.html")))
        for file in found["files"]:
            self.assertTrue(os.path.exists(file), file)

    def test_a_leg_that_is_refuted_refutes_all(self):
        said = self.plan(case=self.overloaded, code=1)
        self.assertIn("leg 2 of 3, carry:", " ".join(said.split()))
        whole = self.path("out", "certificate.json")
        self.assertIn("leg 2 of 3: refuted again", self.check(whole, self.overloaded))
        self.check(whole, "--expect", "proved", code=1)
        self.assertEqual(sorted(os.listdir(self.path("out", "2-carry"))), ["certificate.json", "report.html"])
        self.assertIn("another problem than the case's", self.check(whole, self.case, code=1))

    def test_earlier_tables_never_stand_beside_another_certificate(self):
        self.plan()
        shutil.copytree(self.path("out", "1-fetch"), self.path("out", "4-another"))
        self.write("out/4-another/notes.txt", "mine\n")
        shutil.copytree(self.path("out", "1-fetch"), self.path("out", "2024-crane"))
        certificate = text_of(self.path("out", "2024-crane", "certificate.json"))
        self.write("out/2024-crane/certificate.json", certificate + "\n\n")
        mine = sorted(os.listdir(self.path("out", "2024-crane")))
        self.plan(case=self.overloaded, code=1)
        self.assertEqual(os.listdir(self.path("out", "4-another")), ["notes.txt"])
        self.assertEqual(sorted(os.listdir(self.path("out", "2024-crane"))), mine)
        self.assertFalse(os.path.exists(self.path("out", "2-carry", "path.csv")))
        self.assertTrue(os.path.exists(self.path("out", "1-fetch", "path.csv")))

    def test_other_commands_say_that_they_take_one_path(self):
        self.plan("--no-report")
        whole = self.path("out", "certificate.json")
        csv_file = self.path("out", "1-fetch", "path.csv")
        for command in (("audit", self.case, csv_file), ("map", self.case), ("sensitivity", self.case)):
            said = run(TAUT, *command)
            self.assertEqual(said.returncode, 3, command)
            self.assertIn("query.legs: got legs", said.stderr, command)
        for command in (("report", whole, "--text"), ("monitor", whole, csv_file), ("formal", whole)):
            said = run(TAUT, *command)
            self.assertEqual(said.returncode, 3, command)
            self.assertIn("several legs", said.stderr, command)
        said = run(TAUT, "plan", self.case, "--save-atlas", self.path("atlas"))
        self.assertEqual(said.returncode, 3)
        self.assertIn("--save-atlas", said.stderr)

    def test_the_overview_leads_to_the_reports_of_the_legs(self):
        self.plan()
        page = text_of(self.path("out", "report.html"))
        self.assertIn("All 3 legs are proved", page)
        self.assertIn("taking a load and putting it down", page)
        for folder in FOLDERS:
            self.assertIn(f'href="{folder}/report.html"', page)
        self.assertNotIn("<script", page)
        again = self.path("again.html")
        said = run(TAUT, "report", self.path("out", "certificate.json"), "--out", again)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(text_of(again), page)
        self.plan(case=self.overloaded, code=1)
        page = text_of(self.path("out", "report.html"))
        self.assertIn("DO NOT RUN", page)
        self.assertIn("Leg 2 of 3, carry: ", page)
        self.assertNotIn("All 3 legs are proved", page)
        self.plan("--max-seconds", "0", code=2)
        page = text_of(self.path("out", "report.html"))
        self.assertIn("UNCHECKED", page)
        self.assertNotIn("PROVED", page)
        self.assertNotIn("are proved", page)

    def test_bodies_are_there_in_their_legs(self):
        self.write("block.obj", BLOCK)
        case = self.write("bodies.yaml", ROBOT.replace("PAYLOAD", "10 g") + BODIES.replace("PLACE", "200"))
        said = " ".join(self.plan(case=case).split())
        self.assertIn("'payload before', obstacle", said)
        whole = self.path("out", "certificate.json")
        self.assertIn("proved again: 3 legs", self.check(whole, case))
        self.assertIn("proved again: 3 legs", self.check(whole))
        names = [[[body["name"] for body in leg["problem"]["bodies"][kind]] for kind in ("platform", "obstacles")]
                 for leg in self.certificate("out")["legs"]]
        self.assertEqual(names, [[["plate"], ["payload before", "mast"]], [["payload", "plate"], ["mast"]],
                                 [["plate"], ["mast", "block"]]])
        self.assertTrue(os.path.exists(self.path("out", "block.obj")))
        self.assertEqual([os.path.exists(self.path("out", folder, "block.obj")) for folder in FOLDERS],
                         [False, False, True])
        page = text_of(self.path("out", "report.html"))
        for expected in ("obstacles: payload before, mast", "on the platform: payload, plate",
                         "whether what one leg carries stands where"):
            self.assertIn(expected, page)
        again = self.path("again.html")
        said = run(TAUT, "report", whole, "--out", again)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(text_of(again), page)
        # In the way of the platform, but only on the last leg.
        case = self.write("bodies.yaml", ROBOT.replace("PAYLOAD", "10 g") + BODIES.replace("PLACE", "-10"))
        said = " ".join(self.plan(case=case, code=1).split())
        self.assertIn("leg 3 of 3, return:", said)

    def test_a_share_is_provable_in_all_legs(self):
        said = run(TAUT, "plan", self.case, "--out", self.path("out"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertRegex(" ".join(said.stdout.split()), "All legs are provable at [0-9.]+ % of all tolerances")
        self.assertIn("All legs are provable at", text_of(self.path("out", "report.html")))
        found = json.loads(run(TAUT, "plan", self.case, "--out", self.path("out"), "--json").stdout)
        of = lambda shares: {(share["of"], share["item"]): float(share["share"]) for share in shares}
        legs = {leg["name"]: of(leg["plan"]["headroom"]["shares"]) for leg in found["legs"]}
        shares = found["headroom"]["shares"]
        self.assertEqual(shares[0]["of"], "all")
        for share in shares:
            key = share["of"], share["item"]
            self.assertEqual(float(share["share"]), legs[share["leg"]][key])
            self.assertEqual(float(share["share"]), min(leg[key] for leg in legs.values() if key in leg))
        self.assertEqual(json.loads(self.plan("--json"))["headroom"], None)

    def test_show_says_each_leg(self):
        case = self.write("bodies.yaml", ROBOT.replace("PAYLOAD", "10 g") + BODIES.replace("PLACE", "200"))
        self.write("block.obj", BLOCK)
        said = run(TAUT, "show", case, "--out", self.path("legs.svg"))
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        fetch, carry, back = (said.stdout.split("\nLeg ")[k] for k in (1, 2, 3))
        self.assertTrue(fetch.startswith("1 of 3, fetch\n"))
        self.assertIn("'payload before'", fetch)
        self.assertNotIn("'payload before'", carry)
        self.assertIn("Waypoint 1: pz = 0.34\n", carry)
        self.assertIn("'block'", back)
        self.assertEqual(said.stdout.count("Robot (a in the world frame"), 1)
        self.assertIn("<svg", text_of(self.path("legs.svg")))
        shown = json.loads(run(TAUT, "show", case, "--json").stdout)
        self.assertEqual([leg["name"] for leg in shown["legs"]], ["fetch", "carry", "return"])
        self.assertEqual(len(shown["legs"][1]["case"]["waypoints"]), 2)

    def test_regress_knows_them(self):
        said = run(TAUT, "regress", self.case, "--json")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_the_case_of_the_project_ends_as_it_declares(self):
        said = run(TAUT, "regress", os.path.join(CASES, "moves", "pick-and-place.yaml"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_an_interruption_leaves_whole_files(self):
        case = os.path.join(CASES, "moves", "pick-and-place.yaml")
        process = subprocess.Popen([TAUT, "plan", case, "--out", self.path("out"), "--no-report"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        interrupt(process, 0.5)
        output, _ = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 2, output)
        for folder in ("", *FOLDERS):
            self.assertEqual([name for name in os.listdir(self.path("out", folder)) if name.endswith(".part")], [])
        self.assertEqual(len(self.certificate("out")["legs"]), 3)
        self.check(self.path("out", "certificate.json"), case, code=2)

    def test_moves_have_tables_over_all_legs(self):
        case = self.write("moves.yaml", ROBOT.replace("PAYLOAD", "10 g") + "time: {load: {speed: 50 mm/s, "
                          "acceleration: 100 mm/s^2}, rate: 20 Hz}\n")
        found = json.loads(self.plan("--json", "--no-report", case=case))
        legs = [leg["plan"]["move"]["duration_s"] for leg in found["legs"]]
        self.assertAlmostEqual(found["duration_s"], sum(legs), 12)
        for name in ("winches.csv", "poses.csv", "poses.tum"):
            text = text_of(self.path("out", name))
            self.assertIn("# leg carry: from", text)
            self.assertIn(hashlib.sha256(text_of(self.path("out", "certificate.json")).encode()).hexdigest(), text)
            lines = [line for line in text.splitlines() if not line.startswith("#")]
            split = (lambda line: line.split(" ")) if name.endswith(".tum") else (lambda line: line.split(","))
            rows = [[float(cell) for cell in split(line)] for line in lines[0 if name.endswith(".tum") else 1:]]
            times = [row[0] for row in rows]
            self.assertEqual(times, sorted(set(times)))
            self.assertAlmostEqual(times[-1], sum(legs), 12)
            of_legs = 0
            for folder in FOLDERS:
                alone = text_of(self.path("out", folder, name)).splitlines()
                of_legs += sum(not line.startswith(("#", "t[s]")) for line in alone)
            self.assertEqual(len(rows), of_legs - 2)
        self.check(self.path("out", "certificate.json"), case)

    def test_the_speed_is_that_of_every_leg(self):
        case = self.write("moves.yaml", ROBOT.replace("PAYLOAD", "10 g") + "time: {load: {speed: 50 mm/s}}\n")
        planned = json.loads(self.plan("--json", "--no-report", case=case))["legs"]
        slower = json.loads(self.plan("--json", "--no-report", "--speed", "50%", case=case))["legs"]
        for fast, slow in zip(planned, slower):
            self.assertAlmostEqual(slow["plan"]["move"]["duration_s"] / fast["plan"]["move"]["duration_s"], 2, 2)


if __name__ == "__main__":
    main()

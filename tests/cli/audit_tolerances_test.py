#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut audit` of tolerances that are far too large for a machine that is held by lengths: some of it takes its time.

Usage: audit_tolerances_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import os
import re

from command_line import AUDITS, CHECK, ROBOT1, SOURCE, Audits, main, run, text_of


class LargeTolerances(Audits):
    def test_the_checker_follows_deviations_as_far_as_the_prover(self):
        """From next to a singular pose, where it is about how small the steps are."""
        text = re.sub(r"tension: .*", "tension: [" + "[0, 600], " * 5 + "[0.175769929, 600]]", text_of(ROBOT1))
        text = re.sub(r"length: \[.*", "length: [1, 5500]", text.split("\nquery:")[0] + "\n")
        verdicts = []
        path = self.write("path.csv", "phi[rad],theta[rad]\n-2.366581387,1.440598576\n-2.366580387,1.440598576\n")
        for size in (1.8, 1.86, 1.9, 2.2, 3, 6):
            case = self.write("case.yaml", f"{text}tolerances: {{cable_length: 0, platform_anchors: {size}}}\n")
            verdicts.append(self.audit(case, path)["verdict"])
            result = run(CHECK, self.path("out", "certificate.json"), case)
            self.assertEqual(result.returncode, 2 if verdicts[-1] == "undecided" else 0, result.stdout + result.stderr)
        self.assertEqual(verdicts[0], "refuted")
        self.assertNotIn("proved", verdicts)

    def test_tolerances_that_lead_past_singular_poses_are_refuted(self):
        """By a deviation that breaks a limit before: one that can be followed."""
        name = os.path.join(AUDITS, "robot1-cable-lengths-tolerances.yaml")
        self.audit(name, os.path.join(AUDITS, "robot1-cable-lengths.csv"))
        first, second = ([float.fromhex(x) for x in w["position"] + w["quaternion"] + w["lengths"]]
                         for w in self.certificate()["path"]["waypoints"][14:16])
        row = lambda x: ",".join(map(repr, x))
        path = self.write("path.csv", "px[m],py[m],pz[m],qx,qy,qz,qw,l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n"
                          f"{row(first)}\n,,,,,,,{row(second[7:])}\n")
        text = text_of(name)
        for tolerance, verdict in [(0.01, "proved"), (3, "refuted"), (30, "refuted")]:
            case = self.write("case.yaml", text.replace("cable_length: 0.01,", f"cable_length: {tolerance},"))
            self.assertEqual(self.audit(case, path)["verdict"], verdict, tolerance)
            result = run(CHECK, self.path("out", "certificate.json"), case)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_the_witness_is_the_gravest_deviation_that_was_found(self):
        text = text_of(os.path.join(SOURCE, "cases", "tutorial", "04-tolerances.yaml")).split("\nplanner:")[0]
        text = re.sub(r"tolerances: .*", "tolerances: {base_anchors: 0.1, load_point: 0.5, mass: 30}", text)
        case = self.write("case.yaml", text + "\n")
        path = self.write("path.csv", "phi[deg],theta[deg]\n30,5\n40,12\n50,18\n60,25\n")
        summary = self.audit(case, path)
        self.assertEqual(summary["verdict"], "refuted")
        below = lambda witness: float(witness["limit"]) - float(witness["value"][1])
        witness = summary["witness"]
        self.assertIn("deviation", witness)
        self.assertEqual(witness["kind"], "tension_min")
        for stretch in summary["stretches"]:
            for end in stretch["inner"] or []:
                self.assertGreaterEqual(below(witness), below(end["witness"]))
        result = run(CHECK, self.path("out", "certificate.json"), case)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    main()

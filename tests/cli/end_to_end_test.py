#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""End to end through the command line: what a user types, what appears, and with which exit code.

Usage: end_to_end_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import csv
import json
import math
import os
import re
import subprocess

from command_line import CASES, CHECK, EXIT, InFolder, TAUT, expected, interrupt, main, run, text_of



def all_cases():
    for folder, _, files in os.walk(CASES):
        for name in sorted(files):
            case = os.path.join(folder, name)
            if name.endswith(".yaml") and not re.search("^audit:|^  legs:", text_of(case), re.M):
                # audits: audit_test.py; legs: legs_test.py
                yield case


class EndToEnd(InFolder):
    def test_a_new_case_plans_as_it_stands_and_with_its_tolerances(self):
        case = self.path("crane.yaml")
        self.assertEqual(run(TAUT, "init", case).returncode, 0)
        text = text_of(case)
        self.assertIn("name: \"crane\"\n", text)
        again = run(TAUT, "init", case)
        self.assertEqual(again.returncode, 3)
        self.assertIn("exists", again.stderr)
        self.assertEqual(text_of(case), text)
        planned = run(TAUT, "plan", "--no-report", case, "--out", self.out)
        self.assertEqual(planned.returncode, 0, planned.stdout + planned.stderr)
        tolerant, lines = re.subn(r"^# (tolerances:|  [a-z_]+: )", r"\1", text, flags=re.M)
        self.assertEqual(lines, 5)
        planned = run(TAUT, "plan", "--no-report", self.write("tolerant.yaml", tolerant), "--out", self.out)
        self.assertEqual(planned.returncode, 0, planned.stdout + planned.stderr)
        self.assertRegex(planned.stdout.replace("\n  ", " "),
                         r"Each alone, with all others as stated: base anchors \d+ %")
        self.assertEqual(run(TAUT, "init", self.path("a 'quoted' name.yaml")).returncode, 0)
        self.assertIn("name: \"new-case\"\n", text_of(self.path("a 'quoted' name.yaml")))

    def test_the_doctor_looks_at_this_machine(self):
        said = run(TAUT, "doctor")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertRegex(said.stdout, r"ok +directed rounding")
        self.assertRegex(said.stdout, r"ok +taut-check +taut-check \d")

    def test_every_case_ends_as_it_declares_and_its_certificate_is_accepted(self):
        """With a report of those of the tutorial; .ci/run makes one of each, also of cranes, which take their time."""
        for number, case in enumerate(case for case in all_cases() if os.sep + "cranes" + os.sep not in case):
            with self.subTest(case=case):
                out = self.path(str(number))
                is_reported = "tutorial" in case
                planned = run(TAUT, "plan", case, "--out", out, *([] if is_reported else ["--no-report"]))
                verdict = expected(case)
                self.assertEqual(planned.returncode, EXIT[verdict], planned.stdout + planned.stderr)
                # The load as it was understood comes first, on two lines.
                word = {"proved": "PROVED", "refuted": "REFUTED - DO NOT RUN",
                        "undecided": "(UNDECIDED - NO DECISION|NO PATH FOUND)", "no path": "NO PATH EXISTS"}[verdict]
                bodies = r"(?:      Inertia counts .*\n)?(?:In time: .*\n)?(?:Bodies: .*\n(?: {8}.*\n)*)?"
                self.assertRegex(planned.stdout, rf"\ALoad: .*\n      .*\n{bodies}{word}: ")
                self.assertEqual(planned.stderr, "", "no progress where stderr is no terminal")
                results = {"certificate.json"} | ({"report.html"} if is_reported else set())
                tables = {"winches.csv", "poses.csv", "poses.tum"} if "\ntime:" in text_of(case) else {"controller.csv"}
                results |= tables | {"path.csv"} if verdict == "proved" else set()
                results |= {"sphere.stl"} if "mesh: sphere.stl" in text_of(case) else set()
                self.assertEqual(set(os.listdir(out)), results)
                checked = run(CHECK, os.path.join(out, "certificate.json"), case)
                self.assertEqual(checked.returncode, 2 if verdict == "undecided" else 0,
                                 checked.stdout + checked.stderr)

    def cost(self, case, *options):
        result = run(TAUT, "plan", os.path.join(CASES, case + ".yaml"), "--out", self.path(case), "--json", *options)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return json.loads(result.stdout)["cost"]

    def test_a_sphere_by_constraints_gives_paths_as_long_as_by_parameters(self):
        for query in ("q1-q2-q3", "sigma-free-q2-q3"):
            with self.subTest(query=query):
                parametric = self.cost("robot2-sphere-" + query, "--no-report")
                implicit = self.cost("robot2-implicit-sphere-" + query, "--no-report")
                self.assertLess(abs(implicit - parametric), 0.01 * parametric)

    def test_path_csv_shows_poses_on_the_constraints(self):
        case = "robot2-implicit-sphere-q1-q2-q3"
        self.cost(case)
        with open(self.path(case, "path.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        for row in rows:
            p = [float(row[name]) for name in ("px[m]", "py[m]", "pz[m]")]
            self.assertAlmostEqual(math.hypot(p[0], p[1], p[2] - 0.306), 0.13, delta=1e-12)
        start = self.certificate(case)["path"]["waypoints"][0]
        self.assertEqual([float.fromhex(x) for x in start["x"]][:3], [0.0, 0.0, 0.176])
        report = text_of(self.path(case, "report.html"))
        self.assertIn("Constraints", report)
        self.assertIn("(1000*py) + 130*sin(theta)*sin(phi) = 0", report)
        self.assertNotIn("Where the platform may go", report)

    def test_a_waypoint_off_the_constraints_is_bad_input(self):
        good = text_of(os.path.join(CASES, "robot2-implicit-position-on-sphere.yaml"))
        case = self.write("off.yaml", good.replace("{px: 81.0918,", "{px: 86.0907,"))
        result = run(TAUT, "plan", case, "--out", self.path("never"))
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertRegex(result.stderr,
                         r"off\.yaml:\d+:\d+: query\.waypoints\[0\]: got a waypoint that is .* mm and 0 rad off")

    def test_a_certificate_of_one_case_is_not_accepted_for_another(self):
        run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        checked = run(CHECK, self.path("certificate.json"), os.path.join(CASES, "robot1-slice-qs2-qg.yaml"))
        self.assertEqual(checked.returncode, 1, checked.stdout + checked.stderr)

    def test_the_same_case_gives_the_same_certificate(self):
        case = os.path.join(CASES, "robot1-slice-qs-qg.yaml")
        run(TAUT, "plan", "--no-report", case, "--out", self.path("a"))
        run(TAUT, "plan", "--no-report", case, "--out", self.path("b"))
        self.assertEqual(self.certificate("a"), self.certificate("b"))

    def test_path_csv_holds_the_certificates_waypoints_bit_for_bit(self):
        run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot1-slice-qs-qg.yaml"), "--out", self.out)
        waypoints = self.certificate()["path"]["waypoints"]
        with open(self.path("path.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), len(waypoints))
        for row, waypoint in zip(rows, waypoints):
            self.assertEqual([float(row["x.phi"]), float(row["x.theta"])], [float.fromhex(x) for x in waypoint["x"]])
            self.assertEqual([int(row["half_turns.phi"]), int(row["half_turns.theta"])], waypoint["half_turns"])

    def test_start_and_goal_are_the_cases_own(self):
        run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot1-slice-qs-qg.yaml"), "--out", self.out)
        waypoints = self.certificate()["path"]["waypoints"]
        self.assertEqual([float.fromhex(x) for x in waypoints[0]["x"]], [-2.3, 1.6])
        self.assertEqual([abs(float.fromhex(x)) for x in waypoints[-1]["x"]], [1.7, 1.7])

    def test_no_report_is_made_where_none_is_wanted(self):
        case = os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        run(TAUT, "plan", case, "--out", self.out)
        self.assertIn("report.html", os.listdir(self.out))
        said = run(TAUT, "plan", case, "--no-report", "--out", self.out)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertTrue(said.stdout.endswith(": path.csv, controller.csv, certificate.json\n"), said.stdout)
        self.assertEqual(sorted(os.listdir(self.out)), ["certificate.json", "controller.csv", "path.csv"],
                         "none of an earlier plan stays")
        for options, report in (([], ["report.html"]), (["--no-report"], [])):
            said = run(TAUT, "audit", case, self.path("path.csv"), *options, "--out", self.path("audited"))
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertTrue(said.stdout.endswith(", ".join([": path.csv", "certificate.json", *report]) + "\n"))
            self.assertEqual(sorted(os.listdir(self.path("audited"))), ["certificate.json", "path.csv", *report])

    def test_the_report_is_made_again_from_the_certificate_alone(self):
        run(TAUT, "plan", os.path.join(CASES, "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        first = text_of(self.path("report.html"))
        os.remove(self.path("report.html"))
        again = run(TAUT, "report", self.path("certificate.json"))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(text_of(self.path("report.html")), first)

    def test_no_report_is_made_of_an_altered_certificate(self):
        run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        certificate = self.certificate()
        certificate["margins"]["tension_N"] = "99"
        altered = self.write("altered.json", json.dumps(certificate))
        result = run(TAUT, "report", altered, "--out", self.path("never.html"))
        self.assertEqual(result.returncode, 3, result.stdout)
        self.assertFalse(os.path.exists(self.path("never.html")))

    def test_a_range_end_that_no_binary64_keeps_is_not_proved(self):
        text = re.sub(r"slice: {.*}", "surface: {parameters: {u: [-0.1, 0.1]}, pose: {px: 0, py: 0, pz: 350, "
                      "phi: -2.3, theta: 1.5 + u, sigma: 0.6}}",
                      text_of(os.path.join(CASES, "robot1-slice-qs-qg.yaml")))
        text = re.sub(r"  waypoints:.*?\n\n", "  waypoints:\n    - {u: -0.1}\n    - {u: 0.1}\n\n", text, flags=re.S)
        result = run(TAUT, "plan", "--no-report", self.write("range.yaml", text), "--out", self.out)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn("range", result.stdout)

    def test_standard_output_that_can_not_be_written_is_a_failure(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run([TAUT, "--version"], stdout=full, stderr=subprocess.PIPE, timeout=60)
        self.assertEqual(result.returncode, 4)

    def test_json_output_is_one_json_object(self):
        case = os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        result = run(TAUT, "plan", "--no-report", case, "--out", self.out, "--json")
        summary = json.loads(result.stdout)
        self.assertEqual(summary["verdict"], "proved")
        self.assertEqual(summary["segments"], len(self.certificate()["segments"]))
        self.assertEqual(summary["margins"], self.certificate()["margins"])

    def budgeted(self, planner, case="robot2-free-q2-q3.yaml"):
        good = text_of(os.path.join(CASES, case))
        return self.write("budget.yaml", re.sub(r"planner: {.*}", f"planner: {{{planner}}}", good))

    def test_a_budget_that_is_spent_without_a_path_says_so_and_how_near_it_came(self):
        tiny = "radius: 0.01, epsilon: 0.01"
        for planner, budget in ((f"strategy: astar, max_charts: 40, {tiny}", "40 charts"),
                                (f"strategy: greedy, max_charts: 40, {tiny}", "40 charts"),
                                ("strategy: astar, max_seconds: 1e-9", "1e-09 s")):
            with self.subTest(planner=planner):
                case = self.budgeted(planner, "robot1-slice-qs-qg.yaml")
                result = run(TAUT, "plan", "--no-report", case, "--out", self.out)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertRegex(result.stdout, f"NO PATH FOUND: .*the budget of {budget} is spent; best so far: ")
                self.assertEqual(self.certificate()["verdict"], "undecided")

    def test_only_what_is_proved_is_left_for_a_machine_to_follow(self):
        proved = run(TAUT, "plan", os.path.join(CASES, "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        self.assertIn("path.csv", proved.stdout)
        self.assertTrue(os.path.exists(self.path("path.csv")))
        undecided = run(TAUT, "plan", self.budgeted("max_charts: 1", "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        self.assertEqual(undecided.returncode, 2, undecided.stdout + undecided.stderr)
        self.assertNotIn("path.csv", undecided.stdout)
        self.assertNotIn("controller.csv", undecided.stdout)
        self.assertNotIn("0 rad", undecided.stdout)
        self.assertFalse(os.path.exists(self.path("path.csv")))
        self.assertFalse(os.path.exists(self.path("controller.csv")))

    def test_codes_are_explained_as_they_are_shown(self):
        self.assertEqual(run(TAUT, "explain", "[U7]").stdout, run(TAUT, "explain", "u7").stdout)

    def test_a_budget_of_charts_gives_the_best_path_within_it(self):
        summary = {}
        for charts in (60, 600):
            case = self.budgeted(f"strategy: astar, max_charts: {charts}")
            result = run(TAUT, "plan", "--no-report", case, "--out", self.path(str(charts)), "--json")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            summary[charts] = json.loads(result.stdout)
            self.assertLessEqual(summary[charts]["charts"], charts)
            checked = run(CHECK, self.path(str(charts), "certificate.json"), case)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertTrue(summary[60]["budget_spent"])
        self.assertLessEqual(summary[600]["cost"], summary[60]["cost"])

    def test_the_result_says_whether_its_search_came_to_an_end(self):
        case = os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        whole = json.loads(run(TAUT, "plan", "--no-report", case, "--out", self.out, "--json").stdout)
        self.assertEqual((whole["within_factor"], whole["budget_spent"]), (1, False))
        generous = run(TAUT, "plan", "--no-report", case, "--out", self.out, "--budget", "1000")
        self.assertEqual(generous.returncode, 0, generous.stderr)
        self.assertIn("the shortest on the charts' graph.", generous.stdout)
        self.assertIn("Length here is the angle that the platform turns.", generous.stdout)
        self.assertEqual((whole["cost_unit"], whole["cost_measure"]), ("rad", "the angle that the platform turns"))
        greedy = run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot2-free-q2-q3.yaml"), "--out", self.out)
        self.assertIn("the first, not the shortest", greedy.stdout)

    def test_an_unreachable_goal_names_what_was_exhausted(self):
        # Only the straight way from q_s to q_g is left, which slackens a cable.
        text = re.sub(r"slice: {.*}", "surface: {parameters: {u: [0, 1]}, pose: {px: 0, py: 0, pz: 350, "
                      "phi: -2.3 + 4*u, theta: 1.6 + u/10, sigma: 34 deg}}",
                      text_of(os.path.join(CASES, "robot1-slice-qs-qg.yaml")))
        text = re.sub(r"  waypoints:.*?\n\n", "  waypoints:\n    - {u: 0}\n    - {u: 1}\n\n", text, flags=re.S)
        for strategy in ("astar", "greedy"):
            with self.subTest(strategy=strategy):
                case = self.write("straight.yaml", text.replace("astar", strategy))
                result = run(TAUT, "plan", "--no-report", case, "--out", self.out)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertRegex(result.stdout, r"NO PATH FOUND: no path from waypoint 0 to 1 of the query: the "
                                 r"component "
                                 r"of the start was covered by \d+ charts of radius 0.15 .* not met; best so far: a "
                                 r"chart whose distance to waypoint 1 is [\d.]+.* evidence, not proof")

    def test_one_lowered_anchor_in_the_certificate_is_noticed(self):
        run(TAUT, "plan", "--no-report", os.path.join(CASES, "robot1-slice-qs1-qg.yaml"), "--out", self.out)
        text = text_of(self.path("certificate.json"))
        altered = self.write("altered.json", text.replace("-0.1905256", "-0.1905257", 1))
        self.assertEqual(run(CHECK, altered).returncode, 3)

    def test_an_infeasible_start_names_cable_limit_and_amount(self):
        case = os.path.join(CASES, "tutorial", "02-a-slack-start.yaml")
        result = run(TAUT, "plan", case, "--out", self.out)
        self.assertEqual(result.returncode, 1)
        # Its length breaks a limit, too, by 6.8 % of the width between limits; the tension by 96 %.
        self.assertIn("REFUTED - DO NOT RUN: at waypoint 0 of the query the tension of cable 3 falls to at most "
                      "-0.381 N, not above its lower limit of 0.05 N.\n", result.stdout)
        self.assertEqual(self.certificate()["verdict"], "refuted")

    def test_bad_input_exits_with_3_says_where_and_writes_nothing(self):
        good = text_of(os.path.join(CASES, "robot1-slice-qs-qg.yaml"))
        mutants = {
            "not YAML": "taut: [",
            "empty": "",
            "unknown key": good.replace("robot:", "robbot:"),
            "nan": good.replace("pz: 350", "pz: .nan"),
            "not a number": good.replace("pz: 350", "pz: up"),
            "limits reversed": good.replace("[0.05, 0.5]", "[0.5, 0.05]"),
            "five anchors": good.replace("    - [190.5256, -110, 0]\n", "", 1),
            "indefinite E": good.replace("diagonal: [1e4", "diagonal: [-1e4"),
            "waypoint lacks theta": good.replace("{phi: 1.7, theta: 1.7}", "{phi: 1.7}"),
        }
        for name, text in mutants.items():
            with self.subTest(mutant=name):
                self.assertNotEqual(text, good)
                case = self.write("bad.yaml", text)
                result = run(TAUT, "plan", case, "--out", self.path("never"))
                self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
                self.assertIn("bad.yaml", result.stderr)
                self.assertEqual(result.stdout, "")
                self.assertFalse(os.path.exists(self.path("never")))

    def test_missing_files_and_wrong_flags_exit_with_3(self):
        case = os.path.join(CASES, "robot1-slice-qs-qg.yaml")
        in_the_way = self.write("file", "")
        for arguments in (["plan", self.path("none.yaml")], ["plan"], ["plan", case, "--speed", "9"],
                          ["plan", case, "--budget", "0"], [], ["fly"],
                          ["plan", case, "--out", in_the_way], ["report", self.path("none.json")],
                          ["report", self.write("no.json", "{")], ["report", self.write("list.json", "[]")]):
            with self.subTest(arguments=arguments):
                result = run(TAUT, *arguments, cwd=self.out)
                self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
                self.assertNotEqual(result.stderr, "")

    def test_a_command_without_what_it_takes_is_told_so(self):
        said = run(TAUT, "plan").stderr
        self.assertIn("CASE is required", said)
        self.assertIn("taut plan --help", said)
        self.assertNotIn("expected a command", said)
        self.assertIn("got 'fly', expected a command: plan", run(TAUT, "fly").stderr)

    def test_a_waypoint_may_be_lost_to_tolerances(self):
        text = text_of(os.path.join(CASES, "tutorial/04-tolerances.yaml"))

        def plan(tolerance):
            case = self.write("loose.yaml", text.replace("{base_anchors: 0.1,", f"{{base_anchors: {tolerance},"))
            return run(TAUT, "plan", "--no-report", case, "--out", self.out)

        said = plan(1.2)  # more than can be proved, less than is violated
        self.assertEqual(said.returncode, 2, said.stdout + said.stderr)
        self.assertRegex(said.stdout, r"waypoint \d of the query: the tolerances are too large for a proof at "
                                      r"margin (tension|length)_(min|max) of cable \d \[U6\]")
        self.assertRegex(said.stdout,
                         r"In the way: the (tension|length) of cable \d at waypoint \d of the query, limit")
        self.assertRegex(said.stdout.replace("\n  ", " "),
                         r"Waypoint \d of the query is provable at [\d.]+ % of all tolerances and deviations")
        for far_too_large in (5, 100):
            said = plan(far_too_large)
            self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
            self.assertIn("on a machine that deviates within the tolerances", said.stdout)
            self.assertIn("accepted", said.stdout)

    def test_an_interrupted_plan_is_undecided_and_leaves_whole_files(self):
        good = text_of(os.path.join(CASES, "robot2-sphere-q1-q2-q3.yaml"))
        case = self.write("long.yaml", re.sub(r"radius: 0.15, epsilon: 0.15", "radius: 0.0007, epsilon: 0.0007", good))
        process = subprocess.Popen([TAUT, "plan", case, "--out", self.out], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        interrupt(process, 0.5)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, output)
        self.assertEqual(self.certificate()["verdict"], "undecided")
        self.assertEqual([name for name in os.listdir(self.out) if name.endswith(".part")], [])

    def test_a_saved_atlas_answers_later_queries(self):
        atlas, case = self.path("robot1.atlas"), os.path.join(CASES, "robot1-slice-qs-qg.yaml")
        plan = (TAUT, "plan", "--no-report", "--json", "--save-atlas", atlas)
        saved = run(*plan, case, "--out", self.path("a"), "--grow")
        self.assertEqual(saved.returncode, 0, saved.stderr)
        for number, name in enumerate(["robot1-slice-qs1-qg.yaml", "robot1-slice-qs2-qg.yaml"]):
            out, other = self.path(str(number)), os.path.join(CASES, name)
            answer = run(*plan, other, "--out", out, "--atlas", atlas)
            self.assertEqual(answer.returncode, 0, answer.stderr)
            summary = json.loads(answer.stdout)
            self.assertGreater(summary["charts_stored"], 300)
            self.assertEqual(summary["charts"], summary["charts_stored"] + 1, "the start; the goal is known")
            checked = run(CHECK, os.path.join(out, "certificate.json"), other)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertEqual(sorted(os.listdir(self.out)), ["0", "1", "a", "robot1.atlas"])

    def test_a_stale_or_damaged_atlas_is_refused_and_nothing_is_written(self):
        atlas, case = self.path("atlas"), os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        run(TAUT, "plan", "--no-report", case, "--out", self.path("a"), "--save-atlas", atlas)
        with open(atlas, "rb") as file:
            whole = file.read()
        altered = bytearray(whole)
        altered[500] ^= 1
        finer = self.write("finer.yaml", text_of(case).replace("radius: 0.15", "radius: 0.12"))
        stronger = self.write("stronger.yaml", text_of(case).replace("[0.05, 0.5]", "[0.05, 0.51]"))
        self.assertNotEqual(text_of(finer), text_of(case))
        self.assertNotEqual(text_of(stronger), text_of(case))
        for case_used, content, expected_text in [
                (finer, whole, "planner.radius 0.15, expected 0.12"), (stronger, whole, "of another problem"),
                (case, bytes(altered), "damaged"), (case, whole[:-1], "damaged"), (case, whole + b"x", "damaged"),
                (case, b"", "0 bytes"), (case, b"taut: 1\n" * 100, "is no atlas file")]:
            with self.subTest(expected=expected_text):
                with open(atlas, "wb") as file:
                    file.write(content)
                refused = run(TAUT, "plan", "--no-report", case_used, "--out", self.path("b"), "--atlas", atlas)
                self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
                self.assertIn(atlas, refused.stderr)
                self.assertIn(expected_text, refused.stderr)
                self.assertFalse(os.path.exists(self.path("b")))
        for missing in [self.path("nowhere"), self.out, "/dev/null"]:
            refused = run(TAUT, "plan", "--no-report", case, "--out", self.path("b"), "--atlas", missing)
            self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)

    def test_where_no_atlas_can_be_written_nothing_is(self):
        case = os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        closed = self.path("closed")
        os.mkdir(closed, 0o555)
        places = [self.path("no/such/folder/atlas"), self.out, "/proc/taut.atlas"]
        for place in places + ([] if os.geteuid() == 0 else [os.path.join(closed, "atlas")]):
            with self.subTest(place=place):
                refused = run(TAUT, "plan", case, "--out", self.path("b"), "--save-atlas", place)
                self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
                self.assertIn(place, refused.stderr)
                self.assertFalse(os.path.exists(self.path("b", "path.csv")))
        self.assertEqual(run(TAUT, "plan", case, "--out", self.path("b"), "--grow").returncode, 3)

    def test_the_case_is_not_overwritten(self):
        case = self.write("case.yaml", text_of(os.path.join(CASES, "robot1-slice-qs1-qg.yaml")))
        before = text_of(case)
        refused = run(TAUT, "plan", case, "--out", self.path("b"), "--save-atlas", case)
        self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
        self.assertIn("got the file that is read, expected another to be written", refused.stderr)
        self.assertEqual(text_of(case), before)

    def test_concurrent_writers_leave_one_whole_atlas(self):
        atlas, case = self.path("atlas"), os.path.join(CASES, "robot1-slice-qs1-qg.yaml")
        plan = (TAUT, "plan", "--no-report", case, "--out")
        writers = [subprocess.Popen([*plan, self.path(str(number)), "--save-atlas", atlas], stdout=subprocess.DEVNULL,
                                    stderr=subprocess.DEVNULL) for number in range(6)]
        self.assertEqual([writer.wait(timeout=300) for writer in writers], [0] * 6)
        self.assertEqual(run(*plan, self.path("b"), "--atlas", atlas).returncode, 0)
        self.assertEqual(sorted(os.listdir(self.out)), ["0", "1", "2", "3", "4", "5", "atlas", "b"])

    def test_an_infeasible_query_saves_no_atlas(self):
        case = os.path.join(CASES, "tutorial/02-a-slack-start.yaml")
        refuted = run(TAUT, "plan", case, "--out", self.path("a"), "--save-atlas", self.path("atlas"))
        self.assertEqual(refuted.returncode, 1, refuted.stderr)
        self.assertEqual(os.listdir(self.out), ["a"])

    def test_an_interrupted_anytime_plan_gives_its_best_path(self):
        case = self.budgeted("strategy: astar, max_seconds: 1000, radius: 0.05, epsilon: 0.05, smooth: none")
        process = subprocess.Popen([TAUT, "plan", "--no-report", case, "--out", self.out, "--json"],
                                   stdout=subprocess.PIPE, text=True)
        interrupt(process, 2)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, output)
        summary = json.loads(output)
        self.assertFalse(summary["budget_spent"])
        self.assertNotEqual(summary["within_factor"], 1)
        self.assertEqual(run(CHECK, self.path("certificate.json"), case).returncode, 0)

    def test_a_goal_that_is_the_start_by_another_name_is_one_segment(self):
        good = text_of(os.path.join(CASES, "robot1-slice-qs-qg.yaml"))
        case = self.write("same.yaml", re.sub(r"{phi: 1.7, theta: 1.7}", "{phi: -2.3 + pi, theta: -1.6}", good))
        result = run(TAUT, "plan", "--no-report", case, "--out", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.certificate()["segments"]), 1)

    def test_version(self):
        result = run(TAUT, "--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^taut \d+\.\d+\.\d+")


if __name__ == "__main__":
    main()

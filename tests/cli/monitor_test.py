#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut monitor, on files and on a pipe that is open while it answers.

Usage: monitor_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import select
import subprocess
import tempfile
import warnings

import jsonschema

from command_line import CASES, ROBOT1, SOURCE, TAUT, InFolder, interrupt, main, run, text_of

DOCS = "file://" + os.path.abspath(os.path.join(SOURCE, "docs")) + "/"
SCHEMAS = {DOCS + name: json.loads(text_of(os.path.join(SOURCE, "docs", name)))
           for name in ("output.schema.json", "certificate.schema.json")}
with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)  # newer ones have another resolver, which Debian 12's has not
    RESOLVER = jsonschema.RefResolver(DOCS + "output.schema.json", SCHEMAS[DOCS + "output.schema.json"], store=SCHEMAS)
SECONDS = 60  # that an answer may take on a busy machine


class Monitor(InFolder):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        out = os.path.join(cls.folder.name, "out")
        planned = run(TAUT, "plan", ROBOT1, "--out", out, "--no-report", "--headroom", "0")
        assert planned.returncode == 0, planned.stderr
        cls.proved = os.path.join(out, "certificate.json")
        lines = [line for line in text_of(os.path.join(out, "controller.csv")).splitlines() if line[0] != "#"]
        names = lines[0].split(",")
        cls.header, cls.rows = lines[0], lines[1:]
        cls.lengths = [k for k, name in enumerate(names) if name.lower().startswith("l")]
        assert len(cls.lengths) == 6 and len(cls.rows) > 10

    def monitor(self, rows, *options, header=None, end="\n"):
        path = self.write("rows.csv", "\n".join([header or self.header] + rows) + end)
        return run(TAUT, "monitor", self.proved, path, "--length-error", "0.001mm", "--position-error", "0.001mm",
                   "--orientation-error", "1e-6rad", *options)

    def changed(self, row, cable, by):
        """A row of which one length is off."""
        cells = row.split(",")
        k = self.lengths[cable - 1]
        cells[k] = repr(float(cells[k]) + by)
        return ",".join(cells)

    def test_the_table_for_the_controller_is_good(self):
        said = self.monitor(self.rows)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        first = said.stdout.splitlines()[0]
        self.assertIn("Monitoring a proved path", first)
        self.assertIn("lengths 0.001 mm", first)
        self.assertIn(f"{len(self.rows)} rows, {len(self.rows)} of them good. 0 alarms.", said.stdout)
        self.assertIn(f"Last good row: {len(self.rows)}, ", said.stdout)
        self.assertNotIn("ALARM", said.stdout)

    def test_an_alarm_names_row_line_place_and_cable(self):
        rows = list(self.rows)
        rows[7] = self.changed(rows[7], 3, 0.012)
        said = self.monitor(["# a comment", ""] + rows)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        alarms = [line for line in said.stdout.splitlines() if line.startswith("ALARM")]
        self.assertEqual(len(alarms), 1, said.stdout)
        self.assertRegex(alarms[0], r"^ALARM row 8, line 11, t = -, s = [\d.]+: length of cable 3: measured [\d.]+ mm, "
                                    r"allowed [\d.]+ to [\d.]+ mm; all else fits this place$")
        self.assertIn("1 alarm (1 length)", said.stdout)

    def test_lines_that_are_no_rows_are_told_and_passed_over(self):
        cells = self.rows[3].split(",")
        bad = [",".join(cells[:-1]), ",".join(cells + ["1"]), ",".join(["nan"] * len(cells)),
               self.rows[3].replace(cells[self.lengths[0]], "inf"), self.rows[3].replace(cells[self.lengths[0]], "-1"),
               "text", ",".join(["1e300"] * len(cells)), "\x1b[2J", "," * 70000]
        said = self.monitor(self.rows[:4] + bad + self.rows[4:])
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        told = [line for line in said.stdout.splitlines() if line.startswith("BAD line ")]
        self.assertEqual([line.split()[2] for line in told], [f"{6 + k}:" for k in range(len(bad))])
        self.assertNotIn("\x1b", said.stdout)
        self.assertIn(f"{len(self.rows)} rows, {len(self.rows)} of them good", said.stdout)
        self.assertIn("9 lines could not be read", said.stdout)

    def test_a_row_that_is_cut_is_not_judged(self):
        said = self.monitor(self.rows[:5] + [self.rows[5][:-3]], end="")
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertIn("5 rows, 5 of them good", said.stdout)
        self.assertIn("BAD line 7: got no line end", said.stdout)

    def test_time_may_not_go_back(self):
        timed = [f"{t}," + row for t, row in zip((0, 1, 1, 0.5, 2), self.rows)]
        said = self.monitor(timed, header="t[s]," + self.header)
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertIn("BAD line 5: t: got 0.5 s after 1 s", said.stdout)
        self.assertIn("4 rows, 4 of them good", said.stdout)

    def test_it_answers_at_once_on_a_pipe(self):
        with subprocess.Popen([TAUT, "monitor", self.proved, "--length-error", "0.001mm", "--position-error", "0.001mm",
                               "--orientation-error", "1e-6rad"],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            def tell(text):
                process.stdin.write(text.encode())
                process.stdin.flush()

            def hear():
                self.assertTrue(select.select([process.stdout], [], [], SECONDS)[0], "no answer")
                line = b""
                while not line.endswith(b"\n"):
                    byte = os.read(process.stdout.fileno(), 1)
                    self.assertTrue(byte, line)
                    line += byte
                return line.decode()

            tell(self.header + "\n")
            self.assertIn("Monitoring", hear())
            self.assertIn("Columns", hear())
            tell(self.rows[0] + "\n" + self.rows[1][:20])
            tell(self.rows[1][20:] + "\n" + self.changed(self.rows[2], 1, -0.009) + "\n")
            self.assertIn("ALARM row 3, line 4", hear())
            tell(self.rows[3] + "\n" + self.changed(self.rows[4], 6, 0.009) + "\n")
            self.assertIn("ALARM row 5, line 6", hear())
            process.stdin.close()
            self.assertIn("5 rows, 3 of them good. 2 alarms (2 length).", hear())
            self.assertEqual(process.wait(SECONDS), 1)

    def test_an_interruption_ends_with_the_summary(self):
        with subprocess.Popen([TAUT, "monitor", self.proved, "--length-error", "0.001mm"], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE) as process:
            process.stdin.write((self.header + "\n").encode())
            process.stdin.flush()
            process.stdout.readline()
            interrupt(process, after=0.1)
            rest = process.stdout.read().decode()
            self.assertEqual(process.wait(SECONDS), 2)
            self.assertIn("Interrupted.\n0 rows", rest)

    def test_json_has_a_document_on_each_line(self):
        rows = list(self.rows)
        rows[2] = self.changed(rows[2], 2, 0.015)
        said = self.monitor(rows + ["x"], "--json")
        self.assertEqual(said.returncode, 1, said.stderr)
        documents = [json.loads(line) for line in said.stdout.splitlines()]
        validator = jsonschema.Draft202012Validator({"$ref": "#/$defs/monitor"}, resolver=RESOLVER)
        for document in documents:
            self.assertEqual([fault.message[:300] for fault in validator.iter_errors(document)], [], document)
        self.assertEqual([document["event"] for document in documents], ["start", "alarm", "bad line", "summary"])
        self.assertEqual((documents[1]["cable"], documents[1]["row"]), (2, 3))
        self.assertEqual(documents[-1]["exit_code"], 1)
        self.assertEqual(documents[-1]["alarms"]["length"], 1)

    def test_only_what_is_proved_is_monitored(self):
        refuted = run(TAUT, "plan", os.path.join(CASES, "tutorial", "02-a-slack-start.yaml"), "--out", self.path("r"))
        self.assertEqual(refuted.returncode, 1)
        said = run(TAUT, "monitor", self.path("r", "certificate.json"), os.devnull)
        self.assertEqual(said.returncode, 3)
        self.assertRegex(said.stderr, r"got the verdict 'refuted', expected a path that is proved \[E5\]")
        cut = self.write("cut.json", text_of(self.proved)[:-40])
        self.assertEqual(run(TAUT, "monitor", cut, os.devnull).returncode, 3)
        unchecked = run(TAUT, "monitor", self.proved, os.devnull, "--max-seconds", "0")
        self.assertEqual(unchecked.returncode, 2)
        self.assertIn("Nothing is monitored", unchecked.stderr)

    def test_wrong_use(self):
        for header, expected in (("t[s],f1", "got neither lengths nor a pose"), ("L1,L1", "got the column 'L1' twice"),
                                 ("L1[kg]", "a unit in brackets"), ("L1,px,py", "got a part of a pose"),
                                 ("weather", "got the column 'weather'"), ("L1[m", "a unit in brackets")):
            said = self.monitor(["1"], header=header)
            self.assertEqual(said.returncode, 3, said.stdout)
            self.assertIn(expected, said.stderr)
            self.assertIn("[E4]", said.stderr)
        said = run(TAUT, "monitor", self.proved, self.path("none.csv"))
        self.assertEqual(said.returncode, 3)
        self.assertIn("[E2]", said.stderr)
        for option, value in (("--length-error", "-1mm"), ("--length-error", "1kN"), ("--tension-error", "x"),
                              ("--time-error", "1m"), ("--length-error", "2"), ("--orientation-error", "1")):
            said = run(TAUT, "monitor", self.proved, os.devnull, f"{option}={value}")
            self.assertEqual(said.returncode, 3)
            self.assertRegex(said.stderr, rf"{option}: got .* expected a .* of 0 or more.*\[E1\]")


class MonitorOfAMove(InFolder):
    """A move that a plan has written, and its own tables."""
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        out = os.path.join(cls.folder.name, "out")
        case = os.path.join(CASES, "moves", "hexacrane.yaml")
        planned = run(TAUT, "plan", case, "--out", out, "--no-report", "--headroom", "0")
        assert planned.returncode == 0, planned.stderr
        cls.proved = os.path.join(out, "certificate.json")
        cls.tables = {name: text_of(os.path.join(out, name)) for name in ("winches.csv", "poses.csv")}

    def monitor(self, text):
        return run(TAUT, "monitor", self.proved, self.write("rows.csv", text), "--length-error", "0.001mm",
                   "--position-error", "0.001mm", "--orientation-error", "1e-5rad")

    def at(self, name, time):
        """The table, with other times."""
        lines = [line for line in self.tables[name].splitlines() if not line.startswith("#")]
        rows = [line.split(",") for line in lines[1:]]
        return "\n".join(lines[:1] + [",".join([repr(time(float(row[0])))] + row[1:]) for row in rows]) + "\n"

    def test_its_own_tables_are_good(self):
        for name, text in self.tables.items():
            said = self.monitor(text)
            self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
            self.assertIn("Monitoring a proved move of", said.stdout)
            self.assertIn(" 0 alarms.", said.stdout)
            self.assertIn("Against the law, rows are from", said.stdout)
            self.assertEqual("(left out: v1, v2" in said.stdout, name == "winches.csv", said.stdout)

    def test_a_slower_clock_lags_and_a_faster_one_is_told(self):
        slower = self.monitor(self.at("winches.csv", lambda t: 1.25 * t + 7))
        self.assertEqual(slower.returncode, 0, slower.stdout + slower.stderr)
        behind = re.search(r"Against the law, rows are from ([\d.]+) s behind", slower.stdout)
        self.assertGreater(float(behind.group(1)), 0.5)
        for name in self.tables:
            faster = self.monitor(self.at(name, lambda t: 0.9 * t))
            self.assertEqual(faster.returncode, 1, faster.stdout + faster.stderr)
            self.assertRegex(faster.stdout, r"ALARM row \d+, line \d+, t = [\d.]+ s, s = [\d.]+: ahead of the law")

    def test_a_move_that_goes_back_is_told(self):
        lines = [line for line in self.tables["winches.csv"].splitlines() if not line.startswith("#")]
        rows = [line.split(",") for line in lines[1:]]
        back = rows[: len(rows) // 2] + rows[len(rows) // 2 - 20 : len(rows) // 4 : -1]
        text = "\n".join(lines[:1] + [",".join([repr(0.02 * k)] + row[1:]) for k, row in enumerate(back)]) + "\n"
        said = self.monitor(text)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn(": backwards", said.stdout)


if __name__ == "__main__":
    main()

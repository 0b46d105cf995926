# SPDX-License-Identifier: GPL-3.0-or-later
"""What people see on a terminal: the verdict first, then the numbers, wrapped and coloured; in a pipe neither.

    terminal_test.py TAUT TAUT_CHECK SOURCE_DIRECTORY
"""
import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import termios
import unittest

from command_line import AUDITS, CASES, ROBOT1, TAUT, InFolder, main, run

GUST = os.path.join(CASES, "cranes", "portal-20t-gust.yaml")
NO_PATH = os.path.join(CASES, "tutorial", "02-a-slack-start.yaml")
BRIDGING = os.path.join(AUDITS, "robot1-bridging.yaml")
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")
NUMBERS = ["Closest to going slack", "Highest tension", "Least length left", "Load uncertainty could grow"]


def on_terminal(*command, columns, **environment):
    """What a command prints on a terminal of so many columns, and its exit code."""
    main_end, terminal = pty.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    clean = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "COLUMNS")}
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=terminal, stderr=subprocess.PIPE,
                          env={**clean, "TERM": "xterm", **environment}) as process:
        os.close(terminal)
        said = b""
        try:
            while piece := os.read(main_end, 1 << 16):
                said += piece
        except OSError:  # the other end was closed
            pass
        finally:
            os.close(main_end)
    return said.decode().replace("\r\n", "\n"), process.returncode


def words_of(text):
    return ESCAPE.sub("", text).split()


class Terminal(InFolder):
    def plan(self, case, columns, **environment):
        return on_terminal(TAUT, "plan", case, "--out", self.path("out"), columns=columns, **environment)

    def test_lines_are_wrapped_between_words(self):
        piped = run(TAUT, "plan", ROBOT1, "--out", self.path("out"))
        self.assertGreater(max(map(len, piped.stdout.splitlines())), 120, "in a pipe sentences stay whole")
        for columns in (40, 80, 133):
            said, code = self.plan(ROBOT1, columns)
            self.assertEqual(code, 0)
            for line in ESCAPE.sub("", said).splitlines():
                self.assertTrue(len(line) <= columns or " " not in line.strip(), line)
            def untimed(words):
                return [word for word in words if not re.fullmatch(r"\d+\.\d+", word)]
            self.assertEqual(untimed(words_of(said)), untimed(piped.stdout.split()), "no word is lost")

    def test_a_number_and_its_unit_stay_together(self):
        unit = re.compile(r"(?:k?N(?:·m)?|mm|m|t|kg|%|deg|ms)[.,;:)]*$")
        parted = re.compile(r"\d\)?$")
        broken = 0
        run(TAUT, "plan", GUST, "--out", self.path("out"), "--headroom", "0")
        for columns in range(40, 100, 4):
            said, _ = on_terminal(TAUT, "report", self.path("out", "certificate.json"), "--text", columns=columns)
            lines = [line.split() for line in ESCAPE.sub("", said).splitlines() if line.strip()]
            for line, following in zip(lines, lines[1:]):
                broken += bool(parted.search(line[-1]) or unit.match(line[-1]))
                self.assertFalse(parted.search(line[-1]) and unit.match(following[0]), (columns, line, following))
        self.assertGreater(broken, 0, "some line ends with a number or its unit")

    def test_the_verdict_is_in_colour_unless_nobody_wants_that(self):
        for case, colour, word in ((ROBOT1, 32, "PROVED"), (GUST, 31, "REFUTED - DO NOT RUN"),
                                   (BRIDGING, 31, "REFUTED - DO NOT RUN")):
            command = "audit" if case == BRIDGING else "plan"
            said, _ = on_terminal(TAUT, command, case, "--out", self.path(word), columns=80)
            self.assertIn(f"\x1b[1;{colour}m{word}\x1b[0m:", said)
        for environment in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertNotIn("\x1b", self.plan(ROBOT1, 80, **environment)[0])
        self.assertIn("\x1b", self.plan(ROBOT1, 80, NO_COLOR="")[0])

    def test_a_pipe_gets_no_colour(self):
        said = run(TAUT, "plan", ROBOT1, "--out", self.path("out"), env={**os.environ, "TERM": "xterm"})
        self.assertNotIn("\x1b", said.stdout)

    def test_the_result_begins_with_the_verdict_and_the_reports_numbers(self):
        planned = run(TAUT, "plan", ROBOT1, "--out", self.path("out")).stdout.splitlines()
        begin = next(k for k, line in enumerate(planned) if line.startswith("PROVED: the path is wrench-feasible"))
        self.assertTrue(planned[0].startswith("Load: "), "what was understood comes before")
        report = run(TAUT, "report", self.path("out", "certificate.json"), "--json")
        shown = json.loads(report.stdout)["key_numbers"]
        self.assertEqual([number["title"] for number in shown], NUMBERS)
        for number, line in zip(shown, planned[begin + 1:]):
            self.assertEqual(re.split(r"  +", line.strip()), [number["title"], number["value"], number["detail"]])
        text = run(TAUT, "report", self.path("out", "certificate.json"), "--text").stdout
        self.assertTrue(text.startswith("PROVED: Everywhere on this move"), text[:80])

    def test_a_text_report_is_wrapped_on_a_terminal_only(self):
        run(TAUT, "plan", GUST, "--out", self.path("out"))
        certificate = self.path("out", "certificate.json")
        said, code = on_terminal(TAUT, "report", certificate, "--text", columns=72)
        self.assertEqual(code, 0)
        self.assertTrue(said.startswith("\x1b[1;31mREFUTED - DO NOT RUN\x1b[0m: "), said[:60])
        for line in ESCAPE.sub("", said).splitlines():
            self.assertTrue(len(line) <= 72 or " " not in line.strip(), line)
        piped = run(TAUT, "report", certificate, "--text").stdout
        self.assertEqual(run(TAUT, "report", certificate, "--text", "--out", self.path("report.txt")).returncode, 0)
        with open(self.path("report.txt"), encoding="utf-8") as file:
            self.assertEqual(file.read(), piped)

    def test_what_is_not_proved_says_so_first(self):
        said = run(TAUT, "plan", NO_PATH, "--out", self.path("none")).stdout
        self.assertRegex(said, r"(?m)^(REFUTED - DO NOT RUN|NO PATH FOUND|UNDECIDED - NO DECISION): ")
        self.assertNotIn("PROVED", said)
        unchecked = run(TAUT, "plan", ROBOT1, "--out", self.path("unchecked"), "--max-seconds", "0").stdout
        self.assertRegex(unchecked, r"(?m)^UNCHECKED: nothing was proved")
        self.assertNotIn("PROVED", unchecked)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests through the command line share."""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TAUT, CHECK, SOURCE = sys.argv[1:4]
CASES = os.path.join(SOURCE, "cases")
AUDITS = os.path.join(CASES, "audits")
ROBOT1 = os.path.join(CASES, "robot1-slice-qs-qg.yaml")
EXIT = {"proved": 0, "refuted": 1, "undecided": 2, "no path": 1}


def run(*arguments, **options):
    return subprocess.run(list(arguments), capture_output=True, text=True, timeout=300, check=False, **options)


def interrupt(process, after):
    """Sends Ctrl-C's signal, so many seconds after the process has begun to heed it.

    On a busy machine that may take a while.
    """
    def heeds():
        with open(f"/proc/{process.pid}/status", encoding="utf-8") as file:
            caught = re.search(r"^SigCgt:\s*(\w+)", file.read(), re.M).group(1)
        return int(caught, 16) >> (signal.SIGINT - 1) & 1

    while process.poll() is None and not heeds():
        time.sleep(0.01)
    time.sleep(after)
    if process.poll() is not None:
        raise AssertionError(f"it should take longer than {after} s")
    process.send_signal(signal.SIGINT)


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def expected(case):
    """The verdict that a case declares."""
    return re.search(r"^expect:\s*(?:\{verdict:\s*)?(no path|\w+)", text_of(case), re.M).group(1)


class InFolder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.out = directory.name
        self.addCleanup(directory.cleanup)

    def path(self, *parts):
        return os.path.join(self.out, *parts)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def certificate(self, folder="."):
        return json.loads(text_of(self.path(folder, "certificate.json")))


class Audits(InFolder):
    def audit(self, case, path, *options, out="out"):
        result = run(TAUT, "audit", case, path, "--out", self.path(out), "--json", *options)
        self.assertIn(result.returncode, (0, 1, 2), result.stderr)
        summary = json.loads(result.stdout)
        self.assertEqual(result.returncode, EXIT[summary["verdict"]])
        return summary

    def certificate(self, out="out"):
        return json.loads(text_of(self.path(out, "certificate.json")))


def certify(case, out):
    """Plans a case, or audits it where it is one of cases/audits, without a report and without asking for headroom."""
    command = "audit" if case.startswith(AUDITS + os.sep) else "plan"
    return run(TAUT, command, case, "--out", out, "--no-report", "--headroom", "0")


def main():
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)

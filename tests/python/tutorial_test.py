#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial runs and draws. Usage: tutorial_test.py SOURCE_DIR, with the module in PYTHONPATH."""
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = sys.argv[1]


class Tutorial(unittest.TestCase):
    def test_runs_and_draws(self):
        with tempfile.TemporaryDirectory() as out:
            said = subprocess.run([sys.executable, os.path.join(SOURCE, "python", "examples", "tutorial.py"),
                                   os.path.join(SOURCE, "cases", "robot1-slice-qs-qg.yaml"), out],
                                  capture_output=True, text=True, check=False, timeout=250)
            self.assertEqual(said.returncode, 0, said.stderr)
            for line in ("<taut.Certificate proved", "checker: ", "<taut.Certificate refuted", "not proved from",
                         "and back: proved"):
                self.assertIn(line, said.stdout)
            for name in ("plan.png", "audit.png"):
                with open(os.path.join(out, name), "rb") as file:
                    self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
                self.assertGreater(os.path.getsize(os.path.join(out, name)), 10_000)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""./taut-python finds the module of its tree, from any folder and without a path set by hand.

Usage: wrapper_test.py SOURCE_DIR, of which ./test has built build/release
"""
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.abspath(sys.argv[1])


class Wrapper(unittest.TestCase):
    def test_the_module_is_found(self):
        clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        with tempfile.TemporaryDirectory() as elsewhere:
            said = subprocess.run([os.path.join(SOURCE, "taut-python"), "-B", "-c",
                                   "import taut; print(taut.__file__)"],
                                  cwd=elsewhere, env=clean, capture_output=True, text=True, check=False, timeout=280)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertTrue(said.stdout.startswith(os.path.join(SOURCE, "build", "release", "python", "taut")), said.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

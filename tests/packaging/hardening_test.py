#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is linked: hardened as a distribution's packages are, and of the library its interface only is seen.

Usage: hardening_test.py BUILD_DIR PROGRAM… LIBRARY
"""
import json
import os
import subprocess
import sys
import unittest

BUILD, *PROGRAMS = sys.argv[1:]


def readelf(*arguments):
    return subprocess.run(["readelf", "--wide", *arguments], capture_output=True, text=True, check=True,
                          timeout=60).stdout


class Hardening(unittest.TestCase):
    def test_programs_are_loaded_anywhere_and_sealed(self):
        for program in PROGRAMS:
            with self.subTest(program):
                self.assertRegex(readelf("--file-header", program), r"Type:\s+DYN ")
                segments = readelf("--program-headers", program)
                self.assertIn("GNU_RELRO", segments)
                self.assertNotRegex(segments, r"GNU_STACK.* RWE ")
                self.assertRegex(readelf("--dynamic", program), r"\(FLAGS(_1)?\).*NOW")

    def test_programs_guard_the_stack(self):
        for program in PROGRAMS:
            with self.subTest(program):
                self.assertIn("__stack_chk_fail", readelf("--dyn-syms", program))

    def test_all_sources_are_compiled_so(self):
        with open(os.path.join(BUILD, "compile_commands.json"), encoding="utf-8") as file:
            commands = json.load(file)
        self.assertGreater(len(commands), 50)
        for entry in commands:
            for option in ("-fstack-protector-strong", "-fcf-protection", "-D_FORTIFY_SOURCE=2"):
                self.assertIn(option, entry["command"].split(), entry["file"])

    def test_the_library_shows_its_interface_only(self):
        self.assertRegex(readelf("--dynamic", PROGRAMS[-1]), r"SONAME.*\[libtaut\.so\.0\.1\]")
        symbols = subprocess.run(["nm", "-D", "-C", "--defined-only", PROGRAMS[-1]], capture_output=True, text=True,
                                 check=True, timeout=60).stdout.splitlines()
        names = sorted({line.split(None, 2)[2] for line in symbols})
        self.assertTrue(any("taut::v0::plan(" in name for name in names))
        # Whoever changes this list changes the ABI, and with it the minor version (docs/library.md).
        with open(os.path.join(os.path.dirname(__file__), "symbols.txt"), encoding="utf-8") as file:
            self.assertEqual(names, file.read().splitlines())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

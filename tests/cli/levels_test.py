#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""TAUT_SIMD: proofs are the same with all vector instructions that this processor has, and other values are refused.

Usage: levels_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os

from command_line import ROBOT1, TAUT, InFolder, main, run

FLAGS = {"sse2": "sse2", "avx2": "avx2", "avx512": "avx512f"}


def levels():
    """Those that this processor has."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        flags = next(line for line in file if line.startswith("flags")).split()
    return [level for level, flag in FLAGS.items() if flag in flags]


def run_with(level, *arguments):
    return run(TAUT, *arguments, env={**os.environ, "TAUT_SIMD": level})


class Levels(InFolder):
    def certificate(self, level, case):
        said = run_with(level, "plan", case, "--out", self.path(level))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        with open(self.path(level, "certificate.json"), "rb") as file:
            return file.read()

    def test_plans_and_their_certificates_are_the_same(self):
        first, *others = levels()
        certificate = self.certificate(first, ROBOT1)
        for level in others:
            self.assertEqual(self.certificate(level, ROBOT1), certificate, level)

    def test_maps_are_the_same(self):
        first, *others = levels()

        def said_of_map(level):
            told = run_with(level, "map", ROBOT1, "--undecided", "5 %", "--json")
            self.assertEqual(told.returncode, 0, told.stderr)
            return {key: value for key, value in json.loads(told.stdout).items() if not key.endswith("_seconds")}

        known = said_of_map(first)
        for level in others:
            self.assertEqual(said_of_map(level), known, level)

    def test_other_values_are_refused(self):
        said = run_with("mmx", "map", ROBOT1)
        self.assertEqual((said.returncode, said.stdout), (3, ""))
        self.assertIn("TAUT_SIMD: got 'mmx', expected sse2, avx2 or avx512", said.stderr)


if __name__ == "__main__":
    main()

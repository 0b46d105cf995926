#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is compiled for AVX2 or AVX-512 shares no function with the rest, and fuses nothing.

The linker keeps one of several functions of one name. If it kept one that was compiled for AVX-512, a processor without
it would run it. So the objects of certify/lanes define nothing for others but their table of kernels.

Usage: lanes_symbols_test.py LIBRARY
"""
import re
import subprocess
import sys
import unittest

LIBRARY = sys.argv.pop()
REGISTER = {"sse2": "%xmm", "avx2": "%ymm", "avx512": "%zmm"}
TABLE = {"sse2": "kSse2Kernels", "avx2": "kAvx2Kernels", "avx512": "kAvx512Kernels"}


def output_by_member(*command):
    """{"sse2": lines, ...} of a tool that is given the library."""
    result, level = {}, None
    for line in subprocess.run([*command, LIBRARY], check=True, capture_output=True, text=True).stdout.splitlines():
        if member := re.match(r"(.*\.o):", line):
            found = re.match(r"level_(\w+)\.cc", member.group(1))
            level = found.group(1) if found else None
        elif level is not None:
            result.setdefault(level, []).append(line)
    return result


class Lanes(unittest.TestCase):
    def test_each_level_exports_its_table_alone(self):
        symbols = output_by_member("nm", "--defined-only", "--demangle")
        self.assertEqual(set(symbols), set(TABLE))
        for level, lines in symbols.items():
            shared = [line.split(maxsplit=2)[2] for line in lines if line and not line.split()[1].islower()]
            weak = [line for line in lines if line and line.split()[1] in "wWvVu"]
            self.assertEqual(shared, [f"taut::lanes::{TABLE[level]}"])
            self.assertEqual(weak, [])

    def test_each_level_uses_its_registers_and_fuses_nothing(self):
        code = output_by_member("objdump", "--disassemble", "--no-show-raw-insn")
        self.assertEqual(set(code), set(REGISTER))
        for level, lines in code.items():
            text = "\n".join(lines)
            self.assertIn(REGISTER[level], text)
            self.assertNotRegex(text, r"\tv?fn?m(add|sub)")
        self.assertNotRegex("\n".join(code["sse2"]), "%[yz]mm")
        self.assertNotIn("%zmm", "\n".join(code["avx2"]))


if __name__ == "__main__":
    unittest.main()

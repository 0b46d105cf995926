#!/usr/bin/env python3
"""Manual pages and completions name just the options that the programs have.

Usage: surface_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import os
import re
import subprocess
import sys
import unittest

TAUT, CHECK, SOURCE = sys.argv[1:4]
PACKAGING = os.path.join(SOURCE, "packaging")


def text_of(*parts):
    with open(os.path.join(PACKAGING, *parts), encoding="utf-8") as file:
        return file.read()


def options_of(*command):
    said = subprocess.run([*command, "--help"], capture_output=True, text=True, check=True, timeout=60).stdout
    return set(re.findall(r"^ +(?:-\w,)?(--[\w-]+)", said, re.M))


def commands():
    said = subprocess.run([TAUT, "--help"], capture_output=True, text=True, check=True, timeout=60).stdout
    return re.findall(r"^  (\w+) ", said[said.index("Subcommands:"):], re.M)


def completions(program, *words):
    script = ('source "$1"; COMP_WORDS=("${@:3}"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "$2"; '
              'printf "%s\\n" "${COMPREPLY[@]}"')
    function = "_" + program.replace("-", "_")
    said = subprocess.run(["bash", "-c", script, "bash", os.path.join(PACKAGING, "completion", program), function,
                           program, *words], capture_output=True, text=True, check=True, timeout=60).stdout
    return set(said.split())


def in_page(text):
    return set(re.findall(r"^\.(?:B|BI|BR) .*?(--[\w-]+)", text.replace("\\-", "-"), re.M))


class Surface(unittest.TestCase):
    def test_commands(self):
        self.assertEqual(completions("taut", ""), set(commands()) | {"--help", "--version"})
        page = text_of("taut.1")
        for command in commands():
            self.assertIn(f".B {command}\n", page)
            self.assertIn(f".SS taut {command}\n", page)

    def test_options_of_taut(self):
        sections = dict(re.findall(r"^\.SS taut (\w+)\n(.*?)(?=^\.S[SH])", text_of("taut.1"), re.M | re.S))
        for command in commands():
            with self.subTest(command):
                options = options_of(TAUT, command)
                self.assertIn("--help", options)
                self.assertEqual(completions("taut", command, "--"), options)
                self.assertEqual(in_page(sections[command]), options - {"--help"})

    def test_options_of_taut_check(self):
        options = options_of(CHECK)
        self.assertEqual(completions("taut-check", "--"), options)
        self.assertEqual(in_page(text_of("taut-check.1")), options)

    def test_laws_are_completed(self):
        self.assertEqual(completions("taut", "audit", "--interpolation", ""), {"straight", "geodesic", "cable-lengths"})

    def test_pages_are_well_formed(self):
        for page in ("taut.1", "taut-check.1"):
            said = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z",
                                   os.path.join(PACKAGING, page)], capture_output=True, text=True, timeout=60,
                                  check=False)
            self.assertEqual((said.returncode, said.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Manual pages and completions name just the options that the programs have; packages say whose works are in them.

Usage: surface_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import tomllib
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


class Packages(unittest.TestCase):
    def test_pyproject_agrees_with_cmake(self):
        with open(os.path.join(SOURCE, "pyproject.toml"), "rb") as file:
            project = tomllib.load(file)
        build = project["tool"]["scikit-build"]
        lists = {folder: text_of("..", folder, "CMakeLists.txt") for folder in (".", "python", "packaging")}
        version = build["metadata"]["version"]
        self.assertEqual(project["project"]["dynamic"], ["version"])
        found = re.search(version["regex"], text_of("..", version["input"]))
        said = subprocess.run([TAUT, "--version"], capture_output=True, text=True, check=True, timeout=60).stdout
        self.assertEqual(said, f"taut {found.group('value')}\n")
        self.assertIn(f'DESCRIPTION "{project["project"]["description"]}"', lists["."])
        for name in build["cmake"]["define"]:
            self.assertTrue(name.startswith("CMAKE_") or
                            re.search(rf"(option|set)\({name} ", "".join(lists.values())), name)
        for component in build["install"]["components"]:
            self.assertRegex(lists["packaging"], rf"COMPONENT {component}\b")
        for target in build["build"]["targets"]:
            self.assertIn(f"install(TARGETS {target} ", lists["packaging"])
        for folder in build["wheel"]["packages"]:
            self.assertTrue(os.path.exists(os.path.join(SOURCE, folder, "__init__.py")))
        for file in [project["project"]["readme"], *build["wheel"]["license-files"]]:
            self.assertTrue(os.path.exists(os.path.join(SOURCE, file)), file)

    def test_the_bill_of_materials_names_what_the_script_contains(self):
        with tempfile.TemporaryDirectory() as folder:
            bills = []
            for name in ("a.json", "b.json"):
                path = os.path.join(folder, name)
                subprocess.run([os.path.join(SOURCE, "scripts", "sbom"), path], check=True, timeout=60,
                               env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})
                with open(path, encoding="utf-8") as file:
                    bills.append(file.read())
        self.assertEqual(*bills)
        bill = json.loads(bills[0])
        self.assertEqual((bill["spdxVersion"], bill["creationInfo"]["created"]), ("SPDX-2.3", "2023-11-14T22:13:20Z"))
        packages = {package["name"]: package for package in bill["packages"]}
        lock = json.loads(text_of("..", "package-lock.json"))["packages"]
        for name in ("three", "@observablehq/plot", "d3"):
            self.assertEqual(packages[name]["versionInfo"], lock[f"node_modules/{name}"]["version"])
            self.assertEqual(packages[name]["licenseDeclared"], lock[f"node_modules/{name}"]["license"])
        self.assertEqual(packages["inter-ui"]["licenseDeclared"], "OFL-1.1")
        for name in ("esbuild", "subset-font", "harfbuzzjs"):
            self.assertNotIn(name, packages)
        identifiers = {package["SPDXID"] for package in bill["packages"]} | {"SPDXRef-DOCUMENT"}
        self.assertEqual(len(identifiers), len(bill["packages"]) + 1)
        for relation in bill["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, identifiers)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

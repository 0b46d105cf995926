#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs taut into a folder of its own, and builds and runs what uses it: the examples, and a program on its layers.

Usage: library_test.py BUILD_DIR SOURCE_DIR TAUT_CHECK
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, CHECK = sys.argv[1:4]
CASE = os.path.join(SOURCE, "cases", "robot1-slice-qs-qg.yaml")


def run(*command, **options):
    said = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, **options)
    if said.returncode not in (0, 1):
        raise AssertionError(f"{command}: {said.returncode}\n{said.stdout}\n{said.stderr}")
    return said


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = os.path.join(cls.folder, "prefix")
        for component in ("libtaut", "libtaut-dev"):
            run("cmake", "--install", BUILD, "--prefix", cls.prefix, "--component", component)
        # Somewhere else: nothing installed may remember where it was.
        moved = os.path.join(cls.folder, "moved")
        os.rename(cls.prefix, moved)
        cls.prefix = moved

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def build(self, source):
        shutil.copytree(source, self.path(os.path.basename(source)))
        build = self.path(os.path.basename(source), "build")
        said = run("cmake", "-G", "Ninja", "-S", self.path(os.path.basename(source)), "-B", build,
                   "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        said = run("cmake", "--build", build, "--parallel", "2")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        return build

    def test_examples(self):
        build = self.build(os.path.join(SOURCE, "examples"))
        said = run(os.path.join(build, "plan_and_prove"), CASE, self.folder)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("there and back: proved", said.stdout)
        certificate = self.path("certificate.json")
        with open(certificate, encoding="utf-8") as file:
            self.assertEqual(json.load(file)["verdict"], "proved")
        self.assertEqual(run(CHECK, certificate, CASE).returncode, 0)
        self.assertTrue(os.path.getsize(self.path("report.html")) > 10_000)
        said = run(os.path.join(build, "check_certificate"), certificate, CASE)
        self.assertEqual((said.returncode, said.stdout[:9]), (0, "accepted:"))
        said = run(os.path.join(build, "audit_table"), CASE)
        self.assertEqual(said.returncode, 1)
        self.assertRegex(said.stdout, r"not proved from segment .* (tension_\w+ of cable \d|singular)")

    def test_layers(self):
        build = self.build(os.path.join(SOURCE, "tests", "packaging", "layers"))
        said = run(os.path.join(build, "layers"), CASE)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_pkg_config(self):
        folder = os.path.dirname(next(os.path.join(root, "taut.pc") for root, _, files in os.walk(self.prefix)
                                      if "taut.pc" in files))
        said = run("pkg-config", "--cflags", "--libs", "taut", env={**os.environ, "PKG_CONFIG_PATH": folder})
        program = self.path("program")
        run("c++", "-std=c++20", "-o", program, os.path.join(SOURCE, "examples", "check_certificate.cc"),
            *said.stdout.split())
        library = re.search(r"-L(\S+)", said.stdout).group(1)
        said = run(program, CASE, CASE, env={**os.environ, "LD_LIBRARY_PATH": library})
        self.assertEqual(said.returncode, 1)
        self.assertIn("not accepted", said.stdout)

    def test_another_minor_version_is_refused(self):
        with open(self.path("CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write("cmake_minimum_required(VERSION 3.16)\nproject(other LANGUAGES NONE)\n"
                       "find_package(taut 0.2 REQUIRED)\n")
        said = subprocess.run(["cmake", "-S", self.folder, "-B", self.path("other"),
                               f"-DCMAKE_PREFIX_PATH={self.prefix}"], capture_output=True, text=True, check=False)
        self.assertNotEqual(said.returncode, 0)
        self.assertIn("0.1.0", said.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

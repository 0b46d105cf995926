#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents keep their word: every command in them runs and ends as they say, and every link leads somewhere.

Commands are the lines of ```sh blocks. One that ends otherwise than with 0 says so: "# exits with 1".

Usage: documents_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TAUT, CHECK, SOURCE = (os.path.abspath(argument) for argument in sys.argv[1:4])
DOCUMENTS = [os.path.join(SOURCE, "README.md")] + sorted(glob.glob(os.path.join(SOURCE, "docs", "*.md")))
NOT_HERE = ("./test", "bench/run", "scripts/")  # CI runs them: here they would run themselves


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def commands(text):
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S):
        for line in block.replace("\\\n", "").splitlines():  # a backslash continues a line
            command, _, comment = line.partition(" #")
            if not command.strip() or command.startswith("#") or command.startswith(NOT_HERE):
                continue
            expected = re.search(r"exits with (\d)", comment)
            yield command.strip(), int(expected.group(1)) if expected else 0


def cases_for(document):
    """regress.md speaks of anyone's folder of cases: the tutorial's will do. .ci/run runs all cases."""
    return os.path.join(SOURCE, "cases", *(["tutorial"] if os.path.basename(document) == "regress.md" else []))


def without_times(text):
    return re.sub(r"[\d.]+ ms", "… ms", text).strip()


class Documents(unittest.TestCase):
    def test_every_command_runs(self):
        count = 0
        for document in DOCUMENTS:
            with tempfile.TemporaryDirectory() as folder:
                os.symlink(cases_for(document), os.path.join(folder, "cases"))
                for name, program in (("taut", TAUT), ("taut-check", CHECK)):
                    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                        file.write(f'#!/bin/sh\nexec "{program}" "$@"\n')
                    os.chmod(os.path.join(folder, name), 0o755)
                for command, expected in commands(text_of(document)):
                    with self.subTest(document=os.path.basename(document), command=command):
                        ran = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True,
                                             timeout=280, check=False)
                        self.assertEqual(ran.returncode, expected, ran.stdout + ran.stderr)
                    count += 1
        self.assertGreater(count, 12)

    def test_every_source_states_its_licence(self):
        sources = (".cc", ".h", ".h.in", ".py", ".js", ".mjs", ".css", ".cmake", ".cmake.in", ".sh", "CMakeLists.txt")
        count = 0
        for folder, folders, files in os.walk(SOURCE):
            folders[:] = [name for name in folders
                          if name not in ("build", "node_modules", "out", ".git", "__pycache__")]
            for path in (os.path.join(folder, name) for name in files):
                with open(path, "rb") as file:
                    beginning = file.read(200)
                if path.endswith(sources) or beginning.startswith(b"#!"):
                    count += 1
                    self.assertIn(b"SPDX-License-Identifier: GPL-3.0-or-later", beginning, path)
        self.assertGreater(count, 300)

    def test_the_workflows_commands_run(self):
        """Beside a folder cases, with taut's sources in taut/."""
        for workflow in sorted(glob.glob(os.path.join(SOURCE, "docs", "ci", "*.yml"))):
            run = re.findall(r"^ *- (?:run: )?(taut/taut .*)$", text_of(workflow), re.M)
            self.assertEqual(len(run), 1, workflow)
            with self.subTest(os.path.basename(workflow)), tempfile.TemporaryDirectory() as folder:
                shutil.copytree(os.path.join(SOURCE, "cases", "tutorial"), os.path.join(folder, "cases"))
                os.mkdir(os.path.join(folder, "taut"))
                for name, program in (("taut", TAUT), ("taut-check", CHECK)):
                    os.symlink(program, os.path.join(folder, "taut", name))
                path = os.path.join(folder, "taut") + os.pathsep + os.environ["PATH"]
                ran = subprocess.run(["sh", "-c", run[0]], cwd=folder, capture_output=True, text=True, timeout=280,
                                     check=False, env={**os.environ, "PATH": path})
                self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
                self.assertIn("<testsuite", text_of(os.path.join(folder, "taut.xml")), "what the workflow keeps")

    def test_the_readme_shows_what_is_printed(self):
        shown = re.search(r"It prints\n\n```\n(.*?)```", text_of(DOCUMENTS[0]), re.S).group(1)
        case = re.search(r"^\./taut plan (\S+)", text_of(DOCUMENTS[0]), re.M).group(1)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(os.path.join(SOURCE, "cases"), os.path.join(folder, "cases"))
            said = subprocess.run([TAUT, "plan", case], cwd=folder, capture_output=True, text=True, timeout=280,
                                  check=True)
        self.assertEqual(without_times(said.stdout), without_times(shown))

    def test_every_link_leads_somewhere(self):
        count = 0
        for document in DOCUMENTS + glob.glob(os.path.join(SOURCE, "bench", "*.md")):
            for target in re.findall(r"\]\(([^)\s]+)\)", text_of(document)):
                if target.startswith(("http:", "https:", "mailto:")):
                    continue
                path, _, anchor = target.partition("#")
                file = os.path.normpath(os.path.join(os.path.dirname(document), path)) if path else document
                with self.subTest(document=os.path.basename(document), link=target):
                    self.assertTrue(os.path.exists(file))
                    if anchor:
                        heads = re.findall(r"^#+ +(.*)$", text_of(file), re.M)
                        anchors = {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}
                        self.assertIn(anchor, anchors)
                count += 1
        self.assertGreater(count, 40)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""No include and no link runs up: every room uses only the rooms that docs/architecture.md allows it; and no two files
define types of one name, of which the linker would take one.

Usage: layers_test.py SOURCE_DIR
"""
import os
import re
import sys
import unittest

SOURCE = os.path.abspath(sys.argv[1])
NOT_PRODUCT = {"bench", "build", "node_modules", "out", "tests"}
# Targets that are not called after their room.
TARGETS = {"taut": "cli", "taut_shared": "api", "taut::taut": "api/taut", "taut-check": "checker/taut_check.cc",
           "taut_python": "python"}
# Flags for the compiler, which are no room.
FLAGS = {"taut_common", "taut_rounding"}


def text_of(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def allowed_rooms():
    """{room: rooms that it may use}, from the lowest room to the highest."""
    block = re.search(r"^```rooms\n(.*?)^```", text_of("docs/architecture.md"), re.M | re.S).group(1)
    result = {}
    for line in re.sub(r"\n +", " ", block).splitlines():
        room, _, used = line.partition(":")
        result[room] = used.replace("nothing", "").split()
    return result


ALLOWED = allowed_rooms()


def room_of(path):
    """The longest listed room that holds a file; the path itself where none does."""
    rooms = [room for room in ALLOWED if path == room or os.path.dirname(path) == room]
    return max(rooms, key=len) if rooms else path


def wrong_includes(path, text):
    """The includes of a file's text that its room is not allowed."""
    room = room_of(path)
    own = {room, os.path.dirname(path)}
    included = re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.M)
    included += ["api/" + header for header in re.findall(r"^\s*#\s*include\s*<(taut/[^>]+)>", text, re.M)]
    return [f"{path}: {header}" for header in included if room_of(header) not in own | set(ALLOWED.get(room, []))]


def used_by(folder):
    """All that the rooms in a folder may use, as folders: what its target may link to."""
    rooms = [room for room in ALLOWED if room.split("/")[0] == folder and not room.endswith(".cc")]
    return {used.split("/")[0] for room in rooms for used in ALLOWED[room]}


def wrong_links(path, text):
    """The links of targets in a CMakeLists.txt that their room is not allowed."""
    result = []
    for target, links in re.findall(r"target_link_libraries\(\s*(\S+)([^)]*)\)", text):
        room = TARGETS.get(target, re.sub("^taut_", "", target))
        may = {used.split("/")[0] for used in ALLOWED[room]} if room in TARGETS.values() else used_by(room)
        for link in re.findall(r"(?<!\S)taut[-_:]\S*", links):
            if link in FLAGS:
                continue
            used = TARGETS.get(link, re.sub("^taut(_|::)", "", link)).split("/")[0]
            if used not in may and used != room.split("/")[0]:
                result.append(f"{path}: {target} to {link}")
    return result


def product_files(endings):
    for folder, folders, files in os.walk(SOURCE):
        top = os.path.relpath(folder, SOURCE)
        if top == ".":
            folders[:] = [name for name in folders if name not in NOT_PRODUCT and not name.startswith(".")]
        for name in files:
            if name.endswith(endings):
                yield os.path.relpath(os.path.join(folder, name), SOURCE)


def types_of(text):
    """The types that a file defines with external linkage, each with its namespace; but for those inside of others."""
    result, namespaces = [], []
    for line in text.splitlines():
        opened = re.match(r"(?:inline )?namespace ([\w:]*) *\{", line)
        if opened:
            namespaces.append(opened.group(1))
        elif line.startswith("}  // namespace") and namespaces:
            namespaces.pop()
        defined = re.match(r"(?:struct|class|enum class) (\w+) *(?:\{|:(?!:)|final)", line)
        if defined and "" not in namespaces:
            result.append("::".join([*namespaces, defined.group(1)]))
    return result


class Layers(unittest.TestCase):
    def test_rooms_use_lower_rooms_only(self):
        below = set()
        for room, used in ALLOWED.items():
            self.assertEqual(set(used) - below, set(), room)
            below.add(room)

    def test_rooms_are_the_folders_with_sources(self):
        sources = list(product_files((".h", ".cc")))
        self.assertEqual({os.path.dirname(path) for path in sources},
                         {os.path.dirname(room) if room.endswith(".cc") else room for room in ALLOWED})
        for room in ALLOWED:
            self.assertTrue(os.path.exists(os.path.join(SOURCE, room)), room)

    def test_no_include_runs_up(self):
        files = list(product_files((".h", ".cc")))
        self.assertGreater(len(files), 200)
        self.assertEqual([wrong for path in files for wrong in wrong_includes(path, text_of(path))], [])

    def test_no_link_runs_up(self):
        files = [path for path in product_files("CMakeLists.txt")
                 if path.count("/") and not path.startswith("examples")]
        links = [text_of(path) for path in files]
        self.assertGreater(sum(text.count("target_link_libraries") for text in links), 14)
        self.assertEqual([wrong for path, text in zip(files, links) for wrong in wrong_links(path, text)], [])

    def test_no_type_is_defined_twice(self):
        types = [name for path in product_files((".h", ".cc")) for name in types_of(text_of(path))]
        self.assertGreater(len(types), 300)
        self.assertEqual(sorted({name for name in types if types.count(name) > 1}), [])
        text = "namespace taut {\nstruct A {\n};\nnamespace {\nstruct B {\n};\n}  // namespace\nclass C : A {\n};\n"
        self.assertEqual(types_of(text + "struct C::D {\n};\n}  // namespace taut\nstruct E final\n"),
                         ["taut::A", "taut::C", "E"])

    def test_what_is_not_allowed_is_found(self):
        def include(path, header):
            return wrong_includes(path, f"#pragma once\n  # include {header}\n")

        self.assertEqual(include("base/files.h", '"cli/console.h"'), ["base/files.h: cli/console.h"])
        self.assertEqual(include("checker/check.cc", '"case/case_file.h"'), ["checker/check.cc: case/case_file.h"])
        self.assertEqual(include("checker/check.cc", '"../certify/margin.h"'),
                         ["checker/check.cc: ../certify/margin.h"])
        self.assertEqual(include("certify/motion/motion.h", '"certify/box_proof.h"'),
                         ["certify/motion/motion.h: certify/box_proof.h"])
        self.assertEqual(include("kinematics/model.h", "<taut/taut.h>"), ["kinematics/model.h: api/taut/taut.h"])
        self.assertEqual(include("checker/taut_check.cc", '"case/case_file.h"'), [])
        self.assertEqual(include("checker/taut_check.cc", '"checker/check.h"'), [])
        for target, link in (("taut_checker", "taut_case"), ("taut-check", "taut_certify"),
                             ("taut_atlas", "taut::certify"), ("taut_python", "taut_app")):
            self.assertEqual(wrong_links("there", f"target_link_libraries({target}\n  PUBLIC taut_common {link})"),
                             [f"there: {target} to {link}"])
        self.assertEqual(wrong_links("there", "target_link_libraries(taut-check PRIVATE taut_checker taut_case)"), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

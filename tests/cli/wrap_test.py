#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`taut wrap`: a closed mesh around meshes that are not closed, cross themselves or have many parts.

Usage: wrap_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import os
import random
import re

from command_line import CASES, InFolder, TAUT, main, run, text_of

BOX = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # corner k has k's bits


def box(lower, upper, first=0, faces=BOX):
    """The lines of an OBJ file, whose corners begin with number first + 1."""
    corners = [[(upper if k >> axis & 1 else lower)[axis] for axis in range(3)] for k in range(8)]
    return "".join("v %r %r %r\n" % tuple(map(float, c)) for c in corners) + "".join(
        "f %s\n" % " ".join(str(first + k + 1) for k in face) for face in faces)


def read_obj(text):
    points, faces = [], []
    for line in text.splitlines():
        word, *rest = line.split()
        if word == "v":
            points.append([float(x) for x in rest])
        else:
            faces.append([int(x) - 1 for x in rest])
    return points, faces


def winding(points, faces, p):
    """How often the faces wind around p: crossings of a slanted ray, by the signs of integers' determinants."""
    far = (0.8341, 0.5177, 0.1933)
    det = lambda a, b, c: (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0]))
    count = 0
    for face in faces:
        a, b, c = ([x - y for x, y in zip(points[k], p)] for k in face)
        signs = [det(far, *pair) > 0 for pair in ((a, b), (b, c), (c, a))]
        if len(set(signs)) == 1 and (det(a, b, c) > 0) == signs[0]:
            count += 1 if signs[0] else -1
    return count


class Wrap(InFolder):
    def wrap(self, text, *options, out="wrap.obj", name="soup.obj", code=0):
        source = self.path(name)
        with open(source, "w", encoding="ascii") as f:
            f.write(text)
        done = run(TAUT, "wrap", source, "--out", self.path(out), *options)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        return done

    def expect_inside(self, points, out="wrap.obj"):
        corners, faces = read_obj(text_of(self.path(out)))
        edges = [tuple(face[k - 1:k + 1]) if k else (face[-1], face[0]) for face in faces for k in range(3)]
        self.assertEqual(len(edges), len(set(edges)))
        self.assertEqual({(b, a) for a, b in edges}, set(edges), "not closed")
        for p in points:
            self.assertNotEqual(winding(corners, faces, p), 0, p)
        return corners, faces

    def test_a_box_without_a_lid_is_closed(self):
        done = self.wrap(box((0, 0, 0), (2, 1, 1), faces=BOX[1:]), "--alpha", "1.5")
        self.assertIn("not closed: 4 edges of one triangle", done.stdout)
        self.assertIn("all of the mesh is inside", done.stdout)
        self.expect_inside([(0, 0, 0), (2, 1, 1), (1, 0.5, 0.5), (2, 0, 0.5)])

    def test_parts_and_crossings_are_inside(self):
        soup = box((0, 0, 0), (1, 1, 1)) + box((0.5, 0.5, 0.5), (2, 2, 2), 8) + box((5, 5, 5), (5.2, 6, 6), 16)
        self.wrap(soup)
        corners, faces = self.expect_inside([(1, 1, 1), (0, 0, 0), (2, 2, 2), (5, 5, 5), (5.2, 6, 6)])
        self.assertEqual(winding(corners, faces, (4, 4, 4)), 0)

    def test_random_soups_of_triangles_are_inside(self):
        draw = random.Random(1)
        for trial in range(4):
            points = [tuple(draw.uniform(-1, 1) for _ in range(3)) for _ in range(36)]
            text = "".join("v %r %r %r\n" % p for p in points) + "".join(
                "f %d %d %d\n" % (k + 1, k + 2, k + 3) for k in range(0, 36, 3))
            self.wrap(text, "--alpha", "0.2", "--offset", "0.01")
            self.expect_inside(points)

    def test_every_format_says_the_same(self):
        sizes = []
        for out in ("w.obj", "w.ply", "w.stl"):
            sizes.append(re.search(r"Written: .*?, (\d+) triangles", self.wrap(
                box((0, 0, 0), (2, 1, 1)), out=out).stdout.replace("\n", " ")).group(1))
            again = run(TAUT, "wrap", self.path(out), "--out", self.path("again.obj"))
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn(sizes[-1] + " triangles, 1 part that hang", again.stdout)
            self.assertIn("edges, closed", again.stdout.replace("\n ", ""))
        self.assertEqual(len(set(sizes)), 1)

    def test_a_case_takes_a_wrap_where_its_mesh_is_open(self):
        self.wrap(box((-0.02, -0.02, -0.02), (0.02, 0.02, 0.02), faces=BOX[1:]), "--alpha", "0.03", name="tool.obj",
                  out="wrapped.obj")
        case = text_of(os.path.join(CASES, "robot1-slice-qs-qg.yaml")) + (
            "bodies:\n  clearance: 1 mm\n  platform:\n  - {name: tool, mesh: %s, unit: m}\n  obstacles:\n"
            "  - {name: wall, half_space: {point: [0, 0, -1], normal: [0, 0, 1]}}\n")
        for mesh, said in (("tool.obj", "not watertight"), ("wrapped.obj", "watertight, 1 closed part")):
            with open(self.path("case.yaml"), "w", encoding="utf-8") as f:
                f.write(case % mesh)
            shown = run(TAUT, "show", self.path("case.yaml"))
            self.assertEqual(shown.returncode, 0, shown.stderr)
            self.assertIn(said, " ".join(shown.stdout.split()))

    def test_what_is_not_inside_is_not_written(self):
        # CGAL passes over faces without an area.
        for needle, message in ((((5, 5, 5), (6, 6, 6)), "a part of the mesh is outside of it"),
                                (((0, 0, 0), (6, 6, 6)), "it meets the mesh")):
            text = box((0, 0, 0), (1, 1, 1)) + "".join("v %r %r %r\n" % p for p in needle) + "f 9 10 10\n"
            done = self.wrap(text, code=3)
            self.assertIn("the wrap was not written: " + message, " ".join(done.stderr.split()))
            self.assertFalse(os.path.exists(self.path("wrap.obj")))

    def test_bad_input_writes_nothing(self):
        good = box((0, 0, 0), (2, 1, 1))
        for text, options, message in (
                ("", (), "got '"),
                (good.replace("2.0", "nan"), (), "got '"),
                ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", (), "expected a mesh"),
                (good, ("--alpha", "0"), "a number above 0"),
                (good, ("--alpha", "nan"), "a number above 0"),
                (good, ("--offset", "-1"), "a number above 0"),
                (good, ("--offset", "1e300"), "--offset: got 1e+300, expected"),
                (good, ("--alpha", "1e-9"), "--alpha: got 1e-09, expected")):
            done = self.wrap(text, *options, code=3)
            self.assertIn(message, " ".join(done.stderr.split()), (text[:20], options))
            self.assertFalse(os.path.exists(self.path("wrap.obj")))
        self.assertIn("--out: got", self.wrap(good, out="wrap.off", code=3).stderr)
        self.assertIn("expected another", self.wrap(good, out="soup.obj", code=3).stderr)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies from case to report and taut-check: what a mesh contains, and what people are told of what is not checked."""
import copy
import hashlib
import html
import json
import os
import re
import struct
import sys
import unittest

from command_line import CASES, CHECK, TAUT, InFolder, run, text_of

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def box(half, at=(0, 0, 0)):
    """12 triangles."""
    corners = [tuple(at[k] + half[k] * c[k] for k in range(3)) for c in CORNERS]
    return [(corners[a], corners[b], corners[c]) for p, q, r, s in FACES for a, b, c in ((p, q, r), (p, r, s))]


def stl(triangles, more=b""):
    pieces = [struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in corner), 0) for triangle in triangles]
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(pieces) + more


def stated_first(page):
    """What the first page says the verdict is about."""
    stated = re.search(r'<dl class="scope">.*?</dl>', page, re.S).group(0)
    return html.unescape(re.sub(r"<[^>]*>", "", stated)).replace("\u00a0", " ")


class Tutorial(InFolder):
    def test_its_bodies_are_proved_clear_and_a_higher_rack_is_hit(self):
        tutorial = text_of(os.path.join(os.path.dirname(CASES), "docs", "tutorial.md"))
        bodies = re.search(r"```yaml\n(bodies:\n.*?)```", tutorial, re.S).group(1)
        self.assertEqual(run(TAUT, "init", self.path("crane.yaml")).returncode, 0)
        crane = text_of(self.path("crane.yaml"))
        higher = bodies.replace("1800], at: [900, 900, 900]", "2500], at: [900, 900, 1250]")
        self.assertNotEqual(higher, bodies)
        for stated, code, expected in (
                (bodies, 0, r"(?s)PROVED: .*keep\s+their\s+clearances\."),
                (higher, 1, r"waypoint\s+0\s+of\s+the\s+query\s+cable\s+2\s+and\s+'rack'")):
            said = run(TAUT, "plan", self.write("case.yaml", crane + stated), "--out", self.path("out"))
            self.assertEqual(said.returncode, code, said.stdout + said.stderr)
            self.assertRegex(said.stdout, expected)


class ExitConesAlone(InFolder):
    def test_the_verdict_and_taut_check_say_what_is_checked(self):
        bodies = os.path.join(CASES, "bodies")
        case = text_of(os.path.join(bodies, "exit-cone-left.yaml"))
        case = self.write("case.yaml", case.replace("half_angle: 20", 'half_angle: "60 + 10^17 - 10^17"'))
        said = run(TAUT, "audit", case, os.path.join(bodies, "exit-cone-left.csv"), "--out", self.path("out"))
        self.assertRegex(said.stdout, r"(?s)PROVED: .*;\s+cables\s+that\s+have\s+exit\s+cones\s+stay\s+in\s+them\.")
        self.assertNotIn("checked bodies", said.stdout)
        checked = run(CHECK, self.path("out", "certificate.json"))
        self.assertEqual(checked.returncode, 0, checked.stdout)
        for expected in ("bodies: no class of pairs is checked; cable 5 in a cone of half-angle 60 degrees",
                         ". NOT CHECKED: platform-obstacles; cables-obstacles; cables-cables; cables-platform"):
            self.assertIn(expected, checked.stdout)


class MeshFolder(InFolder):
    """The slit's tool in the middle of a rock, of which the nearest surface is far away."""

    def audit(self, rock, out="out", edit=lambda text: text, code=None):
        case = text_of(os.path.join(CASES, "bodies", "slit-wider.yaml"))
        case = re.sub(r"  obstacles:\n(    - .*\n)+", "  obstacles: [{name: rock, mesh: rock.stl, unit: m}]\n", case)
        case = self.write("case.yaml", edit(case))
        with open(self.path("rock.stl"), "wb") as file:
            file.write(rock)
        said = run(TAUT, "audit", case, os.path.join(CASES, "bodies", "slit.csv"), "--out", self.path(out))
        if code is not None:
            self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return said


class Meshes(MeshFolder):
    def test_a_closed_mesh_is_solid_wherever_a_part_of_it_is(self):
        rocks = {"box": box((9, 9, 9)),
                 "overlapping boxes": box((9, 9, 9)) + box((9, 9, 9), (1, 1, 1)),
                 "a box in a box": box((9, 9, 9)) + box((12, 12, 12)),
                 "a box in a box, turned inside out":
                     box((12, 12, 12)) + [(a, c, b) for a, b, c in box((9, 9, 9))]}
        for name, rock in rocks.items():
            with self.subTest(rock=name):
                said = self.audit(stl(rock), code=1)
                self.assertIn("rock", said.stdout)
                checked = run(CHECK, self.path("out", "certificate.json"))
                self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_of_an_open_mesh_everybody_says_that_only_the_surface_is_checked(self):
        for name, rock in {"a hole": box((9, 9, 9))[:-1],
                           "a stray triangle": box((9, 9, 9)) + [((40, 0, 0), (41, 0, 0), (40, 1, 0))]}.items():
            with self.subTest(rock=name):
                self.assertIn("only its surface is checked", self.audit(stl(rock), code=0).stdout)
                certificate = self.path("out", "certificate.json")
                checked = run(CHECK, certificate)
                self.assertIn("only the surface of rock.stl was checked, a mesh without an inside", checked.stdout)
                text = run(TAUT, "report", certificate, "--text").stdout
                self.assertIn("it has no inside: only its surface is checked", text)
                page = text_of(self.path("out", "report.html"))
                self.assertTrue("Only the surface is checked, not what is inside, of 'rock'" in stated_first(page))
                self.assertTrue("what is inside of 'rock', whose surface is not closed" in html.unescape(page))

    def test_another_mesh_is_refused(self):
        self.audit(stl(box((9, 9, 9), (0, 0, 40))), code=0)
        certificate = self.path("out", "certificate.json")
        self.assertEqual(run(CHECK, certificate).returncode, 0)
        with open(self.path("out", "rock.stl"), "wb") as file:
            file.write(stl(box((9, 9, 8), (0, 0, 40))))
        self.assertNotEqual(run(CHECK, certificate).returncode, 0)

    def test_a_certificate_leads_to_no_mesh_outside_of_the_folders(self):
        self.audit(stl(box((9, 9, 9), (0, 0, 40))), code=0)
        with open(self.path("out", "certificate.json"), encoding="utf-8") as file:
            certificate = json.load(file)
        os.mkdir(self.path("other"))
        elsewhere = self.path("rock.stl")
        self.assertTrue(os.path.exists(elsewhere))
        os.remove(self.path("out", "rock.stl"))
        for name in ("../rock.stl", elsewhere, "../out/../rock.stl"):
            certificate["problem"]["bodies"]["obstacles"][0]["mesh"]["file"] = name
            certificate["problem_sha256"] = digest(certificate["problem"])
            with open(self.path("out", "certificate.json"), "w", encoding="utf-8") as file:
                file.write(sealed(certificate))
            checked = run(CHECK, self.path("out", "certificate.json"), "--meshes", self.path("other"))
            self.assertEqual(checked.returncode, 3, checked.stdout + checked.stderr)
            self.assertIn("there is no file of this name", checked.stderr)

    def test_a_file_that_holds_more_than_it_says_is_refused(self):
        rock = box((9, 9, 9), (0, 0, 40))
        for file in (stl(rock)[:-1], stl(rock, b"\0"), stl(rock, stl(rock)[84:134])):
            said = self.audit(file, code=3)
            self.assertIn("case.yaml:", said.stderr)
            self.assertIn("no whole", said.stderr)
            self.assertFalse(os.path.exists(self.path("out")))


def digest(value):
    """Of its canonical JSON."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()


def sealed(certificate):
    """With the digest of what it says."""
    certificate = copy.deepcopy(certificate)
    footer = certificate.pop("footer")
    footer["sha256"] = digest(certificate)
    return json.dumps({**certificate, "footer": footer}, sort_keys=True)


def altered(value):
    """Other values in place of one."""
    if isinstance(value, str):
        yield from ("1e-9", "7") if re.fullmatch(r"[-+.e\d]+", value) else (value + "x", "")
    elif isinstance(value, list):
        yield value[:-1]
        yield value + value[-1:]
        for k, part in enumerate(value):
            yield from (value[:k] + [other] + value[k + 1:] for other in altered(part))
    elif isinstance(value, int):
        yield value + 1
    elif isinstance(value, dict):
        for key, part in value.items():
            yield {k: v for k, v in value.items() if k != key}
            yield from ({**value, key: other} for other in altered(part))


class Altered(MeshFolder):
    """Whatever bodies a certificate states in place of the case's, taut-check refuses it with the case: even where what
    it says of them is true."""

    def expect_refused(self, least):
        certificate = json.loads(text_of(self.path("out", "certificate.json")))
        altered_file, case = self.path("out", "altered.json"), self.path("case.yaml")

        def check(bodies):
            certificate["problem"]["bodies"] = bodies
            with open(altered_file, "w") as file:
                file.write(sealed(certificate))
            return run(CHECK, altered_file, case)

        stated = certificate["problem"]["bodies"]
        said = check(stated)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        count = 0
        for bodies in altered(stated):
            if bodies == stated:
                continue
            self.assertNotEqual(check(bodies).returncode, 0, bodies)
            count += 1
        self.assertGreater(count, least)

    def test_bodies_are_the_cases(self):
        case = self.write("case.yaml", text_of(os.path.join(CASES, "bodies", "slit-wider.yaml")))
        said = run(TAUT, "audit", case, os.path.join(CASES, "bodies", "slit.csv"), "--out", self.path("out"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.expect_refused(100)

    def test_meshes_are_the_cases(self):
        self.audit(stl(box((9, 9, 9), (0, 0, 40))), code=0)
        self.expect_refused(40)

    def test_contacts_and_exit_cones_are_the_cases(self):
        text = text_of(os.path.join(CASES, "bodies", "slit-wider.yaml")).replace("space:", """\
  contacts:
  - {pair: [tool, left wall], at: [0, 0, 6], within: 0.5, depth: 1 mm}
  - {pair: [right wall, tool], at: [1, 0, 6], within: 0.5, depth: 2 mm}
  exit_cones:
  - {cable: 1, end: base, axis: [-15, -10, -10], half_angle: 60}
  - {cable: 5, end: platform, axis: [0, -1, 1], half_angle: 70}
space:""")
        said = run(TAUT, "audit", self.write("case.yaml", text), os.path.join(CASES, "bodies", "slit.csv"), "--out",
                   self.path("out"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.expect_refused(140)


class ContactsAndCones(InFolder):
    """A container that stands on the floor, and whose cables lean as far as their sheaves swivel."""

    LIFT = text_of(os.path.join(CASES, "cranes", "portal-20t-lift.yaml"))
    AUDIT = re.sub(r"query:.*", "audit: {path: path.csv}\n", LIFT, flags=re.S)

    def audit(self, edit=lambda text: text, to=4, code=None):
        path = self.write("path.csv", "px[m],py[m],pz[m],phi[deg],theta[deg],sigma[deg]\n"
                                      "-4,0,3.5,0,0,0\n-4,0,%s,0,0,0\n" % to)
        said = run(TAUT, "audit", self.write("case.yaml", edit(self.AUDIT)), path, "--out", self.path("out"))
        if code is not None:
            self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        return " ".join(said.stdout.split())

    def test_a_load_may_touch_what_it_stands_on_and_nowhere_else(self):
        self.audit(code=0)
        stated = stated_first(text_of(self.path("out", "report.html")))
        self.assertIn("These may touch: 'container' and 'floor', up to 25 mm deep, while the platform's origin is "
                      "within 300 mm of (\u22124, 0, 3.5) m;", " ".join(stated.split()))
        checked = run(CHECK, self.path("out", "certificate.json"), self.path("case.yaml"))
        self.assertEqual(checked.returncode, 0, checked.stdout)
        said = self.audit(lambda text: text.replace("within: 300 mm", "within: 100 mm"), code=1)
        self.assertIn("'container' and 'floor' are nearer to each other, or deeper in each other, than the case allows",
                      said)
        self.audit(lambda text: re.sub(r"  contacts:.*?  exit_cones:", "  exit_cones:", text, flags=re.S), code=1)

    def test_a_depth_has_to_take_up_what_tolerances_may_move_the_load_by(self):
        self.assertNotIn("PROVED", self.audit(lambda text: text.replace("depth: 25 mm", "depth: 15 mm"), code=2))

    def test_a_cable_may_lean_as_far_as_its_cone(self):
        said = self.audit(lambda text: text.replace("half_angle: 35", "half_angle: 20"), code=1)
        self.assertRegex(said, "cable 6 leaves its exit cone at the base")
        self.assertIn("cable 5 at the base, 20° around (0, 10, -10)", said)


class Clearances(InFolder):
    def audit(self, edit):
        case = edit(text_of(os.path.join(CASES, "bodies", "slit-wider.yaml")))
        return run(TAUT, "audit", self.write("case.yaml", case), os.path.join(CASES, "bodies", "slit.csv"), "--out",
                   self.path("out"))

    def test_the_first_page_names_the_least_one_of_a_class(self):
        said = self.audit(lambda text: text.replace("  platform:", "  pair_clearances: [{pair: [tool, left wall], "
                                                                   "clearance: 0}]\n  platform:"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("2 pairs, 0 m to 0.1 mm, as some have their own",
                      stated_first(text_of(self.path("out", "report.html"))))

    def test_some_class_of_pairs_is_checked(self):
        said = self.audit(lambda text: text.replace("  platform:", "  pairs: []\n  platform:"))
        self.assertEqual(said.returncode, 3)
        self.assertIn("bodies.pairs: got an empty list, expected one class of pairs or more", said.stderr)
        self.assertFalse(os.path.exists(self.path("out")))


class Planning(InFolder):
    """Around the post of robot2-sphere-post, in spaces of other kinds, and along a spline."""

    POST = text_of(os.path.join(CASES, "bodies", "robot2-sphere-post.yaml"))
    BODIES = re.search(r"^bodies:\n(?:  .*\n)+", POST, re.M).group(0)
    OBSTACLES = re.compile(r"^  obstacles:\n(?:    - .*\n)+  pair_clearances:\n(?:    - .*\n)+", re.M)

    def plan(self, text, out):
        """Plans a case and has its certificate checked."""
        said = run(TAUT, "plan", self.write(f"{out}.yaml", text), "--out", self.path(out))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        checked = run(CHECK, self.path(out, "certificate.json"))
        self.assertEqual(checked.returncode, 0, checked.stdout)
        return said.stdout

    def require_a_way_around(self, free, around):
        """The path that is planned without the obstacles is refuted with them; the one planned with them is proved."""
        self.plan(free, "free")
        audited = run(TAUT, "audit", self.write("audited.yaml", around), self.path("free", "path.csv"), "--out",
                      self.path("audited"))
        self.assertEqual(audited.returncode, 1, audited.stdout + audited.stderr)
        self.assertIn("'pin' and 'post'", audited.stdout)
        self.assertIn("platform and obstacles, 4 pairs", self.plan(around, "around"))

    def with_bodies(self, case):
        text = text_of(os.path.join(CASES, case))
        return text, text.replace("\nspace:", f"\n{self.BODIES}space:", 1)

    def test_on_a_constraint(self):
        self.require_a_way_around(*self.with_bodies("robot2-implicit-sphere-q1-q2-q3.yaml"))

    def test_on_a_surface_of_three_parameters(self):
        self.require_a_way_around(*self.with_bodies("robot2-sphere-sigma-free-q2-q3.yaml"))

    def test_along_a_spline(self):
        around = self.POST.replace("epsilon: 0.15}", "epsilon: 0.15, smooth: spline}")
        self.require_a_way_around(self.OBSTACLES.sub("", around), around)
        self.assertTrue(text_of(self.path("around", "path.csv")).startswith("control_point,"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut plan where no path exists: verdict, files, certificate; and taut-check on altered certificates.

Usage: no_path_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import copy
import functools
import hashlib
import json
import os
import tempfile

from command_line import CASES, CHECK, ROBOT1, TAUT, InFolder, main, run, text_of

APART = os.path.join(CASES, "maps", "robot1-sigma34-apart.yaml")
BAR = os.path.join(CASES, "maps", "robot1-bar-apart.yaml")  # with bodies
LETTERS = "ABCDEFGHIJKLabcdefghijklmnopqrstuvwx"


def digest(value):
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def sealed(certificate):
    """With the digests and the count that belong to the rest."""
    certificate["problem_sha256"] = digest(certificate["problem"])
    certificate.pop("footer", None)
    certificate["footer"] = {"nodes": len(certificate["map"]["tree"]), "sha256": digest(certificate)}
    return certificate


@functools.cache
def planned(case):
    """The certificate of the case; not to be altered in place."""
    with tempfile.TemporaryDirectory() as out:
        said = run(TAUT, "plan", case, "--out", out)
        assert said.returncode == 1, said.stdout + said.stderr
        return json.loads(text_of(os.path.join(out, "certificate.json")))


def subtree(tree, node):
    """The end of the part of a tree that begins at a node."""
    open_ends = 1
    while open_ends:
        open_ends += 1 if tree[node] in "012" else -1
        node += 1
    return node


class Altered(InFolder):
    CASE = APART

    @property
    def certificate(self):
        return planned(self.CASE)

    def check(self, certificate, *arguments):
        file = self.write("mutant.json", json.dumps(certificate, sort_keys=True))
        return run(CHECK, file, *arguments)

    def assert_outcome(self, certificate, outcome, *arguments):
        said = self.check(certificate, *arguments)
        self.assertEqual((said.stdout + said.stderr).split(":")[0], outcome, said.stdout + said.stderr)
        return said

    def with_tree(self, tree):
        mutant = copy.deepcopy(self.certificate)
        mutant["map"]["tree"] = tree
        return sealed(mutant)

    def changed(self, change):
        mutant = copy.deepcopy(self.certificate)
        change(mutant)
        return sealed(mutant)


class NoPath(Altered):
    # ---- taut plan ---------------------------------------------------------------------------------------------------

    def test_what_plan_says_and_writes(self):
        out = self.path("out")
        said = run(TAUT, "plan", APART, "--out", out)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn("NO PATH EXISTS: no motion of the coordinates within their ranges leads from waypoint 0 of the "
                      "query to waypoint 1", " ".join(said.stdout.split()))
        self.assertEqual(sorted(os.listdir(out)), ["certificate.json", "report.html"])
        page = text_of(os.path.join(out, "report.html"))
        for expected in ("NO PATH EXISTS", "there is no continuous motion", "From one part of a slice to another",
                         "Robot 1 (reconstructed)", "phi = −1.8413 rad, theta = 1.3422 rad", "every tilt",
                         "pz = 350 mm, sigma = 0.5934 rad", "Every tension above 0.05 N and below 0.5 N",
                         'class="wall-tension"', 'class="from-start"', 'class="from-goal"', ">goal</text>"):
            self.assertIn(expected, page)
        self.assertNotIn("<script", page)
        checked = run(CHECK, os.path.join(out, "certificate.json"), APART, "--expect", "no path")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertIn("no path exists from waypoint 0 of the query to waypoint 1", checked.stdout)
        report = run(TAUT, "report", os.path.join(out, "certificate.json"), "--text")
        self.assertTrue(report.stdout.startswith("NO PATH EXISTS: "), report.stdout + report.stderr)
        self.assertIn("Title: From one part of a slice to another, Robot 1", report.stdout)

    def test_what_was_not_checked_is_not_drawn(self):
        file = self.write("certificate.json", json.dumps(self.certificate, sort_keys=True))
        said = run(TAUT, "report", file, "--max-seconds", "0", "--out", self.path("page.html"))
        self.assertEqual(said.returncode, 2, said.stdout + said.stderr)
        page = text_of(self.path("page.html"))
        self.assertIn("UNCHECKED", page)
        for claimed in ("NO PATH EXISTS", 'class="wall-tension"', "What is claimed"):
            self.assertNotIn(claimed, page)

    def test_cells_too_fine_to_be_drawn_are_said_to_be_joined(self):
        tree = self.certificate["map"]["tree"]
        run(TAUT, "plan", os.path.join(CASES, "maps", "robot2-sphere-apart.yaml"), "--out", self.path("coarse"))
        self.assertIn("edges are edges of cells. What has no colour",
                      text_of(self.path(os.path.join("coarse", "report.html"))))
        wall = next(n for n, c in enumerate(tree) if c.isalpha())
        halved = "0" * 11 + tree[wall] * 12  # the halves of a cell have its reason
        page = self.page_of(self.with_tree(tree[:wall] + halved + tree[wall + 1:]))
        self.assertIn("Where cells are narrower than 1/2048 of an axis, a place of that width has the colour of one of "
                      "them: of a wall, if there is one.", page)

    def page_of(self, certificate):
        said = run(TAUT, "report", self.write("drawn.json", json.dumps(certificate, sort_keys=True)), "--out",
                   self.path("drawn.html"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        return text_of(self.path("drawn.html"))

    def test_a_report_of_free_text_that_is_none(self):
        def odd(c):
            c["generator"] = {"name": 7}

        def hostile(c):
            c["generator"] = {"name": "<script>alert(1)</script>"}
            c["illustration"] = ["<b>", {"units": 3}]
        file = self.write("odd.json", json.dumps(self.changed(odd), sort_keys=True))
        said = run(TAUT, "report", file, "--out", self.path("page.html"))
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertIn("generator.name", said.stderr)
        file = self.write("hostile.json", json.dumps(self.changed(hostile), sort_keys=True))
        said = run(TAUT, "report", file, "--out", self.path("page.html"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        self.assertIn("&lt;script&gt;alert(1)", text_of(self.path("page.html")))
        self.assertNotIn("<script", text_of(self.path("page.html")))

    def test_json(self):
        said = run(TAUT, "plan", APART, "--out", self.path("out"), "--json")
        self.assertEqual(said.returncode, 1)
        found = json.loads(said.stdout)
        self.assertEqual((found["verdict"], found["no_path"]["answer"]), ("no path", "apart"))
        self.assertEqual((found["margins"], found["witness"], found["length_m"]), ({}, None, None))

    def test_it_need_not_be_tried(self):
        said = run(TAUT, "plan", APART, "--out", self.path("out"), "--no-path", "0")
        self.assertEqual(said.returncode, 2)
        self.assertIn("NO PATH FOUND", said.stdout)

    def test_an_open_map_says_where(self):
        """Too short a time for a map: what is open is said."""
        said = run(TAUT, "plan", APART, "--out", self.path("out"), "--no-path", "0.000001")
        self.assertEqual(said.returncode, 2)
        words = " ".join(said.stdout.split())
        self.assertIn("did not show whether a path exists from waypoint 0 of the query to 1", words)
        self.assertRegex(words, r"the middle one at phi = \S+ rad \(± \S+ rad\), theta = ")

    def test_map_writes_the_certificate(self):
        said = run(TAUT, "map", APART, "--undecided", "1%", "--out", self.path("map"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(sorted(os.listdir(self.path("map"))), ["certificate.json", "map.svg"])
        checked = run(CHECK, self.path("map", "certificate.json"), APART, "--expect", "no path")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        self.assertEqual(run(TAUT, "map", ROBOT1, "--undecided", "5%", "--out", self.path("joined")).returncode, 0)
        self.assertEqual(os.listdir(self.path("joined")), ["map.svg"])

    def test_regress(self):
        for name in ("robot1-sigma34-apart", "robot1-sigma10-joined"):
            case = os.path.join(CASES, "maps", name + ".yaml")
            said = run(TAUT, "regress", case, "--out", self.path(name))
            self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    # ---- Altered certificates ----------------------------------------------------------------------------------------

    def test_it_is_accepted_as_it_is(self):
        self.assert_outcome(self.certificate, "accepted")
        self.assert_outcome(sealed(copy.deepcopy(self.certificate)), "accepted", APART)

    def test_reasons(self):
        tree = self.certificate["map"]["tree"]
        walls = [n for n, c in enumerate(tree) if c.isalpha()]
        self.assertGreater(len(walls), 300)
        for node in walls[::len(walls) // 12]:
            for what in self.other_sides(tree[node]):
                self.assert_outcome(self.with_tree(tree[:node] + what + tree[node + 1:]), "rejected")

    @staticmethod
    def other_sides(letter):
        """The same cable beyond its other limit, and a length in place of a tension: both false."""
        n = LETTERS.index(letter)
        return {LETTERS[n ^ 1], LETTERS[n % 12]} - {letter}

    def test_cells_without_their_reasons(self):
        """Any run of the wall that is left out lets the flood through."""
        tree = self.certificate["map"]["tree"]
        walls = [n for n, c in enumerate(tree) if c.isalpha()]
        run_length = 12
        for begin in range(0, len(walls) - run_length, len(walls) // 10):
            dropped = set(walls[begin:begin + run_length])
            self.assert_outcome(self.with_tree("".join("." if n in dropped else c for n, c in enumerate(tree))),
                                "rejected")
        self.assert_outcome(self.with_tree("."), "rejected")

    def test_all_is_said_to_be_outside(self):
        for letter in "Aam":
            self.assert_outcome(self.with_tree(letter), "rejected")
        open_too = self.certificate["map"]["tree"].replace(".", "a")
        self.assert_outcome(self.with_tree(open_too), "rejected")

    def test_nodes(self):
        tree = self.certificate["map"]["tree"]
        inner = [n for n, c in enumerate(tree) if c in "01" and subtree(tree, n) - n > 60]
        for node in inner[::max(1, len(inner) // 6)]:
            flipped = "1" if tree[node] == "0" else "0"
            self.assert_outcome(self.with_tree(tree[:node] + flipped + tree[node + 1:]), "rejected")
            middle, end = subtree(tree, node + 1), subtree(tree, node)
            swapped = tree[:node + 1] + tree[middle:end] + tree[node + 1:middle] + tree[end:]
            self.assert_outcome(self.with_tree(swapped), "rejected")

    def test_trees_that_are_none(self):
        tree = self.certificate["map"]["tree"]
        for text in ("", tree[:-1], tree + ".", tree.replace(".", "y", 1), "2" + tree + ".", tree.replace(".", " ", 1)):
            self.assert_outcome(self.with_tree(text), "malformed")

    def test_the_problem(self):
        """What was proved of one problem does not hold of others; and with the case, no other is accepted."""
        def waypoint(n, *to):
            return lambda c: c["problem"]["query"]["waypoints"].__setitem__(n, list(to))
        goal = self.certificate["problem"]["query"]["waypoints"][1]

        def loosened(c):
            c["problem"]["robot"]["tension_N"] = [["0.0001", "5"]] * 6

        def calm(c):
            c["problem"]["load"]["wrench"] = ["0", "0", "0.5", "0", "0", "0"]

        def turned(c):
            c["problem"]["space"]["pose"]["sigma"] = "(10)*pi/180"

        def no_flip(c):
            c["problem"]["space"]["flip"] = None
        changes = (waypoint(0, *goal), waypoint(1, "-2.3", "1.6"), loosened, turned, no_flip)
        for change in changes:
            self.assert_outcome(self.changed(change), "rejected")
        # With half the load the same cables go slack: it is true of that problem as well, but not of the case.
        for change in (*changes, calm):
            said = self.assert_outcome(self.changed(change), "rejected", APART)
            self.assertIn("another problem", said.stdout)

    def test_periodicity(self):
        """Without its period phi is a range with walls: another problem, whose wall at the ends nothing proves."""
        def walled(c):
            c["problem"]["space"]["flip"] = None
            c["problem"]["space"]["parameters"] = [
                {"name": "phi", "kind": "range", "range": ["-pi", "pi"]},
                {"name": "theta", "kind": "range", "range": ["0", "pi"]}]
        self.assertIn("another problem", self.assert_outcome(self.changed(walled), "rejected", APART).stdout)

        def narrowed(c):
            walled(c)
            c["problem"]["space"]["parameters"][0]["range"] = ["-3", "3"]
        self.assert_outcome(self.changed(narrowed), "rejected")

        def unbounded(c):
            c["problem"]["space"]["flip"] = None
            c["problem"]["space"]["pose"]["px"] = "phi/10"
            c["problem"]["space"]["parameters"][0]["kind"] = "real"
        self.assert_outcome(self.changed(unbounded), "malformed")

    def test_form(self):
        def put(*path):
            *keys, last, value = path

            def change(c):
                for key in keys:
                    c = c[key]
                c[last] = value
            return change
        for change in (put("version", 2), put("verdict", "proved"), put("claim", "No path exists."),
                       put("waypoints", [1, 2]), put("waypoints", [0, 0]), put("waypoints", [0]),
                       put("map", "bits", 31), put("map", "bits", 4097), put("map", "extra", 1), put("extra", 1),
                       put("format", "taut-certificate"), put("problem", "query", "waypoints", []),
                       put("problem", "space", "constraints", ["phi"])):
            self.assert_outcome(self.changed(change), "malformed")
        altered = copy.deepcopy(self.certificate)
        altered["map"]["tree"] = altered["map"]["tree"][:-1] + "B"
        self.assertIn("altered", self.assert_outcome(altered, "malformed").stderr)
        cut = copy.deepcopy(self.certificate)
        cut["footer"]["nodes"] += 1
        self.assert_outcome(cut, "malformed")

    def test_what_was_asked_for(self):
        self.assert_outcome(self.certificate, "rejected", "--expect", "proved")
        self.assert_outcome(self.certificate, "rejected", ROBOT1)
        self.assert_outcome(self.certificate, "unchecked", "--max-seconds", "0")
        path = self.write("path.csv", "phi[rad],theta[rad]\n0,1\n1,1\n")
        self.assert_outcome(self.certificate, "rejected", APART, "--path", path)


class Contact(Altered):
    """Where only an obstacle parts start and goal, a certificate of version 2."""
    CASE = BAR

    def contact_of(self, change):
        """With what each leaf of contact says changed: `change` is given a copy of its reason."""
        def apply(c):
            reasons = []
            for index in c["map"]["contact_of_leaf"]:
                reasons.append(copy.deepcopy(c["map"]["contacts"][index]))
                change(reasons[-1])
            c["map"]["contacts"] = reasons
            c["map"]["contact_of_leaf"] = list(range(len(reasons)))
        return self.changed(apply)

    def test_it_is_proved_and_drawn(self):
        out = self.path("out")
        said = run(TAUT, "plan", BAR, "--out", out)
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn("NO PATH EXISTS", said.stdout)
        page = text_of(os.path.join(out, "report.html"))
        for expected in ('class="wall-contact"', "two bodies are too near (proved)", "platform-obstacles"):
            self.assertIn(expected, page)
        checked = run(CHECK, os.path.join(out, "certificate.json"), BAR, "--expect", "no path")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_without_the_obstacle_there_is_a_path(self):
        text = text_of(BAR)
        bodies = text[text.index("bodies:"):text.index("space:")]
        free = self.write("free.yaml", text.replace(bodies, "").replace("expect: no path", "expect: proved"))
        said = run(TAUT, "regress", free, "--out", self.path("free"))
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_it_is_accepted_as_it_is(self):
        self.assertEqual(self.certificate["version"], 2)
        self.assertGreater(len(self.certificate["map"]["contact_of_leaf"]), 10)
        self.assert_outcome(self.certificate, "accepted", BAR)
        self.assert_outcome(self.contact_of(lambda reason: None), "accepted", BAR)

    def test_other_points_and_pairs(self):
        def other_pair(reason):
            reason["pair"] = 0 if reason["pair"] != 0 else 1

        def ends(reason):
            for points in reason["points"]:
                points[1].reverse()

        def far(reason):
            reason["points"] = [[["1", "0"], ["1", "0"]]]

        def same_four(reason):
            reason["points"] = reason["points"][:1] * 4
        self.assertGreater(len({tuple(map(str, c["points"])) for c in self.certificate["map"]["contacts"]}), 3)
        for change in (other_pair, ends, far, same_four):
            self.assert_outcome(self.contact_of(change), "rejected")

    def test_permuted_reasons(self):
        self.assert_outcome(self.changed(lambda c: c["map"]["contact_of_leaf"].reverse()), "rejected")
        self.assert_outcome(self.changed(lambda c: c["map"]["contacts"].reverse()), "rejected")

    def test_cells_without_their_reasons(self):
        tree = self.certificate["map"]["tree"]
        leaves = [n for n, c in enumerate(tree) if c == "y"]
        for k in range(0, len(leaves), max(1, len(leaves) // 8)):
            def opened(c, k=k):
                c["map"]["tree"] = tree[:leaves[k]] + "." + tree[leaves[k] + 1:]
                del c["map"]["contact_of_leaf"][k]
            # One thin wall: most of its cells are needed. What is still parted is still true.
            self.check(self.changed(opened))

        def all_opened(c):
            c["map"]["tree"] = tree.replace("y", ".")
            c["map"]["contact_of_leaf"] = []
        self.assert_outcome(self.changed(all_opened), "rejected")

    def test_contact_where_there_is_none(self):
        tree = self.certificate["map"]["tree"]
        for n in [n for n, c in enumerate(tree) if c == "."][::max(1, tree.count(".") // 6)]:
            def closed(c, n=n):
                c["map"]["tree"] = tree[:n] + "y" + tree[n + 1:]
                c["map"]["contact_of_leaf"].insert(tree[:n].count("y"), 0)
            self.assert_outcome(self.changed(closed), "rejected")
        self.assert_outcome(self.changed(
            lambda c: c["map"].update(tree="y", contact_of_leaf=[0])), "rejected")

    def test_the_problem(self):
        """Thinner bodies, smaller clearances and other places are other problems, in which these do not touch."""
        def bodies(change):
            return self.changed(lambda c: change(c["problem"]["bodies"]))

        def thinner(b):
            b["obstacles"][0]["hull"]["radius_m"] = "0.0001"

        def closer(b):
            b["clearance_m"] = {name: "0" for name in b["clearance_m"]}
            thinner(b)

        def moved(b):
            b["obstacles"][0]["at_m"] = ["0", "0", "0.1"]

        def turned(b):
            b["obstacles"][0]["rotation_rad"] = ["0.5", "0", "0"]

        def shorter(b):
            b["platform"][0]["hull"]["points_m"][1] = ["0", "0", "0.05"]
        for change in (thinner, closer, moved, turned, shorter):
            self.assert_outcome(bodies(change), "rejected")
        thick = self.changed(lambda c: c["problem"]["bodies"]["obstacles"][0]["hull"].update(radius_m="0.0061"))
        self.assertIn("another problem", self.assert_outcome(thick, "rejected", BAR).stdout)

    def test_form(self):
        def at_map(change):
            return self.changed(lambda c: change(c["map"]))

        def version(n):
            return self.changed(lambda c: c.update(version=n))

        def claim_of_less(c):
            c["claim"] = planned(APART)["claim"]

        def without_bodies(c):
            del c["problem"]["bodies"]
            c["version"] = 1
            claim_of_less(c)
        one = [["1", "0"], ["1", "0"]]
        for mutant in (version(1), version(3), self.changed(claim_of_less), self.changed(without_bodies),
                       at_map(lambda m: m.pop("contacts")), at_map(lambda m: m.pop("contact_of_leaf")),
                       at_map(lambda m: m["contact_of_leaf"].pop()), at_map(lambda m: m["contact_of_leaf"].append(0)),
                       at_map(lambda m: m["contact_of_leaf"].__setitem__(0, len(m["contacts"]))),
                       at_map(lambda m: m["contact_of_leaf"].__setitem__(0, -1)),
                       at_map(lambda m: m.update(tree=m["tree"].replace("y", "z"))),
                       self.contact_of(lambda r: r.update(pair=10 ** 6)), self.contact_of(lambda r: r.update(pair=-1)),
                       self.contact_of(lambda r: r.update(points=[])),
                       self.contact_of(lambda r: r.update(points=[one] * 2)),
                       self.contact_of(lambda r: r.update(points=[one] * 5)),
                       self.contact_of(lambda r: r.update(points=[[["1", "0"]]])),
                       self.contact_of(lambda r: r.update(points=[[["1", "1"], ["1", "0"]]])),
                       self.contact_of(lambda r: r.update(points=[[["2", "-1"], ["1", "0"]]])),
                       self.contact_of(lambda r: r.update(points=[[["1", "0", "0"], ["1", "0"]]])),
                       self.contact_of(lambda r: r.pop("pair")), self.contact_of(lambda r: r.update(extra=1))):
            self.assert_outcome(mutant, "malformed")


if __name__ == "__main__":
    main()

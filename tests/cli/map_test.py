#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""taut map: what it prints, its JSON and its picture; what it refuses.

Usage: map_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import ast
import json
import os
import re
import subprocess
import xml.etree.ElementTree as xml

from command_line import CASES, CHECK, ROBOT1, TAUT, InFolder, interrupt, main, run, text_of

SVG = "{http://www.w3.org/2000/svg}"


def read_npy(path):
    """The shape and the bytes of a .npy file of bytes."""
    with open(path, "rb") as file:
        content = file.read()
    assert content[:8] == b"\x93NUMPY\x01\x00"
    size = int.from_bytes(content[8:10], "little")
    assert (10 + size) % 64 == 0
    header = ast.literal_eval(content[10:10 + size].decode("ascii"))
    assert (header["descr"], header["fortran_order"]) == ("|u1", False)
    return header["shape"], content[10 + size:]


def corners_of(path):
    """The lines of an SVG path of absolute M and L."""
    return [[tuple(map(float, corner.split(","))) for corner in re.findall(r"[ML]?([-\d.]+,[-\d.]+)", line)]
            for line in re.findall(r"M[^M]+", path)]


def encloses(ring, point):
    """Whether a polygon has a point inside: by the crossings of a ray."""
    x, y = point
    return sum((y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0)
               for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1])) % 2 == 1


def signed_area(ring):
    assert ring[0] == ring[-1]
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(ring, ring[1:])) / 2


class Map(InFolder):
    def found(self, *arguments):
        said = run(TAUT, "map", *arguments, "--json")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        return json.loads(said.stdout)

    def test_the_slice_of_robot_1(self):
        found = self.found(ROBOT1)
        share = found["share"]
        self.assertEqual(sum(share[kind] for kind in ("inside", "tension", "length", "unbalanced", "undecided")), 1)
        self.assertLessEqual(share["undecided"], 0.01)
        # A raster has 49.55 % inside.
        self.assertLess(share["inside"], 0.4956)
        self.assertGreater(share["inside"] + share["undecided"], 0.4954)
        self.assertEqual((found["end"], found["connections"]), ("share", ["joined"]))
        self.assertEqual(found["inside"]["count"], len(found["inside"]["largest"]))
        self.assertEqual([axis["kind"] for axis in found["axes"]], ["turn", "tilt"])

    def test_text_restates_the_load_and_says_what_is_proved(self):
        said = run(TAUT, "map", ROBOT1, "--undecided", "5 %")
        self.assertEqual((said.returncode, said.stderr), (0, ""))
        for expected in ("Load: ", "phi from -3.1416 rad to 3.1416 rad, a whole turn", "which is every tilt",
                         "inside, proved", "outside, proved", "undecided", "from waypoint 0 to 1 of the query: joined"):
            self.assertIn(expected, said.stdout)

    def test_the_same_map_on_any_number_of_threads(self):
        def without_times(document):
            return {key: value for key, value in document.items() if not key.endswith("seconds")}
        one = without_times(self.found(ROBOT1, "--undecided", "0.03"))
        said = subprocess.run(["taskset", "-c", "0", TAUT, "map", ROBOT1, "--undecided", "0.03", "--json"],
                              capture_output=True, text=True, timeout=300, check=True)
        self.assertEqual(without_times(json.loads(said.stdout)), one)

    def test_waypoints_that_are_apart_or_infeasible(self):
        """The regions of Fig. 7: one at small tilts, and three more at large ones."""
        def connections(*waypoints):
            lines = "".join(f"    - {{phi: {phi}, theta: {theta}}}\n" for phi, theta in waypoints)
            changed, times = re.subn(r"(?<=waypoints:\n)(    - .*\n)+", lines, text_of(ROBOT1))
            self.assertEqual(times, 1)
            changed = re.sub(r"^expect:.*\n", "", changed, flags=re.M)
            return self.found(self.write("case.yaml", changed))["connections"]
        main_region, others = (-2.3, 1.6), [(-1.2, 2.0), (0.8, 1.8), (2.6, 2.6)]
        self.assertEqual(connections(main_region, others[0], others[1], others[2], others[0]), ["apart"] * 4)
        self.assertEqual(connections(main_region, (0.3, 1.5)), ["outside"])
        # Across phi = 180 degrees, and over theta = 0, beyond which phi is half a turn further.
        self.assertEqual(connections((3.1, 0.5), (-3.1, 0.5), (0.0, -0.5), (1.0, 0.0)), ["joined"] * 3)

    def test_the_picture_has_all_kinds_and_marks(self):
        said = run(TAUT, "map", ROBOT1, "--out", self.path("map"))
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(os.listdir(self.path("map")), ["map.svg"])
        picture = xml.fromstring(text_of(self.path("map", "map.svg")))
        classes = {path.get("class") for path in picture.iter(SVG + "path")}
        self.assertLessEqual({"inside", "tension", "unbalanced", "undecided", "cut-off", "singular"}, classes)
        self.assertNotIn("both", classes)
        texts = {text.text for text in picture.iter(SVG + "text")}
        self.assertLessEqual({"start", "goal", "phi [rad]", "theta [rad]", "encloses det J = 0"}, texts)

    def test_budgets_end_it(self):
        self.assertEqual(self.found(ROBOT1, "--budget", "0.001")["end"], "time")
        self.assertEqual(self.found(ROBOT1, "--cells", "10000")["end"], "cells")
        self.assertEqual(self.found(ROBOT1, "--cell", "0.02", "--undecided", "0.001")["end"], "width")

    def test_an_interruption_is_said(self):
        process = subprocess.Popen([TAUT, "map", os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml"),
                                    "--undecided", "0.001", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        interrupt(process, 0.5)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, err)
        self.assertEqual(json.loads(out)["error"]["code"], "U11")

    def test_three_coordinates(self):
        case = os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml")
        found = self.found(case, "--undecided", "60 %")
        self.assertEqual(len(found["axes"]), 3)
        self.assertGreater(found["share"]["inside"], 0)
        for option, reason in (("--polygons", "polygons are flat"), ("--path", "a flat picture"),
                               ("--atlas", "a flat picture")):
            said = run(TAUT, "map", case, option, self.path("x"))
            self.assertEqual(said.returncode, 3)
            self.assertIn("got a case with 3 free coordinates, expected two, because", said.stderr)
            self.assertIn(reason, said.stderr)
            self.assertFalse(os.path.exists(self.path("x")))

    def test_three_coordinates_end_at_a_million_cells(self):
        case = os.path.join(CASES, "maps", "robot1-orientations.yaml")
        said = run(TAUT, "map", case)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("there are as many cells as there may be", said.stdout)
        self.assertIn("Of three coordinates a map ends at 1000000 cells unless something else is asked for",
                      said.stdout)
        cells = int(re.search(r"^(\d+) cells from", said.stdout, re.M).group(1))
        self.assertGreater(cells, 990000)
        self.assertLessEqual(cells, 1000000)
        said = run(TAUT, "map", case, "--cells", "20000")
        self.assertIn("there are as many cells as there may be", said.stdout)
        self.assertNotIn("unless something else", said.stdout)

    def test_slices_of_three_coordinates(self):
        case = os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml")
        found = self.found(case, "--undecided", "50%", "--out", self.path("map"), "--grid", self.path("g.npy"),
                           "--grid-size", "20,10,30")
        self.assertEqual(os.listdir(self.path("map")), ["map.html"])
        page = text_of(self.path("map", "map.html"))
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S).group(1))
        self.assertEqual([axis["name"] for axis in data["axes"]], [axis["name"] for axis in found["axes"]])
        self.assertEqual(len(data["tree"]), 2 * found["cells"] - 1)
        shape, values = read_npy(self.path("g.npy"))
        self.assertEqual(shape, (20, 10, 30))
        inside = sum(value in (1, 3, 5) for value in values) / len(values)
        self.assertGreater(inside, 0)
        self.assertLessEqual(inside, found["share"]["inside"])

    def test_where_one_may_go(self):
        """From the main region of Fig. 7, and from one that is cut off from it."""
        main_region = self.found(ROBOT1)["region"]
        self.assertEqual(main_region, self.found(ROBOT1, "--from", "1")["region"] | {"start": main_region["start"]})
        island = self.found(ROBOT1, "--from", "phi: -1.2 rad, theta: 2")["region"]
        self.assertEqual(island["start"], "(phi: -1.2 rad, theta: 2)")
        degrees = self.found(ROBOT1, "--from", "{theta: 114.59 deg, phi: -68.75 deg}")["region"]
        self.assertEqual(degrees["reachable"], island["reachable"])
        for region in (main_region, island):
            self.assertEqual(region["reachable"] + region["open"] + region["cut_off"], 1)
            self.assertLess(region["open"], 0.005)
        self.assertAlmostEqual(main_region["reachable"], 0.355, delta=0.002)
        self.assertAlmostEqual(island["reachable"], 0.0596, delta=0.002)
        outside = self.found(ROBOT1, "--from", "phi: 0.3, theta: 1.5")["region"]
        self.assertTrue(outside["starts_outside"])
        self.assertEqual((outside["reachable"], outside["cut_off"]), (0, 1))
        said = run(TAUT, "map", ROBOT1, "--from", "phi: 0.3, theta: 1.5").stdout
        self.assertIn("nowhere: it is itself infeasible (proved)", said)
        self.assertIn("reachable, proved", run(TAUT, "map", ROBOT1, "--undecided", "5%").stdout)

    def test_starts_that_are_none(self):
        for start, expected in (("2", "got '2', expected a waypoint of the query, from 0 to 1, or coordinates"),
                                ("phi: 1", "--from:1:1: got no 'theta', expected the key 'theta'"),
                                ("phi: 1, theta: 2 mm", "--from:1:17: theta: got '2 mm', expected"),
                                ("phi: 1, beta: 2", "beta"), ("phi 1", "expected"), ("{phi: [", "expected"),
                                ("}", "--from")):
            said = run(TAUT, "map", ROBOT1, "--from", start)
            self.assertEqual(said.returncode, 3, start)
            self.assertIn("--from", said.stderr)
            self.assertIn(expected, said.stderr)
        ranged = os.path.join(CASES, "robot2-sphere-q2-q3.yaml")
        said = run(TAUT, "map", ranged, "--from", "alpha1: 0, alpha2: 1.7")
        self.assertEqual(said.returncode, 3)
        self.assertIn("--from: alpha2: got '1.7', which is 1.7, expected a value in the parameter's range", said.stderr)

    def test_polygons_cover_the_space_and_agree_with_the_shares(self):
        found = self.found(ROBOT1, "--polygons", self.path("p.geojson"))
        collection = json.loads(text_of(self.path("p.geojson")))
        about = collection["taut_map"]
        self.assertEqual((about["area_unit"], about["start"]), ("rad²", "waypoint 0 of the query"))
        shares, reach = {}, {}
        for feature in collection["features"]:
            properties = feature["properties"]
            area = sum(signed_area(ring) for polygon in feature["geometry"]["coordinates"] for ring in polygon)
            self.assertAlmostEqual(area, properties["area"], delta=1e-9)
            shares[properties["kind"]] = shares.get(properties["kind"], 0) + properties["share"]
            reach[properties.get("from_start")] = reach.get(properties.get("from_start"), 0) + properties["share"]
            for polygon in feature["geometry"]["coordinates"]:
                self.assertGreater(signed_area(polygon[0]), 0)
                self.assertTrue(all(signed_area(hole) < 0 for hole in polygon[1:]))
                for x, y in (corner for ring in polygon for corner in ring):
                    for value, axis in zip((x, y), about["axes"]):
                        k = (value - axis["lower"]) / (axis["upper"] - axis["lower"]) * axis["units"]
                        self.assertLess(abs(k - round(k)), 1e-3)
        for kind, share in shares.items():
            self.assertEqual(share, found["share"][kind])
        self.assertEqual(sum(shares.values()), 1)
        self.assertEqual(reach["reachable"], found["region"]["reachable"])
        self.assertEqual(reach["cut_off"] + reach[None], found["region"]["cut_off"])

    def test_the_grid_and_its_meaning(self):
        found = self.found(ROBOT1, "--grid", self.path("g.npy"), "--grid-size", "720,360")
        about = json.loads(text_of(self.path("g.npy.json")))
        shape, values = read_npy(self.path("g.npy"))
        self.assertEqual(shape, (720, 360))
        self.assertEqual([axis["count"] for axis in about["axes"]], [720, 360])
        self.assertEqual([entry["boxes"] for entry in about["values"]], [values.count(n) for n in range(6)])
        self.assertEqual(found["files"], [self.path("g.npy"), self.path("g.npy.json")])

        def value_at(phi, theta):
            place = [int((x - axis["origin"]) / axis["step"]) for x, axis in zip((phi, theta), about["axes"])]
            return values[place[0] * shape[1] + place[1]]
        self.assertEqual([value_at(-2.3, 1.55), value_at(-1.2, 2.0), value_at(0.3, 1.5)], [3, 5, 2])
        share = {value: values.count(value) / len(values) for value in range(6)}
        region = found["region"]
        self.assertLessEqual(share[3], region["reachable"])
        self.assertGreater(share[3], region["reachable"] - 0.02)
        self.assertLessEqual(share[2], 1 - found["share"]["inside"] - found["share"]["undecided"])
        self.assertLessEqual(share[2] + share[4] + share[5], region["cut_off"])

    def test_a_path_is_drawn(self):
        self.assertEqual(run(TAUT, "plan", ROBOT1, "--out", self.path("plan")).returncode, 0)
        found = self.found(ROBOT1, "--undecided", "5%", "--out", self.path("map"), "--path",
                           self.path("plan", "path.csv"))
        self.assertEqual(found["files"], [self.path("map", "map.svg")])
        picture = xml.fromstring(text_of(self.path("map", "map.svg")))
        way, = (path.get("d") for path in picture.iter(SVG + "path") if path.get("class") == "way")
        start, goal = ((float(circle.get("cx")), float(circle.get("cy"))) for circle in picture.iter(SVG + "circle"))
        corners = [tuple(map(float, corner.split(","))) for corner in re.findall(r"[ML]([-\d.,]+)", way)]
        for end, corner in ((start, corners[0]), (goal, corners[-1])):
            self.assertLess(max(abs(a - b) for a, b in zip(end, corner)), 0.02)
        poses = self.write("poses.csv", "px [mm],py [mm],pz [mm],phi [rad],theta [rad],sigma [rad]\n0,0,350,0,0,0\n")
        said = run(TAUT, "map", ROBOT1, "--out", self.path("other"), "--path", poses)
        self.assertEqual(said.returncode, 3)
        self.assertIn("whose rows are poses or cable lengths, expected a file of the case's own", said.stderr)
        self.assertFalse(os.path.exists(self.path("other")))

    def test_charts_of_an_atlas_are_drawn(self):
        atlas = self.path("qs-qg.atlas")
        planned = run(TAUT, "plan", ROBOT1, "--out", self.path("plan"), "--save-atlas", atlas, "--json")
        self.assertEqual(planned.returncode, 0, planned.stderr)
        charts = json.loads(planned.stdout)["charts"]
        self.found(ROBOT1, "--undecided", "5%", "--out", self.path("map"), "--atlas", atlas)
        text = text_of(self.path("map", "map.svg"))
        self.assertIn("charts of the atlas (nothing is proved of them)", text)
        picture = xml.fromstring(text)
        drawn, = (path.get("d") for path in picture.iter(SVG + "path") if path.get("class") == "charts")
        outlines = corners_of(drawn)
        self.assertGreaterEqual(len(outlines), charts)  # one that crosses the end of a turn has two lines
        # Start and goal are the centres of charts, whose polygons share no place but their edges.
        for circle in picture.iter(SVG + "circle"):
            place = float(circle.get("cx")), float(circle.get("cy"))
            around, = (outline for outline in outlines if encloses(outline, place))
            self.assertLess(max(abs(x - place[0]) + abs(y - place[1]) for x, y in around), 120)
        self.found(ROBOT1, "--undecided", "5%", "--out", self.path("plain"))
        self.assertNotIn("charts", text_of(self.path("plain", "map.svg")))
        other = os.path.join(CASES, "robot2-sphere-q2-q3.yaml")
        said = run(TAUT, "map", other, "--out", self.path("other"), "--atlas", atlas)
        self.assertEqual(said.returncode, 3)
        self.assertIn("qs-qg.atlas: ", said.stderr)
        self.assertFalse(os.path.exists(self.path("other")))

    def test_a_png_is_the_svg_with_two_dots_a_pixel(self):
        found = self.found(ROBOT1, "--undecided", "5%", "--out", self.path("map"), "--png")
        self.assertEqual(found["files"], [self.path("map", "map.svg"), self.path("map", "map.png")])
        with open(self.path("map", "map.png"), "rb") as file:
            png = file.read()
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        picture = xml.fromstring(text_of(self.path("map", "map.svg")))
        size = [int.from_bytes(png[at:at + 4], "big") for at in (16, 20)]
        self.assertEqual(size, [2 * int(picture.get("width")), 2 * int(picture.get("height"))])
        said = run(TAUT, "map", ROBOT1, "--undecided", "5%", "--out", self.path("none"), "--png",
                   env={**os.environ, "TAUT_BROWSER": "/no/such/browser"})
        self.assertEqual(said.returncode, 3)
        self.assertIn("--png: found no browser", said.stderr)
        self.assertFalse(os.path.exists(self.path("none")))

    def test_files_that_are_refused(self):
        for arguments, expected in ((["--grid", "g.csv"], "expected a name that ends in .npy"),
                                    (["--grid-size", "4"], "got no --grid"),
                                    (["--path", "path.csv"], "got no --out"), (["--png"], "got no --out"),
                                    (["--atlas", "a.atlas"], "--atlas: got no --out"),
                                    (["--grid", "g.npy", "--polygons", "g.npy.json"], "expected another file"),
                                    (["--polygons", ROBOT1], "cases"),
                                    *((["--grid", "g.npy", "--grid-size", size], "--grid-size: got")
                                      for size in ("0", "a", "4,", "4,4,4", "-1", "2000000", "1000000"))):
            said = run(TAUT, "map", ROBOT1, *arguments)
            self.assertEqual(said.returncode, 3, arguments)
            self.assertIn(expected, said.stderr)

    def test_more_cells_than_fit_into_memory_are_refused(self):
        said = run(TAUT, "map", ROBOT1, "--cells", "1000000000")
        if said.returncode == 0:
            self.skipTest("this machine has 80 GB to spare")
        self.assertEqual(said.returncode, 3)
        self.assertRegex(said.stderr, r"--cells: got 1000000000, which may take 80.0 GB of memory \(80 bytes each\), "
                                      r"expected at most \d+, because [\d.]+ GB are available")

    def test_a_slice_may_bound_positions(self):
        level = text_of(ROBOT1).replace("slice: {px: 0, py: 0, pz: 350, sigma: 34 deg}",
                                        "slice: {px: [-200, 200], py: [-0.2 m, 0.2 m], pz: 350, phi: 0, theta: 0, "
                                        "sigma: 34 deg}")
        self.assertNotEqual(level, text_of(ROBOT1))
        level = re.sub(r"\{phi: [-\d.]+, theta: [-\d.]+\}", "{px: 0, py: 0}", level)
        found = self.found(self.write("level.yaml", level))
        self.assertEqual([(axis["name"], axis["kind"], axis["lower"], axis["upper"]) for axis in found["axes"]],
                         [("px", "range", "-0.2", "0.2"), ("py", "range", "-0.2", "0.2")])
        self.assertGreater(found["share"]["inside"], 0)
        self.assertGreater(found["share"]["length"], 0)
        self.assertEqual(found["connections"], ["joined"])
        crane = text_of(os.path.join(CASES, "cranes", "portal-20t.yaml")).split("decoration:", maxsplit=1)[0]
        crane = crane.replace("free: {px: [-8, 8], py: [-5, 5], pz: [3, 10]}",
                              "slice: {px: [-8, 8], py: [-5, 5], pz: 6, phi: 0, theta: 0, sigma: 0}")
        crane = self.write("crane.yaml", re.sub(r"\{px: (-?4), py: 0,.*\}", r"{px: \1, py: 0}", crane))
        planned = run(TAUT, "plan", crane, "--out", self.path("crane"))
        self.assertEqual(planned.returncode, 0, planned.stdout + planned.stderr)
        checked = run(CHECK, self.path("crane", "certificate.json"), crane, "--expect", "proved")
        self.assertTrue(checked.stdout.startswith("accepted"), checked.stdout + checked.stderr)

    def test_what_has_no_map_is_refused(self):
        for name, expected in (("robot1-free-box-qs-qg", "(px, py, pz, phi, theta, sigma), expected two or three"),
                               ("robot2-implicit-rail", "expected")):
            said = run(TAUT, "map", os.path.join(CASES, name + ".yaml"))
            self.assertEqual(said.returncode, 3, said.stdout)
            self.assertIn(expected, said.stderr)
            self.assertIn("[E3]", said.stderr)
        unbounded = text_of(ROBOT1).replace("slice: {px: 0, py: 0,", "slice: {py: 0, theta: 0.3,")
        unbounded = re.sub(r"\{phi: [-\d.]+, theta: [-\d.]+\}", "{phi: 0, px: 0}", unbounded)
        said = run(TAUT, "map", self.write("unbounded.yaml", unbounded))
        self.assertEqual(said.returncode, 3)
        self.assertIn("px: got a coordinate without bounds, expected a range", said.stderr)
        for share in ("0", "100%", "x", "-1%"):
            self.assertEqual(run(TAUT, "map", ROBOT1, f"--undecided={share}").returncode, 3)
        self.assertEqual(run(TAUT, "map", ROBOT1, "--cell", "2").returncode, 3)
        self.assertEqual(run(TAUT, "map", ROBOT1, "--cells", "5").returncode, 3)


if __name__ == "__main__":
    main()

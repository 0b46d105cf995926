#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast the path of a move can be run at best, without a limit of jerk: what taut's time laws are held to.

Usage: move_optimum.py CERTIFICATE... [--points N] [--json]

Nothing here is taut's but the certificate: kinematics are Taylor arithmetic on numpy's arrays, bodies are particles
(a filled box has the momenta of six particles of a sixth of its mass each, in the middles of its faces), and the
optimum is a linear program. Debian packages: python3-numpy, python3-scipy (with HiGHS).

The path is sampled evenly by its arc length l in the space of parameters, so that it has a direction everywhere, at
the tripled control points where a spline begins and ends, too. Unknown is b = (dl/dt)^2 at N + 1 places, linear in
between, so that d2l/dt2 = b'/2 is constant there. Speeds are limited at the places, and everything that depends on
accelerations in the middles between. Maximising the sum of b gives the greatest b everywhere. Norms, worst loads and
what is not linear (power; stops) enter as cuts: rows are added where the last solution violates a limit, until none is
violated by more than 1e-6 of it.

Deviations within tolerances are left out, as is the slack that a proof needs: no law that is proved can be faster, but
for the error of the discretisation. Loads are those of K, each with its own masses in weight and inertia.
"""
import ast
import itertools
import json
import math
import sys

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

ENOUGH = 1e-6    # by which a limit may be exceeded, as a share of it
ROUNDS = 60      # of adding rows
CORNERS = 16     # directions of a norm to begin with


class Jet:
    """x, x' and x'' by l, of arrays."""

    def __init__(self, x, x1=0.0, x2=0.0):
        self.x, self.x1, self.x2 = (np.asarray(v, float) for v in (x, x1, x2))

    def __add__(self, o):
        o = jet(o)
        return Jet(self.x + o.x, self.x1 + o.x1, self.x2 + o.x2)

    def __mul__(self, o):
        o = jet(o)
        return Jet(self.x * o.x, self.x1 * o.x + self.x * o.x1, self.x2 * o.x + 2 * self.x1 * o.x1 + self.x * o.x2)

    def __neg__(self):
        return self * -1.0

    def __sub__(self, o):
        return self + -jet(o)

    def __rsub__(self, o):
        return jet(o) - self

    def __truediv__(self, o):
        o = jet(o)
        return self * o.of(1 / o.x, -1 / o.x**2, 2 / o.x**3)

    def __rtruediv__(self, o):
        return jet(o) / self

    def __pow__(self, n):
        n = float(n)
        return self.of(self.x**n, n * self.x**(n - 1), n * (n - 1) * self.x**(n - 2))

    __radd__, __rmul__ = __add__, __mul__

    def of(self, f, f1, f2):
        """A function with these derivatives, of this."""
        return Jet(f, f1 * self.x1, f2 * self.x1**2 + f1 * self.x2)


def jet(x):
    return x if isinstance(x, Jet) else Jet(x)


def sin(x):
    x = jet(x)
    return x.of(np.sin(x.x), np.cos(x.x), -np.sin(x.x))


def cos(x):
    x = jet(x)
    return x.of(np.cos(x.x), -np.sin(x.x), -np.cos(x.x))


FUNCTIONS = {"sin": sin, "cos": cos, "sqrt": lambda x: jet(x)**0.5, "tan": lambda x: sin(x) / cos(x)}


def evaluate(text, names):
    """An expression of a certificate: decimals, names, pi, + - * / ^ and FUNCTIONS."""
    tree = ast.parse(text.replace("^", "**"), mode="eval")
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id not in {**FUNCTIONS, **names, "pi": 0}:
            raise SystemExit(f"move_optimum.py: unknown name '{node.id}' in the expression '{text}'")
    return eval(compile(tree, "expression", "eval"), {"__builtins__": {}, "pi": math.pi, **FUNCTIONS, **names})


def number(text):
    value = evaluate(text, {}) if isinstance(text, str) else text
    return float(value.x) if isinstance(value, Jet) else float(value)


def binary64(text):
    return float.fromhex(text) if isinstance(text, str) else float(text)


# ---- the path ----

def control_points(path):
    """Parameters, one row a waypoint; and behind them, in a space with constraints, its normals."""
    return np.array([[binary64(x) + math.pi * turn for x, turn in zip(w["x"], w["half_turns"])] +
                     [binary64(x) for x in w.get("normals", [])] for w in path["waypoints"]])


def basis(x):
    """Of uniform cubic B-splines: weights of four control points, and of their derivatives."""
    one = np.ones_like(x)
    return (np.stack([(1 - x)**3, 3 * x**3 - 6 * x**2 + 4, -3 * x**3 + 3 * x**2 + 3 * x + one, x**3], -1) / 6,
            np.stack([-(1 - x)**2, 3 * x**2 - 4 * x, -3 * x**2 + 2 * x + one, x**2], -1) / 2,
            np.stack([1 - x, 3 * x - 2, 1 - 3 * x, x], -1))


def curve(controls, s):
    """A spline's parameters and their two derivatives at places s."""
    pieces = len(controls) - 3
    control_of = np.stack([controls[i:i + pieces] for i in range(4)], 1)  # piece, control, parameter
    piece = np.clip(s.astype(int), 0, pieces - 1)
    return [np.einsum("nc,ncp->np", weights, control_of[piece]) for weights in basis(s - piece)]


def runs_of(path):
    """Parts between places where the motion has to rest: control points of each, and whether it is a spline."""
    controls = control_points(path)
    if path["interpolation"] == "straight-in-parameters":
        return [(controls[k:k + 2], False) for k in range(len(controls) - 1)]
    if path["interpolation"] != "cubic-b-spline":
        raise SystemExit(f"move_optimum.py: got a path that is {path['interpolation']}, expected "
                         "straight-in-parameters or cubic-b-spline")
    stops = [k for k in range(1, len(controls) - 1) if (controls[k - 1:k + 2] == controls[k]).all()]
    return [(controls[a - 1:b + 2], True) for a, b in zip(stops, stops[1:])]


def sample(controls, is_spline, count, where):
    """Parameters and normals as jets by arc length, of `count` parameters, at the shares `where` of it; its length."""
    if not is_spline:
        way = controls[1] - controls[0]
        length = np.linalg.norm(way[:count])
        return [Jet(a + where * d, d / length + 0 * where, 0 * where) for a, d in zip(controls[0], way)], length
    pieces = len(controls) - 3

    def at(s):
        return curve(controls, s)

    # Arc length by Gauss's rule over short steps, then s by interpolation and Newton's method.
    steps = 400 * pieces
    knots = np.linspace(0, pieces, steps + 1)
    nodes, weights = np.polynomial.legendre.leggauss(5)
    half = 0.5 * pieces / steps
    inner = (knots[:-1, None] + half * (1 + nodes)).ravel()
    rate = np.linalg.norm(at(inner)[1][:, :count], axis=1).reshape(steps, -1)
    until = np.concatenate([[0], np.cumsum(half * rate @ weights)])
    length = until[-1]
    wanted = where * length
    s = np.interp(wanted, until, knots)
    low, high = np.zeros_like(s), np.full_like(s, pieces)
    for _ in range(60):  # bisection, which does not mind that the rate is 0 at the ends
        k = np.minimum((s / (2 * half)).astype(int), steps - 1)
        span = s - knots[k]
        points = knots[k][:, None] + 0.5 * span[:, None] * (1 + nodes)
        along = np.linalg.norm(at(points.ravel())[1][:, :count], axis=1).reshape(points.shape) @ weights
        is_beyond = until[k] + 0.5 * span * along > wanted
        high, low = np.where(is_beyond, s, high), np.where(is_beyond, low, s)
        s = 0.5 * (low + high)
    x, x1, x2 = at(s)
    # Where control points are tripled the first and last piece are straight: any other place of it has its direction.
    x1[where <= 0], x1[where >= 1] = controls[3] - controls[2], controls[-3] - controls[-4]
    x2[(where <= 0) | (where >= 1)] = 0
    rate = np.linalg.norm(x1[:, :count], axis=1)[:, None]
    direction = x1 / rate
    bend = x2 / rate**2
    bend = bend - direction * np.sum((direction * bend)[:, :count], axis=1)[:, None]
    return [Jet(x[:, p], direction[:, p], bend[:, p]) for p in range(x.shape[1])], length


# ---- kinematics: vectors are lists of three jets, matrices lists of rows ----

def product(r, v):
    return [r[i][0] * v[0] + r[i][1] * v[1] + r[i][2] * v[2] for i in range(3)]


def matrices(a, b):
    return [[a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] for j in range(3)] for i in range(3)]


def about(axis, angle):
    c, s = cos(angle), sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    r = [[jet(float(a == b)) for b in range(3)] for a in range(3)]
    r[i][i], r[i][j], r[j][i], r[j][j] = c, -s, s, c
    return r


def rotation(space, pose):
    kind = space.get("angles")
    if kind is None:
        turns = [(2, pose["phi"]), (1, pose["theta"]), (2, pose["sigma"] - pose["phi"])]
    else:
        raise SystemExit(f"move_optimum.py: poses by {kind} are not implemented, expected tilt and torsion")
    r = about(*turns[0])
    for turn in turns[1:]:
        r = matrices(r, about(*turn))
    return r


def numbers(v, order):
    """Of a vector of jets, derivative `order`: an array with one row a place."""
    count = max(np.size(getattr(x, a)) for x in v for a in ("x", "x1", "x2"))
    return np.stack([np.broadcast_to(getattr(x, ("x", "x1", "x2")[order]), count) for x in v], -1)


def named(space, parameters):
    return {**{p["name"]: x for p, x in zip(space["parameters"], parameters)},
            **{k: number(v) for k, v in space["constants"].items()}}


def on_constraints(space, jets):
    """Parameters l + N y with C(l + N y) = 0, from jets of l and N.

    By Newton's method for y: its matrix at the end is that of the derivatives, too, so that each further step makes one
    more of them right.
    """
    count, equations = len(space["parameters"]), len(space["constraints"])
    line, normals = jets[:count], np.array(jets[count:], object).reshape(count, equations)
    places = np.size(line[0].x)

    def residuals(parameters):
        return [jet(evaluate(c, named(space, parameters))) for c in space["constraints"]]
    y = [Jet(np.zeros(places)) for _ in range(equations)]
    for _ in range(12):
        here = [x + sum((n * z for n, z in zip(row, y)), Jet(0.0)) for x, row in zip(line, normals)]
        matrix = np.stack([np.stack([np.broadcast_to(c.x1, places) for c in residuals(
            [Jet(x.x, row[i].x) for x, row in zip(here, normals)])], -1) for i in range(equations)], -1)
        inverse, left = np.linalg.inv(matrix), residuals(here)
        y = [z - sum((c * inverse[:, i, k] for k, c in enumerate(left)), Jet(0.0)) for i, z in enumerate(y)]
    return [x + sum((n * z for n, z in zip(row, y)), Jet(0.0)) for x, row in zip(line, normals)]


class Motion:
    """All that is needed of a motion at some places of it, by what its parameters are jets of."""

    def __init__(self, problem, parameters):
        space, robot, load = problem["space"], problem["robot"], problem["load"]
        if space["constraints"]:
            parameters = on_constraints(space, parameters)
        names = named(space, parameters)
        pose = {k: jet(evaluate(v, names)) for k, v in space["pose"].items()}
        self.p = [pose["px"], pose["py"], pose["pz"]]
        self.r = rotation(space, pose)
        self.places = np.size(parameters[0].x)
        self.load_point = [number(x) for x in load["point_m"]]
        self.cables, self.base = [], [np.array([number(x) for x in a]) for a in robot["base_anchors_m"]]
        for a, b in zip(robot["base_anchors_m"], robot["platform_anchors_m"]):
            d = [x - number(y) for x, y in zip(self.point([number(x) for x in b]), a)]
            self.cables.append((d, (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])**0.5))
        self.load = self.point(self.load_point)
        # [w] = R' R^T and its derivative, from rows of R.
        r0, r1, r2 = (np.stack([numbers(row, k) for row in self.r], 1) for k in range(3))
        r0, r1, r2 = (np.broadcast_to(r, (self.places, 3, 3)) for r in (r0, r1, r2))
        w = np.einsum("nij,nkj->nik", r1, r0)
        w1 = np.einsum("nij,nkj->nik", r2, r0) + np.einsum("nij,nkj->nik", r1, r1)
        self.turn, self.turn1 = (np.stack([m[:, 2, 1], m[:, 0, 2], m[:, 1, 0]], -1) for m in (w, w1))
        self.r0 = r0

    def point(self, b):
        """A point of the platform."""
        return [x + y for x, y in zip(self.p, product(self.r, b))]

    def at(self, v, order):
        return np.broadcast_to(numbers(v, order), (self.places, 3))

    def influence(self):
        """[place, cable, 6]: rows of J^-1, f = J^-1 w about the load point."""
        columns = []
        lever = self.at(self.load, 0)
        for (d, _), b in zip(self.cables, self.anchors()):
            u = self.at(d, 0)
            u = u / np.linalg.norm(u, axis=1)[:, None]
            columns.append(np.concatenate([u, np.cross(b - lever, u)], 1))
        return np.linalg.inv(np.stack(columns, -1))

    def anchors(self):
        return [self.at(d, 0) + a for (d, _), a in zip(self.cables, self.base)]


# ---- loads ----

def support(shape, y, r0):
    """max over a set of vectors of y · v; its sets are those of problem.load.items."""
    kinds = set(shape) - {"axes", "at_m", "at_tolerance_m"}
    if shape.get("axes", "W") == "P":
        y = np.einsum("nij,ni->nj", r0, y)
    if kinds == {"ball"}:
        return number(shape["ball"]["radius"]) * np.linalg.norm(y, axis=1)
    if kinds == {"disc"}:
        normal = np.array([number(x) for x in shape["disc"]["normal"]])
        normal /= np.linalg.norm(normal)
        return number(shape["disc"]["radius"]) * np.linalg.norm(y - np.outer(y @ normal, normal), axis=1)
    raise SystemExit(f"move_optimum.py: got an item with {sorted(kinds)}, expected weights, balls and discs")


class Loads:
    def __init__(self, problem, motion):
        load = problem["load"]
        if "ellipsoid" in load and load["ellipsoid"]:
            raise SystemExit("move_optimum.py: got a load with an ellipsoid, expected items alone")
        self.motion = motion
        self.gravity = np.array([number(x) for x in load["gravity_m_s2"]])
        self.weights = [item["weight"] for item in load["items"] if "weight" in item]
        self.others = [item for item in load["items"] if "weight" not in item]
        self.inverse = motion.influence()

    def fixed(self, i, sign):
        """The most that all but weights add to sign times the tension of cable i."""
        y = sign * self.inverse[:, i]
        total = np.zeros(self.motion.places)
        for item in self.others:
            if "moment" in item:
                total += support(item["moment"], y[:, 3:], self.motion.r0)
            else:
                at = self.motion.at(self.motion.point([number(x) for x in item["force"]["at_m"]]), 0)
                lever = at - self.motion.at(self.motion.load, 0)
                total += support(item["force"], y[:, :3] + np.cross(y[:, 3:], lever), self.motion.r0)
        return total

    def of_weight(self, weight, y, shift):
        """(constant, by a, by b): y · (wrench less inertia) a kg, with its centre of gravity moved by `shift` (P)."""
        motion = self.motion
        centre = np.array([number(x) for x in weight["at_m"]]) + shift  # one row a place
        box = [number(x) for x in weight.get("inertia_box_m") or [0, 0, 0]]
        result = [0.0, 0.0, 0.0]
        lever = motion.at(motion.load, 0)
        for k, sign in itertools.product(range(3), (-0.5, 0.5)):
            place = centre.copy()
            place[:, k] += sign * box[k]
            particle = motion.point([place[:, 0], place[:, 1], place[:, 2]])
            arm = motion.at(particle, 0) - lever
            g = y[:, :3] + np.cross(y[:, 3:], arm)
            result[0] = result[0] + g @ self.gravity / 6
            result[1] = result[1] - np.sum(g * motion.at(particle, 1), 1) / 6
            result[2] = result[2] - np.sum(g * motion.at(particle, 2), 1) / 6
        return np.stack(result)

    def worst(self, i, sign, a, b):
        """The rows (constant, by a, by b) of sign times the tension of cable i, for the load that is worst at a, b."""
        y = sign * self.inverse[:, i]
        total = np.zeros((3, self.motion.places))
        total[0] = self.fixed(i, sign)
        now = np.stack([np.ones_like(a), a, b])
        for weight in self.weights:
            off = number(weight["at_tolerance_m"])
            shift = np.zeros((self.motion.places, 3))
            masses = [number(m) for m in weight["mass_kg"]]
            best = None
            for mass in masses:
                if off > 0:
                    slope = np.zeros((self.motion.places, 3))
                    for k in range(3):
                        step = np.zeros((self.motion.places, 3))
                        step[:, k] = off
                        change = self.of_weight(weight, y, step) - self.of_weight(weight, y, -step)
                        slope[:, k] = np.sum(change * now, 0)
                    size = np.linalg.norm(slope, axis=1)[:, None]
                    shift = off * slope / np.where(size > 0, size, 1)
                row = mass * self.of_weight(weight, y, shift)
                if best is None:
                    best = row
                else:
                    best = np.where(np.sum(row * now, 0) > np.sum(best * now, 0), row, best)
            total += best
        return total


# ---- the program ----

class Program:
    def __init__(self, problem, run, points):
        time = problem["time"]

        def get(name):
            return None if time.get(name) is None else number(time[name])

        def each(name):
            return [None] * 6 if time.get(name) is None else [None if x is None else number(x) for x in time[name]]
        nodes = np.linspace(0, 1, points + 1)
        middles = 0.5 * (nodes[:-1] + nodes[1:])
        self.slowing = 1 / get("stopping_time_s") if get("stopping_time_s") else 0.0
        count = len(problem["space"]["parameters"])
        at_nodes, length = sample(*run, count, nodes)
        at_nodes, self.at = Motion(problem, at_nodes), Motion(problem, sample(*run, count, middles)[0])
        self.points, self.step = points, length / points
        # Speeds: bounds of b.
        self.upper = np.full(points + 1, np.inf)

        def bound(rate, limit):
            with np.errstate(divide="ignore"):
                self.upper = np.minimum(self.upper, limit**2 / rate**2)
        if get("load_speed_m_s"):
            bound(np.linalg.norm(at_nodes.at(at_nodes.load, 1), axis=1), get("load_speed_m_s"))
        if get("load_angular_speed_rad_s"):
            bound(np.linalg.norm(at_nodes.turn, axis=1), get("load_angular_speed_rad_s"))
        for (_, length), limit in zip(at_nodes.cables, each("winch_speed_m_s")):
            if limit:
                bound(np.broadcast_to(length.x1, points + 1), limit)
        self.upper[[0, -1]] = 0
        # Norms (by a, by b, limit), of vectors; magnitudes; tensions.
        self.norms = []
        if get("load_acceleration_m_s2"):
            self.norms.append((self.at.at(self.at.load, 1), self.at.at(self.at.load, 2), get("load_acceleration_m_s2")))
        if get("load_angular_acceleration_rad_s2"):
            self.norms.append((self.at.turn, self.at.turn1, get("load_angular_acceleration_rad_s2")))
        for (_, length), limit in zip(self.at.cables, each("winch_acceleration_m_s2")):
            if limit:
                by_a, by_b = (np.broadcast_to(x, points)[:, None] for x in (length.x1, length.x2))
                self.norms.append((by_a, by_b, limit))
        self.tensions = [[number(x) for x in pair] for pair in problem["robot"]["tension_N"]]
        self.powers = each("winch_power_W")
        self.loads = Loads(problem, self.at)
        self.rows, self.columns, self.values, self.limits = [], [], [], []

    def corners(self):
        """All (a, b) that a move has to be able to do where it may stop: weights of a, b and of sqrt(b)."""
        if not self.slowing:
            yield 1.0, 1.0, 0.0
            return
        for of_a, of_b, of_root in itertools.product((0.0, 1.0), (0.0, 1.0), (-self.slowing, self.slowing)):
            yield of_a, of_b, of_root

    def add(self, which, of_a, of_b, limit):
        """Rows of_a a + of_b b <= limit in the middles `which`, scaled."""
        size = np.maximum(np.abs(limit), 1e-300)
        first = len(self.limits)
        index = np.arange(first, first + len(which))
        for offset, value in ((0, 0.5 * of_b - of_a / (2 * self.step)), (1, 0.5 * of_b + of_a / (2 * self.step))):
            self.rows.extend(index)
            self.columns.extend(which + offset)
            self.values.extend(value / size)
        self.limits.extend(limit / size)

    def cut(self, a, b):
        """Adds rows where a limit is exceeded. @returns the largest excess, as a share."""
        most = 0.0
        root = np.sqrt(np.maximum(b, 0))
        safe = np.maximum(b, 1e-12 * max(b.max(), 1e-12))

        def check(of_a, of_b, of_1, limit, corner):
            """of_a a' + of_b b' + of_1 <= limit, with a' and b' of a corner; sqrt(b) <= its tangent."""
            nonlocal most
            share_a, share_b, slowing = corner
            value = of_a * (share_a * a + slowing * root) + of_b * share_b * b + of_1
            excess = (value - limit) / np.abs(limit - of_1)
            which = np.flatnonzero(excess > ENOUGH)
            most = max(most, excess.max())
            if not len(which):
                return
            tangent = of_a * slowing  # of sqrt(b), where its weight is positive; else it relieves, and is left out
            tangent = np.maximum(tangent, 0) if slowing else 0 * of_a
            self.add(which, (of_a * share_a)[which],
                     (of_b * share_b + tangent / (2 * np.sqrt(safe)))[which],
                     (limit - of_1 - tangent * np.sqrt(safe) / 2)[which])

        for corner in self.corners():
            share_a, share_b, slowing = corner
            # A load that is worst at a corner.
            a_now, b_now = share_a * a + slowing * root, share_b * b
            for by_a, by_b, limit in self.norms:
                direction = by_a * a_now[:, None] + by_b * b_now[:, None]
                size = np.linalg.norm(direction, axis=1)[:, None]
                direction = direction / np.where(size > 0, size, 1)
                of_a, of_b = np.sum(direction * by_a, 1), np.sum(direction * by_b, 1)
                check(of_a, of_b, 0.0, np.full(self.points, limit), corner)
            for i, sign in itertools.product(range(6), (-1, 1)):
                of_1, of_a, of_b = self.loads.worst(i, sign, a_now, b_now)
                low, high = self.tensions[i]
                check(of_a, of_b, of_1, np.full(self.points, high if sign > 0 else -low), corner)
                if sign > 0 and self.powers[i]:
                    most = max(most, self.cut_power(i, (of_1, of_a, of_b), a, b, corner))
        return most

    def cut_power(self, i, row, a, b, corner):
        """(f) |L'| sqrt(b) <= P, or f <= P / (|L'| sqrt(b)), which is above its tangent."""
        of_1, of_a, of_b = row
        share_a, share_b, slowing = corner
        rate = np.abs(np.broadcast_to(self.at.cables[i][1].x1, self.points))
        safe = np.maximum(b, 1e-9 * b.max())
        root = np.sqrt(safe)
        tension = of_1 + of_a * (share_a * a + slowing * np.sqrt(np.maximum(b, 0))) + of_b * share_b * b
        excess = tension * rate * np.sqrt(np.maximum(b, 0)) / self.powers[i] - 1
        which = np.flatnonzero(excess > ENOUGH)
        if len(which):
            power = self.powers[i] / rate[which]
            tangent = np.maximum((of_a * slowing)[which], 0) if slowing else 0.0
            self.add(which, (of_a * share_a)[which],
                     (of_b * share_b)[which] + tangent / (2 * root[which]) + 0.5 * power / root[which]**3,
                     1.5 * power / root[which] - of_1[which] - tangent * root[which] / 2)
        return excess.max()

    def begin(self):
        """Rows without which nothing is bounded: norms in some directions."""
        for by_a, by_b, limit in self.norms:
            e1 = by_a / np.maximum(np.linalg.norm(by_a, axis=1), 1e-300)[:, None]
            across = by_b - e1 * np.sum(e1 * by_b, 1)[:, None]
            size = np.linalg.norm(across, axis=1)[:, None]
            e2 = across / np.where(size > 0, size, 1)
            corners = 2 if by_a.shape[1] == 1 else CORNERS
            for k in range(corners):
                direction = math.cos(2 * math.pi * k / corners) * e1 + math.sin(2 * math.pi * k / corners) * e2
                self.add(np.arange(self.points), np.sum(direction * by_a, 1), np.sum(direction * by_b, 1),
                         np.full(self.points, limit))
        zero = np.zeros(self.points)
        for i, sign in itertools.product(range(6), (-1, 1)):
            of_1, of_a, of_b = self.loads.worst(i, sign, zero, zero)
            low, high = self.tensions[i]
            left = (high if sign > 0 else -low) - of_1
            if not (left > 0).all():
                raise SystemExit("move_optimum.py: the path is not feasible at rest")
            self.add(np.arange(self.points), of_a, of_b, left)

    def solve(self):
        self.begin()
        scale = np.nanmedian(np.where(np.isfinite(self.upper) & (self.upper > 0), self.upper, np.nan))
        scale = scale if np.isfinite(scale) else 1.0
        for rounds in range(ROUNDS):
            matrix = csr_matrix((np.array(self.values) * scale, (self.rows, self.columns)),
                                shape=(len(self.limits), self.points + 1))
            upper = np.where(np.isfinite(self.upper), self.upper / scale, 1e6)
            bounds = np.stack([np.zeros(self.points + 1), upper], 1)
            result = linprog(-np.ones(self.points + 1), A_ub=matrix, b_ub=self.limits, bounds=bounds, method="highs")
            if result.x is None:
                raise SystemExit(f"move_optimum.py: {result.message}")
            b = np.maximum(result.x, 0) * scale
            middle, slope = 0.5 * (b[:-1] + b[1:]), np.diff(b) / (2 * self.step)
            if self.cut(slope, middle) <= ENOUGH:
                break
        else:
            print(f"move_optimum.py: after {ROUNDS} rounds a limit is still exceeded", file=sys.stderr)
        root = np.sqrt(b)
        self.b, self.rounds = b, rounds + 1
        return float(np.sum(2 * self.step / (root[:-1] + root[1:])))


def fastest(certificate, points):
    """The duration [s] of the fastest law along a certificate's path, resting where the motion has to."""
    runs = runs_of(certificate["path"])
    return sum(Program(certificate["problem"], run, points).solve() for run in runs)


def duration(certificate):
    law = certificate["path"]["timing"]
    return binary64(law["step_s"]) * (len(law["controls"]) - 3)


def greatest_jerk(certificate):
    """The largest jerk of the load point [m/s^3], from differences of its acceleration by the certificate's law."""
    path, law = certificate["path"], certificate["path"]["timing"]
    step, samples = binary64(law["step_s"]), 8
    pieces = len(law["controls"]) - 3
    values = np.array([[binary64(c)] for c in law["controls"]])
    place, rate, bend = (x[:, 0] for x in curve(values, np.arange(samples * pieces + 1) / samples))
    rate, bend = rate / step, bend / step**2
    controls = control_points(path)
    if path["interpolation"] == "cubic-b-spline":
        x, x1, x2 = curve(controls, place)
    else:
        k = np.clip(place.astype(int), 0, len(controls) - 2)
        x1 = controls[k + 1] - controls[k]
        x, x2 = controls[k] + (place - k)[:, None] * x1, 0 * x1
    motion = Motion(certificate["problem"], [Jet(*(v[:, p] for v in (x, x1, x2))) for p in range(controls.shape[1])])
    acceleration = motion.at(motion.load, 1) * bend[:, None] + motion.at(motion.load, 2) * rate[:, None]**2
    return float(np.linalg.norm(np.diff(acceleration, axis=0), axis=1).max() * samples / step)


def main():
    arguments = sys.argv[1:]
    points = int(arguments[arguments.index("--points") + 1]) if "--points" in arguments else 1000
    files = [x for k, x in enumerate(arguments) if not x.startswith("--") and arguments[k - 1] != "--points"]
    if not files:
        raise SystemExit(__doc__)
    for name in files:
        with open(name, encoding="utf-8") as file:
            certificate = json.load(file)
        best, law = fastest(certificate, points), duration(certificate)
        if "--json" in arguments:
            print(json.dumps({"certificate": name, "optimum_s": best, "law_s": law, "ratio": law / best}))
        else:
            print(f"{name}: {best:.4f} s at best, {law:.4f} s by the law, ratio {law / best:.4f}", flush=True)


if __name__ == "__main__":
    main()

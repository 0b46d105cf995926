#!/usr/bin/env python3
"""Writes the certificates of this folder, in floating point and from equations of its own.

It is no prover: it samples a short path, claims margins a little below what it saw, and leaves it to the checker to
find out. Each certificate NAME.json has a NAME.txt beside it: why it is there and, after "expect: ", what the
checker's message must contain. Only Python's standard library. Usage: make_certificates.py
"""
import copy, hashlib, json, math, os
from fractions import Fraction
from math import cos, sin, tan, pi, sqrt

HERE = os.path.dirname(os.path.abspath(__file__))

CLAIMS = {
    'proved': 'For every s along the path, every machine, load and pose within the stated tolerances, '
              'and every wrench w in K: the force Jacobian J is non-singular, the unique f with J f = '
              'w satisfies f_lo,i < f_i < f_hi,i, and d_lo,i < d_i < d_hi,i, for all six cables i = '
              '1..6. The path is given by its exact waypoints and interpolation law; robot, load, '
              'limits and tolerances are the exact numbers of the problem. Where the pose is only '
              'implied, by constraints or by the lengths of the cables, it is the one in its tube, '
              'exactly one for every s. A machine that holds its cables\' lengths and deviates is at '
              'the pose to which its deviation leads as it grows from zero. That these poses exist is '
              'part of the claim.',
    'refuted': 'The path is not wrench-feasible: at the witness pose of the path some wrench w in K '
              'needs a tension outside its open limits, or a cable length is outside its open limits, '
              'or the force Jacobian J is singular at some pose between the two witness poses. Robot '
              'and load are there as the problem states them, or differ by the deviation that the '
              'witness states, which is within the tolerances. The pose of a machine that deviates is '
              'the one to which its deviation leads: where it holds its cables\' lengths, as anchors and '
              'lengths deviate more and more from nothing on; and then by the deviation in tracking. '
              'Where stretches are listed, the claim of a proved path holds outside of them, and each '
              'stretch that has witnesses is violated at both of them.',
    'undecided': 'Nothing is claimed. The path was neither proved nor refuted; this does not mean that it is unsafe.',
}


# ---- canonical form and digests -------------------------------------------------------------------------------------

def digest(value):
    text = json.dumps(value, sort_keys=True, separators=(',', ':'), ensure_ascii=True)
    return hashlib.sha256(text.encode('ascii')).hexdigest()


def seal(c):
    """Recomputes digests and counts."""
    c['problem_sha256'] = digest(c['problem'])
    c['path_sha256'] = digest(c['path'])
    c.pop('footer', None)
    c['footer'] = {'waypoints': len(c['path']['waypoints']), 'segments': len(c['segments']),
                   'boxes': sum(len(s['boxes']) for s in c['segments']), 'sha256': digest(c)}
    return c


def hex64(x):
    """As C's %a: no trailing zeros."""
    text = float(x).hex()
    mantissa, exponent = text.split('p')
    if '.' in mantissa:
        mantissa = mantissa.rstrip('0').rstrip('.')
    return mantissa + 'p' + exponent


# ---- the robots -----------------------------------------------------------------------------------------------------

def twice(points):
    return [list(p) for p in points for _ in (0, 1)]


def octahedral(base, platform, tension, length, point, wrench, diagonal):
    return ({'base_anchors_m': twice(base), 'platform_anchors_m': [list(p) for p in platform + platform],
             'tension_N': [list(tension)] * 6, 'length_m': [list(length)] * 6},
            {'point_m': list(point), 'wrench': list(wrench),
             'ellipsoid': [[diagonal[i] if i == j else '0' for j in range(6)] for i in range(6)]})


ROBOT1 = octahedral([('0', '0.22', '0'), ('-0.1905256', '-0.11', '0'), ('0.1905256', '-0.11', '0')],
                    [('-0.1125833', '0.065', '0'), ('0.1125833', '0.065', '0'), ('0', '-0.13', '0')],
                    ('0.05', '0.5'), ('0.1', '0.55'), ('0.03', '0.014', '-0.021'), ('0', '0', '1', '0', '0', '0'),
                    ['10000'] * 3 + ['1000000'] * 3)
ROBOT2 = octahedral([('0', '0.3', '0'), ('-0.2598076', '-0.15', '0'), ('0.2598076', '-0.15', '0')],
                    [('-0.1299038', '0.075', '0'), ('0.1299038', '0.075', '0'), ('0', '-0.15', '0')],
                    ('0.1', '6.58'), ('0.2', '0.6'), ('0', '0', '0'), ('0', '0', '5.886', '0', '0', '0'),
                    ['10000'] * 6)

SLICE = {'parameters': [{'name': 'phi', 'kind': 'periodic'}, {'name': 'theta', 'kind': 'real'}], 'constants': {},
         'flip': [0, 1], 'pose': {'px': '0', 'py': '0', 'pz': '0.35', 'phi': 'phi', 'theta': 'theta',
                                  'sigma': '(34)*pi/180'}, 'constraints': []}
SPHERE = {'parameters': [{'name': 'alpha1', 'kind': 'periodic'},
                         {'name': 'alpha2', 'kind': 'range', 'range': ['-pi/2', 'pi/2']}],
          'constants': {'rs': '0.13', 'zs': '0.306'}, 'flip': None,
          'pose': {'px': 'rs*cos(alpha2)*cos(alpha1)', 'py': 'rs*cos(alpha2)*sin(alpha1)', 'pz': 'zs - rs*sin(alpha2)',
                   'phi': 'alpha1 - pi', 'theta': 'pi/2 - alpha2', 'sigma': '0'}, 'constraints': []}


def problem(name, robot, space, query):
    return copy.deepcopy({'name': name, 'robot': robot[0], 'load': robot[1], 'tolerances': None, 'space': space,
                          'query': {'waypoints': query}})


# ---- the statics, in floating point ---------------------------------------------------------------------------------

def solve(A, B):
    """A^-1 B and det A."""
    n = len(A)
    W = [list(A[i]) + list(B[i]) for i in range(n)]
    det = 1.0
    for c in range(n):
        p = max(range(c, n), key=lambda i: abs(W[i][c]))
        if p != c:
            W[c], W[p], det = W[p], W[c], -det
        det *= W[c][c]
        W[c] = [x / W[c][c] for x in W[c]]
        for i in range(n):
            if i != c:
                W[i] = [x - W[i][c] * y for x, y in zip(W[i], W[c])]
    return [row[n:] for row in W], det


def evaluate(space, expressions, values):
    names = {k: getattr(math, k) for k in ('sqrt', 'sin', 'cos', 'tan', 'exp', 'log', 'atan2', 'pi')}
    names.update({k: float(v) for k, v in space['constants'].items()})
    names.update({p['name']: v for p, v in zip(space['parameters'], values)})
    return [eval(e.replace('^', '**'), names) for e in expressions]


def pose_of(space, values):
    return evaluate(space, [space['pose'][k] for k in ('px', 'py', 'pz', 'phi', 'theta', 'sigma')], values)


def frame(pr, values):
    """p and R at parameters; a pose (p, R) stays what it is."""
    if isinstance(values, tuple):
        return values
    px, py, pz, a, b, s = pose_of(pr['space'], values)
    g = s - a
    return [px, py, pz], [
        [cos(a) * cos(b) * cos(g) - sin(a) * sin(g), -cos(a) * cos(b) * sin(g) - sin(a) * cos(g), cos(a) * sin(b)],
        [sin(a) * cos(b) * cos(g) + cos(a) * sin(g), -sin(a) * cos(b) * sin(g) + cos(a) * cos(g), sin(a) * sin(b)],
        [-sin(b) * cos(g), sin(b) * sin(g), cos(b)]]


def geometry(pr, values):
    """Columns of J, and lengths."""
    p, R = frame(pr, values)
    turn = lambda v: [sum(R[i][j] * v[j] for j in range(3)) for i in range(3)]
    number = lambda v: [float(x) for x in v]
    pm = number(pr['load']['point_m'])
    columns, lengths = [], []
    for ai, bi in zip(pr['robot']['base_anchors_m'], pr['robot']['platform_anchors_m']):
        ai, bi = number(ai), number(bi)
        d = [x + y - z for x, y, z in zip(p, turn(bi), ai)]
        n = sqrt(sum(x * x for x in d))
        u = [x / n for x in d]
        r = turn([x - y for x, y in zip(bi, pm)])
        columns.append(u + [r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2], r[0] * u[1] - r[1] * u[0]])
        lengths.append(n)
    return columns, lengths


def statics(pr, values):
    """Lengths, f0, v, det J."""
    columns, lengths = geometry(pr, values)
    number = lambda v: [float(x) for x in v]
    J = [[columns[j][i] for j in range(6)] for i in range(6)]
    inverse, det = solve(J, [[float(i == j) for j in range(6)] for i in range(6)])
    E = [number(row) for row in pr['load']['ellipsoid']]
    w = number(pr['load']['wrench'])
    f0 = [sum(x * y for x, y in zip(row, w)) for row in inverse]
    v = []
    for row in inverse:
        e, _ = solve(E, [[x] for x in row])
        v.append(sqrt(sum(x * y[0] for x, y in zip(row, e))))
    return lengths, f0, v, det


def margins_at(pr, values):
    lengths, f0, v, _ = statics(pr, values)
    tension, length, scale = [], [], []
    for i in range(6):
        lo, hi = map(float, pr['robot']['tension_N'][i])
        tension += [f0[i] - v[i] - lo, hi - f0[i] - v[i]]
        scale += [(f0[i] - lo) / v[i], (hi - f0[i]) / v[i]]
        lo, hi = map(float, pr['robot']['length_m'][i])
        length += [lengths[i] - lo, hi - lengths[i]]
    return min(tension), min(length), min(scale)


# ---- certificates ---------------------------------------------------------------------------------------------------

def waypoint(x, half_turns=None, normals=None):
    w = {'x': [hex64(v) for v in x], 'half_turns': half_turns or [0] * len(x)}
    if normals is not None:
        w['normals'] = [hex64(v) for v in normals]
    return w


def path(waypoints, spline=False, tubes=()):
    return {'interpolation': 'cubic-b-spline' if spline else 'straight-in-parameters', 'waypoints': waypoints,
            'tubes': [hex64(t) for t in tubes], 'pose_tubes': [], 'times': None}


def straight(*waypoints, tubes=()):
    return path(list(waypoints), tubes=tubes)


def spline(*corners, tubes=()):
    """Through the first and the last corner, and near the others."""
    return path([corners[0]] * 2 + list(corners) + [corners[-1]] * 2, True, tubes)


def pose(p, q, lengths=None):
    """A waypoint of the laws of poses."""
    w = {'position': [hex64(v) for v in p], 'quaternion': [hex64(v) for v in q]}
    if lengths is not None:
        w['lengths'] = [hex64(v) for v in lengths]
    return w


def poses(law, *waypoints, pose_tubes=(), times=None):
    return {'interpolation': law, 'waypoints': list(waypoints), 'tubes': [],
            'pose_tubes': [{'position': hex64(p), 'turn': hex64(u)} for p, u in pose_tubes], 'times': times}


def control_points(pa):
    return 4 if pa['interpolation'] == 'cubic-b-spline' else 2


def mix(pa, k, s, values):
    """`values` of the control points of segment k, mixed by the path's law."""
    n = control_points(pa)
    weights = [1 - s, s] if n == 2 else [(1 - s)**3 / 6, (3 * s**3 - 6 * s**2 + 4) / 6,
                                         (-3 * s**3 + 3 * s**2 + 3 * s + 1) / 6, s**3 / 6]
    points = [values(w) for w in pa['waypoints'][k:k + n]]
    return [sum(w * p[j] for w, p in zip(weights, points)) for j in range(len(points[0]))]


def times(A, B):
    return [[sum(x * B[k][j] for k, x in enumerate(row)) for j in range(len(B[0]))] for row in A]


def rotation(q):
    x, y, z, w = q
    n = x * x + y * y + z * z + w * w
    return [[e / n for e in row] for row in (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z))]


def quaternion(phi, theta, sigma):
    """Of Rz(phi) Ry(theta) Rz(sigma - phi)."""
    g = sigma - phi
    return [-sin(theta / 2) * sin((phi - g) / 2), sin(theta / 2) * cos((phi - g) / 2), cos(theta / 2) * sin((phi + g) / 2),
            cos(theta / 2) * cos((phi + g) / 2)]


def between_poses(pr, pa, k, s):
    """Where segment k is at s, under a law of poses: slerp as quaternions mix, or Newton's method on the lengths."""
    numbers = lambda key: [[float.fromhex(x) for x in w[key]] for w in (pa['waypoints'] + pa['waypoints'][-1:])[k:k + 2]]
    mixed = lambda a, b: [(1 - s) * x + s * y for x, y in zip(a, b)]
    p = mixed(*numbers('position'))
    a, b = ([x / sqrt(sum(y * y for y in q)) for x in q] for q in numbers('quaternion'))
    c = sum(x * y for x, y in zip(a, b))
    if c < 0:
        b, c = [-x for x in b], -c
    if pa['interpolation'] == 'geodesic':
        half = math.acos(min(1, c))
        if half < 1e-9:
            return p, rotation(a)
        return p, rotation([(sin((1 - s) * half) * x + sin(s * half) * y) / sin(half) for x, y in zip(a, b)])
    tube = pa['pose_tubes'][k]
    ends = (pa['waypoints'] + pa['waypoints'][-1:])[k:k + 2]
    places = [(Fraction(0), ends[0], tube)] + [(Fraction(i['s']), i, i['tube']) for i in tube.get('inner', [])] + [(Fraction(1), ends[1], None)]
    j = max(j for j in range(len(places) - 1) if places[j][0] <= s)
    (begin, first, tube), (end, last, _) = places[j:j + 2]
    t = (s - float(begin)) / float(end - begin)
    at = lambda key: [(1 - t) * float.fromhex(x) + t * float.fromhex(y) for x, y in zip(first[key], last[key])]
    return with_lengths(pr, (at('position'), rotation(at('quaternion'))), mixed(*numbers('lengths')), tube)


def bent(pr, first, last, parts, sizes):
    """One segment of straight lengths between two poses, with inner poses that are on the motion."""
    lengths = [geometry(pr, (p, rotation(q)))[1] for p, q in (first, last)]
    inner, (p, q) = [], first
    for n in range(1, parts):
        wanted = [(1 - n / parts) * x + n / parts * y for x, y in zip(*lengths)]
        p, R = with_lengths(pr, (p, rotation(q)), wanted, {'position': '1', 'turn': '1'})
        new = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1], 1 + R[0][0] + R[1][1] + R[2][2]]
        size = sqrt(sum(x * x for x in new)) * (1 if sum(x * y for x, y in zip(new, q)) > 0 else -1)
        q = [x / size for x in new]
        tube = dict(zip(('position', 'turn'), map(hex64, sizes)))
        inner.append({'s': dyadic(n, parts), **pose(p, q), 'tube': tube})
    path = poses('straight-in-cable-lengths', *[pose(*at, l) for at, l in zip((first, last), lengths)], pose_tubes=[sizes])
    path['pose_tubes'][0]['inner'] = inner
    return path


def with_lengths(pr, reference, lengths, tube):
    """The pose near a reference at which the cables have these lengths."""
    p, R = reference
    move = lambda z: ([x + y for x, y in zip(p, z)], times(rotation([*z[3:], 1]), R))
    off = lambda z: [a - b for a, b in zip(geometry(pr, move(z))[1], lengths)]
    z, h = [0.0] * 6, 1e-7
    for _ in range(20):
        columns = []
        for i in range(6):
            up, down = (off([x + e * (n == i) for n, x in enumerate(z)]) for e in (h, -h))
            columns.append([(x - y) / (2 * h) for x, y in zip(up, down)])
        step, _ = solve([[columns[j][i] for j in range(6)] for i in range(6)], [[x] for x in off(z)])
        z = [x - y[0] for x, y in zip(z, step)]
    assert max(map(abs, off(z))) < 1e-12, pr['name']
    assert max(map(abs, z[:3])) < float.fromhex(tube['position']) and max(map(abs, z[3:])) < float.fromhex(tube['turn'])
    return move(z)


def parameters(pr, pa, k, s):
    """Where segment k is at s, a pose under the laws of poses; with constraints, by Newton's method on differences."""
    if 'position' in pa['waypoints'][0]:
        return between_poses(pr, pa, k, s)
    line = mix(pa, k, s, lambda w: [float.fromhex(x) + pi * h for x, h in zip(w['x'], w['half_turns'])])
    count = len(pr['space']['constraints'])
    if count == 0:
        return line
    normals = mix(pa, k, s, lambda w: [float.fromhex(x) for x in w['normals']])
    move = lambda y: [x + sum(normals[j * count + i] * y[i] for i in range(count)) for j, x in enumerate(line)]
    C = lambda y: evaluate(pr['space'], pr['space']['constraints'], move(y))
    y, h = [0.0] * count, 1e-6
    for _ in range(20):
        nudged = [[C([y[n] + e * h * (n == i) for n in range(count)]) for e in (1, -1)] for i in range(count)]
        jacobian = [[(nudged[i][0][e] - nudged[i][1][e]) / (2 * h) for i in range(count)] for e in range(count)]
        step, _ = solve(jacobian, [[c] for c in C(y)])
        y = [a - b[0] for a, b in zip(y, step)]
    assert max(map(abs, C(y))) < 1e-13 and max(map(abs, y)) < float.fromhex(pa['tubes'][k]), (pr['name'], k, s, y)
    return move(y)


def dyadic(k, m):
    f = Fraction(k, m)
    return str(f)


def certificate(pr, pa, verdict, **more):
    c = {'format': 'taut-certificate', 'version': 3, 'generator': {'name': 'make_certificates.py', 'version': '1'},
         'verdict': verdict, 'claim': CLAIMS[verdict], 'problem': pr, 'path': pa, 'segments': [], 'margins': {},
         'witness': None, 'stretches': None, 'source': None, 'undecided': None, 'illustration': None}
    c.update(more)
    return seal(c)


def proved(pr, pa, boxes=8, below=0.995, samples=400):
    n = control_points(pa)
    segments = []
    for k in range(len(pa['waypoints']) - n + 1):
        sampled = [margins_at(pr, parameters(pr, pa, k, i / samples)) for i in range(samples + 1)]
        lowest = [min(m[j] for m in sampled) * below for j in range(3)]
        assert lowest[0] > 0 and lowest[1] > 0 and lowest[2] >= 1, (pr['name'], k, lowest)
        segments.append(segment(k, n, lowest, boxes))
    return of_segments(pr, pa, segments)


KEYS = ('tension_N', 'length_m', 'wrench_scale')


def segment(k, n, margins, boxes):
    return {'from': k, 'to': k + n - 1, 'boxes': [[dyadic(i, boxes), dyadic(i + 1, boxes)] for i in range(boxes)],
            'margins': {key: '%.6e' % x for key, x in zip(KEYS, margins)}}


def of_segments(pr, pa, segments):
    margins = {key: min((s['margins'][key] for s in segments), key=float) for key in KEYS}
    return certificate(pr, pa, 'proved', segments=segments, margins=margins)


def asserted(pr, pa, boxes=1):
    """Claims of margins so small that nothing but the motion itself can be in doubt."""
    n = control_points(pa)
    return of_segments(pr, pa, [segment(k, n, (1e-6, 1e-6, 1), boxes) for k in range(len(pa['waypoints']) - n + 1)])


def enclosing(x):
    return ['%.10f' % (x - 1e-8), '%.10f' % (x + 1e-8)]


def write(folder, name, c, why, expect=None):
    """`c`: a certificate, or the file's bytes."""
    data = c if isinstance(c, bytes) else (json.dumps(c, indent=1, ensure_ascii=True) + '\n').encode('ascii')
    base = os.path.join(HERE, folder, name)
    with open(base + '.json', 'wb') as f:
        f.write(data)
    with open(base + '.txt', 'w') as f:
        f.write(why + '\n' + ('expect: ' + expect + '\n' if expect else ''))


def changed(c, edit, reseal=True):
    c = json.loads(json.dumps(c))  # a copy of each waypoint, also where several are one object
    edit(c)
    return seal(c) if reseal else c


def reject(name, c, why, expect, edit=lambda c: None):
    """Well formed, but false: every digest is right."""
    write('rejected', name, changed(c, edit), why, expect)


def malform(name, why, expect, edit, c, reseal=True):
    """Against the format."""
    write('malformed', name, changed(c, edit, reseal), why, expect)


def raise_margin(key, factor, text=None):
    def edit(c):
        for s in c['segments']:
            s['margins'][key] = text or '%.6e' % (float(s['margins'][key]) * factor)
        c['margins'][key] = min((s['margins'][key] for s in c['segments']), key=float)
    return edit


def main():
    explicit_motions()
    splines()
    implied_motions()
    motions_between_poses()
    tolerated()
    stretches()
    held_deviations()
    grazing()


def explicit_motions():
    near = problem('robot1-near-start', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.2', '1.55']])
    a, m, b = waypoint([-2.3, 1.6]), waypoint([-2.26, 1.57]), waypoint([-2.2, 1.55])
    near_c = proved(near, straight(a, m, b))
    write('accepted', 'robot1_near_start', near_c, "Two short segments of Robot 1's slice, near the paper's q_s.")

    goal = problem('robot1-near-goal', ROBOT1, SLICE, [['1.7', '1.7'], ['1.65', '1.7']])
    write('accepted', 'robot1_near_goal', proved(goal, straight(waypoint([1.7, 1.7]), waypoint([1.65, 1.7])), 4),
          "A short segment near the paper's q_g.")

    flat = problem('robot1-through-zero-tilt', ROBOT1, SLICE, [['-2', '0.05'], ['-2', '-0.05']])
    write('accepted', 'robot1_through_zero_tilt', proved(flat, straight(waypoint([-2, 0.05]), waypoint([-2, -0.05])), 2),
          'theta passes 0, where tilt-and-torsion angles are singular and the pose is not.')

    flip = problem('robot1-flipped', ROBOT1, SLICE, [['1.2', '-0.05'], ['1.2', '0.05']])
    write('accepted', 'robot1_flipped', proved(flip, straight(waypoint([1.2, 0.05], [-1, 0]), waypoint([1.2, -0.05], [-1, 0])), 2),
          'Both waypoints are written as (phi + an odd half turn, -theta).')

    still = problem('robot1-start-is-goal', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.3', '1.6']])
    write('accepted', 'robot1_start_is_goal', proved(still, straight(a, a), 1), 'A plan whose start is its goal.')

    turned = problem('robot1-a-turn-later', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.2', '1.55']])
    write('accepted', 'robot1_a_turn_later', proved(turned, straight(waypoint([-2.3, 1.6], [4, 0]),
          waypoint([-2.2, 1.55], [4, 0])), 8), 'Both waypoints two whole turns on: the same poses.')

    sphere = problem('robot2-sphere', ROBOT2, SPHERE, [['0.55', 'pi/2'], ['0.55', '1.4']])
    sphere_c = proved(sphere, straight(waypoint([0.55, pi / 2]), waypoint([0.55, 1.4])), 8)
    write('accepted', 'robot2_sphere', sphere_c,
          "Robot 2 on the paper's sphere (16); starts at the end of a closed range, binary64(pi/2) < pi/2.")

    # Refuted.
    across = problem('robot1-straight', ROBOT1, SLICE, [['-2.3', '1.6'], ['1.7', '1.7']])
    ends = straight(waypoint([-2.3, 1.6]), waypoint([1.7, 1.7]))
    at, worst = None, None
    for k in range(65):
        lengths, f0, v, det = statics(across, parameters(across, ends, 0, k / 64))
        i = min(range(6), key=lambda n: f0[n] - v[n])
        if worst is None or f0[i] - v[i] < worst[1]:
            at, worst = k, (i, f0[i] - v[i])
    tension = certificate(across, ends, 'refuted', witness={
        'at': {'segment': 0, 's': dyadic(at, 64)}, 'kind': 'tension_min', 'cable': worst[0] + 1,
        'value': enclosing(worst[1]), 'limit': '0.05'})
    write('accepted', 'refuted_tension_min', tension, "The straight motion q_s to q_g: a cable would have to push.")

    up = copy.deepcopy(tension)
    best = max(((k, i, f0[i] + v[i]) for k in range(65) for _, f0, v, _ in [statics(across, parameters(across, ends, 0, k / 64))]
                for i in range(6)), key=lambda t: t[2])
    up['witness'] = {'at': {'segment': 0, 's': dyadic(best[0], 64)}, 'kind': 'tension_max', 'cable': best[1] + 1,
                     'value': enclosing(best[2]), 'limit': '0.5'}
    write('accepted', 'refuted_tension_max', seal(up), 'The same motion: a cable would have to pull too hard.')

    def high_slice(pz):
        space = copy.deepcopy(SLICE)
        space['pose']['pz'] = pz
        return space
    far = problem('robot1-too-far', ROBOT1, high_slice('0.6'), [['0', '0'], ['1', '0']])
    _, lengths = geometry(far, [0.0, 0.0])
    i = max(range(6), key=lambda n: lengths[n])
    write('accepted', 'refuted_length_max', certificate(far, straight(waypoint([0, 0])), 'refuted', witness={
        'at': {'waypoint': 0}, 'kind': 'length_max', 'cable': i + 1, 'value': enclosing(lengths[i]), 'limit': '0.55'}),
        "A path of a single waypoint, the query's first, 600 mm below the base: the cables do not reach.")
    close = problem('robot1-in-the-base', ROBOT1, high_slice('0'), [['1', '0'], ['0', '0']])
    _, lengths = geometry(close, [0.0, 0.0])
    i = min(range(6), key=lambda n: lengths[n])
    close['robot']['length_m'][i] = ['0.3', '0.55']
    assert lengths[i] < 0.3
    write('accepted', 'refuted_length_min', certificate(close, straight(waypoint([0, 0])), 'refuted', witness={
        'at': {'waypoint': 0}, 'kind': 'length_min', 'cable': i + 1, 'value': enclosing(lengths[i]), 'limit': '0.3'}),
        "The query's second waypoint, in the plane of the base, where J is singular: the length is refuted all the same.")

    dets = [statics(across, parameters(across, ends, 0, k / 64))[3] for k in range(65)]
    k = next(k for k in range(64) if dets[k] * dets[k + 1] < 0)
    singular = certificate(across, ends, 'refuted', witness={
        'kind': 'singular', 'at': {'segment': 0, 's': dyadic(k, 64)}, 'to': {'segment': 0, 's': dyadic(k + 1, 64)}})
    write('accepted', 'refuted_singular', singular, 'det J changes sign between two places of the straight motion.')

    # A periodic parameter may stand in many forms, as long as the pose closes.
    closing = copy.deepcopy(SLICE)
    closing.update(parameters=[{'name': 't', 'kind': 'periodic'}], constants={'two': '2.0'}, flip=None,
                   pose={'px': '0.001*sin(-two*t + 3*(t - 1))^2/(2 + cos(t))', 'py': '0*atan2(sin(t), 3 + tan(t)^2)',
                         'pz': '0.35 + 0*t^0', 'phi': '-2.3 + (t*1 - t^1)*1000 - 0*t', 'theta': '1.6',
                         'sigma': '(34)*pi/180'})
    closed = problem('robot1-closing', ROBOT1, closing, [['0.1'], ['0.2']])
    closed_c = proved(closed, straight(waypoint([0.1], [2]), waypoint([0.2], [2])), 8)
    write('accepted', 'robot1_closing', closed_c, 'The pose plainly closes along the periodic parameter; whole turns on.')

    # Well formed, but false: every digest is right.
    def robot(key, i, value):
        def edit(c):
            c['problem']['robot'][key][i] = value
        return edit

    reject('tension_margin_too_high', near_c, 'The tension margin is claimed 1 % too high.', 'tension margin',
           raise_margin('tension_N', 1.01))
    reject('length_margin_too_high', near_c, 'The length margin is claimed 1 % too high.', 'length margin',
           raise_margin('length_m', 1.01))
    reject('wrench_scale_too_high', near_c, 'K is claimed to grow by 1 % too much.', 'wrench scale',
           raise_margin('wrench_scale', 1.01))
    reject('margin_zero', near_c, 'A margin of zero proves no strict inequality.', 'not positive',
           raise_margin('tension_N', 0, '0'))
    reject('wrench_scale_below_one', near_c, 'Less than K is covered.', 'below 1', raise_margin('wrench_scale', 0, '0.99'))
    lo = min(statics(near, parameters(near, near_c['path'], 0, 0.5))[1])
    reject('tension_limit_above', near_c, 'A cable has to pull harder than it does.', 'lower tension margin',
           lambda c: c['problem']['robot'].update(tension_N=[['%.3f' % (lo + 0.02), '0.5']] * 6))
    reject('length_limit_below', near_c, 'A cable is shorter than it has to be.', 'upper length margin',
           robot('length_m', 0, ['0.1', '0.2']))
    reject('anchor_moved', near_c, 'A base anchor 4 cm off.', 'false', robot('base_anchors_m', 0, ['0.04', '0.22', '0']))
    reject('load_tilted', near_c, 'A side load of 0.3 N that the proof did not have.', 'false',
           lambda c: c['problem']['load'].update(wrench=['0.3', '0', '1', '0', '0', '0']))
    def shrink(c):
        for i in range(6):
            c['problem']['load']['ellipsoid'][i][i] = '100' if i < 3 else '10000'
    reject('ellipsoid_too_large', near_c, 'E a hundred times smaller: K ten times wider.', 'false', shrink)
    def indefinite(c):
        for i, j in ((0, 1), (1, 0)):
            c['problem']['load']['ellipsoid'][i][j] = '10000'
    reject('ellipsoid_singular', near_c, 'E is only positive semidefinite: K is unbounded.', 'positive definite',
           indefinite)
    def move(c):
        c['path']['waypoints'][1] = waypoint([-0.3, 1.65])
    reject('waypoint_outside', near_c, 'The waypoint in the middle lies outside C.', 'segment 0', move)
    def forget(c):
        c['problem']['query']['waypoints'].insert(1, ['-2.25', '1.5'])
    reject('query_waypoint_missed', near_c, 'The path does not pass the second of three waypoints.', 'query waypoint 1', forget)
    def nudge(c):
        c['path']['waypoints'][0] = waypoint([math.nextafter(-2.3, 0), 1.6])
    reject('start_one_ulp_off', near_c, 'The path starts one ulp beside what was typed.', 'query waypoint 0', nudge)
    def odd(c):
        c['path']['waypoints'] = [waypoint([-2.3 - pi, 1.6], [1, 0]), waypoint([-2.2 - pi, 1.55], [1, 0])]
        c['segments'].pop()
        c['margins'] = dict(c['segments'][0]['margins'])
    reject('odd_half_turn', near_c, 'An odd half turn with theta as typed is another pose.', 'query waypoint 0', odd)
    def leave(c):
        c['path']['waypoints'][0] = waypoint([0.55, math.nextafter(pi / 2, 2)])
        c['problem']['query']['waypoints'][0] = ['0.55', '1.5707963267948968']
    reject('range_left', sphere_c, 'A parameter starts one ulp outside its closed range.', 'in its range', leave)
    def refuted_at(x, query=across):
        _, f0, v, _ = statics(query, x)
        i = min(range(6), key=lambda n: f0[n] - v[n])
        assert f0[i] - v[i] < 0.05
        return {'kind': 'tension_min', 'cable': i + 1, 'value': enclosing(f0[i] - v[i]), 'limit': '0.05'}
    outside = [0.0, 3.0]
    write('rejected', 'refuted_beside_the_query', certificate(across, straight(waypoint(outside)), 'refuted', witness={
        'at': {'waypoint': 0}, **refuted_at(outside)}),
        "True of a pose that the query does not ask for: it says nothing of the case.", "none of the query's")
    write('rejected', 'refuted_path_leads_elsewhere', certificate(across, straight(ends['waypoints'][0], waypoint(outside)), 'refuted',
        witness={'at': {'waypoint': 1}, **refuted_at(outside)}),
        "A path from the query's start to a pose that the query does not ask for.", 'query waypoint 1')
    reject('witness_violates_nothing', tension, 'At the witness the tension is within its limits.', 'violates',
           lambda c: c['witness'].update(at={'segment': 0, 's': '0'}))
    reject('witness_value_off', tension, 'The value stated is not the one at the witness.', 'value',
           lambda c: c['witness'].update(value=['-0.0000001', '0']))
    reject('same_sign', singular, 'det D does not change its sign between these.', 'same sign',
           lambda c: c['witness'].update(to=c['witness']['at']))
    # The platform is turned upside down by a jump, not by passing a singular pose: a mirror image through z = 0.
    jump = copy.deepcopy(across)
    jump['space'].update(parameters=[{'name': 't', 'kind': 'real'}], flip=None,
                         pose={'px': '0', 'py': '0', 'pz': '0.35*sqrt(t^2)/t', 'phi': '0', 'theta': '0', 'sigma': '0.6'})
    jump['query']['waypoints'] = [['-1'], ['1']]
    d0, d1 = statics(jump, [-1.0])[3], statics(jump, [1.0])[3]
    assert d0 * d1 < 0, (d0, d1)
    write('rejected', 'sign_change_by_a_jump', certificate(jump, straight(waypoint([-1]), waypoint([1])), 'refuted', witness={
        'kind': 'singular', 'at': {'waypoint': 0}, 'to': {'waypoint': 1}}),
        'det J has opposite signs at the ends, but the path jumps between them, so that no pose need be singular.',
        'not confirmed')
    undef = problem('undefined', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.2', '1.55']])
    undef['space']['pose']['pz'] = '0.35 + 0*sqrt(-1)'
    bad = changed(near_c, lambda c: c.update(problem=undef))
    write('rejected', 'undefined_expression', bad, 'sqrt(-1) is no real number, not even times 0.', 'square root')

    # Against the format.
    def malform_near(name, why, expect, edit, **more):
        malform(name, why, expect, edit, near_c, **more)
    def set_boxes(boxes):
        def edit(c):
            c['segments'][0]['boxes'] = boxes
        return edit
    malform_near('boxes_with_a_gap', 'A part of the segment is in no box.', 'boxes', set_boxes([['0', '1/4'], ['1/2', '1']]))
    malform_near('boxes_overlapping', 'Boxes tile; they do not overlap.', 'boxes', set_boxes([['0', '3/4'], ['1/2', '1']]))
    malform_near('boxes_stop_early', 'The last box does not reach 1.', 'boxes', set_boxes([['0', '1/2']]))
    malform_near('boxes_empty', 'No box at all.', 'boxes', set_boxes([]))
    malform_near('box_no_dyadic', 'Ends are dyadic.', 'power of two', set_boxes([['0', '1/3'], ['1/3', '1']]))
    malform_near('box_not_lowest', 'Ends are in lowest terms.', 'lowest terms', set_boxes([['0', '2/4'], ['2/4', '1']]))
    malform_near('margins_not_the_worst', 'The top level claims more than a segment.', 'margins',
            lambda c: c['margins'].update(tension_N='1'))
    malform_near('margins_of_no_segment', 'The top level claims a number that no segment has.', 'margins',
            lambda c: c['margins'].update(tension_N='1e-9'))
    malform_near('claim_reworded', 'The theorem is not the one of the verdict.', 'claim',
            lambda c: c.update(claim=c['claim'].replace('every', 'some')))
    malform_near('claim_of_another_verdict', 'The theorem is not the one of the verdict.', 'claim',
            lambda c: c.update(claim=CLAIMS['refuted']))
    malform_near('altered', 'A digit changed after it was sealed.', 'altered',
            lambda c: c['margins'].update(tension_N='1e-9'), reseal=False)
    malform_near('limits_reversed', 'lower < upper.', 'lower < upper', robot('tension_N', 2, ['0.5', '0.05']))
    malform_near('limit_negative', 'Cables do not push.', '0 <= lower', robot('tension_N', 2, ['-0.1', '0.5']))
    malform_near('ellipsoid_asymmetric', 'E is symmetric.', 'symmetric',
            lambda c: c['problem']['load']['ellipsoid'][0].__setitem__(1, '1'))
    malform_near('flip_of_others', 'phi is not the parameter that flip says.', 'flip',
            lambda c: c['problem']['space'].update(flip=[1, 0]))
    malform_near('flip_mentioned', 'sigma depends on phi, so that (phi + pi, -theta) is another pose.', 'flip',
            lambda c: c['problem']['space']['pose'].update(sigma='2*phi'))
    malform_near('flip_theta_periodic', 'theta is of kind real where (phi + pi, -theta) is the same pose.', 'theta of kind real',
            lambda c: c['problem']['space']['parameters'][1].update(kind='periodic'))
    malform_near('flip_phi_real', 'phi is of kind periodic where (phi + pi, -theta) is the same pose.', 'phi of kind periodic',
            lambda c: c['problem']['space']['parameters'][0].update(kind='real'))
    # Half turns of a parameter that is no angle would detach the path from the query: here the typed start, t = 0,
    # is 8.35 m below the base, and the path stays at t = 2 pi, 0.35 m below it.
    falling = copy.deepcopy(SLICE)
    falling.update(parameters=[{'name': 't', 'kind': 'periodic'}], flip=None,
                   pose={'px': '0', 'py': '0', 'pz': '0.35 + 8*(1 - t/(2*pi))', 'phi': '-2.3', 'theta': '1.6',
                         'sigma': '(34)*pi/180'})
    fallen = problem('robot1-falling', ROBOT1, falling, [['0'], ['0']])
    write('malformed', 'periodic_position', proved(fallen, straight(*[waypoint([0.0], [2])] * 2), 1),
          'A position that is not the same after a turn of a periodic parameter.', 'pz: expected the same pose')

    def pose(**coordinates):
        return lambda c: c['problem']['space']['pose'].update(coordinates)
    malform('periodic_position_linear', 'px moves on with each turn.', 'px: expected the same', pose(px='t*0.002'), closed_c)
    malform('periodic_position_whole', 'So it does by whole metres.', 'px: expected the same', pose(px='t*2'), closed_c)
    malform('periodic_half_angle', 'After one turn phi is half a turn on.', 'phi: expected the same', pose(phi='t/2'),
            closed_c)
    malform('periodic_half_angle_in_sine', 'sin(t/2) changes its sign.', 'py: expected the same', pose(py='sin(t/2)'),
            closed_c)
    malform('periodic_squared', 'No multiple of 2 pi.', 'sigma: expected the same', pose(sigma='t*t'), closed_c)
    malform('periodic_exponential', 'exp does not close.', 'theta: expected the same', pose(theta='exp(t)'), closed_c)
    malform_near('query_of_one_waypoint', 'A query leads from one waypoint to another.', 'at least two waypoints',
            lambda c: c['problem']['query']['waypoints'].pop())
    def fix(c):
        c['problem']['space'].update(parameters=[], flip=None)
        pose(phi='-2.3', theta='1.6')(c)
        c['problem']['query'].update(waypoints=[[], []])
        c['path'].update(waypoints=[waypoint([])] * len(c['path']['waypoints']))
    malform('query_with_a_name', "A query's values are constant expressions: no names but pi.", 'known name',
            lambda c: c['problem']['query']['waypoints'][0].__setitem__(0, '0*rs + 0.55'), sphere_c)
    malform('range_with_a_name', "So are a range's ends.", 'known name',
            lambda c: c['problem']['space']['parameters'][1].update(range=['-pi/2 + 0*rs', 'pi/2']), sphere_c)
    malform_near('no_parameters', 'Nothing could move.', 'at least one parameter', fix)
    malform_near('expression_with_a_tab', 'Blanks are the only white space.', 'printable', pose(px='0\t'))
    malform_near('expression_not_ascii', 'A minus sign of another script.', 'printable', pose(px='\u22120'))
    malform_near('half_turn_of_a_real', 'Half turns are for periodic parameters.', 'half_turns',
            lambda c: c['path']['waypoints'][0].update(half_turns=[0, 2]))
    malform_near('one_waypoint', 'A path of one waypoint has no segment to prove.', 'at least two',
            lambda c: (c.update(segments=[], margins={}), c['path'].update(waypoints=c['path']['waypoints'][:1])))
    malform_near('waypoint_decimal', 'Waypoints are binary64.', 'binary64',
            lambda c: c['path']['waypoints'][0]['x'].__setitem__(0, '-2.3'))
    malform_near('waypoint_rounded', 'A 54th bit: no binary64.', 'binary64',
            lambda c: c['path']['waypoints'][0]['x'].__setitem__(0, '-0x1.26666666666668p+1'))
    malform_near('waypoint_infinite', 'Finite.', 'binary64', lambda c: c['path']['waypoints'][0]['x'].__setitem__(0, 'inf'))
    malform_near('decimal_nan', 'nan is no decimal.', 'decimal', lambda c: c['problem']['load']['wrench'].__setitem__(0, 'nan'))
    malform_near('number_for_string', 'Reals are strings.', 'a string',
            lambda c: c['problem']['load']['wrench'].__setitem__(0, 0))
    malform_near('fractional_number', 'No JSON number carries a real value.', 'no integer',
            lambda c: c.update(illustration=0.5))
    malform_near('unknown_key', 'Keys are fixed.', 'no key', lambda c: c.update(note='hello'))
    malform_near('expression_unknown_name', 'A name that is neither parameter nor constant.', 'known name',
            lambda c: c['problem']['space']['pose'].update(sigma='omega'))
    malform_near('constant_named_pi', 'pi has a meaning already.', "not 'pi'",
            lambda c: c['problem']['space'].update(constants={'pi': '3'}))
    whole = json.dumps(near_c).encode('ascii')
    write('malformed', 'cut', whole[:len(whole) // 2], 'Half a file.', 'cut')
    write('malformed', 'empty', b'', 'Nothing.', 'cut')
    write('malformed', 'trailing', whole + b'{}', 'Something after the end.', 'no JSON')
    write('malformed', 'nul_and_trailing', whole + b'\0{"verdict": "refuted"}\xff', 'A NUL byte does not end the file.',
          'NUL')
    write('malformed', 'byte_order_mark', b'\xef\xbb\xbf' + whole, 'The file begins with its first brace.',
          'byte order mark')
    write('malformed', 'message_breaks_the_line', changed(near_c, lambda c: c.update({'\r\x1b[2Kaccepted\n\u00e4': ''})),
          'What a file says can not pass for what the checker says.', r"no key '\x0d\x1b[2Kaccepted\x0a\xc3\xa4'")
    write('malformed', 'duplicate_key', whole.replace(b'"verdict": "proved"', b'"verdict": "proved", "verdict": "proved"'),
          'Which of the two counts?', 'twice')
    write('malformed', 'deep', b'[' * 100000, 'A nesting bomb.', 'deep')


def splines():
    near = problem('robot1-near-start', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.2', '1.55']])
    a, m, b = waypoint([-2.3, 1.6]), waypoint([-2.26, 1.57]), waypoint([-2.2, 1.55])
    across = problem('robot1-straight', ROBOT1, SLICE, [['-2.3', '1.6'], ['1.7', '1.7']])
    bend = spline(a, waypoint([-2.27, 1.59]), m, b)
    bend_c = proved(near, bend, 4, samples=100)
    write('accepted', 'spline', bend_c, 'A cubic B-spline, triple at both ends.')
    inner = problem('robot1-spline-through', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.26', '1.57'], ['-2.2', '1.55']])
    write('accepted', 'spline_through_three', proved(inner, spline(a, m, m, m, b), 4, samples=100),
          'The waypoint in the middle stands three times, so that the spline goes through it.')
    reel = waypoint([-2.3, -1.6], [3, 0])
    turned_spline = problem('robot1-spline-still', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.3', '1.6']])
    write('accepted', 'spline_flipped', proved(turned_spline, path([reel] * 4, True), 1),
          'A spline that stands still, at the other representation of its pose.')
    across_spline = spline(waypoint([-2.3, 1.6]), waypoint([-0.3, 1.65]), waypoint([1.7, 1.7]))
    worst = min(((k, n, i, f0[i] - v[i]) for k in range(4) for n in range(9)
                 for _, f0, v, _ in [statics(across, parameters(across, across_spline, k, n / 8))] for i in range(6)),
                key=lambda t: t[3])
    spline_tension = certificate(across, across_spline, 'refuted', witness={
        'at': {'segment': worst[0], 's': dyadic(worst[1], 8)}, 'kind': 'tension_min', 'cable': worst[2] + 1,
        'value': enclosing(worst[3]), 'limit': '0.05'})
    write('accepted', 'refuted_spline', spline_tension, 'A spline on which a cable would have to push.')
    signs = [(k, n, statics(across, parameters(across, across_spline, k, n / 16))[3]) for k in range(4) for n in range(17)]
    i = next(i for i in range(len(signs) - 1) if signs[i][2] * signs[i + 1][2] < 0)
    write('accepted', 'refuted_spline_singular', certificate(across, across_spline, 'refuted', witness={
        'kind': 'singular', 'at': {'segment': 0, 's': '0'},
        'to': {'segment': signs[i + 1][0], 's': dyadic(signs[i + 1][1], 16)}}),
        'det J changes sign along a spline, over several segments.')
    # Well formed, but false.
    def unpin(c):
        c['path']['waypoints'].pop(0)
        c['segments'].pop()
    renumber = lambda edit: lambda c: (edit(c), [s.update({'from': k, 'to': k + 3}) for k, s in enumerate(c['segments'])],
                                       c.update(margins=of_segments(near, bend, c['segments'])['margins']))
    reject('spline_begins_beside_the_query', bend_c, 'The start stands only twice: the spline begins beside it.',
           'query waypoint 0', renumber(unpin))
    def release(c):
        c['path']['waypoints'].pop()
        c['segments'].pop()
    reject('spline_ends_beside_the_query', bend_c, 'The goal stands only twice: the spline ends before it.',
           'query waypoint 1', renumber(release))
    reject('spline_passes_by', proved(inner, spline(a, m, m, b), 4, samples=40),
           'The waypoint in the middle stands only twice: the spline passes beside it.', 'query waypoint 1')
    reject('spline_margin_too_high', bend_c, 'The tension margin is claimed 1 % too high.', 'tension margin',
           raise_margin('tension_N', 1.01))
    reject('spline_taken_for_straight', changed(bend_c, lambda c: c['path'].update(waypoints=[a, b] * 4)),
           'A spline through other waypoints.', 'query waypoint 0')
    def swing(c):
        c['path']['waypoints'][3] = waypoint([-0.3, 1.65])
    reject('spline_control_point_outside', bend_c, 'A control point far outside C draws the spline with it.', 'segment 0', swing)

    # Against the format.
    malform('spline_of_three', 'A spline has four control points a segment.', 'at least four',
            lambda c: c['path'].update(waypoints=[a, a, a]), bend_c)
    malform('spline_segment_of_two', "A spline's segment has four control points.", 'to: expected an integer from 3 to 3',
            lambda c: c['segments'][0].update(to=1), bend_c)
    malform('spline_segment_missing', 'One segment for each four successive waypoints.', 'segments: expected an array',
            lambda c: c['segments'].pop(), bend_c)
    malform('spline_witness_at_a_waypoint', 'A spline need not pass its control points.', "the key 'segment'",
            lambda c: c['witness'].update(at={'waypoint': 3}), spline_tension)
    malform('spline_witness_beyond', 'There are as many segments as three fewer than waypoints.', 'witness.at.segment: expected',
            lambda c: c['witness'].update(at={'segment': len(c['path']['waypoints']) - 3, 's': '0'}), spline_tension)
    malform('interpolation_unknown', 'There are four laws.', 'a law of the format',
            lambda c: c['path'].update(interpolation='quintic'), bend_c)


def implied_motions():
    free = [{'name': n, 'kind': k} for n, k in (('px', 'real'), ('py', 'real'), ('pz', 'real'), ('phi', 'periodic'),
                                                ('theta', 'real'), ('sigma', 'real'))]
    ball = {'parameters': free, 'constants': {'rs': '0.13', 'zs': '0.306'}, 'flip': [3, 4],
            'pose': {p['name']: p['name'] for p in free}, 'constraints': ['px^2 + py^2 + (pz - zs)^2 - rs^2']}
    def on_sphere(a1, a2):
        return [0.13 * cos(a2) * cos(a1), 0.13 * cos(a2) * sin(a1), 0.306 - 0.13 * sin(a2), a1 - pi, pi / 2 - a2, 0.0]
    def on_ball(a1, a2, half_turns=None):
        x = on_sphere(a1, a2)
        return waypoint(x, half_turns, [x[0] / 0.13, x[1] / 0.13, (x[2] - 0.306) / 0.13, 0, 0, 0])
    def typed(w):
        return ['%.17g' % float.fromhex(x) for x in w['x']]
    def between_typed(*waypoints):
        return [typed(w) for w in waypoints]

    u, v, w = on_ball(0.55, 1.5), on_ball(0.6, 1.45), on_ball(0.6, 1.4)
    ball_problem = problem('robot2-ball', ROBOT2, ball, between_typed(u, w))
    ball_c = proved(ball_problem, straight(u, v, w, tubes=[2**-9, 2**-10]), 2, samples=60)
    write('accepted', 'implied_sphere', ball_c,
          'The platform stays on a sphere, free to turn; two segments with tubes of different widths.')
    accepted_spline = proved(ball_problem, spline(u, v, w, tubes=[2**-9] * 4), 2, samples=60)
    write('accepted', 'implied_sphere_spline', accepted_spline, 'The same along a spline: smooth, and on the sphere.')
    write('accepted', 'implied_start_is_goal', proved(problem('robot2-ball-still', ROBOT2, ball, between_typed(u, u)),
          straight(u, u, tubes=[2**-20]), 1, samples=1), 'A plan whose start is its goal, on the sphere.')

    facing = dict(ball, flip=None, constraints=['px + rs*sin(theta)*cos(phi)', 'py + rs*sin(theta)*sin(phi)',
                                                'pz - zs + rs*cos(theta)', 'sigma'])
    def gradients(x):
        """The transpose of dC/dlambda, by rows."""
        f, t = x[3], x[4]
        r = 0.13
        return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -r * sin(t) * sin(f), r * sin(t) * cos(f), 0, 0,
                r * cos(t) * cos(f), r * cos(t) * sin(f), -r * sin(t), 0, 0, 0, 0, 1]
    def facing_at(a1, a2):
        x = on_sphere(a1, a2)
        return waypoint(x, None, gradients(x))
    u4, w4 = facing_at(0.55, 1.5), facing_at(0.55, 1.4)
    facing_problem = problem('robot2-facing', ROBOT2, facing, between_typed(u4, w4))
    write('accepted', 'implied_facing', proved(facing_problem, straight(u4, w4, tubes=[2**-8]), 2, samples=60),
          'Four constraints: on the sphere, and turned towards its centre.')

    # Toy spaces: the pose depends on t, and what x does is up to the constraint.
    def toy(constraint, *extra, x=None, pose=None):
        return {'parameters': [{'name': 't', 'kind': 'real'}, x or {'name': 'x', 'kind': 'real'}] +
                [{'name': n, 'kind': 'real'} for n in extra], 'constants': {}, 'flip': None,
                'pose': dict({'px': '0.001*x', 'py': '0', 'pz': '0.35', 'phi': '-2.3 + 0.1*t', 'theta': '1.6 - 0.05*t',
                              'sigma': '(34)*pi/180'}, **(pose or {})),
                'constraints': [constraint] if isinstance(constraint, str) else constraint}
    def toy_path(space, points, normals, tubes, law=straight):
        """From (t, x, ...) to (t, x, ...)."""
        points = [waypoint(x, None, n) for x, n in zip(points, normals)]
        return problem('toy', ROBOT1, space, between_typed(points[0], points[-1])), law(*points, tubes=tubes)
    def toy_c(constraint, points=((0, 0), (1, 0)), normals=((0, 1), (0, 1)), tubes=(0.5,), boxes=1, **more):
        return asserted(*toy_path(toy(constraint, **more), points, normals, tubes), boxes)

    write('accepted', 'implied_one_of_two_sheets', toy_c('(x - t/16)*(x + 1)', tubes=[0.125]),
          'The constraint has two sheets; the tube holds one of them.')
    write('accepted', 'implied_between_close_zeros', toy_c('(x^2 - 1e-18)*(1 + t)', points=((0, 1e-9), (1, 1e-9)),
          tubes=[2**-31]), 'Two zeros 2e-9 apart, of which a very thin tube holds one.')
    write('accepted', 'implied_narrow_then_wide', toy_c('x + t^2/16', points=((0, 0), (0.5, -1 / 64), (1, -1 / 16)),
          normals=((0, 1),) * 3, tubes=[2**-6, 4]), 'At the joint a wide tube has the same zero as a narrow one.')
    write('accepted', 'implied_oblique_normals', toy_c('x - t/16', normals=((0.25, 1), (-0.5, 2))),
          'Normals need not be normal, nor of length 1, nor constant.')
    write('accepted', 'implied_two_coupled', asserted(*toy_path(toy(['x + z - t/8', 'x - z + t^2/8'], 'z'),
          ((0, 0, 0), (1, 0, 0.125)), ((0, 0, 1, 1, 1, -1),) * 2, [0.5]), 2), 'Two constraints, mixed by their normals.')
    write('accepted', 'implied_one_y_stays_zero', asserted(*toy_path(toy(['x - t^2/8', 'z - (x - t^2/8)^2'], 'z'),
          ((0, 0, 0), (1, 0.125, 0)), ((0, 0, 1, 0, 0, 1),) * 2, [0.125])),
          'One unknown is 0 all along while the other moves: a box about both has to have room for both.')
    within = {'name': 'x', 'kind': 'range', 'range': ['-1/8', '1/8']}
    write('accepted', 'implied_within_range', toy_c('x - t*(1 - t)/4', x=within),
          'Between its ends the motion comes close to the end of a range.')

    def implied_slice(constraint):
        space = copy.deepcopy(SLICE)
        space['parameters'].append({'name': 'z', 'kind': 'real'})
        space['pose']['pz'] = 'z'
        space.update(flip=None, constraints=[constraint])
        return space
    def z_up(phi, theta, half_turns=None):
        return waypoint([phi, theta, 0.35], half_turns, [0, 0, 1])
    wave = problem('robot1-wave', ROBOT1, implied_slice('z - 0.35 - 0.003*sin(phi + 2.3)'),
                   between_typed(z_up(-2.3, 1.6), z_up(1.7, 1.7)))
    wave_ends = straight(z_up(-2.3, 1.6), z_up(1.7, 1.7), tubes=[0.0625])
    scan = [(n, statics(wave, parameters(wave, wave_ends, 0, n / 64))) for n in range(65)]
    n, i, value = min(((n, i, f0[i] - v[i]) for n, (_, f0, v, _) in scan for i in range(6)), key=lambda t: t[2])
    wave_tension = certificate(wave, wave_ends, 'refuted', witness={
        'at': {'segment': 0, 's': dyadic(n, 64)}, 'kind': 'tension_min', 'cable': i + 1, 'value': enclosing(value),
        'limit': '0.05'})
    write('accepted', 'refuted_implied', wave_tension, 'On an implied motion a cable would have to push.')
    n = next(n for n in range(64) if scan[n][1][3] * scan[n + 1][1][3] < 0)
    wave_singular = certificate(wave, wave_ends, 'refuted', witness={
        'kind': 'singular', 'at': {'segment': 0, 's': dyadic(n, 64)}, 'to': {'segment': 0, 's': dyadic(n + 1, 64)}})
    write('accepted', 'refuted_implied_singular', wave_singular, 'det J changes sign on an implied motion.')
    here = problem('robot1-wave-here', ROBOT1, implied_slice('z - 0.55 - 0.01*sin(phi + 2.3)'),
                   between_typed(z_up(-2.3, 1.6), z_up(1.7, 1.7)))
    one = path([waypoint([-2.3, 1.6, 0.552], None, [0, 0, 1])], tubes=[0.0625])
    here['query']['waypoints'] = [typed(one['waypoints'][0]), typed(z_up(1.7, 1.7))]
    _, lengths = geometry(here, [-2.3, 1.6, 0.55])
    i = max(range(6), key=lambda n: lengths[n])
    assert lengths[i] > 0.55
    write('accepted', 'refuted_implied_waypoint', certificate(here, one, 'refuted', witness={
        'at': {'waypoint': 0}, 'kind': 'length_max', 'cable': i + 1, 'value': enclosing(lengths[i]), 'limit': '0.55'}),
        'A path of one waypoint, and of one tube: the pose on the constraint, 2 mm above the waypoint, is too far.')

    # A normal that is nearly tangent makes the rounding of 0.35 a way of 2 rad, to a pose that the query never asked for.
    rounding = Fraction(0.35) - Fraction(7, 20)
    astray = waypoint([-2.3, 1.6, 0.35], None, [1, 0, float(-rounding / 2)])
    led = problem('robot1-led-astray', ROBOT1, implied_slice('z - 0.35'), between_typed(z_up(-2.3, 1.6), z_up(1.7, 1.7)))
    _, f0, v, _ = statics(led, [-0.3, 1.6, 0.35])
    i = min(range(6), key=lambda n: f0[n] - v[n])
    assert f0[i] - v[i] < 0.05
    write('rejected', 'implied_query_led_astray', certificate(led, path([astray], tubes=[4.0]), 'refuted', witness={
        'at': {'waypoint': 0}, 'kind': 'tension_min', 'cable': i + 1, 'value': enclosing(f0[i] - v[i]), 'limit': '0.05'}),
        'A true refutation of a pose 2 rad from the waypoint, where a nearly tangent normal leads.', 'next to what the path states')

    # Well formed, but false: no motion, or not the only one, or not where it has to be.
    unique, inside, exists = 'it may not be the only one in its tube', 'it may leave its tube', 'the motion on the constraints'
    reject('implied_tube_too_narrow', ball_c, 'The sphere bulges out of the tube.', inside,
           lambda c: c['path'].update(tubes=[hex64(2**-16)] * 2))
    reject('implied_tube_holds_two_sheets', toy_c('(x - t/8)*(x + 1)', tubes=[1.5]), 'The tube holds two sheets.', unique)
    reject('implied_tube_around_the_sphere', ball_c, 'The tube reaches the other side of the sphere.', unique,
           lambda c: c['path'].update(tubes=[hex64(0.5)] * 2))
    reject('implied_close_zeros', toy_c('(x^2 - 1e-18)*(1 + t)'), 'Two zeros 2e-9 apart, both in the tube.', exists)
    reject('implied_double_zero', toy_c('x^2'), 'There is one zero; but it is double, so that rounding C would lose it.', exists)
    reject('implied_triple_zero', toy_c('x^3'), 'There is one zero, and it is singular.', exists)
    reject('implied_no_zero', toy_c('x^2 + 1e-30', normals=((0.5, 1),) * 2), 'There is no zero at all.', exists)
    reject('implied_audit_led_astray', toy_c('x - 1/4', pose={'px': '0.04*x'}),
           'A motion 10 mm from where the path says, in an audit, which has no query to compare with.', 'next to what the path states',
           lambda c: c['problem'].update(query={'waypoints': []}))
    reject('implied_no_zero_in_the_tube', toy_c('x - 1', tubes=[0.875]), 'The zero is outside the tube.', inside)
    reject('implied_zero_at_the_end_of_the_tube', toy_c('x - 1', tubes=[1]), 'The zero is not inside the tube, but at its end.', inside)
    reject('implied_without_y', toy_c('t - t + 0*x'), 'The constraint says nothing of x: any is a zero.', exists)
    reject('implied_never_fulfilled', toy_c('1 + 0*x'), 'The constraint is a constant.', exists)
    reject('implied_jump_of_atan2', toy_c('x - 0.01*atan2(t - 0.3, -1)'), 'The zero jumps where atan2 passes its cut.', 'atan2')
    reject('implied_jump_of_a_sign', toy_c('x - 0.01*sqrt((t - 0.3)^2)/(t - 0.3)'), 'The zero jumps where t - 0.3 changes its sign.',
           exists)
    reject('implied_jump_between_boxes', toy_c('x - 0.01*atan2(t - 0.5, -1)', boxes=2),
           'The zero jumps just where one box ends and the next begins.', 'atan2')
    reject('implied_pole', toy_c('x - 0.001/(t - 0.5)', boxes=2), 'The zero runs off to infinity.', exists)
    reject('implied_root_in_the_tube', toy_c('sqrt(x + 0.01) - 0.1'), 'C is not defined in all of the tube.', 'square root')
    reject('implied_kink', toy_c('x + sqrt(x^2)/2', normals=((0.5, 1),) * 2),
           'One zero, but C has no derivative there.', exists)
    reject('implied_normals_tangent', toy_c('x - t/16', normals=((1, 1 / 16),) * 2), 'The normals lie in the surface.', exists)
    reject('implied_normals_vanish', toy_c('x', normals=((0, 1), (0, 0))), 'The normals vanish at the end.', exists)
    reject('implied_normals_flip', toy_c('x', normals=((0, 1), (0, -1))), 'The normals change their sign half-way, where they vanish.',
           exists)
    reject('implied_normals_flip_inside_a_box', toy_c('x', normals=((0, 1), (0, -2)), boxes=2),
           'So they do at 1/3, no end or middle of a box.', exists)
    reject('implied_normals_turn_into_the_surface', toy_c('x', normals=((1, 1), (1, -1))), 'The normals turn through the surface.', exists)
    reject('implied_rank_deficient', asserted(*toy_path(toy(['x + z - t/8', '2*x + 2*z - t/4'], 'z'),
           ((0, 0, 0), (1, 0, 0.125)), ((0, 0, 1, 0, 0, 1),) * 2, [0.5])), 'The second constraint repeats the first.', exists)
    reject('implied_rank_lost_on_the_way', asserted(*toy_path(toy(['x', 'x + z*(t - 0.3)'], 'z'),
           ((0, 0, 0), (1, 0, 0)), ((0, 0, 1, 0, 0, 1),) * 2, [0.5])), 'At t = 0.3 the two constraints are one.', exists)
    reject('implied_normals_dependent', asserted(*toy_path(toy(['x', 'z'], 'z'),
           ((0, 0, 0), (1, 0, 0)), ((0, 0, 1, 1, 1, 1),) * 2, [0.5])), 'The two normals are one.', exists)
    reject('implied_range_left', toy_c('x - 0.51*t*(1 - t)', x=within), 'Between the waypoints the motion leaves a range.', 'x in its range')
    reject('implied_range_left_at_the_end', toy_c('x - t/4', points=((0, 0), (1, 0.125)), x=within),
           'The waypoint is in its range, the pose on the constraint next to it is not.', 'x in its range')
    reject('implied_range_left_by_a_waypoint', toy_c('x', points=((0, 0), (1, 0.25)), x=within),
           'The motion is in its range, but a waypoint is not.', 'waypoint 1: x in its range')
    reject('implied_wide_tube_at_the_joint', toy_c('x*(x - 0.01)', points=((0, 0), (0.5, 0.0005), (1, 0.01)),
           normals=((0, 1),) * 3, tubes=[2**-9, 2**-5]),
           'From one sheet to another: the second tube holds both, so that the motion could jump.', unique)
    reject('implied_narrow_tubes_at_the_joint', toy_c('x*(x - 0.01)', points=((0, 0), (0.5, 0.0005), (1, 0.01)),
           normals=((0, 1),) * 3, tubes=[2**-9, 2**-11]),
           'From one sheet to another: at the joint neither is in the narrow tube.', exists)
    reject('implied_pose_off', ball_c, 'Robot and path are those of the proof, the sphere is 4 mm lower.', 'false',
           lambda c: (c['problem']['space']['constants'].update(zs='0.310'), c['path'].update(tubes=[hex64(2**-6)] * 2)))
    reject('implied_margin_too_high', ball_c, 'The tension margin is claimed 1 % too high.', 'tension margin',
           raise_margin('tension_N', 1.01))
    reject('implied_spline_with_other_normals', changed(accepted_spline, lambda c:
           c['path']['waypoints'][1]['normals'].__setitem__(0, '0x1p-8')),
           'The start stands three times, but not with the same normals.', 'query waypoint 0')
    reject('implied_one_ulp_beside_the_query', ball_c, 'The path starts one ulp beside what was typed.', 'query waypoint 0',
           lambda c: c['path']['waypoints'][0]['x'].__setitem__(0, hex64(math.nextafter(float.fromhex(u['x'][0]), 0))))
    reject('implied_witness_violates_nothing', wave_tension, 'At the witness the tension is within its limits.', 'violates',
           lambda c: c['witness'].update(at={'segment': 0, 's': '0'}))
    reject('implied_witness_without_a_motion', wave_tension, 'In so thin a tube there is no motion to refute.', inside,
           lambda c: c['path'].update(tubes=[hex64(2**-40)]))
    reject('implied_witness_of_another_sheet', wave_tension, 'The tube holds two motions: which of them is refuted?', exists,
           lambda c: (c['problem']['space'].update(constraints=['(z - 0.35 - 0.003*sin(phi + 2.3))*(z - 0.3)']),
                      c['path'].update(tubes=[hex64(0.125)])))
    def mirror(constraint, tubes, points):
        """The platform hangs in z; a change of sheet turns det J over."""
        space = implied_slice(constraint)
        space['pose'].update(phi='0*phi', theta='0*theta', sigma='0.6')
        points = [waypoint(x, None, [0, 0, 1]) for x in points]
        pr = problem('mirror', ROBOT1, space, between_typed(points[0], points[-1]))
        assert statics(pr, [0, 0, 0.35])[3] * statics(pr, [0, 0, -0.35])[3] < 0
        return certificate(pr, straight(*points, tubes=tubes), 'refuted', witness={
            'kind': 'singular', 'at': {'waypoint': 0}, 'to': {'waypoint': len(points) - 1}})
    reject('implied_sign_change_by_a_jump', mirror('z - 0.1*atan2(theta + 0.3, -1)', [0.5], [(0, -1, -0.253), (0, 1, 0.2226)]),
           'det J has opposite signs, but the motion jumps between them.', 'atan2')
    reject('implied_sign_change_of_two_sheets', mirror('(z - 0.35)*(z + 0.35)', [0.25, 1.0, 0.25],
           [(-1, 0, 0.35), (-0.5, 0, 0.35), (0.5, 0, -0.35), (1, 0, -0.35)]),
           'det J has opposite signs on two sheets, and nothing leads from one to the other.', exists)

    # Against the format.
    def on(path_edit):
        return lambda c: path_edit(c['path'])
    sheet_c = toy_c('x - t/8')
    bare_c = asserted(problem('robot1-near-start', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.3', '1.6']]),
                      straight(waypoint([-2.3, 1.6]), waypoint([-2.3, 1.6])))
    malform('tubes_missing', 'One tube a segment.', 'path.tubes: expected an array of 2', on(lambda p: p.update(tubes=[])), ball_c)
    malform('tubes_one_too_many', 'One tube a segment.', 'path.tubes: expected an array of 2',
            on(lambda p: p['tubes'].append('0x1p-9')), ball_c)
    malform('tubes_of_a_spline', 'One tube a segment, three fewer than waypoints.', 'path.tubes: expected an array of 4',
            on(lambda p: p['tubes'].extend(p['tubes'][:2])), accepted_spline)
    malform('tubes_of_an_explicit_motion', 'Without constraints there are no tubes.', 'path.tubes: expected an array of 0',
            on(lambda p: p.update(tubes=['0x1p-9'])), bare_c)
    malform('tube_zero', 'A tube has a width.', 'a positive width', on(lambda p: p.update(tubes=['0x0p+0'])), sheet_c)
    malform('tube_negative', 'A tube has a width.', 'a positive width', on(lambda p: p.update(tubes=['-0x1p-9'])), sheet_c)
    malform('tube_infinite', 'Finite.', 'binary64', on(lambda p: p.update(tubes=['inf'])), sheet_c)
    malform('tube_decimal', 'Tubes are binary64.', 'binary64', on(lambda p: p.update(tubes=['0.5'])), sheet_c)
    malform('normals_missing', 'Each waypoint has its normals.', "the key 'normals'",
            on(lambda p: p['waypoints'][1].pop('normals')), sheet_c)
    malform('normals_of_an_explicit_motion', 'Without constraints there are no normals.', "no key 'normals'",
            on(lambda p: p['waypoints'][0].update(normals=[])), bare_c)
    malform('normals_too_few', 'One a parameter and constraint.', 'normals: expected an array of 2',
            on(lambda p: p['waypoints'][0].update(normals=['0x1p+0'])), sheet_c)
    malform('normals_too_many', 'One a parameter and constraint.', 'normals: expected an array of 2',
            on(lambda p: p['waypoints'][0].update(normals=['0x1p+0'] * 4)), sheet_c)
    malform('normals_infinite', 'Finite.', 'binary64', on(lambda p: p['waypoints'][0].update(normals=['0x1p+0', '0x1p+1024'])),
            sheet_c)
    malform('normals_by_rows', 'Rows are not nested.', 'a string',
            on(lambda p: p['waypoints'][0].update(normals=[['0x1p+0'], ['0x0p+0']])), sheet_c)
    def constraints(*texts):
        return lambda c: c['problem']['space'].update(constraints=list(texts))
    malform('constraints_as_many_as_parameters', 'Nothing could move.', 'fewer constraints than parameters',
            constraints('x', 't'), sheet_c)
    malform('constraint_of_an_unknown_name', 'Constraints are of the parameters, not of the pose.', 'known name', constraints('px'), sheet_c)
    malform('constraint_an_equation', 'A constraint is an expression, which is to be 0.', 'an operator or the end',
            constraints('x = 0'), sheet_c)
    malform('constraint_with_a_name', 'Constraints are strings.', 'a string', constraints({'x': '0'}), sheet_c)
    malform('constraint_that_does_not_close', 'A turn of phi leads to another surface.', "plainly so, where the periodic parameter 'phi'",
            constraints('px^2 + py^2 + (pz - zs)^2 - rs^2 + phi'), changed(ball_c, lambda c: c['problem']['space'].update(flip=None)))
    malform('constraint_whole_turns', 'Nor is C the same that grows by 2 pi a turn.', "plainly so, where the periodic parameter 'phi'",
            constraints('phi - 1', ), changed(ball_c, lambda c: c['problem']['space'].update(flip=None)))
    malform('flip_in_a_constraint', '(phi + pi, -theta) may be off the surface.', 'constraints that mention neither',
            constraints('px^2 + py^2 + (pz - zs)^2 - rs^2 + 0*theta'), ball_c)
    def seventh(c):
        c['problem']['space']['parameters'].append({'name': 'seventh', 'kind': 'real'})
    malform('constrained_seven_parameters', 'There are at most six.', 'at most 6', seventh, ball_c)


FREE = {'parameters': [{'name': n, 'kind': 'periodic' if n in ('phi', 'sigma') else 'real'}
                       for n in ('px', 'py', 'pz', 'phi', 'theta', 'sigma')], 'constants': {}, 'flip': [3, 4],
        'pose': {n: n for n in ('px', 'py', 'pz', 'phi', 'theta', 'sigma')}, 'constraints': []}


def audited(name, robot=ROBOT1, space=FREE):
    return problem(name, robot, space, [])


def tolerances(**more):
    return dict({'base_anchor_m': ['0'] * 6, 'platform_anchor_m': ['0'] * 6, 'load_point_m': '0', 'wrench': ['0'] * 6,
                 'position_m': '0', 'orientation_rad': '0', 'cable_length_m': None}, **more)


GROUPS = [('base_anchor_m', i, 3) for i in range(6)] + [('platform_anchor_m', i, 3) for i in range(6)] + [
    ('load_point_m', None, 3), ('wrench', None, 1), ('position_m', None, 3), ('orientation_rad', None, 3)] + [
    ('cable_length_m', i, 1) for i in range(6)]


def deviant(pr, at, deviation):
    """The machine that deviates, its numbers as floats, and its pose, from the stated one's at (p, R)."""
    number = lambda v: [float(x) for x in v]
    add = lambda v, w: [x + y for x, y in zip(v, w)]
    get = lambda key, i=None: deviation.get((key, i), [0.0] * 3)
    a, b = ([number(x) for x in pr['robot'][key]] for key in ('base_anchors_m', 'platform_anchors_m'))
    tau = get('wrench')[0]
    held = pr['tolerances']['cable_length_m'] is not None or pr.get('held')
    lengths = geometry(pr, at)[1] if held else None
    result = dict(pr, robot=dict(pr['robot'], base_anchors_m=[add(x, get('base_anchor_m', i)) for i, x in enumerate(a)],
                                 platform_anchors_m=[add(x, get('platform_anchor_m', i)) for i, x in enumerate(b)]),
                  load=dict(pr['load'], point_m=add(number(pr['load']['point_m']), get('load_point_m')),
                            wrench=[x + tau * float(y) for x, y in zip(number(pr['load']['wrench']), pr['tolerances']['wrench'])]))
    if held:
        lengths = [x + get('cable_length_m', i)[0] for i, x in enumerate(lengths)]
        at = with_lengths(result, at, lengths, {'position': '1', 'turn': '1'})
    p, R = at
    u = get('orientation_rad')
    angle = sqrt(sum(x * x for x in u))
    q = [x / angle * sin(angle / 2) for x in u] + [cos(angle / 2)] if angle > 0 else [0, 0, 0, 1]
    return result, (add(p, get('position_m')), times(rotation(q), R))


def all_margins(pr, at):
    lengths, f0, v, _ = statics(pr, at)
    result = []
    for i in range(6):
        lo, hi = map(float, pr['robot']['tension_N'][i])
        short, long = map(float, pr['robot']['length_m'][i])
        result.append((f0[i] - v[i] - lo, hi - f0[i] - v[i], lengths[i] - short, long - lengths[i],
                       (f0[i] - lo) / v[i], (hi - f0[i]) / v[i]))
    return result


def tolerance_of(pr, key, i):
    value = pr['tolerances'][key]
    if value is None:
        return 0.0
    if key == 'wrench':
        return 1.0 if any(float(x) for x in value) else 0.0
    return evaluate({'constants': {}, 'parameters': []}, [value if i is None else value[i]], [])[0]


def losses(pr, at):
    """To first order, what each kind of tolerance takes from each margin, by differences."""
    result = {}
    for key, i, size in GROUPS:
        tolerance = tolerance_of(pr, key, i)
        if tolerance == 0:
            continue
        h = 1e-6
        rates = []
        for c in range(size):
            up, down = ([x for row in all_margins(*deviant(pr, at, {(key, i): [e * (n == c) for n in range(3)]})) for x in row]
                        for e in (h, -h))
            rates.append([(x - y) / (2 * h) for x, y in zip(up, down)])
        loss = [tolerance * sqrt(sum(r[n]**2 for r in rates)) for n in range(36)]
        kind = result.setdefault(key, [0.0] * 36)
        result[key] = [x + y for x, y in zip(kind, loss)]
    return result


def robust(pr, at, without=None):
    """Margins less what the tolerances take: of all kinds but one."""
    left = [x for row in all_margins(pr, at) for x in row]
    for key, loss in losses(pr, at).items():
        if key != without:
            left = [x - y for x, y in zip(left, loss)]
    kind = lambda columns: min(left[6 * i + c] for i in range(6) for c in columns)
    return kind((0, 1)), kind((2, 3)), kind((4, 5))


def tolerant(pr, pa, boxes=8, below=0.98, samples=4, without=None):
    """Proved of every machine within the tolerances; or, without one of them, only claimed."""
    pr = copy.deepcopy(pr)
    n = control_points(pa)
    segments = []
    for k in range(len(pa['waypoints']) - n + 1):
        seen = dict(pr, held=pa['interpolation'] == 'straight-in-cable-lengths')
        sampled = [robust(seen, frame(pr, parameters(pr, pa, k, i / samples)), without) for i in range(samples + 1)]
        lowest = [min(m[j] for m in sampled) * below for j in range(3)]
        assert lowest[0] > 0 and lowest[1] > 0 and lowest[2] >= 1, (pr['name'], k, lowest)
        segments.append(segment(k, n, lowest, boxes))
    return of_segments(pr, pa, segments)


KINDS = {'base_anchor_m': ['0.0001'] * 6, 'platform_anchor_m': ['0.0001'] * 6, 'load_point_m': '0.0002',
         'wrench': ['0.003', '-0.002', '0.02', '0.0001', '0', '0'], 'position_m': '0.0001', 'orientation_rad': '(0.03)*pi/180'}

# A machine held by lengths amplifies what its anchors do.
LESS = dict(KINDS, base_anchor_m=['0.000005'] * 6, platform_anchor_m=['0.000005'] * 6, load_point_m='0.00005', position_m='0.00003',
            orientation_rad='(0.01)*pi/180')


def tolerated():
    """Tolerances of each kind, alone and together, of each law."""
    near = problem('robot1-near-start', ROBOT1, SLICE, [['-2.3', '1.6'], ['-2.2', '1.55']])
    ends = straight(waypoint([-2.3, 1.6]), waypoint([-2.2, 1.55]))
    def with_kinds(pr, **kinds):
        return dict(copy.deepcopy(pr), tolerances=tolerances(**kinds))
    for kind, value in KINDS.items():
        name = kind.rsplit('_', 1)[0] if kind != 'wrench' else kind
        alone = with_kinds(near, **{kind: value})
        good = tolerant(alone, ends)
        write('accepted', 'tolerance_' + name, good, 'A tolerance of one kind.')
        reject('tolerance_%s_ignored' % name, tolerant(alone, ends, without=kind, below=0.999),
               'The margins are those of the machine as it is stated.', 'as claimed')

    everything = with_kinds(near, **KINDS)
    all_c = tolerant(everything, ends, below=0.93)
    write('accepted', 'tolerances', all_c, 'All kinds of tolerances at once.')
    for kind in KINDS:
        name = kind.rsplit('_', 1)[0] if kind != 'wrench' else kind
        reject('tolerances_without_' + name, tolerant(everything, ends, without=kind, below=0.999), 'One kind of tolerance was left out.',
               'as claimed')
    held = with_kinds(near, **LESS, cable_length_m=['0.000005'] * 6)
    held_c = tolerant(held, ends, below=0.85)
    write('accepted', 'tolerances_held_by_lengths', held_c, 'All kinds of tolerances, of a machine that holds the lengths of its cables.')
    for kind in ('cable_length_m', 'base_anchor_m', 'platform_anchor_m'):
        reject('tolerances_held_without_' + kind.rsplit('_', 1)[0], tolerant(held, ends, without=kind, below=0.999),
               'One kind of tolerance was left out.', 'as claimed')
    write('accepted', 'tolerance_of_exact_lengths', tolerant(with_kinds(near, cable_length_m=['0'] * 6, base_anchor_m=['0.00002'] * 6), ends, below=0.93),
          'Lengths are held exactly: the anchors move the platform.')
    reject('tolerance_of_exact_lengths_taken_for_a_pose', changed(tolerant(with_kinds(near, base_anchor_m=['0.00002'] * 6), ends, below=0.999),
           lambda c: c['problem']['tolerances'].update(cable_length_m=['0'] * 6)),
           'The platform does not stay where it was commanded: it is the lengths that are held.', 'as claimed')

    for size in ('0.003', '0.05'):
        reject('tolerances_held_that_lead_to_a_singular_pose_%s' % size[2:], held_c, 'With lengths so wrong the platform may be singular, or nowhere.',
               'a deviation may lead to a singular pose', lambda c: c['problem']['tolerances'].update(cable_length_m=[size] * 6))
    malform('pose_tubes_of_a_deviation', 'Pose tubes belong to the law of cable lengths.', 'pose_tubes: expected an array of 0',
            lambda c: c['path'].update(pose_tubes=[{'position': '0x1p-9', 'turn': '0x1p-8'}]), held_c)

    sigma = 34 * pi / 180
    start, end = ([0, 0, 0.35], quaternion(-2.3, 1.6, sigma)), ([0.001, 0, 0.351], quaternion(-2.27, 1.58, sigma))
    free = audited('robot1-poses')
    turn = poses('geodesic', pose(*start), pose(*end))
    write('accepted', 'tolerances_of_a_geodesic', tolerant(with_kinds(free, **KINDS), turn), 'A geodesic, with tolerances.')
    lengths_of = lambda at: geometry(free, (at[0], rotation(at[1])))[1]
    winches = poses('straight-in-cable-lengths', *[pose(*at, lengths_of(at)) for at in (start, end)], pose_tubes=[(2**-9, 2**-8)])
    winches_c = tolerant(with_kinds(free, **LESS, cable_length_m=['0.000005'] * 6), winches, below=0.93)
    write('accepted', 'tolerances_of_lengths', winches_c, 'Lengths that are straight, with tolerances.')
    write('accepted', 'tolerances_of_lengths_without_their_own', tolerant(with_kinds(free, base_anchor_m=['0.00003'] * 6), winches),
          'Lengths that are straight and held exactly.')
    reject('tolerances_of_lengths_without_cable_length', tolerant(with_kinds(free, **LESS, cable_length_m=['0.000005'] * 6), winches,
           without='cable_length_m', below=0.999), 'One kind of tolerance was left out.', 'as claimed')

    # A tension of a pose that stays, claimed 0.4 % of what a small tolerance takes below the truth; and that tolerance raised by 1 %.
    still = straight(waypoint([-2.3, 1.6]), waypoint([-2.3, 1.6]))
    still_pr = problem('robot1-still', ROBOT1, SLICE, [['-2.3', '1.6']] * 2)
    def times_64th(value, factor):
        if isinstance(value, list):
            return [times_64th(v, factor) for v in value]
        return value + '*%.9f' % (factor / 64) if '(' in value else '%.12f' % (float(value) * factor / 64)
    for kind, value in KINDS.items():
        name = kind.rsplit('_', 1)[0] if kind != 'wrench' else kind
        tight = tolerant(with_kinds(still_pr, **{kind: times_64th(value, 1.004)}), still, boxes=1, below=1, samples=1)
        for key, factor in (('length_m', 0.99), ('wrench_scale', 0.99)):
            raise_margin(key, factor)(tight)
        tight['problem']['tolerances'][kind] = times_64th(value, 1)
        write('accepted', 'tight_' + name, seal(tight), 'A margin claimed nearly as high as it is.')
        reject('tight_%s_raised' % name, tight, 'The tolerance was raised by 1 % afterwards.', 'lower tension margin as claimed',
               lambda c: c['problem']['tolerances'].update({kind: times_64th(value, 1.01)}))


def motions_between_poses():
    sigma = 34 * pi / 180
    tilted = lambda phi, theta, p=(0, 0, 0.35), sigma=sigma: (list(p), quaternion(phi, theta, sigma))
    start, middle, end = tilted(-2.3, 1.6), tilted(-2.28, 1.58), tilted(-2.25, 1.57, (0.002, -0.001, 0.351))
    scaled = lambda at, factor: (at[0], [factor * x for x in at[1]])
    free = audited('robot1-poses')

    # Geodesics.
    turn = poses('geodesic', pose(*start), pose(*middle), pose(*end), times=['0', '0.5', '1.25'])
    turn_c = proved(free, turn, 4, samples=60)
    write('accepted', 'geodesic', turn_c, 'An audit of three poses, each reached at constant rate, with their times.')
    write('accepted', 'geodesic_other_signs', proved(free, poses('geodesic', pose(*scaled(start, -3)), pose(*scaled(middle, 1e-3)),
          pose(*scaled(end, -1))), 4, samples=60), 'Quaternions of any length and sign: the same poses, the shorter way.')
    write('accepted', 'geodesic_without_a_turn', proved(free, poses('geodesic', pose(*start), pose([0, 0, 0.351], start[1])), 2,
          samples=20), 'A straight way on which nothing turns: there is no axis.')
    write('accepted', 'geodesic_still', proved(free, poses('geodesic', pose(*start), pose(*start)), 1, samples=1),
          'Nothing moves.')
    tiny = pose(start[0], [math.nextafter(start[1][0], 1)] + start[1][1:])
    write('accepted', 'geodesic_of_one_ulp', proved(free, poses('geodesic', pose(*start), tiny), 1, samples=4),
          'The axis of a turn of 1e-16 rad is known exactly.')
    sourced = proved(free, turn, 4, samples=60)
    sourced['source'] = {'file': 'crane.csv', 'sha256': '0123456789abcdef' * 4}
    write('accepted', 'geodesic_with_its_source', seal(sourced), 'Which file the path came from is told, and proves nothing.')
    far = poses('geodesic', pose(*start), pose(*tilted(1.7, 1.7)))
    n, i, value = min(((n, i, f0[i] - v[i]) for n in range(65) for _, f0, v, _ in [statics(free, parameters(free, far, 0, n / 64))]
                       for i in range(6)), key=lambda t: t[2])
    far_c = certificate(free, far, 'refuted', witness={'at': {'segment': 0, 's': dyadic(n, 64)}, 'kind': 'tension_min',
                        'cable': i + 1, 'value': enclosing(value), 'limit': '0.05'})
    write('accepted', 'refuted_geodesic', far_c, 'On the shortest way from q_s to q_g a cable would have to push.')
    for phi in range(-3, 4):
        over = poses('geodesic', pose(*start), pose(*tilted(phi, -1.5)))
        signs = [statics(free, parameters(free, over, 0, n / 64))[3] for n in range(65)]
        n = next((n for n in range(64) if signs[n] * signs[n + 1] < 0), None)
        if n is not None:
            break
    write('accepted', 'refuted_geodesic_singular', certificate(free, over, 'refuted', witness={'kind': 'singular',
          'at': {'segment': 0, 's': dyadic(n, 64)}, 'to': {'segment': 0, 's': dyadic(n + 1, 64)}}), 'det J changes sign on it.')

    reject('geodesic_margin_too_high', turn_c, 'The tension margin is claimed 1 % too high.', 'tension margin',
           raise_margin('tension_N', 1.01))
    reject('geodesic_length_margin_too_high', turn_c, 'The length margin is claimed 1 % too high.', 'length margin',
           raise_margin('length_m', 1.01))
    reject('geodesic_the_long_way', turn_c, 'A waypoint on the other side of the world.', 'segment 0',
           lambda c: c['path']['waypoints'].__setitem__(1, pose(*tilted(0.9, 1.6))))
    half = ['0x1p+0', '0x0p+0', '0x0p+0', '0x0p+0'], ['0x0p+0', '0x1p+0', '0x0p+0', '0x0p+0']
    def half_turn(c):
        for k in (0, 1):
            c['path']['waypoints'][k]['quaternion'] = half[k]
    reject('geodesic_of_half_a_turn', turn_c, 'Half a turn has no axis.', 'half a turn', half_turn)
    reject('geodesic_witness_violates_nothing', far_c, 'At the witness the tension is within its limits.', 'violates',
           lambda c: c['witness'].update(at={'waypoint': 0}))
    reject('geodesic_conjugated', turn_c, 'The inverse rotations: x, y, z with the other sign.', 'segment 0',
           lambda c: [w.update(quaternion=[hex64(-float.fromhex(x)) for x in w['quaternion'][:3]] + w['quaternion'][3:])
                      for w in c['path']['waypoints']])

    # Straight in cable lengths.
    lengths_of = lambda at: geometry(free, (at[0], rotation(at[1])))[1]
    held = lambda *places, tubes=((2**-9, 2**-8),), **more: poses('straight-in-cable-lengths', *[pose(*at, lengths_of(at)) for at in places],
                                                            pose_tubes=list(tubes) * (len(places) - 1), **more)
    winches = held(start, middle, end)
    winches_c = proved(free, winches, 4, samples=60)
    write('accepted', 'lengths', winches_c, 'All six winches turn at constant speed from pose to pose.')
    write('accepted', 'lengths_other_signs', proved(free, held(scaled(start, -2), scaled(middle, -2.1), scaled(end, -2.2)), 4, samples=60),
          'Nor does the length of a quaternion matter, nor the sign of all of them.')
    reject('lengths_quaternion_through_zero', asserted(free, held(start, scaled(start, -1))), 'Half-way the reference has no orientation.',
           'division by what may be zero')
    reject('lengths_quaternion_near_zero', asserted(free, held(start, scaled(middle, -1))), 'The reference turns all the way round.',
           'the pose held by the lengths')
    off = ([start[0][0] + 0.0003, start[0][1], start[0][2] - 0.0002], quaternion(-2.299, 1.601, sigma))
    write('accepted', 'lengths_beside_the_reference', proved(free, poses('straight-in-cable-lengths', pose(*off, lengths_of(start)),
          pose(*off, lengths_of(tilted(-2.299, 1.599))), pose_tubes=[(2**-9, 2**-8)]), 4, samples=60),
          'The reference only tells where to look: here it stays, a third of a millimetre beside the pose.')
    write('accepted', 'lengths_narrow_then_wide', proved(free, held(start, middle, end, tubes=[(2**-9, 2**-9)]), 4, samples=60),
          'Tubes of one size.')
    nested = held(start, middle, end)
    nested['pose_tubes'] = [{'position': '0x1p-11', 'turn': '0x1p-10'}, {'position': '0x1p-9', 'turn': '0x1p-8'}]
    write('accepted', 'lengths_nested', proved(free, nested, 4, samples=60), 'A wider tube follows a narrower one.')
    write('accepted', 'lengths_still', proved(free, held(start, start, tubes=[(2**-20, 2**-20)]), 1, samples=1),
          'Nothing moves.')
    sagging = poses('straight-in-cable-lengths', pose([0, 0, 0.35], quaternion(0, 0.1, 0.6), lengths_of(
                    ([0, 0, 0.351], quaternion(0, 0.1, 0.6)))), pose_tubes=[(2**-9, 2**-9)])
    _, f0, v, _ = statics(free, ([0, 0, 0.351], rotation(quaternion(0, 0.1, 0.6))))
    i = max(range(6), key=lambda n: f0[n] + v[n])
    tight = copy.deepcopy(free)
    tight['robot']['tension_N'] = [['0.05', '%.3f' % (f0[i] + v[i] - 0.01)]] * 6
    held_still = certificate(tight, sagging, 'refuted', witness={
        'at': {'waypoint': 0}, 'kind': 'tension_max', 'cable': i + 1, 'value': enclosing(f0[i] + v[i]),
        'limit': tight['robot']['tension_N'][0][1]})
    write('accepted', 'refuted_lengths', held_still, 'A single pose, 1 mm below the reference, at which a cable pulls too hard.')

    unique, inside = 'it may not be the only one in its tube', 'it may leave its tube'
    def tubes(position, turn):
        return lambda c: [t.update(position=hex64(position), turn=hex64(turn)) for t in c['path']['pose_tubes']]
    reject('lengths_margin_too_high', winches_c, 'The tension margin is claimed 1 % too high.', 'tension margin',
           raise_margin('tension_N', 1.01))
    reject('lengths_length_margin_too_high', winches_c, 'The length margin is claimed 1 % too high.', 'length margin',
           raise_margin('length_m', 1.01))
    reject('lengths_tube_too_narrow', winches_c, 'Between the poses the platform leaves its tube.', inside, tubes(2**-30, 2**-30))
    reject('lengths_tube_too_wide', winches_c, 'The tube reaches beyond singular poses.', unique, tubes(0.5, 1.0))
    reject('lengths_tube_without_position', winches_c, 'Wide in turns, but not in positions.',
           'the pose held by the lengths', tubes(2**-40, 2**-8))
    def beside(c):
        for w in c['path']['waypoints']:
            w['position'][2] = hex64(float.fromhex(w['position'][2]) + 0.02)
    reject('lengths_none_in_the_tube', winches_c, 'With these lengths the platform is 20 mm above the tube.', 'the pose held by the lengths',
           beside)
    def unreachable(c):
        c['path']['waypoints'][1]['lengths'][0] = hex64(0.9)
    reject('lengths_that_no_pose_has', winches_c, 'One cable far too long for the others.', 'the pose held by the lengths', unreachable)
    # The other assembly: the mirror image of the platform through the plane of the base has the same lengths.
    mirrored = lambda at: ([at[0][0], at[0][1], -at[0][2]], [-at[1][0], -at[1][1], at[1][2], at[1][3]])
    flat = lambda z: ([0.001, 0.002, z], quaternion(0.3, 0.2, 0.5))
    up, down = flat(0.35), mirrored(flat(0.35))
    assert max(abs(a - b) for a, b in zip(lengths_of(up), lengths_of(down))) < 1e-12
    switch = poses('straight-in-cable-lengths', pose(*up, lengths_of(up)), pose(*up, lengths_of(up)), pose(*down, lengths_of(up)),
                   pose_tubes=[(2**-8, 2**-8)] * 2)
    reject('lengths_another_assembly', asserted(free, switch), 'The reference leads to the mirror image, which has the same lengths; the platform does not.',
           'the pose held by the lengths')
    both = copy.deepcopy(switch)
    both['waypoints'][2] = pose(*up, lengths_of(up))
    both['pose_tubes'][1] = {'position': '0x1.8p-1', 'turn': '0x1.8p-1'}
    reject('lengths_two_assemblies_in_the_tube', asserted(free, both), 'The tube holds the mirror image, too.', unique)
    reject('lengths_taken_for_a_reference', changed(held_still, lambda c: c['witness'].update(value=['0.1', '0.2'])),
           'The quantity is that of the pose with these lengths.', 'value')
    reject('lengths_witness_without_a_pose', held_still, 'In so thin a tube there is no pose to refute.', inside, tubes(2**-40, 2**-40))

    # With inner poses: the reference is a polyline.
    held_by = 'the pose held by the lengths'
    far = bent(free, start, tilted(-2.1, 1.5), 4, (2**-9, 2**-8))
    far_winches = proved(free, far, 16, samples=60)
    write('accepted', 'lengths_inner', far_winches, 'A long step: three inner poses keep the reference near the motion.')
    nested = copy.deepcopy(far)
    nested['pose_tubes'][0]['inner'][1]['tube'] = {'position': '0x1p-10', 'turn': '0x1p-9'}
    write('accepted', 'lengths_inner_nested', proved(free, nested, 16, samples=60), 'The tubes of the pieces are not of one size.')
    write('accepted', 'lengths_inner_within_a_box', proved(free, far, 1, samples=60), 'One box, which reaches across all inner poses.')
    still = bent(free, start, start, 2, (2**-20, 2**-20))
    write('accepted', 'lengths_inner_still', proved(free, still, 1, samples=1), 'Nothing moves, along an inner pose.')
    def inner(edit):
        return lambda c: edit(c['path']['pose_tubes'][0]['inner'])
    def lift(pose, by):
        pose['position'][2] = hex64(float.fromhex(pose['position'][2]) + by)
    reject('lengths_inner_moved', far_winches, 'The second inner pose is 5 mm beside the motion.', held_by, inner(lambda i: lift(i[1], 0.005)))
    reject('lengths_inner_turned', far_winches, 'The second inner pose is turned over.', held_by,
           inner(lambda i: i[1].update(quaternion=[hex64(-float.fromhex(x)) for x in i[1]['quaternion'][:3]] + i[1]['quaternion'][3:])))
    reject('lengths_inner_of_other_sign', far_winches, 'To the second inner pose, and from it, the reference turns all the way round.', held_by,
           inner(lambda i: i[1].update(quaternion=[hex64(-float.fromhex(x)) for x in i[1]['quaternion']])))
    reject('lengths_inner_elsewhere', far_winches, 'The second inner pose stands at another place.', held_by, inner(lambda i: i[1].update(s='5/8')))
    reject('lengths_inner_exchanged', far_winches, 'Two inner poses stand at the place of the other.', held_by,
           inner(lambda i: (i.reverse(), [x.update(s=s) for x, s in zip(i, ('1/4', '1/2', '3/4'))])))
    reject('lengths_inner_left_out', far_winches, 'Straight from end to end, the reference leaves its tube.', held_by,
           lambda c: c['path']['pose_tubes'][0].pop('inner'))
    reject('lengths_inner_tube_too_narrow', far_winches, 'Between two inner poses the platform leaves its tube.', held_by,
           inner(lambda i: i[1].update(tube={'position': '0x1p-30', 'turn': '0x1p-30'})))
    reject('lengths_inner_tube_too_wide', far_winches, 'A tube reaches beyond singular poses.', unique,
           inner(lambda i: i[1].update(tube={'position': '0x1p-1', 'turn': '0x1p+0'})))
    reject('lengths_inner_not_in_the_next_tube', far_winches, 'At an inner pose, which is half a millimetre beside the motion, only the tube before it holds the pose.', held_by,
           inner(lambda i: (lift(i[1], 0.0005), i[1].update(tube={'position': '0x1p-20', 'turn': '0x1p-19'}))))
    def other_assembly(c):
        """A refutation by the mirror image, which is the inner pose in the middle; no motion leads there from a waypoint."""
        tubes_of = c['path']['pose_tubes'][0]
        middle, = [i for i in tubes_of['inner'] if i['s'] == '1/2']
        lift(middle, -2 * float.fromhex(middle['position'][2]))
        x, y, z, w = (float.fromhex(x) for x in middle['quaternion'])
        middle['quaternion'] = [hex64(n) for n in (-x, -y, z, w)]
        narrow = {'position': '0x1p-12', 'turn': '0x1p-11'}
        middle['tube'] = narrow
        tubes_of.update(narrow, inner=[middle])
    elsewhere = copy.deepcopy(far_winches['path'])
    other_assembly({'path': elsewhere})
    middle_pose = between_poses(free, elsewhere, 0, 0.5)
    _, centre, spread = statics(free, middle_pose)[:3]
    slack = min(range(6), key=lambda k: centre[k] - spread[k])
    least = centre[slack] - spread[slack]
    write('rejected', 'lengths_witness_of_another_assembly',
          seal(certificate(free, elsewhere, 'refuted', witness={
              'kind': 'tension_min', 'at': {'segment': 0, 's': '1/2'}, 'cable': slack + 1, 'value': ['%.9f' % (least - 1e-6), '%.9f' % (least + 1e-6)],
              'limit': free['robot']['tension_N'][slack][0]})),
          'The witness is at an inner pose of the mirror image, to which no motion leads from a waypoint.', 'from the waypoint')
    jump = poses('straight-in-cable-lengths', pose(*up, lengths_of(up)), pose(*down, lengths_of(up)), pose_tubes=[(2**-8, 2**-8)])
    jump['pose_tubes'][0]['inner'] = [
        {'s': s, **pose(*at), 'tube': {'position': '0x1p-8', 'turn': '0x1p-8'}} for s, at in (('1/4', up), ('3/4', down))]
    reject('lengths_inner_of_another_assembly', asserted(free, jump), 'In between the reference leads to the mirror image; the platform does not.', held_by)
    reject('lengths_inner_sign_change', certificate(free, jump, 'refuted', witness={
        'kind': 'singular', 'at': {'segment': 0, 's': '0'}, 'to': {'segment': 0, 's': '1'}}),
        'det J has opposite signs in the two assemblies, and nothing leads from one to the other.', held_by)

    # Against the format.
    def on(edit):
        return lambda c: edit(c['path'])
    malform('lengths_inner_at_the_start', 'Inner poses are inside.', 'places that rise', inner(lambda i: i[0].update(s='0')), far_winches)
    malform('lengths_inner_at_the_end', 'Inner poses are inside.', 'places that rise', inner(lambda i: i[2].update(s='1')), far_winches)
    malform('lengths_inner_out_of_order', 'Their places rise.', 'places that rise', inner(lambda i: i.reverse()), far_winches)
    malform('lengths_inner_twice', 'Their places rise.', 'places that rise', inner(lambda i: i.insert(1, i[1])), far_winches)
    malform('lengths_inner_too_fine', 'Denominators are at most 2^52.', 'places that rise', inner(lambda i: i[0].update(s='1/%d' % 2**53)), far_winches)
    malform('lengths_inner_not_dyadic', 'Places are dyadics.', 'a power of two', inner(lambda i: i[0].update(s='1/3')), far_winches)
    malform('lengths_inner_none', 'Where there is none, there is no key.', 'inner poses, or no such key', inner(lambda i: i.clear()), far_winches)
    malform('lengths_inner_quaternion_zero', 'No orientation.', 'a quaternion that is not 0', inner(lambda i: i[0].update(quaternion=['0x0p+0'] * 4)),
            far_winches)
    malform('lengths_inner_position_of_two', 'A position has three numbers.', 'position: expected an array of 3', inner(lambda i: i[0]['position'].pop()),
            far_winches)
    malform('lengths_inner_with_lengths', 'Lengths are straight from waypoint to waypoint.', "no key 'lengths'",
            inner(lambda i: i[0].update(lengths=['0x1p-2'] * 6)), far_winches)
    malform('lengths_inner_without_a_tube', 'Each piece has its tube.', "the key 'tube'", inner(lambda i: i[0].pop('tube')), far_winches)
    malform('lengths_inner_tube_zero', 'A tube has a width.', 'positive widths', inner(lambda i: i[0]['tube'].update(turn='0x0p+0')), far_winches)
    malform('lengths_inner_tubes_not_nested', 'Of two successive tubes one contains the other.', 'contains the one before',
            inner(lambda i: i[1].update(tube={'position': '0x1p-10', 'turn': '0x1p-7'})), far_winches)
    malform('lengths_inner_tubes_not_nested_at_a_waypoint', 'Nor at the end of a segment.', 'contains the one before',
            lambda c: (c['path']['waypoints'].append(c['path']['waypoints'][-1]),
                       c['path']['pose_tubes'].append({'position': '0x1p-10', 'turn': '0x1p-7'})), far_winches)
    malform('quaternion_zero', 'No orientation.', 'a quaternion that is not 0',
            on(lambda p: p['waypoints'][1].update(quaternion=['0x0p+0', '-0x0p+0', '0x0p+0', '0x0p+0'])), turn_c)
    malform('quaternion_of_three', 'A quaternion has four numbers.', 'quaternion: expected an array of 4',
            on(lambda p: p['waypoints'][1]['quaternion'].pop()), turn_c)
    malform('pose_with_parameters', 'A waypoint is a pose or parameters.', "the key 'position'",
            on(lambda p: p['waypoints'].__setitem__(0, waypoint([0, 0, 0.35, 0, 0, 0]))), turn_c)
    malform('pose_for_parameters', 'A waypoint is a pose or parameters.', "the key 'x'",
            on(lambda p: p.update(interpolation='straight-in-parameters')), turn_c)
    malform('geodesic_with_lengths', 'No lengths belong to a geodesic.', "no key 'lengths'", on(lambda p: p.update(interpolation='geodesic', pose_tubes=[])),
            winches_c)
    malform('geodesic_with_pose_tubes', 'Nothing is held by lengths.', 'pose_tubes: expected an array of 0',
            on(lambda p: p.update(pose_tubes=[{'position': '0x1p-8', 'turn': '0x1p-8'}] * 2)), turn_c)
    malform('lengths_missing', 'The law is about lengths.', "the key 'lengths'", on(lambda p: p['waypoints'][0].pop('lengths')), winches_c)
    malform('length_zero', 'Lengths are positive.', 'positive lengths', on(lambda p: p['waypoints'][0]['lengths'].__setitem__(5, '0x0p+0')),
            winches_c)
    malform('length_commanded_negative', 'Lengths are positive.', 'positive lengths',
            on(lambda p: p['waypoints'][0]['lengths'].__setitem__(0, '-0x1p-2')), winches_c)
    malform('pose_tube_zero', 'A tube has a width.', 'positive widths', on(lambda p: p['pose_tubes'][0].update(turn='0x0p+0')), winches_c)
    malform('pose_tube_missing', 'One tube a segment.', 'pose_tubes: expected an array of 2', on(lambda p: p['pose_tubes'].pop()), winches_c)
    malform('pose_tubes_not_nested', 'At a joint one tube contains the other.', 'contains the one before',
            on(lambda p: p['pose_tubes'].__setitem__(1, {'position': '0x1p-10', 'turn': '0x1p-7'})), winches_c)
    malform('times_fall', 'Times rise.', 'a time after the last one', on(lambda p: p.update(times=['0', '2', '1'])), turn_c)
    malform('times_equal', 'Times rise.', 'a time after the last one', on(lambda p: p.update(times=['0', '0.0', '1'])), turn_c)
    malform('times_too_few', 'One time a waypoint.', 'times: expected an array of 3', on(lambda p: p.update(times=['0', '1'])), turn_c)
    malform('poses_of_a_query', 'Parameters were asked for: no pose answers that.', 'none where the path has a law of poses',
            lambda c: c['problem']['query'].update(waypoints=[['0'] * 6] * 2), turn_c)
    malform('poses_of_another_space', 'A law of poses knows of no parameters.', 'the one of the free coordinates',
            lambda c: c['problem'].update(space=copy.deepcopy(SLICE)), turn_c)
    malform('source_of_a_plan', 'A plan has no source.', 'source: expected null', lambda c: c.update(
            source={'file': 'x', 'sha256': '0' * 64}, problem=dict(c['problem'], space=SLICE, query={'waypoints': [['0', '0']] * 2}),
            path=straight(waypoint([0, 0]), waypoint([0, 0]), waypoint([0, 0]))), turn_c)
    malform('source_of_capitals', 'Hex digits are lower-case.', 'source.sha256', lambda c: c['source'].update(sha256='A' * 64), sourced)


def surveyed(pr, pa, cells=32, fine=8):
    """A refuted audit: cells with margins everywhere are proved, runs of others are stretches."""
    n = control_points(pa)
    count = len(pa['waypoints']) - n + 1
    segments, runs = [], []
    for k in range(count):
        kept, lowest = [], [math.inf] * 3
        for i in range(cells):
            seen = [margins_at(pr, parameters(pr, pa, k, (i + j / fine) / cells)) for j in range(fine + 1)]
            least = [min(m[j] for m in seen) for j in range(3)]
            if least[0] > 0.004 and least[1] > 0.004:
                kept.append([dyadic(i, cells), dyadic(i + 1, cells)])
                lowest = [min(x, y) for x, y in zip(lowest, least)]
            elif runs and runs[-1][1] == (k, i):
                runs[-1][1] = (k, i + 1)
            elif runs and i == 0 and runs[-1][1] == (k - 1, cells):
                runs[-1][1] = (k, 1)
            else:
                runs.append([(k, i), (k, i + 1)])
        segments.append({'from': k, 'to': k + n - 1, 'boxes': kept,
                         'margins': segment(k, n, [0.9 * x for x in lowest[:2]] + [1 + 0.9 * (lowest[2] - 1)], 1)['margins'] if kept else None})
    stretches = []
    for (k0, i0), (k1, i1) in runs:
        inner = [w for w in (violation(pr, pa, *divmod(m, cells * fine), cells * fine)
                             for m in range((k0 * cells + i0) * fine, (k1 * cells + i1) * fine)) if w]
        outer = [{'segment': k, 's': dyadic(i, cells)} for k, i in ((k0, i0), (k1, i1))]
        stretches.append({'outer': outer, 'inner': [inner[0], inner[-1]] if inner else None,
                          'reason': None if inner else 'a margin too small for this program'})
    witness = next(s['inner'][0] for s in stretches if s['inner'])
    return certificate(pr, pa, 'refuted', segments=segments, stretches=stretches, witness=witness)


def violation(pr, pa, k, n, m):
    lengths, f0, v, _ = statics(pr, parameters(pr, pa, k, n / m))
    for i in range(6):
        lo, hi = map(float, pr['robot']['tension_N'][i])
        short, long = map(float, pr['robot']['length_m'][i])
        for kind, value, limit, excess in (('tension_min', f0[i] - v[i], 0, lo - f0[i] + v[i]), ('tension_max', f0[i] + v[i], 1, f0[i] + v[i] - hi),
                                           ('length_min', lengths[i], 0, short - lengths[i]), ('length_max', lengths[i], 1, lengths[i] - long)):
            if 1e-5 < excess and abs(value) < 100:
                of = 'tension_N' if kind.startswith('tension') else 'length_m'
                return {'at': {'segment': k, 's': dyadic(n, m)}, 'kind': kind, 'cable': i + 1, 'value': enclosing(value),
                        'limit': pr['robot'][of][i][limit]}
    return None


def stretches():
    slice_audit = problem('robot1-audited', ROBOT1, SLICE, [])
    a, m, b = waypoint([-2.3, 1.6]), waypoint([-0.3, 1.65]), waypoint([1.7, 1.7])
    across = surveyed(slice_audit, straight(a, m, b))
    assert len(across['stretches']) >= 1 and any(s['boxes'] for s in across['segments'])
    write('accepted', 'stretches', across, 'Where the straight motion from q_s to q_g is not safe; the rest is proved.')
    free = audited('robot1-poses')
    sigma = 34 * pi / 180
    at = lambda phi, theta: pose([0, 0, 0.35], quaternion(phi, theta, sigma))
    turns = surveyed(free, poses('geodesic', at(-2.3, 1.6), at(-2.25, 1.6), at(-0.3, 1.65), at(1.6, 1.7), at(1.7, 1.7)))
    write('accepted', 'stretches_of_geodesics', turns, 'A stretch over several segments, and one of them without a box.')
    half = copy.deepcopy(turns)
    half['path']['waypoints'].append(half['path']['waypoints'][-1] | {'quaternion': [hex64(x) for x in (lambda q: [q[3], -q[2], q[1], -q[0]])(
        [float.fromhex(x) for x in half['path']['waypoints'][-1]['quaternion']])]})
    last = len(half['segments'])
    half['segments'].append({'from': last, 'to': last + 1, 'boxes': [], 'margins': None})
    half['stretches'].append({'outer': [{'segment': last, 's': '0'}, {'segment': last, 's': '1'}], 'inner': None, 'reason': 'half a turn'})
    write('accepted', 'stretches_open', seal(half), 'A second stretch is open: half a turn, of which nothing can be said.')
    loose = dict(copy.deepcopy(slice_audit), tolerances=tolerances(load_point_m='0.0001', position_m='0.0001', wrench=['0', '0', '0.02', '0', '0', '0']))
    tolerant_survey = surveyed(loose, straight(a, m, b), cells=128, fine=2)
    # A machine that deviates at the first witness.
    first = tolerant_survey['witness']
    deviation = {'base_anchors_m': [['0'] * 3] * 6, 'platform_anchors_m': [['0'] * 3] * 6, 'load_point_m': ['0.00006', '0', '0.00008'],
                 'wrench': '-0.5', 'position_m': ['0', '0', '0.0001'], 'turn': ['0', '0', '0']}
    k, s = first['at']['segment'], Fraction(first['at']['s'])
    number = lambda v: [float(x) for x in v]
    other = dict(loose, load=dict(loose['load'], point_m=[x + y for x, y in zip(number(loose['load']['point_m']), number(deviation['load_point_m']))],
                                  wrench=[0, 0, 1 - 0.5 * 0.02, 0, 0, 0]))
    p, R = frame(loose, parameters(loose, tolerant_survey['path'], k, float(s)))
    lengths, f0, v, _ = statics(other, ([p[0], p[1], p[2] + 0.0001], R))
    i = first['cable'] - 1
    value = {'tension_min': f0[i] - v[i], 'tension_max': f0[i] + v[i], 'length_min': lengths[i], 'length_max': lengths[i]}[first['kind']]
    deviating = certificate(loose, straight(a, m, b), 'refuted', witness=dict(first, value=enclosing(value), deviation=deviation))
    write('accepted', 'refuted_by_a_deviation', deviating, 'A machine within the tolerances is refuted: its numbers are stated.')

    # False.
    reject('stretches_box_in_a_violation', across, 'A box where the motion is not safe, and the stretch cut there.', 'segment', hide_violation)
    reject('stretches_open_one_taken_for_proved', half, 'Nothing is known of the last segment; it was claimed to be proved.', 'half a turn',
           lambda c: (c['stretches'].pop(), c['segments'][-1].update(boxes=[['0', '1']], margins=c['segments'][0]['margins'])))
    reject('stretches_margin_too_high', across, 'The margin of the boxes is claimed ten times too high.', 'margin',
           lambda c: [s['margins'].update(tension_N='%.6e' % (10 * float(s['margins']['tension_N']))) for s in c['segments'] if s['margins']])
    def no_violation(c):
        c['stretches'][0]['inner'][0]['at'] = c['stretches'][0]['outer'][0]
        c['witness'] = c['stretches'][0]['inner'][1]
    reject('stretches_inner_end_no_violation', across, 'At the first inner end nothing is violated yet.', 'stretch 0', no_violation)
    for kind, value, what in (('load_point_m', ['0.00006', '0.00001', '0.00008'], 'the load point'), ('wrench', '-1.000001', 'the wrench'),
                              ('position_m', ['0.00001', '0', '0.0001'], 'the position'), ('turn', ['0', '0', '1e-9'], 'the angle')):
        reject('deviation_of_%s_too_large' % kind.rsplit('_', 1)[0], deviating, 'The deviation is outside of its tolerance.', what,
               lambda c: c['witness']['deviation'].update({kind: value}))
    reject('deviation_of_an_anchor_too_large', deviating, 'Anchors are exact here.', 'a base anchor',
           lambda c: c['witness']['deviation']['base_anchors_m'].__setitem__(3, ['0', '1e-9', '0']))
    reject('deviation_of_a_platform_anchor_too_large', deviating, 'Anchors are exact here.', 'a platform anchor',
           lambda c: c['witness']['deviation']['platform_anchors_m'].__setitem__(3, ['0', '1e-9', '0']))
    reject('deviation_not_the_one_of_the_value', deviating, 'The value is that of another machine.', 'value',
           lambda c: c['witness']['deviation'].update(wrench='0.5'))

    # Against the format.
    def drop_box(c):
        next(s for s in c['segments'] if s['boxes'])['boxes'].pop(0)
    malform('stretches_with_a_gap', 'A part of the path is neither proved nor in a stretch.', 'tile the path', drop_box, across)
    malform('stretches_box_inside', 'A box inside a stretch.', 'tile the path',
            lambda c: next(s for s in c['segments'] if not s['boxes']).update(boxes=[['1/4', '1/2']], margins=c['segments'][0]['margins']), turns)
    def outside(c):
        c['stretches'][0]['inner'][0] = dict(c['stretches'][0]['inner'][0], at={'segment': 0, 's': '0'})
        c['witness'] = c['stretches'][0]['inner'][1]
    malform('stretches_inner_outside_of_outer', 'The inner ends are inside the outer ones.', 'between the outer ends', outside, across)
    malform('stretches_inner_reversed', 'The first violation comes first.', 'two witnesses in order',
            lambda c: c['stretches'][0]['inner'].reverse(), across)
    malform('stretches_outer_reversed', 'Outer ends are in order.', 'two places in order', lambda c: c['stretches'][0]['outer'].reverse(), across)
    malform('stretches_of_another_witness', "The witness is a stretch's.", "one of the stretches'",
            lambda c: c['witness'].update(value=['-1', '1']), across)
    malform('stretches_all_open', "The witness is a stretch's.", "one of the stretches'",
            lambda c: [s.update(inner=None, reason='unknown') for s in c['stretches']], across)
    malform('stretches_open_without_a_reason', 'Why is it open?', 'reason: expected a string', lambda c: c['stretches'][-1].update(reason=None), half)
    malform('stretches_with_a_reason', 'A violation needs no reason.', 'reason: expected null', lambda c: c['stretches'][0].update(reason='x'), across)
    malform('stretches_of_a_plan', 'Only of audits.', 'null where nothing was audited',
            lambda c: c['problem']['query'].update(waypoints=[['-2.3', '1.6'], ['1.7', '1.7']]), across)
    malform('stretches_margins_without_a_box', 'Nothing is claimed of a segment without boxes.', 'null where there is no box',
            lambda c: next(s for s in c['segments'] if not s['boxes']).update(margins=c['segments'][0]['margins']), turns)
    malform('stretches_of_a_proved_path', 'All of it is proved.', 'stretches: expected null', lambda c: c.update(stretches=[]),
            proved(slice_audit, straight(a, a), 1, samples=1))
    malform('stretches_null_but_boxes', 'Without stretches a refuted certificate proves nothing.', 'segments: expected an array of 0',
            lambda c: c.update(stretches=None), across)
    malform('deviation_without_tolerances', 'Nothing may deviate.', 'tolerances to be within', lambda c: c['problem'].update(tolerances=None), deviating)
    malform('deviation_of_lengths_not_held', 'Lengths deviate only where the machine is held by them.', "no key 'cable_lengths_m'",
            lambda c: c['witness']['deviation'].update(cable_lengths_m=['0'] * 6), deviating)
    malform('deviation_held_without_lengths', 'The length errors are stated where the machine is held by lengths.', "the key 'cable_lengths_m'",
            lambda c: c['problem']['tolerances'].update(cable_length_m=['0'] * 6), deviating)
    malform('tolerance_negative', 'Tolerances are >= 0.', 'a tolerance >= 0', lambda c: c['problem']['tolerances'].update(position_m='-0.001'), deviating)
    malform('tolerance_of_a_turn', 'Angles are below 1 rad.', 'an angle from 0 to below 1', lambda c: c['problem']['tolerances'].update(orientation_rad='1'),
            deviating)
    malform('tolerance_of_a_negative_angle', 'Angles are >= 0.', 'an angle from 0 to below 1',
            lambda c: c['problem']['tolerances'].update(orientation_rad='-pi/180'), deviating)
    malform('tolerance_missing', 'All keys are there.', "the key 'load_point_m'", lambda c: c['problem']['tolerances'].pop('load_point_m'), deviating)
    malform('tolerance_of_five_anchors', 'One an anchor.', 'array of 6', lambda c: c['problem']['tolerances']['base_anchor_m'].pop(), deviating)


def held_deviations():
    """Machines that are held by lengths and deviate: refuted at the pose to which the deviation leads."""
    sigma = 34 * pi / 180
    start, end = ([0, 0, 0.35], quaternion(-2.3, 1.6, sigma)), ([0.001, 0, 0.351], quaternion(-2.27, 1.58, sigma))
    free = audited('robot1-poses')
    slice_audit = audited('robot1-slice', space=SLICE)
    a, b = waypoint([-2.3, 1.6]), waypoint([-2.2, 1.55])
    lengths_of = lambda at: geometry(free, (at[0], rotation(at[1])))[1]
    winches = poses('straight-in-cable-lengths', *[pose(*at, lengths_of(at)) for at in (start, end)], pose_tubes=[(2**-9, 2**-8)])

    def middle_of(pr, pa):
        return frame(pr, parameters(pr, pa, 0, 0.5))

    def led(pr, pa, deviation):
        """The deviating machine, and the pose to which it is led."""
        return deviant(dict(pr, held=True), middle_of(pr, pa), deviation)

    def stated(deviation):
        row = lambda key, i, size=3: ['%.9g' % x for x in deviation.get((key, i), [0.0] * size)[:size]]
        u = deviation.get(('orientation_rad', None), [0.0] * 3)
        angle = sqrt(sum(x * x for x in u)) or 1
        return {'base_anchors_m': [row('base_anchor_m', i) for i in range(6)],
                'platform_anchors_m': [row('platform_anchor_m', i) for i in range(6)], 'load_point_m': row('load_point_m', None),
                'wrench': row('wrench', None, 1)[0], 'position_m': row('position_m', None), 'turn': ['%.9g' % (x / angle * tan(angle / 2)) for x in u],
                'cable_lengths_m': [row('cable_length_m', i, 1)[0] for i in range(6)]}

    def witness(kind, i, limit, value, deviation):
        return {'at': {'segment': 0, 's': '1/2'}, 'kind': kind, 'cable': i + 1, 'value': enclosing(value), 'limit': limit,
                'deviation': stated(deviation)}

    def refuted(pr, pa, deviation):
        """One lower limit is between the tension of the machine as stated and that of the deviating one."""
        _, f0, v, _ = statics(pr, middle_of(pr, pa))
        _, g0, w, _ = statics(*led(pr, pa, deviation))
        i = max(range(6), key=lambda n: (f0[n] - v[n]) - (g0[n] - w[n]))
        before, after = f0[i] - v[i], g0[i] - w[i]
        assert before - after > 1e-5 and (before + after) / 2 > 1e-4, (before, after)
        pr = copy.deepcopy(pr)
        pr['robot']['tension_N'][i] = ['%.7f' % ((before + after) / 2), '0.5']
        return certificate(pr, pa, 'refuted', witness=witness('tension_min', i, pr['robot']['tension_N'][i][0], after, deviation))

    def only(i, size):
        return ['0'] * i + [size] + ['0'] * (5 - i)
    anchors = {('base_anchor_m', 2): [6e-5, 0, 8e-5], ('platform_anchor_m', 4): [0, -8e-5, 6e-5]}
    errors = {('cable_length_m', i): [1e-6 * e] for i, e in enumerate((100, -110, 120, 130, -140, 150))}
    of_anchors = dict(base_anchor_m=only(2, '0.0001'), platform_anchor_m=only(4, '0.0001'))
    of_lengths = dict(cable_length_m=['0.00010', '0.00011', '0.00012', '0.00013', '0.00014', '0.00015'])
    tracked = {('position_m', None): [0, 0, -1e-4], ('orientation_rad', None): [6e-4, 0, -8e-4], ('load_point_m', None): [3e-4, 4e-4, 0],
               ('wrench', None): [-1]}
    of_both = dict(of_anchors, **of_lengths, position_m='0.0001', orientation_rad='0.0011', load_point_m='0.0005', wrench=['0', '0', '0.01', '0', '0', '0'])
    both = {**anchors, **errors, **tracked}

    def with_tolerances(pr, **kinds):
        return dict(copy.deepcopy(pr), tolerances=tolerances(**kinds))
    write('accepted', 'refuted_by_held_anchors', refuted(with_tolerances(slice_audit, cable_length_m=['0'] * 6, **of_anchors), straight(a, b), anchors),
          'Lengths are held exactly; anchors that deviate move the platform to where a cable is too slack.')
    by_lengths = refuted(with_tolerances(slice_audit, **of_lengths), straight(a, b), errors)
    write('accepted', 'refuted_by_held_lengths', by_lengths, 'Lengths that are not quite those commanded.')
    by_both = refuted(with_tolerances(free, **of_both), winches, both)
    write('accepted', 'refuted_by_held_anchors_and_lengths', by_both, 'Anchors, lengths, load and tracking deviate, under the law of cable lengths.')
    write('accepted', 'refuted_by_held_anchors_of_lengths', refuted(with_tolerances(free, **of_anchors), winches, anchors),
          'Lengths that are straight and held exactly, and anchors that deviate.')
    write('accepted', 'refuted_by_held_lengths_of_a_geodesic', refuted(with_tolerances(free, **of_both),
          poses('geodesic', pose(*start), pose(*end)), both), 'A geodesic, followed by lengths that are off.')

    inner = bent(free, start, end, 2, (2**-9, 2**-8))
    write('accepted', 'refuted_by_held_lengths_at_an_inner_pose', refuted(with_tolerances(free, **of_both), inner, both),
          'At an inner pose, where one piece of the reference ends.')
    # A cable's length itself: the error is what the winch is off by, whatever anchors and platform do.
    far_pr = with_tolerances(slice_audit, **of_lengths)
    longest = geometry(far_pr, led(far_pr, straight(a, b), errors)[1])[1][5]
    far_pr['robot'] = dict(far_pr['robot'], length_m=far_pr['robot']['length_m'][:5] + [['0.1', '%.9f' % (longest - 1e-4)]])
    write('accepted', 'refuted_by_held_lengths_too_long', certificate(far_pr, straight(a, b), 'refuted', witness=witness(
          'length_max', 5, far_pr['robot']['length_m'][5][1], longest, errors)), 'A cable is longer than it was commanded, and than it may be.')

    # False.
    def edited(kind, edit):
        return lambda c: edit(c['witness']['deviation'][kind])
    reject('held_deviation_of_a_length_too_large', by_lengths, 'The deviation is outside of its tolerance.', "a cable's length",
           edited('cable_lengths_m', lambda x: x.__setitem__(1, '-0.000110001')))
    reject('held_deviation_of_a_length_that_is_exact', by_both, 'Without a tolerance of them lengths are exact.', "a cable's length",
           lambda c: c['problem']['tolerances'].update(cable_length_m=None))
    reject('held_deviation_of_an_anchor_too_large', by_both, 'The deviation is outside of its tolerance.', 'a base anchor',
           edited('base_anchors_m', lambda x: x.__setitem__(2, ['0.00006', '0.00001', '0.00008'])))
    reject('held_deviation_of_a_platform_anchor_too_large', by_both, 'The deviation is outside of its tolerance.', 'a platform anchor',
           edited('platform_anchors_m', lambda x: x.__setitem__(4, ['0', '-0.00008', '0.0000601'])))
    reject('held_deviation_not_the_one_of_the_value', by_both, 'The value is that of another machine.', 'witness',
           edited('cable_lengths_m', lambda x: x.__setitem__(0, '-0.0001')))
    i = by_both['witness']['cable'] - 1
    machine, _ = led(by_both['problem'], winches, both)
    _, f0, v, _ = statics(machine, middle_of(by_both['problem'], winches))
    reject('held_deviation_that_does_not_move_the_platform', by_both, 'The value is that of the deviating machine at the pose of the stated one.', 'witness',
           lambda c: c['witness'].update(value=enclosing(f0[i] - v[i])))
    # The mirror image through the plane of the base has the same lengths, and there cables would have to push.
    machine, (p, R) = led(by_lengths['problem'], straight(a, b), errors)
    flip = [1, 1, -1]
    image = [p[0], p[1], -p[2]], [[flip[r] * flip[c] * R[r][c] for c in range(3)] for r in range(3)]
    assert max(abs(x - y) for x, y in zip(geometry(machine, image)[1], geometry(machine, (p, R))[1])) < 1e-12
    lengths, f0, v, _ = statics(machine, image)
    i = min(range(6), key=lambda n: f0[n] - v[n])
    assert f0[i] - v[i] < -0.01
    reject('held_deviation_to_another_assembly', by_lengths, 'The value is that of the mirror image, which has the same lengths.', 'violates',
           lambda c: c['witness'].update(witness('tension_min', i, c['problem']['robot']['tension_N'][i][0], f0[i] - v[i], errors)))
    # With the lengths of a pose at which det J has the other sign: whatever the way leads to, it is not that one.
    here = middle_of(slice_audit, straight(a, b))
    det = lambda at: statics(slice_audit, at)[3]
    there = next(at for phi in range(-3, 4) for theta in (0.5, 1, 1.5) for at in [frame(slice_audit, [phi, theta])] if det(here) * det(at) < 0)
    far = {('cable_length_m', n): [float('%.9g' % (y - x))] for n, (x, y) in
           enumerate(zip(geometry(slice_audit, here)[1], geometry(slice_audit, there)[1]))}
    _, f0, v, _ = statics(slice_audit, there)
    i = min(range(6), key=lambda n: f0[n] - v[n])
    reject('held_deviation_past_a_singular_pose', by_lengths, 'The lengths are those of a pose behind singular ones, and so is the value. The way leads elsewhere, by a nearly singular pose: further than can be followed.',
           'the pose to which the deviation leads', lambda c: (c['problem']['tolerances'].update(cable_length_m=['0.5'] * 6),
           c['witness'].update(witness('tension_min', i, c['problem']['robot']['tension_N'][i][0], f0[i] - v[i], far))))
    # The base turns by half a turn, by straight ways; the lengths are those of the pose as it is. Half-way all base anchors are in one line.
    around = {('base_anchor_m', n): [-2 * float(x[0]), -2 * float(x[1]), 0] for n, x in enumerate(slice_audit['robot']['base_anchors_m'])}
    machine = dict(slice_audit, robot=dict(slice_audit['robot'], base_anchors_m=[[-float(x), -float(y), float(z)] for x, y, z in
                                                                                 slice_audit['robot']['base_anchors_m']]))
    around.update({('cable_length_m', n): [float('%.9g' % (y - x))] for n, (x, y) in enumerate(zip(geometry(slice_audit, here)[1], geometry(machine, here)[1]))})
    _, f0, v, _ = statics(machine, here)
    i = min(range(6), key=lambda n: f0[n] - v[n])
    assert f0[i] - v[i] < 0
    reject('held_deviation_through_a_singular_machine', by_lengths, 'Pose and machine are regular at the end, but not on the way.',
           'the pose to which the deviation leads', lambda c: (
           c['problem']['tolerances'].update(cable_length_m=['0.5'] * 6, base_anchor_m=['0.5'] * 6),
           c['witness'].update(witness('tension_min', i, c['problem']['robot']['tension_N'][i][0], f0[i] - v[i], around))))

    # Ways on which no length changes, regular at both ends, singular half-way: anchors pass the platform's plane, or turn about.
    level = straight(waypoint([0, 0]), waypoint([0.001, 0]))
    for name, base, platform, why in (
            ('base_anchors', lambda x: [0, 0, 0.7], None, 'Base anchors rise through the plane of the platform.'),
            ('platform_anchors', None, lambda x: [0, 0, -0.7], 'Platform anchors sink through the plane of the base.'),
            ('all_anchors', lambda x: [-2 * x[0], -2 * x[1], 0], lambda x: [-2 * x[0], -2 * x[1], 0], 'Both rings turn by half a turn.')):
        numbers = lambda key: [[float(v) for v in x] for x in slice_audit['robot'][key]]
        moved = {**({('base_anchor_m', n): base(x) for n, x in enumerate(numbers('base_anchors_m'))} if base else {}),
                 **({('platform_anchor_m', n): platform(x) for n, x in enumerate(numbers('platform_anchors_m'))} if platform else {})}
        loose = with_tolerances(slice_audit, cable_length_m=['0'] * 6, base_anchor_m=['1'] * 6, platform_anchor_m=['1'] * 6)
        at = middle_of(loose, level)
        add = lambda key, kind: [['%.9g' % (u + v) for u, v in zip(x, moved.get((kind, n), [0] * 3))] for n, x in enumerate(numbers(key))]
        machine = dict(slice_audit, robot=dict(slice_audit['robot'], base_anchors_m=add('base_anchors_m', 'base_anchor_m'),
                                               platform_anchors_m=add('platform_anchors_m', 'platform_anchor_m')))
        lengths, f0, v, _ = statics(machine, at)
        i = min(range(6), key=lambda n: f0[n] - v[n])
        loose['robot'] = dict(loose['robot'], tension_N=[list(x) for x in loose['robot']['tension_N']])
        reject('held_deviation_of_%s_through_a_singular_machine' % name,
               certificate(loose, level, 'refuted', witness=witness('tension_min', i, '%.9g' % (abs(f0[i] - v[i]) + 1), f0[i] - v[i], moved)),
               why, 'the pose to which the deviation leads',
               lambda c: c['problem']['robot']['tension_N'][i].__setitem__(slice(0, 2), [c['witness']['limit'], '1000']))

    # Against the format.
    malform('deviation_of_five_lengths', 'One a cable.', 'cable_lengths_m: expected an array of 6', edited('cable_lengths_m', lambda x: x.pop()), by_lengths)
    malform('deviation_of_lengths_missing', 'Under the law of cable lengths all machines are held by them.', "the key 'cable_lengths_m'",
            lambda c: c['witness']['deviation'].pop('cable_lengths_m'), by_both)
    malform('deviation_of_a_pose_by_lengths', 'A machine that is not held by lengths has no length errors.', "no key 'cable_lengths_m'",
            lambda c: c['problem']['tolerances'].update(cable_length_m=None), by_lengths)


def grazing():
    """A cable's length comes within 1e-60 m of its limit, in all exact numbers: on a straight way on which nothing turns."""
    free = audited('robot1-grazing')
    q = [Fraction(x) for x in quaternion(-2.3, 1.6, 34 * pi / 180)]
    R = rotation(q)
    cable = 1
    a, b = ([Fraction(x) for x in free['robot'][key][cable]] for key in ('base_anchors_m', 'platform_anchors_m'))
    Rb = [sum(x * y for x, y in zip(row, b)) for row in R]
    p0 = [Fraction(0), Fraction(0), Fraction(0.35)]
    d = [float(x + y - z) for x, y, z in zip(p0, Rb, a)]
    across = [d[1], -d[0], 0.0]
    p0 = [Fraction(float(x) - 0.002 / 3 * y) for x, y in zip(p0, across)]
    p1 = [Fraction(float(x) + 0.002 * y) for x, y in zip(p0, across)]
    D0 = [x + y - z for x, y, z in zip(p0, Rb, a)]
    step = [y - x for x, y in zip(p0, p1)]
    lowest_at = -sum(x * y for x, y in zip(D0, step)) / sum(x * x for x in step)
    assert 0.2 < lowest_at < 0.5
    squared = sum((x + lowest_at * y)**2 for x, y in zip(D0, step))
    tenths = 10**120
    least = Fraction(math.isqrt(squared.numerator * tenths**2 // squared.denominator), tenths)  # to 120 digits
    def limited(by):
        pr = copy.deepcopy(free)
        pr['robot']['length_m'][cable] = ['0.' + '%0120d' % ((least + by) * tenths), '0.55']
        return pr
    def halve(lo, hi, level):
        """Boxes as small as they are near to the point where the length is least."""
        if level < 3 or (hi - lo > max(lo - lowest_at, lowest_at - hi, Fraction(1, 2**105)) / 2):
            mid = (lo + hi) / 2
            return halve(lo, mid, level + 1) + halve(mid, hi, level + 1)
        return [[str(lo), str(hi)]]
    way = poses('geodesic', pose(p0, q), pose(p1, q))
    boxes = halve(Fraction(0), Fraction(1), 0)
    tiny = Fraction(1, 10**60)
    def claimed(pr, length):
        return of_segments(pr, way, [{'from': 0, 'to': 1, 'boxes': boxes, 'margins': {
            'tension_N': '1e-3', 'length_m': length, 'wrench_scale': '1.01'}}])
    safe = limited(-tiny)
    write('accepted', 'grazing', claimed(safe, '9.99e-61'), 'A length comes within 1e-60 m of its limit: boxes down to 2^-100, 256 bits.')
    reject('grazing_margin_too_high', claimed(safe, '1.01e-60'), 'The margin is 1e-60 m.', 'lower length margin as claimed is false')
    reject('grazing_beyond', claimed(limited(tiny), '1e-61'), 'The limit is passed by 1e-60 m.', 'lower length margin as claimed is false')
    reject('grazing_at_the_limit', claimed(limited(Fraction(0)), '1e-110'), 'The limit is reached to 120 digits.', 'lower length margin as claimed')


def hide_violation(c):
    """Cuts the first stretch in two about its first violation, and claims the cell around that to be proved."""
    stretch = c['stretches'][0]
    at = stretch['inner'][0]['at']
    s = Fraction(at['s'])
    k, cell = at['segment'], 32
    lo, hi = (Fraction(math.floor(s * cell) + e, cell) for e in (0, 1))
    place = lambda x: {'segment': k, 's': str(x)}
    rest = {'outer': [place(hi), stretch['outer'][1]], 'inner': [stretch['inner'][1]] * 2, 'reason': None}
    parts = [rest]
    if place(lo) != stretch['outer'][0]:
        parts.insert(0, {'outer': [stretch['outer'][0], place(lo)], 'inner': None, 'reason': 'small'})
    c['stretches'][0:1] = parts
    c['witness'] = stretch['inner'][1]
    boxes = c['segments'][k]['boxes']
    boxes.append([str(lo), str(hi)])
    boxes.sort(key=lambda b: Fraction(b[0]))
    c['segments'][k]['margins'] = c['segments'][k]['margins'] or {'tension_N': '1e-6', 'length_m': '1e-6', 'wrench_scale': '1'}


if __name__ == '__main__':
    main()

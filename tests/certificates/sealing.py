# SPDX-License-Identifier: GPL-3.0-or-later
"""What make_bases.py and expand.py share: the texts of numbers and boxes, what follows from the rest of a certificate,
and how a certificate is laid out in a file."""
import hashlib, json

MARGINS = ('tension_N', 'length_m', 'wrench_scale')

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


def box(lower, upper):
    """A box of a segment, from fractions or their texts. The one place that says what boxes look like."""
    return [str(lower), str(upper)]


def hex64(x):
    """A binary64 as C's %a writes it: no trailing zeros."""
    mantissa, exponent = float(x).hex().split('p')
    return (mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa) + 'p' + exponent


def digest(value):
    """SHA-256 of the canonical form."""
    text = json.dumps(value, sort_keys=True, separators=(',', ':'), ensure_ascii=True)
    return hashlib.sha256(text.encode('ascii')).hexdigest()


def least_margins(segments):
    """The margins of a proved path: the least of its segments'."""
    return {key: min((s['margins'][key] for s in segments), key=float) for key in MARGINS}


def seal(certificate, keep=()):
    """Computes what follows from the rest: claim, margins of a proved path, digests, footer; not the keys in `keep`."""
    c = certificate
    claimed = [s for s in c['segments'] if s['margins']]
    if 'claim' not in keep:
        c['claim'] = CLAIMS[c['verdict']]
    if 'margins' not in keep:
        c['margins'] = least_margins(claimed) if c['verdict'] == 'proved' and claimed else {}
    c['problem_sha256'] = digest(c['problem'])
    c['path_sha256'] = digest(c['path'])
    c.pop('footer', None)
    c['footer'] = {'waypoints': len(c['path']['waypoints']), 'segments': len(c['segments']),
                   'boxes': sum(len(s['boxes']) for s in c['segments']), 'sha256': digest(c)}
    return c


def without_implied(certificate):
    """A certificate as bases/ keeps it: without what seal() computes."""
    implied = ('claim', 'margins', 'problem_sha256', 'path_sha256', 'footer')
    return {key: value for key, value in certificate.items() if key not in implied}


def laid_out(value, indent=0, before=0, width=115):
    """JSON, broken into lines only where it does not fit on one; `before` characters stand before it on its line."""
    text = json.dumps(value, ensure_ascii=True)
    if not isinstance(value, (dict, list)) or not value or indent + before + len(text) < width:
        return text
    if isinstance(value, dict):
        keys = [json.dumps(key) + ': ' for key in value]
        parts = [key + laid_out(v, indent + 1, len(key) + (before if k == 0 else 0), width)
                 for k, (key, v) in enumerate(zip(keys, value.values()))]
        ends = '{}'
    else:
        parts = [laid_out(v, indent + 1, before if k == 0 else 0, width) for k, v in enumerate(value)]
        ends = '[]'
    pad = '\n' + ' ' * (indent + 1)
    if isinstance(value, list) and all(len(part) < 40 for part in parts):
        return '[' + pad.join(filled(parts, width - indent - 1 - before)) + ']'
    return ends[0] + (',' + pad).join(parts) + ends[1]


def filled(parts, room):
    """Lines with as many parts each as fit."""
    lines = ['']
    for k, part in enumerate(parts):
        if lines[-1] and len(lines[-1]) + len(part) + 1 > room:
            lines[-1] = lines[-1].rstrip()
            lines.append('')
        lines[-1] += part + (', ' if k + 1 < len(parts) else '')
    return lines

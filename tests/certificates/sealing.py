# SPDX-License-Identifier: GPL-3.0-or-later
"""What make_bases.py and expand.py share: the texts of numbers and boxes, what follows from the rest of a certificate,
and how a certificate is laid out in a file."""
import copy, hashlib, json, os, re

MARGINS = ('tension_N', 'length_m', 'wrench_scale')

CLAIMS_FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'checker', 'format', 'claims.h')


def claims():
    """The theorems in words, by verdict."""
    with open(CLAIMS_FILE, encoding='utf-8') as f:
        found = re.findall(r'char\* k(\w+)Claim =((?:\s*"[^"]*")+);', f.read())
    return {verdict.lower(): ''.join(re.findall('"([^"]*)"', texts)) for verdict, texts in found}


def text_of(name):
    """A text of claims.h."""
    with open(CLAIMS_FILE, encoding='utf-8') as f:
        texts = re.search(r'char\* %s =((?:\s*"[^"]*")+);' % name, f.read()).group(1)
    return ''.join(re.findall('"([^"]*)"', texts))


def bodies_clause(verdict, bodies):
    """What follows a claim where there are bodies."""
    names = ('platform-obstacles', 'cables-obstacles', 'cables-cables', 'cables-platform')
    checked = [n for n in names if n in bodies['clearance_m']]
    meshes = any('mesh' in body for body in bodies['platform'] + bodies['obstacles'])
    return '%s%s Pairs that are checked: %s. Pairs that are not checked: %s.%s' % (
        text_of('kClearClause' if verdict == 'proved' else 'kContactClause'), text_of('kBodiesClause'),
        ', '.join(checked) or 'none', ', '.join(n for n in names if n not in checked) or 'none',
        (text_of('kMeshClause') if meshes else '') + (text_of('kContactZonesClause') if 'contacts' in bodies else '') +
        (text_of('kExitConesClause') if 'exit_cones' in bodies else ''))


def time_clause(verdict, has_law, may_stop, has_rows):
    """What follows a claim where the problem has limits in time."""
    if verdict == 'proved':
        clauses = ['kMoveClause'] + ['kMayStopClause'] * may_stop + ['kRowsClause'] * has_rows
        return ''.join(map(text_of, clauses)) if has_law else ''
    if not has_law:
        return text_of('kAtRestClause')
    return text_of('kMoveRefutedClause') + (text_of('kSlowedRefutedClause') if may_stop else '')


def legs_claim(verdicts, are_moves):
    """The claim of a certificate of legs."""
    if 'refuted' in verdicts:
        return 'Leg %d of %d%s' % (verdicts.index('refuted') + 1, len(verdicts), text_of('kLegsRefutedClaim'))
    if set(verdicts) != {'proved'}:
        return text_of('kLegsUndecidedClaim')
    kind = 'kLegsOfMovesClause' if are_moves else 'kLegsOfPathsClause'
    return 'There are %d%s%s%s' % (len(verdicts), text_of('kLegsProvedClaim'), text_of(kind),
                                   text_of('kBetweenLegsClause'))


CLAIMS = claims()
ITEMS_CLAUSE = text_of('kItemsClause')


def box(lower, upper):
    """A box of a segment in bases and edits, from fractions or their texts. How it is proved is found later."""
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
    return {key: min((s['margins'][key] for s in segments), key=float)
            for key in MARGINS + ('clearance_m',) if all(key in s['margins'] for s in segments)}


def seal(certificate, keep=()):
    """Computes what follows from the rest: claim, margins of a proved path, digests, footer; not the keys in `keep`."""
    c = certificate
    claimed = [s for s in c['segments'] if s['margins']]
    if 'claim' not in keep:
        has_items = c['verdict'] != 'undecided' and 'items' in c['problem']['load']
        c['claim'] = CLAIMS[c['verdict']] + (ITEMS_CLAUSE if has_items else '')
        if c['verdict'] != 'undecided' and 'time' in c['problem']:
            stated = c['problem']['time']
            c['claim'] += time_clause(c['verdict'], 'timing' in c['path'], 'stopping_time_s' in stated,
                                      'rows' in stated)
        bodies = c['problem'].get('bodies')
        if c['verdict'] != 'undecided' and isinstance(bodies, dict) and isinstance(bodies.get('clearance_m'), dict):
            c['claim'] += bodies_clause(c['verdict'], bodies)
    if 'margins' not in keep:
        c['margins'] = least_margins(claimed) if c['verdict'] == 'proved' and claimed else {}
    c['problem_sha256'] = digest(c['problem'])
    c['path_sha256'] = digest(c['path'])
    c.pop('footer', None)
    c['footer'] = {'waypoints': len(c['path']['waypoints']), 'segments': len(c['segments']),
                   'boxes': sum(len(s['boxes']) for s in c['segments']), 'sha256': digest(c)}
    return c


def seal_legs(certificate, edits=()):
    """The same of a certificate of legs: what follows of the whole, and of each leg that an edit is about, unless that
    is about a digest of the leg; not what edits are about themselves."""
    c, paths = certificate, [edit['path'].split('/')[1:] for edit in edits]
    for k, leg in enumerate(c['legs']):
        about = [path[2] for path in paths if len(path) > 2 and path[:2] == ['legs', str(k)]]
        if about and not {'path_sha256', 'problem_sha256', 'footer'} & set(about):
            seal(leg, about)
    keep = {path[0] for path in paths}
    verdicts = [leg['verdict'] for leg in c['legs']]
    if 'verdict' not in keep:
        c['verdict'] = 'refuted' if 'refuted' in verdicts else 'proved' if set(verdicts) == {'proved'} else 'undecided'
    if 'claim' not in keep:
        c['claim'] = legs_claim(verdicts, 'timing' in c['legs'][0]['path'])
    c.pop('footer', None)
    c['footer'] = {'legs': len(c['legs']), 'sha256': digest(c)}
    return c


def near(unknowns):
    """Where the solution is, if nothing is known."""
    return {'at': ['0x0p+0'] * unknowns, 'narrowings': 2, 'radius': '0x1p-20', 'slope': ['0x0p+0'] * unknowns}


def with_hints(certificate):
    """The certificate with all keys that say how it is proved, where it lacks them, but without any search for them."""
    c = copy.deepcopy(certificate)
    constraints = c['problem']['space'].get('constraints')
    is_of_lengths = c['path'].get('interpolation') == 'straight-in-cable-lengths'
    unknowns = 6 if is_of_lengths else len(constraints) if isinstance(constraints, list) else 0
    proof = {'bits': 64, **({'near': near(unknowns)} if unknowns else {})}
    rates = {'guesses': 1, 'parts': 1} if c['problem'].get('tolerances') else {}
    for segment in c['segments']:
        if isinstance(segment.get('boxes'), list):
            segment['boxes'] = [b if isinstance(b, dict) else {**proof, **rates, 's': b} for b in segment['boxes']]
    witnesses = [c['witness']] + [w for s in c['stretches'] or [] for w in s.get('inner') or []]
    for witness in witnesses:
        if not isinstance(witness, dict):
            continue
        for key in ('at_proof', 'to_proof') if witness.get('kind') == 'singular' else ('proof',):
            witness.setdefault(key, proof)
        witness.setdefault('motion', [])
        deviation = witness.get('deviation')
        if isinstance(deviation, dict) and 'cable_lengths_m' in deviation:
            moved = [x for key in ('base_anchors_m', 'platform_anchors_m') for row in deviation[key] for x in row]
            still = all(float(x) == 0 for x in moved + deviation['cable_lengths_m'])
            deviation.setdefault('way', None if still else way())
    return c


def way():
    """How a deviation leads somewhere, if nothing is known."""
    poses = [{'position': ['0x0p+0', '0x0p+0', '0x1p-2'], 'quaternion': ['0x0p+0'] * 3 + ['0x1p+0'], 'tau': tau,
              'tube': {'position': '0x1p-5', 'turn': '0x1p-5'}} for tau in ('0', '1')]
    return {'boxes': [{'bits': 64, 'near': near(6), 's': ['0', '1']}], 'poses': poses}


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

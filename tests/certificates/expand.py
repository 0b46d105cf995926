#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes every case of the certificate tests as a file of its own, as the tests read them.

Usage: expand.py FOLDER ADD_HINTS. Writes FOLDER/{accepted,rejected,malformed}/NAME.json, with NAME.txt beside it: why
the case is there and, after "expect: ", what the checker's message must contain. ADD_HINTS is the program that says
how the checker proves a certificate (add_hints.cc). README.md describes the format of cases/.
"""
import copy, glob, json, os, re, shutil, subprocess, sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import yaml

from sealing import CLAIMS, box, hex64, seal, seal_legs, with_hints

HERE = os.path.dirname(os.path.abspath(__file__))
KEYS = {'name', 'why', 'base', 'legs', 'edit', 'hints', 'text', 'seal', 'expect', 'message'}
OUTCOMES = ('accepted', 'rejected', 'malformed')


class CaseError(Exception):
    """A case that can't be expanded; the message names file and case."""


def read_cases():
    """All cases by name, in order. A base is the case of its own name."""
    cases = {}
    for file in sorted(glob.glob(os.path.join(HERE, 'cases', '*.yaml'))):
        with open(file, encoding='utf-8') as f:
            entries = yaml.safe_load(f)
        for case in entries:
            place = '%s: %s' % (os.path.basename(file), case.get('name'))
            if not set(case) <= KEYS or not {'name', 'why', 'expect'} <= set(case):
                raise CaseError('%s: expected name, why, expect and some of %s' % (place, ', '.join(sorted(KEYS))))
            if case['expect'] not in OUTCOMES or (case['expect'] == 'accepted') != ('message' not in case):
                raise CaseError('%s: expected one of %s, with a message unless accepted' % (place, ', '.join(OUTCOMES)))
            if not all(isinstance(case.get(key, ''), str) for key in ('name', 'why', 'base', 'message')):
                raise CaseError('%s: expected strings' % place)
            if case['name'] in cases:
                raise CaseError('%s: the name is taken' % place)
            if is_base(case) + ('base' in case) + ('legs' in case) != 1:
                raise CaseError('%s: expected a base, legs, or a file of this name in bases/' % place)
            cases[case['name']] = case
    unused = {os.path.basename(f)[:-5] for f in glob.glob(os.path.join(HERE, 'bases', '*.json'))} - set(cases)
    if unused:
        raise CaseError('bases without a case: %s' % ', '.join(sorted(unused)))
    return cases


def is_base(case):
    return os.path.exists(os.path.join(HERE, 'bases', case['name'] + '.json'))


def is_of_legs(cases, name):
    """Whether a case is a certificate of legs, or made of one."""
    while 'base' in cases[name]:
        name = cases[name]['base']
    return 'legs' in cases[name]


def whole_of(cases, name, found):
    """The certificate of a case of legs, of those of all other cases."""
    case = cases[name]
    edits = case.get('edit', [])
    if 'legs' in case:
        whole = seal_legs({'format': 'taut-certificate', 'version': 7, 'illustration': None,
                           'generator': {'name': 'expand.py', 'version': '1'},
                           'legs': [found[leg] for leg in case['legs']]})
    else:
        whole = whole_of(cases, case['base'], found)
    return seal_legs(edited(whole, edits, name), edits) if case.get('seal', True) else edited(whole, edits, name)


def draft_of(cases, name, users=()):
    """The certificate of a case without what says how it is proved."""
    if name not in cases or name in users:
        raise CaseError('%s: no such base, or one that needs itself' % name)
    case = cases[name]
    if is_base(case):
        with open(os.path.join(HERE, 'bases', name + '.json'), encoding='ascii') as f:
            return seal(json.load(f))
    if not case.get('seal', True):
        return draft_of(cases, case['base'], users + (name,))
    edits = case.get('edit', [])
    certificate = edited(draft_of(cases, case['base'], users + (name,)), edits, name)
    return seal(certificate, tops(edits))


def edited(certificate, edits, name):
    certificate = copy.deepcopy(certificate)
    for edit in edits:
        before = copy.deepcopy(certificate)
        try:
            apply(certificate, edit)
        except (KeyError, IndexError, ValueError, TypeError) as error:
            raise CaseError('%s: %s: %s' % (name, edit, error)) from error
        if certificate == before:
            raise CaseError('%s: %s: it changes nothing' % (name, edit))
    return certificate


def tops(edits):
    """The keys of the top level that edits are about."""
    return {edit['path'].split('/')[1] for edit in edits}


def certificates_of(cases, names, add_hints):
    """The certificates of cases, before their bytes are edited. Those that need the same search share it."""
    drafts = {name: seal(with_hints(draft_of(cases, name)), tops(cases[name].get('edit', []))) for name in names}
    lines = list({json.dumps(draft, sort_keys=True) for draft in drafts.values()})

    def search(part):
        run = subprocess.run([add_hints], input='\n'.join(part) + '\n', stdout=subprocess.PIPE, text=True, check=True)
        return run.stdout.splitlines()

    workers = os.cpu_count() or 1
    parts = [part for part in (lines[k::workers] for k in range(workers)) if part]
    with ThreadPoolExecutor(workers) as pool:
        found = dict(zip((line for part in parts for line in part),
                         (line for answer in pool.map(search, parts) for line in answer)))
    return {name: finished(cases, name, json.loads(found[json.dumps(draft, sort_keys=True)]))
            for name, draft in drafts.items()}


def finished(cases, name, certificate):
    """With the edits of hints, those of bases first; sealed."""
    case, chain = cases[name], [name]
    while 'base' in cases[chain[0]]:
        chain.insert(0, cases[chain[0]]['base'])
    for user in chain:
        certificate = edited(certificate, cases[user].get('hints', []), user)
    if case.get('seal', True):
        return seal(certificate, tops(case.get('edit', []) + case.get('hints', [])))
    return edited(seal(certificate), case['edit'], name)


def places(value, path):
    """(holder, key) of all that a path means; * is every index or key."""
    steps = [step.replace('~1', '/').replace('~0', '~') for step in path.split('/')[1:]]
    holders = [value]
    for step in steps[:-1]:
        holders = [holder[key] for holder in holders for key in keys(holder, step)]
    found = [(holder, key) for holder in holders for key in keys(holder, steps[-1])]
    if not found:
        raise KeyError('nothing is at ' + path)
    return found


def keys(holder, step):
    if isinstance(holder, dict):
        return list(holder) if step == '*' else [step]
    if not isinstance(holder, list):
        return []  # null, where other elements have what is meant
    return list(range(len(holder))) if step == '*' else [len(holder) if step == '-' else int(step)]


def apply(certificate, edit):
    """One operation of README.md."""
    operation, path = edit['op'], edit['path']
    for holder, key in places(certificate, path):
        if operation in ('add', 'copy'):
            value = value_at(certificate, edit['from']) if operation == 'copy' else boxes(path, edit['value'])
            holder.insert(key, None) if isinstance(holder, list) else None
            holder[key] = copy.deepcopy(value)
            continue
        old = holder[key]
        if operation == 'remove':
            del holder[key]
        elif operation == 'replace':
            holder[key] = copy.deepcopy(boxes(path, edit['value']))
        elif operation == 'reverse':
            holder[key] = old[::-1]
        elif operation == 'scale':
            holder[key] = hex64(float.fromhex(old) * edit['by']) if '0x' in old else '%.6e' % (float(old) * edit['by'])
        elif operation == 'shift':
            holder[key] = hex64(float.fromhex(old) + edit['by'])
        elif operation == 'substitute':
            holder[key] = old.replace(edit['old'], edit['new'])
        elif operation == 'claim':
            holder[key] = CLAIMS[edit['of']]
        else:
            raise ValueError('no such operation')


def value_at(certificate, path):
    (holder, key), = places(certificate, path)
    return holder[key]


def boxes(path, value):
    """The value for a path. Edits write a box as [lower, upper] and n equal boxes as n; box() gives them their form."""
    if re.fullmatch('/segments/[^/]+/boxes', path):
        if isinstance(value, int):
            value = [[Fraction(k, value), Fraction(k + 1, value)] for k in range(value)]
        return [box(*ends) for ends in value]
    is_box = re.fullmatch('/segments/[^/]+/boxes/[^/]+', path) and isinstance(value, list)
    return box(*value) if is_box else value


def text_of(certificate, edits):
    """The file's bytes: the certificate's, edited. One character of an edit is one byte."""
    text = (json.dumps(certificate, indent=1, ensure_ascii=True, sort_keys=True) + '\n').encode('ascii')
    for edit in edits:
        (operation, value), = edit.items()
        if operation == 'keep':
            text = text[:int(len(text) * Fraction(value))]
        elif operation == 'prepend':
            text = value.encode('latin-1') + text
        elif operation == 'append':
            text = text + value.encode('latin-1')
        elif operation == 'double':
            text = text.replace(value.encode('latin-1'), (value + ', ' + value).encode('latin-1'), 1)
        elif operation == 'replace':
            if text.count(value[0].encode('latin-1')) != 1:
                raise CaseError('%s: this does not occur exactly once' % value[0])
            text = text.replace(*(part.encode('latin-1') for part in value))
        elif operation == 'last':
            whole = json.loads(text)
            whole[value] = whole.pop(value)
            text = (json.dumps(whole, indent=1, ensure_ascii=True) + '\n').encode('ascii')
        elif operation == 'repeat':
            text = value[0].encode('latin-1') * value[1]
        else:
            raise CaseError('%s: no such edit of a text' % operation)
    return text


def write(folder, case, text):
    base = os.path.join(folder, case['expect'], case['name'])
    with open(base + '.json', 'wb') as f:
        f.write(text)
    with open(base + '.txt', 'w', encoding='utf-8') as f:
        f.write(case['why'] + '\n' + ('expect: ' + case['message'] + '\n' if 'message' in case else ''))


def main(folder, add_hints):
    cases = read_cases()
    for outcome in OUTCOMES:
        shutil.rmtree(os.path.join(folder, outcome), ignore_errors=True)
        os.makedirs(os.path.join(folder, outcome))
    of_legs = [name for name in cases if is_of_legs(cases, name)]
    found = certificates_of(cases, [name for name in cases if name not in of_legs], add_hints)
    for name in of_legs:
        found[name] = whole_of(cases, name, found)
    for name, certificate in found.items():
        write(folder, cases[name], text_of(certificate, cases[name].get('text', [])))
    print('%d certificates in %s' % (len(cases), folder))


if __name__ == '__main__':
    try:
        main(*sys.argv[1:])
    except CaseError as error:
        sys.exit('expand.py: %s' % error)

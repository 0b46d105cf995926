#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes every case of the certificate tests as a file of its own, as the tests read them.

Usage: expand.py FOLDER. Writes FOLDER/{accepted,rejected,malformed}/NAME.json, with NAME.txt beside it: why the case
is there and, after "expect: ", what the checker's message must contain. README.md describes the format of cases/.
"""
import copy, glob, json, os, re, shutil, sys
from fractions import Fraction

import yaml

from sealing import CLAIMS, box, hex64, seal

HERE = os.path.dirname(os.path.abspath(__file__))
KEYS = {'name', 'why', 'base', 'edit', 'text', 'seal', 'expect', 'message'}
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
            if is_base(case) != ('base' not in case):
                raise CaseError('%s: expected a base, or a file of this name in bases/' % place)
            cases[case['name']] = case
    unused = {os.path.basename(f)[:-5] for f in glob.glob(os.path.join(HERE, 'bases', '*.json'))} - set(cases)
    if unused:
        raise CaseError('bases without a case: %s' % ', '.join(sorted(unused)))
    return cases


def is_base(case):
    return os.path.exists(os.path.join(HERE, 'bases', case['name'] + '.json'))


def certificate_of(cases, name, users=()):
    """The certificate of a case, before its bytes are edited."""
    if name not in cases or name in users:
        raise CaseError('%s: no such base, or one that needs itself' % name)
    case = cases[name]
    if is_base(case):
        with open(os.path.join(HERE, 'bases', name + '.json'), encoding='ascii') as f:
            return seal(json.load(f))
    certificate = copy.deepcopy(certificate_of(cases, case['base'], users + (name,)))
    edits = case.get('edit', [])
    for edit in edits:
        before = copy.deepcopy(certificate)
        try:
            apply(certificate, edit)
        except (KeyError, IndexError, ValueError, TypeError) as error:
            raise CaseError('%s: %s: %s' % (name, edit, error)) from error
        if certificate == before:
            raise CaseError('%s: %s: it changes nothing' % (name, edit))
    about = {edit['path'].split('/')[1] for edit in edits}
    return seal(certificate, about) if case.get('seal', True) else certificate


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
    return box(*value) if re.fullmatch('/segments/[^/]+/boxes/[^/]+', path) else value


def text_of(certificate, edits):
    """The file's bytes: the certificate's, edited. One character of an edit is one byte."""
    text = (json.dumps(certificate, indent=1, ensure_ascii=True) + '\n').encode('ascii')
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


def main(folder):
    cases = read_cases()
    for outcome in OUTCOMES:
        shutil.rmtree(os.path.join(folder, outcome), ignore_errors=True)
        os.makedirs(os.path.join(folder, outcome))
    for name, case in cases.items():
        write(folder, case, text_of(certificate_of(cases, name), case.get('text', [])))
    print('%d certificates in %s' % (len(cases), folder))


if __name__ == '__main__':
    try:
        main(sys.argv[1])
    except CaseError as error:
        sys.exit('expand.py: %s' % error)

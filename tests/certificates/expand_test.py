#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of cases do what README.md says, and those that could do nothing unnoticed are errors."""
import json, unittest

import expand


def case(**more):
    return dict({'name': 'a_case', 'why': 'x', 'base': 'geodesic', 'expect': 'rejected', 'message': 'x'}, **more)


class Expand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cases = expand.read_cases()
        cls.base = expand.draft_of(cls.cases, 'geodesic')

    def edited(self, *edits, **more):
        return expand.draft_of({**self.cases, 'a_case': case(edit=list(edits), **more)}, 'a_case')

    def finished(self, **more):
        """Of a case that the search for hints would leave as it is."""
        cases = {**self.cases, 'a_case': case(**more)}
        draft = expand.seal(expand.with_hints(expand.draft_of(cases, 'a_case')))
        return expand.finished(cases, 'a_case', draft)

    def test_there_are_as_many_cases_as_there_were(self):
        count = lambda outcome: sum(c['expect'] == outcome for c in self.cases.values())
        self.assertGreaterEqual(count('accepted'), 174)
        self.assertGreaterEqual(count('rejected'), 289)
        self.assertGreaterEqual(count('malformed'), 350)

    def test_a_star_is_every_element(self):
        c = self.edited({'op': 'replace', 'path': '/segments/*/margins/tension_N', 'value': '0.01'})
        self.assertEqual([s['margins']['tension_N'] for s in c['segments']], ['0.01'] * 2)

    def test_what_follows_is_computed_unless_the_edit_is_about_it(self):
        c = self.edited({'op': 'scale', 'path': '/segments/1/margins/tension_N', 'by': 0.5})
        self.assertEqual(c['margins']['tension_N'], c['segments'][1]['margins']['tension_N'])
        self.assertNotEqual(c['footer']['sha256'], self.base['footer']['sha256'])
        self.assertEqual(c['path_sha256'], self.base['path_sha256'])
        c = self.edited({'op': 'replace', 'path': '/margins/tension_N', 'value': '1'})
        self.assertEqual(c['margins']['tension_N'], '1')
        self.assertNotEqual(c['footer']['sha256'], self.base['footer']['sha256'])
        edit = {'op': 'replace', 'path': '/margins/tension_N', 'value': '1'}
        c = self.finished(edit=[edit], seal=False)
        self.assertEqual(c['margins']['tension_N'], '1')
        self.assertEqual(c['footer'], self.finished()['footer'])

    def test_hints_are_edited_after_they_were_found_and_those_of_bases_first(self):
        bits = lambda value: {'op': 'replace', 'path': '/segments/0/boxes/0/bits', 'value': value}
        c = self.finished(hints=[bits(99)])
        self.assertEqual(c['segments'][0]['boxes'][0], {'bits': 99, 's': ['0', '1/4']})
        self.assertEqual(c, expand.seal(json.loads(json.dumps(c))))
        cases = {**self.cases, 'a_case': case(hints=[bits(99)]),
                 'b_case': dict(case(hints=[bits(100)]), name='b_case', base='a_case')}
        draft = expand.seal(expand.with_hints(expand.draft_of(cases, 'b_case')))
        self.assertEqual(expand.finished(cases, 'b_case', draft)['segments'][0]['boxes'][0]['bits'], 100)
        with self.assertRaisesRegex(expand.CaseError, 'it changes nothing'):
            self.finished(hints=[bits(64)])

    def test_numbers_are_scaled_and_shifted_as_they_are_written(self):
        at = '/path/waypoints/0/position/2'
        height = lambda c: float.fromhex(c['path']['waypoints'][0]['position'][2])
        self.assertEqual(height(self.edited({'op': 'shift', 'path': at, 'by': 0.5})), 0.85)
        self.assertEqual(height(self.edited({'op': 'scale', 'path': at, 'by': -2})), -0.7)

    def test_boxes_are_written_by_their_ends_or_their_number(self):
        ends = [['0', '1/2'], ['1/2', '1']]
        for value in (2, ends):
            c = self.edited({'op': 'replace', 'path': '/segments/0/boxes', 'value': value})
            self.assertEqual(c['segments'][0]['boxes'], [expand.box(*pair) for pair in ends])

    def test_texts_are_edited_byte_by_byte(self):
        text = expand.text_of(self.base, [{'prepend': '\xef\xbb\xbf'}, {'append': '{}'}])
        self.assertTrue(text.startswith(b'\xef\xbb\xbf{') and text.endswith(b'}\n{}'))

    def test_a_key_can_be_moved_to_the_end_and_a_text_replaced(self):
        text = expand.text_of({'a': 1, 'b': 2}, [{'last': 'a'}])
        self.assertEqual(list(json.loads(text)), ['b', 'a'])
        self.assertEqual(expand.text_of({'a': 1}, [{'replace': ['1', '2']}]), b'{\n "a": 2\n}\n')
        with self.assertRaises(expand.CaseError):
            expand.text_of({'a': 1}, [{'replace': ['x', 'y']}])

    def test_edits_that_find_or_change_nothing_are_errors(self):
        for edit in ({'op': 'replace', 'path': '/no/such', 'value': 1}, {'op': 'remove', 'path': '/path/waypoints/9'},
                     {'op': 'replace', 'path': '/path/times/0', 'value': '0'}, {'op': 'turn', 'path': '/path'},
                     {'op': 'substitute', 'path': '/verdict', 'old': 'x', 'new': 'y'},
                     {'op': 'replace', 'path': '/stretches/*/inner', 'value': None}):
            with self.assertRaisesRegex(expand.CaseError, '^a_case: '):
                self.edited(edit)

    def test_a_base_that_is_not_there_or_needs_itself_is_an_error(self):
        for base in ('no_such', 'a_case'):
            with self.assertRaises(expand.CaseError):
                self.edited({'op': 'remove', 'path': '/witness'}, base=base)


if __name__ == '__main__':
    unittest.main()

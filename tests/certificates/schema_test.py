#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/certificate.schema.json holds of every well-formed certificate, true or false, and not of structural mutants.

Usage: schema_test.py ROOT CERTIFICATES, the folder that expand.py wrote.
"""
import glob, json, os, sys

import jsonschema

root, folder_of_cases = sys.argv[1:]
with open(os.path.join(root, 'docs', 'certificate.schema.json')) as f:
    schema = json.load(f)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
failures = []


def certificates(folder):
    return sorted(glob.glob(os.path.join(folder_of_cases, folder, '*.json')))


wellformed = certificates('accepted') + certificates('rejected')
for path in wellformed:
    with open(path) as f:
        error = next(validator.iter_errors(json.load(f)), None)
    if error is not None:
        failures.append('%s: %s' % (path, error.message[:200]))

# What is against the format by its keys, types or texts alone. The others break rules between values, which no schema
# sees.
STRUCTURAL = """
claim_reworded claim_of_another_verdict constraint_with_a_name decimal_nan geodesic_with_lengths
interpolation_unknown lengths_missing no_parameters normals_by_rows number_for_string one_waypoint
pose_for_parameters pose_with_parameters quaternion_of_three query_of_one_waypoint source_of_capitals
spline_of_three stretches_of_a_proved_path stretches_null_but_boxes stretches_open_without_a_reason
stretches_with_a_reason tolerance_missing tolerance_of_five_anchors tube_decimal tube_infinite unknown_key
waypoint_decimal waypoint_infinite expression_with_a_tab expression_not_ascii boxes_empty message_breaks_the_line
bits_31 bits_4097 bits_as_text bits_missing box_with_an_unknown_key box_without_its_ends near_decimal near_infinite
near_radius_infinite near_radius_missing narrowings_9 narrowings_negative parts_0 parts_65 guesses_0 guesses_17
proof_missing proof_with_ends proof_with_parts proof_of_a_singular_pose motion_missing motion_without_a_segment
way_of_one_pose version_3
bodies_of_version_4 version_5_without_bodies bodies_without_directions directions_without_bodies direction_too_large
direction_of_other_axes bodies_without_apart margins_without_clearance body_without_a_shape body_of_two_shapes
body_of_no_point mesh half_space_of_the_platform half_space_turned clearance_of_no_class
apart_of_a_box_that_changes_nothing
legs_of_one legs_missing legs_claim_more legs_with_a_path legs_of_version_6 version_7_of_a_path
legs_with_a_leg_that_is_null legs_of_legs
""".split()
caught = set()
for path in certificates('malformed'):
    try:
        with open(path, encoding='utf-8') as f:
            value = json.load(f)
    except (ValueError, RecursionError):
        continue  # no JSON: no matter for a schema
    if not validator.is_valid(value):
        caught.add(os.path.basename(path)[:-5])
missed = [name for name in STRUCTURAL
          if os.path.exists(os.path.join(folder_of_cases, 'malformed', name + '.json')) and name not in caught]
for name in missed:
    failures.append('the schema allows malformed/%s.json' % name)

# Every key of every object matters: without it, or with another beside it, a certificate is malformed.
FREE = ('generator', 'illustration', 'constants')
for name in ('stretches_open', 'tolerances_of_lengths', 'implied_sphere', 'refuted_by_a_deviation', 'refuted_singular',
             'clearance', 'contact', 'legs'):
    with open(os.path.join(folder_of_cases, 'accepted', name + '.json')) as f:
        text = f.read()

    def walk(value, at):
        if isinstance(value, dict):
            for key in list(value):
                if key in FREE or (key == 'deviation') or (key in ('range', 'normals')):
                    continue
                yield at + (key,)
                if key != 'bodies':  # of which many keys may be missing
                    yield from walk(value[key], at + (key,))
        elif isinstance(value, list):
            for i in range(min(2, len(value))):
                yield from walk(value[i], at + (i,))

    for place in walk(json.loads(text), ()):
        for change in ('lose', 'rename', 'number'):
            if change == 'lose' and place[-1] == 'near':
                continue  # it is there where poses are implied, which no schema sees
            mutant = json.loads(text)
            holder = mutant
            for step in place[:-1]:
                holder = holder[step]
            kept = holder.pop(place[-1]) if change != 'number' else None
            if change == 'rename':
                holder[place[-1] + '_'] = kept
            if change == 'number':
                holder[place[-1]] = 0.5
            if validator.is_valid(mutant):
                failures.append('%s: the schema allows %s of %s' % (name, change, '/'.join(map(str, place))))

print('%d well-formed files, %d malformed ones caught' % (len(wellformed), len(caught)))
print('\n'.join(failures))
sys.exit(1 if failures or len(wellformed) < 100 or len(caught) < 30 else 0)

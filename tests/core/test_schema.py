#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Holds lines of a JSON writer against its published schema, with python3-jsonschema.

usage: test_schema.py SCHEMA WRITER [ARGUMENT]     WRITER is a program that prints JSON lines

Every line has to pass. Then each of them is spoilt in ways that the schema has to notice: a schema
that lets anything through fails this test.
"""
import copy
import json
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    sys.exit('test_schema: python3-jsonschema is missing; tests/setup.sh installs it')


def drop(key):
    return f'without {key}', lambda line: line.pop(key)


def put(key, value):
    return f'{key} = {value!r}', lambda line: line.update({key: value})


HEAD = [drop(key) for key in ('schema', 'frame', 'pts', 'status', 'resolution')]
HEAD += [put('schema', '2.0'), put('frame', 0), put('frame', 1.5), put('pts', -1), put('pts', '0'),
         put('utc', '2026-11-21 11:00:00'), put('status', 'fine'),
         put('resolution', {'width': 0, 'height': 1}), put('extra', 1), put('source', ''),
         put('source', 7), put('tags', {}), put('tags', {'1a': 'b'}), put('tags', {'a': 1}),
         put('tags', 'a=b')]
SPOILT_FRAMES = HEAD + [drop('camera'), drop('objects'), drop('events'), put('camera', {'x': 0}),
                        put('camera', {'x': 0, 'y': 0, 'matrix': [1] * 8}),
                        put('camera', {'x': 0, 'y': 0, 'matrix': ['1'] * 9}),
                        put('camera', {'x': 0, 'y': 0, 'z': 0}), put('objects', {})]
SPOILT_GRAPHS = HEAD + [drop('energy'), drop('regions'), drop('arcs'), put('energy', {'total': 0}),
                        put('regions', {})]
SPOILT_REGIONS = [drop(key) for key in ('id', 'x', 'y', 'w', 'h', 'centroid', 'area', 'colour',
                                        'motion', 'reliability', 'group', 'expected', 'object')]
SPOILT_REGIONS += [put('id', 0), put('w', -1), put('area', 0.5), put('reliability', 1.01),
                   put('motion', {'x': 1}), put('group', -1), put('object', None), put('extra', 1)]
SPOILT_ARCS = [drop(key) for key in ('a', 'b', 'length', 'contrast', 'motion', 'border', 'arc',
                                     'prediction', 'weight', 'kept')]
SPOILT_ARCS += [put('a', 0), put('b', 1), put('length', 0), put('border', -1), put('weight', '1'),
                put('kept', 1), put('extra', 1)]
SPOILT_OBJECTS = [drop(key) for key in ('id', 'state', 'x', 'y', 'w', 'h', 'centroid', 'area',
                                        'velocity', 'age', 'colour', 'parents')]
SPOILT_OBJECTS += [put('id', 0), put('state', 'new'), put('state', 'lost'), put('x', 0.5),
                   put('w', -1), put('area', -1), put('velocity', {'x': 1}), put('velocity', 3),
                   put('colour', '#12345G'), put('parents', [0]), put('parents', [1, 1]),
                   put('contour', [[1]]), put('extra', 1)]
SPOILT_EVENTS = [drop('type'), drop('ids'), put('type', 'birth'), put('ids', ['1'])]


LISTS = {'objects': ('object', SPOILT_OBJECTS), 'events': ('event', SPOILT_EVENTS),
         'regions': ('region', SPOILT_REGIONS), 'arcs': ('arc', SPOILT_ARCS)}


# What only a line of the newer version may have, and what it has to.
def other_version(line):
    copied = copy.deepcopy(line)
    if copied.get('camera', {}).pop('matrix', None):
        return copied
    has_origin = 'source' in line or 'tags' in line
    for key in ('source', 'tags'):
        copied.pop(key, None)
    if not has_origin:
        copied['source'] = 'gate'
    return copied


def spoilt(line):
    """Copies of the line with one fault each, and what the fault is."""
    parts = [('frame', lambda copied: copied, SPOILT_GRAPHS if 'arcs' in line else SPOILT_FRAMES)]
    parts += [(name, lambda copied, key=key: copied[key][-1], faults)
              for key, (name, faults) in LISTS.items() if line.get(key)]
    yield 'frame of the other version', other_version(line)
    for name, part, faults in parts:
        for what, spoil in faults:
            copied = copy.deepcopy(line)
            spoil(part(copied))
            yield f'{name} {what}', copied


def main():
    schema_path, *writer = sys.argv[1:]
    with open(schema_path, encoding='utf-8') as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    output = subprocess.run(writer, check=True, capture_output=True).stdout.decode('utf-8')
    lines = [json.loads(line) for line in output.splitlines()]
    findings = []
    for number, line in enumerate(lines, 1):
        findings += [f'line {number}: {error.json_path}: {error.message}'
                     for error in validator.iter_errors(line)]
        findings += [f'line {number}: the schema accepts a line with this fault: {what}'
                     for what, bad in spoilt(line) if validator.is_valid(bad)]
    sizes = {len(json.dumps(line)) for line in lines}
    if len(sizes) < 3 or any(all(key not in line for line in lines)
                             for key in ('utc', 'source', 'tags')) or (
            'objects' in lines[0] and all('matrix' not in line['camera'] for line in lines)):
        findings.append('the lines do not show all that the writer can do')
    print('\n'.join(findings) or f'{len(lines)} lines agree with {schema["$id"]}')
    sys.exit(bool(findings))


if __name__ == '__main__':
    main()

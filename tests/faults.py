#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks the table of faults: each has a row, and each test that a row names is there.

usage: faults.py [FAULTS.MD]                    (default: the one beside this file)

A row is `| number | fault | tests |`. The third column names tests of GoogleTest as
`Suite.Name`, scripts by their path, each in backquotes, or says "Does not apply: " and why. Tests
must stand in a source under tests/ that a meson.build lists; scripts must be executable. Exits 1
otherwise.
"""
import os
import pathlib
import re
import sys

FAULTS = 60
ROOT = pathlib.Path(__file__).resolve().parent.parent
TEST = re.compile(r'^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,\s*(\w+)\s*\)', re.MULTILINE)
ROW = re.compile(r'^\|\s*(\d+)\s*\|([^|]*)\|([^|]*)\|\s*$', re.MULTILINE)


def known_tests():
    """All `Suite.Name` in the sources that are built."""
    listed = ''.join(p.read_text(encoding='utf-8') for p in (ROOT / 'tests').rglob('meson.build'))
    names = set()
    for path in (ROOT / 'tests').rglob('*.cpp'):
        if path.name in listed:
            names |= {'.'.join(found) for found in TEST.findall(path.read_text(encoding='utf-8'))}
    return names


def is_there(name, tests):
    if '/' not in name:
        return name in tests
    path = ROOT / name.split()[0]
    return path.is_file() and os.access(path, os.X_OK)


def findings(text, tests):
    rows = ROW.findall(text)
    numbers = [int(row[0]) for row in rows]
    problems = [f'fault {n}: {numbers.count(n)} rows'
                for n in range(1, FAULTS + 1) if numbers.count(n) != 1]
    problems += [f'fault {n}: there is none' for n in numbers if not 1 <= n <= FAULTS]
    for number, fault, covered in rows:
        names = re.findall(r'`([^`]+)`', covered)
        has_reason = re.match(r'\s*Does not apply: \w.{20,}', covered)
        if not fault.strip():
            problems.append(f'fault {number}: what is it?')
        if not names and not has_reason:
            problems.append(f'fault {number}: neither a test nor a reason')
        problems += [f'fault {number}: no test {name}' for name in names
                     if not is_there(name, tests)]
    return problems


def main():
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    table = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else ROOT / 'tests/faults.md'
    text, tests = table.read_text(encoding='utf-8'), known_tests()
    problems = findings(text, tests)
    # A check that sees nothing would pass as well.
    for broken in (text.replace('| `', '| `No', 1), re.sub(r'\|\s*7\s*\|', '| 8 |', text, count=1)):
        if not problems and not findings(broken, tests):
            problems.append('the check is blind')
    print('\n'.join(problems + [f'faults: {len(ROW.findall(text))} rows, {len(tests)} tests known, '
                                f'{len(problems)} findings']))
    sys.exit(1 if problems else 0)


if __name__ == '__main__':
    main()

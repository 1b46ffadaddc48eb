#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prints "N passed, N failed" (and ", N skipped") from the log that meson test wrote.

What failed within GoogleTest's programs is listed before: meson shows the ends of long logs only.

usage: summary.py TESTLOG.JSON

Exits 1 when a test failed or none passed.
"""
import collections
import json
import pathlib
import sys

KINDS = {'OK': 'passed', 'EXPECTEDFAIL': 'passed', 'SKIP': 'skipped'}  # All others failed.
MOST_LINES = 60


def failures_in(output):
    """Where a test failed and, within some lines, why; then the test's name."""
    lines = output.splitlines()
    wanted = set()
    for i, line in enumerate(lines):
        if line.endswith(': Failure'):
            wanted.update(range(i, min(i + 6, len(lines))))
        elif line.startswith('[  FAILED  ]'):
            wanted.add(i)
    return [lines[i][:300] for i in sorted(wanted)[:MOST_LINES]]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    log = pathlib.Path(sys.argv[1])
    lines = log.read_text(encoding='utf-8').splitlines() if log.exists() else []
    results = [json.loads(line) for line in lines]
    for result in results:
        if KINDS.get(result['result'], 'failed') == 'failed':
            print(f"{result['name']}: {result['result']}")
            print('\n'.join(failures_in(result.get('stdout', ''))))
    count = collections.Counter(KINDS.get(result['result'], 'failed') for result in results)
    skipped = f", {count['skipped']} skipped" if count['skipped'] else ''
    print(f"{count['passed']} passed, {count['failed']} failed{skipped}")
    sys.exit(0 if count['passed'] and not count['failed'] else 1)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prints "N passed, N failed" (and ", N skipped") from the log that meson test wrote.

usage: summary.py TESTLOG.JSON

Exits 1 when a test failed or none passed.
"""
import collections
import json
import pathlib
import sys

KINDS = {'OK': 'passed', 'EXPECTEDFAIL': 'passed', 'SKIP': 'skipped'}  # All others failed.


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    log = pathlib.Path(sys.argv[1])
    lines = log.read_text(encoding='utf-8').splitlines() if log.exists() else []
    count = collections.Counter(KINDS.get(json.loads(line)['result'], 'failed') for line in lines)
    skipped = f", {count['skipped']} skipped" if count['skipped'] else ''
    print(f"{count['passed']} passed, {count['failed']} failed{skipped}")
    sys.exit(0 if count['passed'] and not count['failed'] else 1)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compiles the kernels for every device and prints what each of them takes: registers, shared
memory, stack and what did not fit into registers. Fails on warnings, on spills and on stacks, which
kernels that are made of loops over pixels need none of; and on what nvcc makes without a word:
traps, where code for both sides refers to a constant of the host's memory, and maxima (or minima)
of three values of which one is negated, max(max(a, b), -c), whose instruction on sm_90 forgets the
sign (ptxas 13.0).

usage: resources.py BUILD_FOLDER
"""
import pathlib
import re
import subprocess
import sys

ENTRY = re.compile(r"Compiling entry function '(\w+)' for 'sm_(\d+)'")
STACK = re.compile(r'(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads')
EXTREME = re.compile(r'\s*(max|min|neg)\.([su]\d+)\s+(%\w+), (%\w+)(?:, (%\w+))?;')
USED = re.compile(r'Used (\d+) registers(?:.*?(\d+) bytes smem)?')


def plain_name(mangled):
    """A kernel's own name: the last one that _ZN…E counts the letters of."""
    names, rest = [], re.sub(r'^_ZN', '', mangled)
    while found := re.match(r'(\d+)', rest):
        length = int(found[1])
        names.append(rest[found.end():found.end() + length])
        rest = rest[found.end() + length:]
    return names[-1] if names else mangled


def kernels_of(path):
    """(kernel, device, registers, shared bytes, stack bytes, spilled bytes) of one file."""
    kernel, stack, spilled = None, 0, 0
    for line in path.read_text(encoding='utf-8').splitlines():
        if found := ENTRY.search(line):
            kernel = plain_name(found[1]), found[2]
        elif found := STACK.search(line):
            stack, spilled = int(found[1]), int(found[2]) + int(found[3])
        elif (found := USED.search(line)) and kernel:
            yield *kernel, int(found[1]), int(found[2] or 0), stack, spilled
            kernel = None


def traps_of(path):
    """The kernels of a file of PTX that end in a trap."""
    kernel = ''
    for line in path.read_text(encoding='utf-8').splitlines():
        if found := re.search(r'\.entry (\w+)', line):
            kernel = plain_name(found[1])
        elif line.strip().startswith('trap'):
            yield kernel


def negated_of(path):
    """The kernels of a file of PTX that have a maximum or minimum of three, one of them negated."""
    kernel, made = '', {}
    for line in path.read_text(encoding='utf-8').splitlines():
        if found := re.search(r'\.entry (\w+)', line):
            kernel, made = plain_name(found[1]), {}
        elif found := EXTREME.match(line):
            what, kind, to, *values = found.groups()
            made[to] = what, kind, values
            for inner in (made[value] for value in values if what != 'neg' and value in made):
                of_three = inner[:2] == (what, kind)
                if of_three and any(made.get(x, ' ')[0] == 'neg' for x in values + inner[2]):
                    yield kernel


def main():
    build = pathlib.Path(sys.argv[1])
    subprocess.run(['ninja', '-C', build, 'cuda-kernels'], check=True, stdout=subprocess.DEVNULL)
    rows = sorted(row for path in (build / 'kernels').glob('*.ptxas') for row in kernels_of(path))
    print(f'{"kernel":24} {"device":>6} {"registers":>9} {"shared":>6} {"stack":>5} {"spilled":>7}')
    for name, device, registers, shared, stack, spilled in rows:
        print(f'{name:24} {"sm_" + device:>6} {registers:9} {shared:6} {stack:5} {spilled:7}')
    bad = [row for row in rows if row[4] or row[5]]
    files = list((build / 'kernels').glob('*.ptx'))
    traps = sorted({name for path in files for name in traps_of(path)})
    negated = sorted({name for path in files for name in negated_of(path)})
    print(f'{len(rows)} kernels, {len(bad)} with a stack or spills; traps: {traps}; of three, one '
          f'negated: {negated}')
    sys.exit(1 if bad or traps or negated or not rows else 0)


if __name__ == '__main__':
    main()

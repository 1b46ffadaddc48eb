#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks with objdump that functions for AVX leave the vector registers clean.

usage: vector_state.py FILE...

Where the upper halves of ymm0 to ymm15 are left in use, each SSE instruction that follows, in
whatever function, waits for them; compilers put a vzeroupper in front of calls and returns, but
forget some behind which a loop over vectors ends in a call of a plain function. Follows the
branches of each function of each FILE, an x86-64 library (other files have nothing to be found).
Exits 1 where a function calls or returns with such registers in use, or where none was found that
uses any. Jumps to computed places are not followed.
"""
import re
import subprocess
import sys

FUNCTION = re.compile(r'^[0-9a-f]+ <(.*)>:$')
INSTRUCTION = re.compile(r'^ *([0-9a-f]+):\t(\S+) *(.*)$')
UPPER = re.compile(r'%[yz]mm(?:\d|1[0-5])\b')
TARGET = re.compile(r'([0-9a-f]+) <')
ENDLESS = re.compile(r'\b__stack_chk_fail\b')  # It does not come back.


def functions(file):
    command = ['objdump', '-d', '-C', '--no-show-raw-insn', file]
    text = subprocess.run(command, capture_output=True, text=True, check=True,
                          env={'LC_ALL': 'C', 'PATH': '/usr/bin:/bin'}).stdout
    name, body = None, []
    for line in text.splitlines():
        if begins := FUNCTION.match(line):
            if body:
                yield name, body
            name, body = begins[1], []
        elif found := INSTRUCTION.match(line):
            body.append((int(found[1], 16), found[2], found[3]))
    if body:
        yield name, body


def ends_in_use(body):
    """The instructions that leave the function while upper halves are in use."""
    if not any(UPPER.search(operands) for _, _, operands in body):
        return set()
    at = {address: i for i, (address, _, _) in enumerate(body)}
    seen, found = [-1] * len(body), set()
    work = [(0, 0)]
    while work:
        i, in_use = work.pop()
        while i < len(body) and seen[i] < in_use:
            seen[i] = in_use
            _, operation, operands = body[i]
            if operation == 'vzeroupper':
                in_use = 0
            elif UPPER.search(operands):
                in_use = 1
            target = TARGET.match(operands)
            goes_to = at.get(int(target[1], 16)) if target else None
            is_jump = operation.startswith('j')
            leaves = operation in ('ret', 'call') or (operation == 'jmp' and goes_to is None)
            if leaves and in_use and not ENDLESS.search(operands):
                found.add(f'{operation} {operands[:90]}')
            if is_jump and goes_to is not None:
                work.append((goes_to, in_use))
            if operation in ('ret', 'jmp'):
                break
            i += 1
    return found


def main():
    findings = checked = 0
    for file in sys.argv[1:]:
        for name, body in functions(file):
            checked += any(UPPER.search(operands) for _, _, operands in body)
            for end in sorted(ends_in_use(body)):
                print(f'{file}: {name[:120]}: {end}')
                findings += 1
    print(f'{checked} functions use upper halves, {findings} leave them in use')
    return 1 if findings or not checked else 0


if __name__ == '__main__':
    sys.exit(main())

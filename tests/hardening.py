#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks with readelf that the files a host loads are hardened.

usage: hardening.py BUILD FLAGS FILE...

Each FILE is bound when it is loaded, read-only after that, never unloaded, has no memory that is
both writable and executable, and begins its functions for others with endbr64 where it is one for
x86-64. (The note that tells the loader so is lost where libc's own start files lack it, as
Debian's do.) One of them at least guards its stacks. In BUILD all of core/ and gst/ was compiled
with each of FLAGS, a list with commas that may be empty. Exits 1 otherwise.
"""
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ENDBR64 = bytes.fromhex('f30f1efa')
SEGMENT = re.compile(r'^ +(\w+) +0x(\w+) 0x(\w+) 0x\w+ 0x(\w+) 0x\w+ ([R ][W ][E ]) ', re.MULTILINE)
SYMBOL = re.compile(r'^ *\d+: (\w+) +\w+ FUNC +\w+ +\w+ +(\w+) ([^@\s]+)', re.MULTILINE)


def readelf(file, *options):
    return subprocess.run(['readelf', '--wide', *options, file], capture_output=True, text=True,
                          check=True, env={'LC_ALL': 'C', 'PATH': '/usr/bin:/bin'}).stdout


def loading_findings(file):
    """What the dynamic section asks of the loader."""
    dynamic = readelf(file, '--dynamic')
    if not re.search(r'\(FLAGS\).*\bBIND_NOW\b|\(FLAGS_1\).*\bNOW\b|\(BIND_NOW\)', dynamic):
        yield 'is bound lazily: no BIND_NOW'
    if not re.search(r'\(FLAGS_1\).*\bNODELETE\b', dynamic):
        yield 'may be unloaded: no NODELETE'
    if re.search(r'\bTEXTREL\b', dynamic):
        yield 'has its code changed by the loader: TEXTREL'


def memory_findings(segments):
    kinds = {kind for kind, *_ in segments}
    if 'GNU_RELRO' not in kinds:
        yield 'stays writable after relocation: no GNU_RELRO'
    if 'GNU_STACK' not in kinds:
        yield 'wants executable stacks: no GNU_STACK'
    for kind, *_, access in segments:
        if kind == 'GNU_STACK' and 'E' in access:
            yield 'wants executable stacks: GNU_STACK is RWE'
        if kind == 'LOAD' and 'W' in access and 'E' in access:
            yield 'has memory that is writable and executable: LOAD is RWE'


def byte_at(address, segments):
    """Where in the file it is."""
    for kind, offset, start, size, _ in segments:
        offset, start, size = (int(number, 16) for number in (offset, start, size))
        if kind == 'LOAD' and start <= address < start + size:
            return address - start + offset
    return None


def branch_findings(file, segments):
    if 'X86-64' not in readelf(file, '--file-header'):
        return
    code = pathlib.Path(file).read_bytes()
    functions = [(int(address, 16), name)
                 for address, section, name in SYMBOL.findall(readelf(file, '--dyn-syms'))
                 if section != 'UND']
    if not functions:
        yield 'exports no function'
    for address, name in functions:
        at = byte_at(address, segments)
        if at is None or code[at:at + len(ENDBR64)] != ENDBR64:
            yield f'{name} does not begin with endbr64'


def findings_of(file):
    segments = SEGMENT.findall(readelf(file, '--segments'))
    yield from loading_findings(file)
    yield from memory_findings(segments)
    yield from branch_findings(file, segments)


def guards_stacks(file):
    return '__stack_chk_fail' in readelf(file, '--dyn-syms')


def compiler_findings(build, flags):
    commands = json.loads((pathlib.Path(build) / 'compile_commands.json').read_text('utf-8'))
    sources = {}
    for row in commands:
        source = os.path.relpath(os.path.join(row['directory'], row['file']), ROOT)
        if source.startswith(('core/', 'gst/')):
            sources[source] = set(shlex.split(row['command']))
    if not sources:
        yield f'{build}: compiles nothing of core/ and gst/'
    for flag in filter(None, flags.split(',')):
        yield from (f'{source}: is compiled without {flag}'
                    for source, used in sorted(sources.items()) if flag not in used)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    build, flags, files = sys.argv[1], sys.argv[2], sys.argv[3:]
    findings = [f'{file}: {what}' for file in files for what in findings_of(file)]
    findings += [] if any(map(guards_stacks, files)) else ['no file imports __stack_chk_fail']
    findings += compiler_findings(build, flags)
    print('\n'.join(findings + [f'hardening: {len(files)} files, {len(findings)} findings']))
    sys.exit(1 if findings else 0)


if __name__ == '__main__':
    main()

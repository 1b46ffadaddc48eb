#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks what the compiler does not: include arrows, sizes, licence lines, white space, commits.

usage: layers.py [ROOT]      (default: the repository that this file is in)

Arrows only point left: core <- kernels <- gst <- examples; tests may see all. Inside core too:
base <- background <- segmentation <- graph <- motion <- objects <- detection <- text, and of
another room only its contract is included (core/motion/motion.hpp), but all of base; kernels take
arithmetic from all of core. No element includes another one, except regiontrack, which is made of
them, and plugin, which registers them. No two types of core have one qualified name. What a device
may call counts bits by core/base/pixel.hpp.
Prints one line per finding and exits 1 when there is any.
"""
import collections
import pathlib
import re
import subprocess
import sys

LAYERS = ('core', 'kernels', 'gst', 'examples')
ROOMS = ('base', 'background', 'segmentation', 'graph', 'motion', 'objects', 'detection',
         'text')
FOREIGN = {  # Outside libraries that a layer must not include.
    'core': r'(glib|gio|gst|gobject|opencv|cuda|cub|thrust)',
    'kernels': r'(glib|gio|gst|gobject|opencv)',
}
ELEMENTS = ('bgremove', 'hsvsegment', 'srg', 'prmmotion', 'mrfmerge', 'haardetect', 'regionoverlay',
            'regionmask', 'regiontext', 'regionwrite', 'regiontrack')
SEES_ELEMENTS = ('regiontrack', 'plugin')
MAX_FILE_LINES, MAX_FUNCTION_LINES, MAX_COLUMNS = 400, 50, 100
MAX_FOLDER_FILES = 25  # Of core.
CODE = ('.cpp', '.hpp', '.h', '.cu', '.cuh')
SCRIPTS = ('.py', '.sh', '.map', '.supp')
SPDX = 'SPDX-License-Identifier: LGPL-2.1-or-later'
UNFINISHED = re.compile(r'\b(TO' r'DO|FIX' r'ME|XX' r'X)\b')  # Split so that this line is none.
INVISIBLE = re.compile('[\u200b-\u200f\u2028-\u202f\u2060-\u2064\ufeff]')
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
NAMESPACE = re.compile(r'^(?:inline )?namespace(?: ([\w:]+))? \{$')
TYPE = re.compile(r'^(?:(?:struct|class|union|enum(?: class)?) (?:\[\[\w+\]\] )?(\w+)\b(?!::)[^;]*'
                  r'|using (\w+) =.*)$')
SUBJECT = re.compile(r'^([a-z][a-z0-9.-]*: \S.*[^.\s]|Revert ".*")$')
COUNTS_BITS = re.compile(r'std::(bit_(ceil|floor|width)|count[lr]_(zero|one)|popcount|'
                         r'has_single_bit)')
MAX_SUBJECT = 72
CHECKED_COMMITS = 10


def git(root, *arguments):
    """The lines that git prints; none where there is no git or no repository."""
    try:
        done = subprocess.run(['git', '-C', root, *arguments], capture_output=True, text=True)
    except FileNotFoundError:
        return []
    return done.stdout.splitlines() if done.returncode == 0 else []


def tracked(root):
    names = git(root, 'ls-files')
    if names:
        return [root / name for name in sorted(set(names)) if (root / name).is_file()]
    skipped = re.compile(r'^(\.git|build.*|demo-output|scratch)(/|$)')
    return sorted(p for p in root.rglob('*')
                  if p.is_file() and not skipped.match(p.relative_to(root).as_posix()))


def is_ours(path):
    return (path.suffix in CODE + SCRIPTS
            or path.name in ('meson.build', 'meson_options.txt', '.clang-tidy')
            or path.parts[-2:] == ('.ci', 'run'))


def arrow_findings(relative, lines):
    layer = relative.parts[0]
    if layer not in LAYERS:
        return
    allowed = LAYERS[:LAYERS.index(layer) + 1]
    in_public_header = relative.parts[:2] == ('gst', 'meta') and relative.suffix == '.h'
    for number, line in enumerate(lines, 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        quote, target = found.groups()
        top = target.split('/')[0]
        if quote == '"' and top in LAYERS + ('tests',) and top not in allowed:
            yield number, f'{layer} must not include {target}'
        if quote == '"' and in_public_header and not target.endswith('.h'):
            yield number, f'a public header must not include {target}'
        if quote == '<' and layer in FOREIGN and re.match(FOREIGN[layer], target):
            yield number, f'{layer} must not include <{target}>'
        if quote == '"' and top == 'core' and layer != 'kernels':
            yield from room_findings(relative, number, target)
        if layer == 'gst' and quote == '"':
            yield from element_findings(relative, number, target)


def room_of(parts):
    """The room of core that a path belongs to, none outside of core."""
    if parts[0] != 'core' or len(parts) < 3:
        return None
    return parts[2] if parts[1] == 'simd' else parts[1]


def room_findings(relative, number, target):
    parts = pathlib.PurePath(target).parts
    own, other = room_of(relative.parts), room_of(parts)
    if other in (own, 'base'):
        return
    if other not in ROOMS:
        yield number, f'core has no room for {target}'
    elif own and ROOMS.index(other) > ROOMS.index(own):
        yield number, f'{own} must not include {target}'
    elif target != f'core/{other}/{other}.hpp':
        yield number, f'of {other} only the contract may be included, not {target}'


def folder_findings(root, paths):
    """Folders of core that hold too much to be seen at a glance."""
    counts = collections.Counter(path.relative_to(root).parent.as_posix() for path in paths
                                 if path.suffix in CODE)
    for folder, count in sorted(counts.items()):
        if folder.split('/')[0] == 'core' and count > MAX_FOLDER_FILES:
            yield f'{folder}: {count} files (at most {MAX_FOLDER_FILES})'


def types_of(lines):
    """The qualified names of the types that a file defines for others, as clang-format lays it out:
    what stands in a namespace begins at the margin."""
    scopes, names = [], set()
    for line in lines:
        opened = NAMESPACE.match(line)
        if opened:
            scopes.append(opened[1])  # None: the file's own.
        elif line.startswith('}  // namespace'):
            scopes.pop()
        elif None not in scopes and (found := TYPE.match(line)):
            names.add('::'.join(scopes + [found[1] or found[2]]))
    return names


def type_findings(root, paths):
    """What the linker does not see: two types of one name are one to it, whichever comes first."""
    places = collections.defaultdict(list)
    for path in paths:
        relative = path.relative_to(root)
        if relative.parts[0] == 'core' and path.suffix in CODE:
            for name in types_of(path.read_text(encoding='utf-8').splitlines()):
                places[name].append(relative.as_posix())
    for name, where in sorted(places.items()):
        if len(where) > 1:
            yield f'{where[0]}: {name} is defined in {", ".join(where[1:])} too'


def element_findings(relative, number, target):
    own = re.split(r'[_.]', relative.name)[0]
    other = re.split(r'[_.]', target.split('/')[-1])[0]
    if (target.startswith('gst/') and other in ELEMENTS and other != own
            and own not in SEES_ELEMENTS):
        yield number, f'{own} must not include another element ({target})'


def function_findings(lines):
    """clang-format puts a body's last brace under its first line: enough to measure functions."""
    for indent in ('', '  '):
        start = None
        for number, line in enumerate(lines, 1):
            if not line.startswith(indent) or line[len(indent):len(indent) + 1] in ('', ' '):
                continue
            if re.match(r'\}[;,)]*( *//.*)?$', line[len(indent):]):
                if start and number - start + 1 > MAX_FUNCTION_LINES:
                    yield start, f'function of {number - start + 1} lines (at most 50)'
                start = None
            elif '(' in line and not re.match(r'\s*(namespace|#|//)', line):
                start = number
            elif line.rstrip().endswith('{') and '(' not in line:
                start = None


def device_findings(relative, lines):
    """Bits counted by std where a device may do so: of 64 bits, and zeros from below of any number,
    nvcc makes constants without a word."""
    in_kernels = relative.parts[0] == 'kernels' and relative.parts[1] not in ('backend', 'shim')
    in_header = relative.parts[0] == 'core' and relative.suffix == '.hpp'
    if not (in_kernels or in_header) or relative.as_posix() == 'core/base/pixel.hpp':
        return
    begin = ''
    for number, line in enumerate(lines, 1):
        if re.match(r' {0,2}[\w\[]', line) and '(' in line and not line.endswith(';'):
            begin = line
        if COUNTS_BITS.search(line) and (in_kernels or 'constexpr' in begin):
            yield number, 'devices must not count bits by std: core/base/pixel.hpp'


def text_findings(relative, text):
    lines = text.split('\n')
    for number, line in enumerate(lines, 1):
        if line.rstrip(' \t\r') != line:
            yield number, 'trailing blank or carriage return'
        if '\t' in line and relative.name != 'rules':  # Of Debian's packages: a makefile.
            yield number, 'tab'
        if INVISIBLE.search(line):
            yield number, 'invisible character'
        if UNFINISHED.search(line):
            yield number, 'unfinished work'
        if len(line) > MAX_COLUMNS and relative.suffix not in ('.md', '.json'):
            yield number, f'{len(line)} columns (at most {MAX_COLUMNS})'
    if text and not text.endswith('\n'):
        yield len(lines), 'no newline at the end'


def file_findings(root, path):
    relative = path.relative_to(root)
    if relative.name == 'LICENSE' or 'corpus' in relative.parts:
        return
    try:
        text = path.read_text(encoding='utf-8')
    except UnicodeDecodeError:  # A picture.
        return
    lines = text.splitlines()
    yield from text_findings(relative, text)
    if is_ours(path) and not any(SPDX in line for line in lines[:3]):
        yield 1, 'no SPDX line'
    if path.suffix in CODE:
        yield from arrow_findings(relative, lines)
        yield from device_findings(relative, lines)
    if path.suffix in CODE and relative.parts[0] != 'tests':
        yield from function_findings(lines)
        if len(lines) > MAX_FILE_LINES:
            yield 1, f'{len(lines)} lines (at most {MAX_FILE_LINES})'


def commit_findings(root):
    log = git(root, 'log', '--no-merges', f'-{CHECKED_COMMITS}', '--format=%h%x1f%s%x1f%B%x1e')
    for entry in '\n'.join(log).split('\x1e'):
        if entry.count('\x1f') != 2:
            continue
        commit, subject, message = (part.strip('\n') for part in entry.split('\x1f'))
        if not SUBJECT.match(subject):
            yield commit, f'subject is not "area: sentence" without full stop: {subject}'
        if len(subject) > MAX_SUBJECT:
            yield commit, f'subject of {len(subject)} characters (at most {MAX_SUBJECT})'
        rest = message.split('\n')[1:]
        if rest and rest[0]:
            yield commit, 'no empty line after the subject'


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    root = root if root.is_dir() else root.parent.parent
    paths = tracked(root)
    findings = [f'{path.relative_to(root)}:{number}: {what}'
                for path in paths for number, what in file_findings(root, path)]
    findings += [*folder_findings(root, paths), *type_findings(root, paths)]
    findings += [f'commit {commit}: {what}' for commit, what in commit_findings(root)]
    print('\n'.join(findings + [f'layers: {len(findings)} findings']))
    sys.exit(1 if findings else 0)


if __name__ == '__main__':
    main()

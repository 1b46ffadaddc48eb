#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks what the built files export, with nm.

usage: symbols.py PLUGIN LIBRARY HEADER...

PLUGIN exports gst_plugin_* and nothing else. LIBRARY exports the functions that the HEADERs declare
for applications and for the plugin, each named gst_*region*, and nothing else. Neither asks for the
time of day, chance, or the user's locale: results depend on frames and their times alone. Exits 1
otherwise.
"""
import pathlib
import re
import subprocess
import sys


CLOCKS_CHANCE_LOCALE = re.compile(
    r'(clock_gettime|clock|time|gettimeofday|localtime(_r)?|g_get_(real|monotonic)_time|'
    r'_ZNSt6chrono.*3nowEv|rand(_r)?|s?random(_r)?|[dlm]rand48|getrandom|g_random_.*|g_rand_.*|'
    r'_ZNSt13random_device.*|setlocale|localeconv|strto(d|f|ld)|atof|v?sscanf)')


def rows_of(library, which):
    out = subprocess.run(['nm', '-D', which, '--without-symbol-versions', library],
                         capture_output=True, text=True, check=True).stdout
    return [line.split() for line in out.splitlines()]


def exported(library):
    """Names of all dynamic symbols that the file defines; A is a version's own name."""
    return {row[2] for row in rows_of(library, '--defined-only') if len(row) == 3 and row[1] != 'A'}


def imported(library):
    return {row[-1] for row in rows_of(library, '--undefined-only')}


def declared(headers):
    """Functions that the headers declare with GST_REGION_API."""
    names = set()
    for header in headers:
        text = pathlib.Path(header).read_text(encoding='utf-8')
        text = re.sub(r'/\*.*?\*/|//[^\n]*', '', text, flags=re.DOTALL)
        names |= set(re.findall(r'\bGST_REGION_API\b[^;#]*?\b(\w+)\s*\(', text))
    return names


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    plugin, library = exported(sys.argv[1]), exported(sys.argv[2])
    public = declared(sys.argv[3:])
    findings = [f'{sys.argv[1]}: exports {name}'
                for name in sorted(plugin) if not name.startswith('gst_plugin_')]
    findings += [] if plugin else [f'{sys.argv[1]}: exports nothing']
    findings += [f'{sys.argv[2]}: exports {name}, which no header declares'
                 for name in sorted(library - public)]
    findings += [f'{sys.argv[2]}: does not export {name}, which a header declares'
                 for name in sorted(public - library)]
    findings += [f'{sys.argv[2]}: exports {name}, which is not named gst_*region*'
                 for name in sorted(library) if not re.match(r'gst_.*region', name)]
    findings += [f'{library}: asks for {name}' for library in sys.argv[1:3]
                 for name in sorted(imported(library)) if CLOCKS_CHANCE_LOCALE.fullmatch(name)]
    print('\n'.join(findings + [
        f'symbols: plugin {len(plugin)}, library {len(library)}, {len(findings)} findings']))
    sys.exit(1 if findings else 0)


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks what the built files export, with nm.

usage: symbols.py PLUGIN LIBRARY HEADER... -- ARCHIVE...

PLUGIN exports gst_plugin_* and nothing else. LIBRARY exports the functions that the HEADERs declare
for applications and for the plugin, each named gst_*region*, and nothing else. Neither LIBRARY nor
the ARCHIVEs that the plugin is made of ask for the time of day, chance, or the user's locale:
results depend on frames and their times alone. (CUDA's runtime does, and is in the plugin beside
them.) Exits 1 otherwise.
"""
import pathlib
import re
import subprocess
import sys


CLOCKS_CHANCE_LOCALE = re.compile(
    r'(clock_gettime|clock|time|gettimeofday|localtime(_r)?|g_get_(real|monotonic)_time|'
    r'_ZNSt6chrono.*3nowEv|rand(_r)?|s?random(_r)?|[dlm]rand48|getrandom|g_random_.*|g_rand_.*|'
    r'_ZNSt13random_device.*|setlocale|localeconv|strto(d|f|ld)|atof|v?sscanf)')


def rows_of(file, *which):
    out = subprocess.run(['nm', '--without-symbol-versions', *which, file],
                         capture_output=True, text=True, check=True).stdout
    return [line.split() for line in out.splitlines()]


def exported(library):
    """Names of all dynamic symbols that the file defines; A is a version's own name."""
    return {row[2] for row in rows_of(library, '-D', '--defined-only')
            if len(row) == 3 and row[1] != 'A'}


def wanted(file):
    """Names that a library, or the objects of an archive, ask others for."""
    which = [] if file.endswith('.a') else ['-D']
    return {row[-1] for row in rows_of(file, '--undefined-only', *which) if row}


def declared(headers):
    """Functions that the headers declare with GST_REGION_API."""
    names = set()
    for header in headers:
        text = pathlib.Path(header).read_text(encoding='utf-8')
        text = re.sub(r'/\*.*?\*/|//[^\n]*', '', text, flags=re.DOTALL)
        names |= set(re.findall(r'\bGST_REGION_API\b[^;#]*?\b(\w+)\s*\(', text))
    return names


def main():
    if len(sys.argv) < 6 or '--' not in sys.argv[4:-1]:
        sys.exit(__doc__)
    end = sys.argv.index('--')
    plugin, library = exported(sys.argv[1]), exported(sys.argv[2])
    public = declared(sys.argv[3:end])
    findings = [f'{sys.argv[1]}: exports {name}'
                for name in sorted(plugin) if not name.startswith('gst_plugin_')]
    findings += [] if plugin else [f'{sys.argv[1]}: exports nothing']
    findings += [f'{sys.argv[2]}: exports {name}, which no header declares'
                 for name in sorted(library - public)]
    findings += [f'{sys.argv[2]}: does not export {name}, which a header declares'
                 for name in sorted(public - library)]
    findings += [f'{sys.argv[2]}: exports {name}, which is not named gst_*region*'
                 for name in sorted(library) if not re.match(r'gst_.*region', name)]
    findings += [f'{file}: asks for {name}' for file in [sys.argv[2], *sys.argv[end + 1:]]
                 for name in sorted(wanted(file)) if CLOCKS_CHANCE_LOCALE.fullmatch(name)]
    print('\n'.join(findings + [
        f'symbols: plugin {len(plugin)}, library {len(library)}, {len(findings)} findings']))
    sys.exit(1 if findings else 0)


if __name__ == '__main__':
    main()

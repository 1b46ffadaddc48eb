# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the report; see ../reproduce.sh, which builds what this runs."""
import argparse
import pathlib
import re
import sys
import time
import traceback

from . import page, registry, workshop

# The claims are a summary of the others' measurements.
LAST = 'claims'


def parse():
    parser = argparse.ArgumentParser(prog='reproduce.sh', description=__doc__)
    parser.add_argument('--build', type=pathlib.Path, required=True)
    parser.add_argument('--data', type=pathlib.Path)
    parser.add_argument('--quick', action='store_true')
    parser.add_argument('--only', default='')
    options = parser.parse_args()
    known = {item.id for item in registry.ITEMS}
    options.only = [name for name in options.only.split(',') if name]
    if unknown := [name for name in options.only if name not in known]:
        parser.error(f'no such item: {", ".join(unknown)}; there are {", ".join(sorted(known))}')
    return options


def make(item, shop, position):
    """The item's Section, or the error that it ended with."""
    start = time.monotonic()
    print(f'[{position}] {item.id}: {item.title} ...', end=' ', flush=True)
    try:
        made = item.make(shop)
    except Exception as error:  # One item that fails leaves the others.
        print(f'FAILED: {error}', flush=True)
        traceback.print_exc()
        return f'{type(error).__name__}: {error}'
    print(f'{time.monotonic() - start:.1f} s', flush=True)
    return made


def make_all(options, shop):
    chosen = [item for item in registry.ITEMS if not options.only or item.id in options.only]
    made = {}
    for number, item in enumerate(sorted(chosen, key=lambda item: item.id == LAST), 1):
        made[item] = make(item, shop, f'{number}/{len(chosen)}')
    return [(item, made[item]) for item in chosen]


def gaps(path, output):
    """Items and pictures that the written page lacks."""
    text = path.read_text(encoding='utf-8')
    sections = dict(re.findall(r'<section id="([\w-]+)">(.*?)</section>', text, re.S))
    lacking = [item.id for item in registry.ITEMS
               if item.id not in sections or 'class="failed"' in sections[item.id]
               or not re.search('<img|<table|class="finding"', sections[item.id])]
    pictures = [name for name in re.findall(r'<img src="([^"]+)"', text)
                if not (output / name).is_file() or (output / name).stat().st_size == 0]
    return lacking, pictures


def main():
    options = parse()
    output = pathlib.Path('paper-report').resolve()
    output.mkdir(exist_ok=True)
    for old in [*output.glob('*.svg'), *output.glob('*.png'), *output.glob('index.html')]:
        old.unlink()
    shop = workshop.Workshop(options.build, options.data, output, options.quick)
    about, start = workshop.machine(), time.monotonic()
    sections = make_all(options, shop)
    notes = [f'Made in {(time.monotonic() - start) / 60:.1f} minutes.']
    if options.quick:
        notes.append('With --quick: few frames and few points. The times mean little.')
    missing = sorted({name for _, made in sections if not isinstance(made, str)
                      for name in made.missing})
    if missing:
        where = f'not below {options.data}' if options.data else 'not given (--data)'
        notes.append(f'Sequences {where}: {", ".join(missing)}.')
    path = output / 'index.html'
    page.write(path, about, notes, sections)
    print(*notes, sep='\n')
    lacking, pictures = gaps(path, output)
    print(f'The report: {path}')
    if lacking or pictures:
        sys.exit(f'reproduce.sh: the report lacks {", ".join([*lacking, *pictures])}')


if __name__ == '__main__':
    main()

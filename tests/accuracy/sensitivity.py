#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tracking loses when one of its numbers is another.

usage: sensitivity.py DATA SCORE.PY [--build FOLDER] [--still FIRST:LAST] [--pan FIRST:LAST]
                      [--sampling WxH@FPS]... [--copies NAME,... | --copies all]
                      [--numbers NAME] [--by PERCENT] [--jobs N] [--gate] [--all]
       sensitivity.py --terms PERCENT DATA SCORE.PY [...]

Each number of core/objects/numbers.hpp is moved down and up (--by, default 25 percent), and
tracking is scored on pets09_s2l1 and tud_campus of DATA by the referee SCORE.PY, and on made-up
scenes, still and panning (default 1:20 each; 0:0 leaves them out). Prints by how much the mean of
MOTA and IDF1 over the sets and IDF1 of pets09_s2l1 fall, those that matter most first (--all: every
number).
--sampling  of the scenes (default: 640x480@25); each one is two sets
--copies    of the clips, slightly changed ("sensitivity copies" lists them; default: same); a set's
            figures are their mean. Of several, and of scenes, prints how far they differ (standard
            deviation; of a change: of what it does to each)
--numbers   only this one, as group.name, or a group
--terms     instead of numbers: what the sets come to with each weight of the energy, that of looks,
            and all of them at so many percent of what they are; 0 leaves them out
--gate      exits 1 when the mean falls by more than .02 or the latter by more than .05
"""
import argparse
import collections
import concurrent.futures
import importlib.util
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADER = ROOT / 'core/objects/numbers.hpp'
CLIPS = ('pets09_s2l1', 'tud_campus')
MOST_MEAN, MOST_PETS = 0.02, 0.05


def names(header):
    """Those of struct Numbers in the order in which it holds them, as group.name."""
    body = header.split('struct Numbers {', 1)[1]
    body = re.sub(r'//.*', '', body)
    for group in re.finditer(r'struct \w+ \{(.*?)\} (\w+);', body, re.S):
        for line in re.finditer(r'Number ([^;]*);', group[1]):
            for name in re.findall(r'(\w+)\s*(?:\{[^}]*\}|= ms\(\d+\))', line[1]):
                yield f'{group[2]}.{name}'


class Runner:
    """Of each set a list of (MOTA, IDF1), of its copies or scenes, for each trial: a number or None
    and a way."""

    def __init__(self, options):
        self.tool = str(options.build / 'tests/accuracy/sensitivity')
        self.options = options
        spec = importlib.util.spec_from_file_location('referee', options.score)
        self.referee = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.referee)
        sys.path.insert(0, str(options.score.resolve().parent))
        self.every = dict(line.split() for line in self.call('copies').splitlines())

    def call(self, *args):
        done = subprocess.run([self.tool, *args], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f'{" ".join(args)}\n{done.stderr}')
        return done.stdout

    def start(self, *args):
        chosen = self.options.chosen
        if self.options.terms is not None:
            return self.call(*args, '--terms', str(self.options.terms))
        return self.call(*args, '--by', str(self.options.by),
                         '--numbers', f'{chosen.start}:{chosen.stop}')

    def scenes(self, kind, seeds, sampling):
        size, fps = sampling.split('@')
        results = collections.defaultdict(list)
        for line in self.start(kind, seeds, '--size', size, '--fps', fps).splitlines():
            number, way, mota, idf1 = line.split()
            results[trial_of(number, way)].append((float(mota), float(idf1)))
        return results

    def clip(self, name):
        results = collections.defaultdict(list)
        for copy in self.options.copies:
            for trial, figures in self.copy(name, copy):
                results[trial].append(figures)
        return results

    def copy(self, name, copy):
        import cv2
        import moteval
        folder = self.options.data / name
        pattern = re.search(r'location=(\S+)', self.referee.source(str(folder)))[1]
        fps = cv2.VideoCapture(pattern).get(cv2.CAP_PROP_FPS)
        count = sum(1 for _ in self.referee.frames(str(folder)))
        with tempfile.TemporaryDirectory() as out:
            shown = pathlib.Path(out) / 'truth'
            shown.mkdir()
            truth = thinned((folder / 'gt.txt').read_text(), int(self.every[copy]))
            (shown / 'gt.txt').write_text(truth)
            for file in ('area.txt', 'seqinfo.ini'):
                if (folder / file).exists():
                    shutil.copy(folder / file, shown)
            self.start(pattern, str(fps), str(count), out, '--copy', copy)
            for file in sorted(pathlib.Path(out).glob('*.txt')):
                number, way, _ = file.name.split('.')
                figures = moteval.evaluate(str(shown / 'gt.txt'), str(file))
                yield trial_of(number, way), (figures['MOTA'], figures['IDF1'])


def trial_of(number, way):
    return None if number == '-' else int(number) if number.isdigit() else number, int(way)


def thinned(truth, every):
    """The lines of one frame in so many."""
    return ''.join(line for line in truth.splitlines(keepends=True)
                   if (int(line.split(',')[0]) - 1) % every == 0)


def means(pairs):
    return tuple(statistics.mean(values) for values in zip(*pairs))


def spread(pairs):
    """Of one alone nothing is known."""
    return tuple(statistics.stdev(values) if len(pairs) > 1 else 0 for values in zip(*pairs))


def differences(changed, usual):
    return [(mota - was_mota, idf1 - was_idf1)
            for (mota, idf1), (was_mota, was_idf1) in zip(changed, usual)]


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('score', type=pathlib.Path)
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build')
    parser.add_argument('--still', default='1:20')
    parser.add_argument('--pan', default='1:20')
    parser.add_argument('--sampling', action='append')
    parser.add_argument('--copies', default='same')
    parser.add_argument('--numbers', default='')
    parser.add_argument('--by', type=int, default=25)
    parser.add_argument('--terms', type=int)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--gate', action='store_true')
    parser.add_argument('--all', action='store_true')
    return parser.parse_args()


def told(pairs):
    return ' '.join(f'{mean:+.3f}' + (f' +-{off:.3f}' if len(pairs) > 1 else '')
                    for mean, off in zip(means(pairs), spread(pairs)))


def print_terms(results):
    """Of each trial what each set comes to, and the mean of their IDF1."""
    print(f'| weight | mean IDF1 | {" | ".join(f"{name}: MOTA / IDF1" for name in results)} |')
    print('|---|---|' + '---|' * len(results))
    for trial in next(iter(results.values())):
        figures = [means(by[trial]) for by in results.values()]
        each = ' | '.join(f'{mota:.3f} / {idf1:.3f}' for mota, idf1 in figures)
        print(f'| {trial[0] or "-"} | {statistics.mean(f[1] for f in figures):.3f} | {each} |')


def choose(known, wanted):
    """The numbers from the first to the last that is wanted."""
    found = [i for i, name in enumerate(known)
             if not wanted or name == wanted or name.startswith(wanted + '.')]
    if not found:
        sys.exit(f'sensitivity.py: no number is called {wanted}; known are {", ".join(known)}')
    return range(found[0], found[-1] + 1)


def main():
    options = parse()
    known = list(names(HEADER.read_text(encoding='utf-8')))
    options.chosen = choose(known, options.numbers)
    runner = Runner(options)
    options.copies = list(runner.every) if options.copies == 'all' else options.copies.split(',')
    if unknown := set(options.copies) - set(runner.every):
        sys.exit(f'sensitivity.py: no copy is called {", ".join(sorted(unknown))}')
    jobs = {name: (runner.clip, name) for name in CLIPS}
    for sampling in options.sampling or ['640x480@25']:
        for kind in ('still', 'pan'):
            if getattr(options, kind) != '0:0':
                jobs[f'{kind} {sampling}'] = (runner.scenes, kind, getattr(options, kind), sampling)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = {name: pool.submit(*job) for name, job in jobs.items()}
        results = {name: future.result() for name, future in futures.items()}
    nothing = (None, 0)
    for name, by in results.items():
        (mota, idf1), (mota_off, idf1_off) = means(by[nothing]), spread(by[nothing])
        print(f'{name}, {len(by[nothing])}: MOTA {mota:.4f} +-{mota_off:.4f} '
              f'IDF1 {idf1:.4f} +-{idf1_off:.4f}')
    if options.terms is not None:
        print_terms(results)
        return
    rows, stay = [], []
    for i in options.chosen:
        changes = {way: {name: differences(by[i, way], by[nothing]) for name, by in results.items()}
                   for way in (-1, 1)}
        if not any(any(pair) for change in changes.values() for pairs in change.values()
                   for pair in pairs):
            stay.append(known[i])
        for way, change in changes.items():
            mean = statistics.mean(sum(means(pairs)) / 2 for pairs in change.values())
            rows.append((mean, means(change['pets09_s2l1'])[1], known[i], way, change))
    rows.sort(key=lambda row: min(row[0] / MOST_MEAN, row[1] / MOST_PETS))
    beyond = [row for row in rows if row[0] < -MOST_MEAN or row[1] < -MOST_PETS]
    print(f'| number | % | mean | pets09 IDF1 | {" | ".join(results)} |')
    print('|---|---|---|---|' + '---|' * len(results))
    for mean, pets, name, way, change in rows if options.all else rows[:max(20, len(beyond))]:
        each = ' | '.join(told(pairs) for pairs in change.values())
        print(f'| {name} | {way * options.by:+d} | {mean:+.4f} | {pets:+.4f} | {each} |')
    print(f'{len(beyond)} of {len(rows)} moves are beyond {MOST_MEAN} of the mean or {MOST_PETS} '
          'of pets09')
    print(f'without any effect either way: {", ".join(stay) or "none"}')
    sys.exit(bool(options.gate and beyond))


if __name__ == '__main__':
    main()

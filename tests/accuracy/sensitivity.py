#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tracking loses when one of its numbers is another.

usage: sensitivity.py DATA SCORE.PY [--build FOLDER] [--still FIRST:LAST] [--pan FIRST:LAST]
                      [--numbers NAME] [--by PERCENT] [--gate] [--all]

Each number of core/objects/numbers.hpp is moved down and up (--by, default 25 percent), and
tracking is scored on pets09_s2l1 and tud_campus of DATA by the referee SCORE.PY, and on made-up
scenes, still and panning (default 1:20 each; 0:0 leaves them out). Prints by how much the mean of
MOTA and IDF1 over the sets and IDF1 of pets09_s2l1 fall, those that matter most first (--all: every
number).
--numbers  only this one, as group.name, or a group
--gate     exits 1 when the mean falls by more than .02 or the latter by more than .05
"""
import argparse
import concurrent.futures
import importlib.util
import pathlib
import re
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
    def __init__(self, options):
        self.tool = str(options.build / 'tests/accuracy/sensitivity')
        self.options = options
        spec = importlib.util.spec_from_file_location('referee', options.score)
        self.referee = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.referee)
        sys.path.insert(0, str(options.score.resolve().parent))

    def start(self, *args):
        chosen = self.options.chosen
        command = [self.tool, *args, '--by', str(self.options.by),
                   '--numbers', f'{chosen.start}:{chosen.stop}']
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f'{" ".join(command)}\n{done.stderr}')
        return done.stdout

    def scenes(self, kind, seeds):
        """(MOTA, IDF1) of each trial, a number or None and a way."""
        for line in self.start(kind, seeds).splitlines():
            number, way, mota, idf1 = line.split()
            yield (None if number == '-' else int(number), int(way)), (float(mota), float(idf1))

    def clip(self, name):
        import cv2
        import moteval
        folder = self.options.data / name
        source = self.referee.source(str(folder))
        pattern = re.search(r'location=(\S+)', source)[1]
        fps = cv2.VideoCapture(pattern).get(cv2.CAP_PROP_FPS)
        count = sum(1 for _ in self.referee.frames(str(folder)))
        with tempfile.TemporaryDirectory() as out:
            self.start(pattern, str(fps), str(count), out)
            for file in sorted(pathlib.Path(out).iterdir()):
                number, way, _ = file.name.split('.')
                figures = moteval.evaluate(str(folder / 'gt.txt'), str(file))
                yield ((None if number == '-' else int(number), int(way)),
                       (figures['MOTA'], figures['IDF1']))


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('score', type=pathlib.Path)
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build')
    parser.add_argument('--still', default='1:20')
    parser.add_argument('--pan', default='1:20')
    parser.add_argument('--numbers', default='')
    parser.add_argument('--by', type=int, default=25)
    parser.add_argument('--gate', action='store_true')
    parser.add_argument('--all', action='store_true')
    return parser.parse_args()


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
    jobs = {name: (runner.clip, name) for name in CLIPS}
    for kind in ('still', 'pan'):
        if getattr(options, kind) != '0:0':
            jobs[kind] = (runner.scenes, kind, getattr(options, kind))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        futures = {name: pool.submit(lambda job: dict(job[0](*job[1:])), job)
                   for name, job in jobs.items()}
        results = {name: future.result() for name, future in futures.items()}
    nothing = (None, 0)
    print('as they are: ' + ', '.join(f'{name} MOTA {by[nothing][0]:.4f} IDF1 {by[nothing][1]:.4f}'
                                      for name, by in results.items()))
    rows, stay = [], []
    for i in options.chosen:
        changes = {way: {name: (by[i, way][0] - by[nothing][0], by[i, way][1] - by[nothing][1])
                         for name, by in results.items()} for way in (-1, 1)}
        if not any(any(pair) for change in changes.values() for pair in change.values()):
            stay.append(known[i])
        for way, change in changes.items():
            mean = sum(map(sum, change.values())) / (2 * len(change))
            rows.append((mean, change['pets09_s2l1'][1], known[i], way, change))
    rows.sort(key=lambda row: min(row[0] / MOST_MEAN, row[1] / MOST_PETS))
    beyond = [row for row in rows if row[0] < -MOST_MEAN or row[1] < -MOST_PETS]
    print(f'| number | % | mean | pets09 IDF1 | {" | ".join(results)} |')
    print('|---|---|---|---|' + '---|' * len(results))
    for mean, pets, name, way, change in rows if options.all else rows[:max(20, len(beyond))]:
        each = ' | '.join(f'{mota:+.3f} {idf1:+.3f}' for mota, idf1 in change.values())
        print(f'| {name} | {way * options.by:+d} | {mean:+.4f} | {pets:+.4f} | {each} |')
    print(f'{len(beyond)} of {len(rows)} moves are beyond {MOST_MEAN} of the mean or {MOST_PETS} '
          'of pets09')
    print(f'without any effect either way: {", ".join(stay) or "none"}')
    sys.exit(bool(options.gate and beyond))


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""How close mrfmerge comes to the optimum of its energy, and how long that takes.

usage: energy.py VIDEO [--gate] [--build FOLDER] [--graphs N] [--seed N]

Runs the elements over the whole frames of VIDEO, as for a moving camera, takes the arcs with the
stage's own weights from regionwrite format=graph and cuts N (300) connected parts of 16 regions out
of them. Prints the mean gap (best − kept) / best of the kept weight to the exact optimum, the same
for N grids of 4x4 nodes with uniform weights, and the processor time of one frame's graph with
160 and with 4096 regions. --gate: exits 1 when a gap is above its limit.
"""
import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PART = 16
LIMITS = {'grids': 0.002, 'parts': 0.0005}
LEAST_OPTIMAL_GRIDS = 0.9
SHIFT_PX = 8  # Between neighbouring frames of surveillance video things move by less.


def graphs_of(options, regions, frames):
    """The arcs (a, b, weight), nodes from 0, of the first frames that have motion."""
    with tempfile.TemporaryDirectory() as folder:
        lines = pathlib.Path(folder, 'graphs.jsonl')
        command = ['meson', 'devenv', '-C', str(options.build), 'gst-launch-1.0', '-q', 'filesrc',
                   f'location={options.video}', *f'''! decodebin ! identity
                   eos-after={frames + 1} ! videoconvert ! hsvsegment scope=frame min-area=1
                   max-regions={regions} ! srg ! prmmotion max-shift={SHIFT_PX} ! mrfmerge !
                   regionwrite format=graph location={lines} ! fakesink'''.split()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=900)
        if done.returncode or not lines.exists():
            sys.exit(f'energy: the pipeline failed\n{done.stdout}{done.stderr}')
        for line in lines.read_text(encoding='ascii').splitlines()[1:]:
            frame = json.loads(line)
            # Hundredths are what the lines hold; the optimum does not depend on the unit.
            yield len(frame['regions']), [(arc['a'] - 1, arc['b'] - 1, round(arc['weight'] * 100))
                                          for arc in frame['arcs']]


def cut(chance, nodes, arcs):
    """A connected part of PART regions, grown from a random one; None where there is none."""
    neighbours = [[] for _ in range(nodes)]
    for a, b, _ in arcs:
        neighbours[a].append(b)
        neighbours[b].append(a)
    part = [chance.randrange(nodes)]
    while len(part) < PART:
        border = sorted({n for member in part for n in neighbours[member]} - set(part))
        if not border:
            return None
        part.append(chance.choice(border))
    number = {node: i for i, node in enumerate(sorted(part))}
    return PART, [(number[a], number[b], w) for a, b, w in arcs if a in number and b in number]


def grid(chance, side=4):
    nodes = range(side * side)
    pairs = [(i, i + 1) for i in nodes if i % side + 1 < side]
    pairs += [(i, i + side) for i in nodes if i + side < side * side]
    return side * side, [(a, b, chance.randint(-10**6, 10**6)) for a, b in pairs]


def solve(options, graphs):
    text = ''.join(f'{nodes} {len(arcs)} ' + ' '.join(f'{a} {b} {w}' for a, b, w in arcs) + '\n'
                   for nodes, arcs in graphs)
    command = [str(options.build / 'tests' / 'accuracy' / 'solve-graphs')]
    done = subprocess.run(command, input=text, check=True, capture_output=True, text=True)
    return [tuple(map(float, line.split())) for line in done.stdout.splitlines()]


def tell_gap(name, solved):
    """Prints one line; returns the mean gap and the share of optimal solutions."""
    gaps = [(best - kept) / best if best else 0.0 for kept, best, _ in solved]
    optimal = sum(gap == 0 for gap in gaps) / len(gaps)
    mean = statistics.fmean(gaps)
    print(f'{name}: {len(gaps)} graphs, mean gap {100 * mean:.4f} %, worst {100 * max(gaps):.2f} %,'
          f' {100 * optimal:.1f} % optimal')
    return mean, optimal


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('video', type=pathlib.Path)
    parser.add_argument('--gate', action='store_true')
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build')
    parser.add_argument('--graphs', type=int, default=300)
    parser.add_argument('--seed', type=int, default=1)
    options = parser.parse_args()
    options.build, options.video = options.build.resolve(), options.video.resolve()
    return options


def main():
    options = parse()
    chance = random.Random(options.seed)
    grids = tell_gap('4x4 grids, uniform weights',
                     solve(options, [grid(chance) for _ in range(options.graphs)]))
    frames = list(graphs_of(options, 160, 20))
    parts = []
    while len(parts) < options.graphs:
        part = cut(chance, *chance.choice(frames))
        parts += [part] if part else []
    mean, _ = tell_gap(f'parts of {PART} regions of {options.video.name}', solve(options, parts))
    for regions, graphs in ((160, frames), (4096, list(graphs_of(options, 4096, 5)))):
        times = [us for _, _, us in solve(options, graphs)]
        print(f'max-regions={regions}: {statistics.median(n for n, _ in graphs):.0f} regions, '
              f'{statistics.median(len(arcs) for _, arcs in graphs):.0f} arcs, '
              f'{statistics.median(times) / 1000:.3f} ms')
    missed = grids[0] > LIMITS['grids'] or grids[1] < LEAST_OPTIMAL_GRIDS or mean > LIMITS['parts']
    if options.gate and missed:
        sys.exit(f'energy: a gap is above its limit {LIMITS}')


if __name__ == '__main__':
    main()

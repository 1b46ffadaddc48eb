#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foreground masks of bgremove's methods and of OpenCV's subtractors, scored by one referee.

usage: masks.py DATA SCORE.PY [--build FOLDER] [--jobs N] [--ours-only] [SET...]

DATA, SCORE.PY and SET are those of run.py. Prints one table: a row for each set that has masks as
its truth, F of all scored frames, or the errors of a set that has a single frame (without blobs
under 8 pixels). bgremove runs with default properties, the peers with theirs. Exits 77 where there
is no such folder.
"""
import argparse
import concurrent.futures
import pathlib
import sys
import tempfile

import cv2

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import run  # noqa: E402

METHODS = ('hybrid', 'paper')
PEERS = {
    'MOG2': lambda: cv2.createBackgroundSubtractorMOG2(),
    'KNN': lambda: cv2.createBackgroundSubtractorKNN(),
    'CNT': lambda: cv2.bgsegm.createBackgroundSubtractorCNT(),
    'GSOC': lambda: cv2.bgsegm.createBackgroundSubtractorGSOC(),
    'LSBP': lambda: cv2.bgsegm.createBackgroundSubtractorLSBP(),
}
HIGHER_IS_BETTER = 'F'


def peer_names():
    """OpenCV may have been built without its contributed modules."""
    return [name for name in PEERS if name in ('MOG2', 'KNN') or hasattr(cv2, 'bgsegm')]


def figures_of_peer(runner, name, peer):
    """One pass over the frames; only the masks that are scored are kept."""
    folder = str(runner.data / name)
    scored = set(runner.module.truth(folder))
    subtractor, masks = PEERS[peer](), {}
    for index, frame in enumerate(runner.module.frames(folder)):
        mask = subtractor.apply(frame)
        if index in scored:
            masks[index] = mask
        if index >= max(scored):
            break
    return runner.module.score_masks(folder, masks.get)


def figures_of_method(options, name, method):
    runner = run.Runner(argparse.Namespace(**{**vars(options), 'method': method,
                                                 'literal': False}))
    with tempfile.TemporaryDirectory() as folder:
        return runner.masks(name, folder)


def cell(figures, kind):
    return f'{figures[kind]:.3f}' if kind == HIGHER_IS_BETTER else str(figures[kind])


def row(name, columns):
    """The best figure of the row is set in bold."""
    kind = HIGHER_IS_BETTER if HIGHER_IS_BETTER in columns[0] else 'TE8'
    choose = max if kind == HIGHER_IS_BETTER else min
    best = choose(figures[kind] for figures in columns)
    cells = [f'**{cell(figures, kind)}**' if figures[kind] == best else cell(figures, kind)
             for figures in columns]
    return f'| {name} ({kind}) | {" | ".join(cells)} |'


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('score', type=pathlib.Path)
    parser.add_argument('sets', nargs='*')
    parser.add_argument('--build', type=pathlib.Path, default=run.ROOT / 'build')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--ours-only', action='store_true')
    return parser.parse_args()


def main():
    options = parse()
    if not options.data.is_dir() or not options.score.is_file():
        print('masks.py: skipped, no data here')
        sys.exit(77)
    runner = run.Runner(argparse.Namespace(**{**vars(options), 'method': '', 'literal': False}))
    sets = [name for name, kind in runner.sets()
            if kind == 'masks' and (not options.sets or name in options.sets)]
    if not sets:
        sys.exit('masks.py: none of these sets is there')
    cv2.setNumThreads(1)
    peers = [] if options.ours_only else peer_names()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = {name: [pool.submit(figures_of_method, options, name, m) for m in METHODS] +
                         [pool.submit(figures_of_peer, runner, name, p) for p in peers]
                   for name in sets}
        print(f'| set | {" | ".join([*METHODS, *peers])} |')
        print('|---' * (1 + len(METHODS) + len(peers)) + '|')
        for name in sets:
            print(row(name, [future.result() for future in futures[name]]), flush=True)


if __name__ == '__main__':
    main()

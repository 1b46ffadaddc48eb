# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sequences with truth below --data, and the scores of masks and boxes."""
import dataclasses
import pathlib
import re

import cv2
import numpy as np
from scipy.optimize import linear_sum_assignment

from . import published

SMALL_PX = 8  # Blobs below are not counted by Toyama et al.; the paper says that it counts them.


@dataclasses.dataclass
class Wallflower:
    """Frames first … evaluated of the folder are shown; the last one's mask is known."""
    name: str
    folder: pathlib.Path
    first: int
    evaluated: int
    truth: np.ndarray

    def frames(self):
        for number, picture in enumerate(pictures_of(self.folder)):
            if number > self.evaluated:
                return
            if number >= self.first:
                yield picture

    def count(self):
        return self.evaluated - self.first + 1


def natural(path):
    return [int(part) if part.isdigit() else part for part in re.split(r'(\d+)', path.name)]


def pictures_of(folder):
    videos = [p for p in sorted(folder.iterdir()) if p.suffix in ('.mkv', '.mp4', '.avi')]
    if not videos:
        for path in sorted(folder.glob('b[0-9]*.bmp'), key=natural):
            yield cv2.imread(str(path))
        return
    capture = cv2.VideoCapture(str(videos[0]))
    while True:
        is_read, picture = capture.read()
        if not is_read:
            return
        yield picture


def span_of(folder, evaluated):
    """Where script.txt starts to train; 0 where it doesn't say."""
    script = folder / 'script.txt'
    text = script.read_text(encoding='latin-1') if script.exists() else ''
    found = re.search(r'(\d+) *- *\d+ +Train', text, re.I)
    return int(found[1]) if found and int(found[1]) < evaluated else 0


def wallflower(data, name):
    """A sequence with its truth, or None."""
    if data is None:
        return None
    for folder in (data / 'wallflower' / name, data / name):
        masks = sorted([*folder.glob('hand_segmented_*.BMP'), *folder.glob('hand_segmented_*.bmp')])
        if not masks or next(pictures_of(folder), None) is None:
            continue
        evaluated = int(re.findall(r'\d+', masks[0].name)[-1])
        truth = cv2.imread(str(masks[0]), cv2.IMREAD_GRAYSCALE) > 127
        return Wallflower(name, folder, span_of(folder, evaluated), evaluated, truth)
    return None


def all_wallflower(data):
    """Those that are there, by name, and the names of the others."""
    found = {name: wallflower(data, name) for name in published.WALLFLOWER}
    return ({name: one for name, one in found.items() if one},
            [f'Wallflower {name}' for name, one in found.items() if not one])


def without_small(mask):
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8),
                                                                connectivity=4)
    small = np.flatnonzero(statistics[:, cv2.CC_STAT_AREA] < SMALL_PX)
    return mask & ~np.isin(labels, small[small > 0])


def errors_of(mask, truth):
    """FN, FP, and their sum without blobs of less than SMALL_PX."""
    return (int((truth & ~mask).sum()), int((mask & ~truth).sum()),
            int((without_small(mask) ^ truth).sum()))


@dataclasses.dataclass
class Tracked:
    """A video, and the boxes of what is in it: {frame from 1: [(x, y, w, h)]}. left_open: of what
    may be found or not."""
    folder: pathlib.Path
    truth: dict
    left_open: dict
    fps: int

    def area(self):
        """The polygon that the truth is of, or None."""
        path = self.folder / 'area.txt'
        if not path.exists():
            return None
        return np.array([list(map(float, line.split(',')))
                         for line in path.read_text(encoding='ascii').split()], np.float32)

    def frames(self, count):
        for number, picture in enumerate(pictures_of(self.folder)):
            if number == count:
                return
            yield picture


def pets(data):
    folder = data / 'pets09_s2l1' if data else None
    if not folder or not (folder / 'gt.txt').exists() or next(pictures_of(folder), None) is None:
        return None
    truth, left_open = {}, {}
    for line in (folder / 'gt.txt').read_text(encoding='ascii').split():
        row = line.split(',')
        rows = truth if float(row[6]) != 0 else left_open
        rows.setdefault(int(row[0]), []).append(tuple(map(float, row[2:6])))
    return Tracked(folder, truth, left_open, 7)


def overlaps(a, b):
    """Intersection by union of each box of a with each of b."""
    a, b = np.array(a, float).reshape(-1, 4), np.array(b, float).reshape(-1, 4)
    low = np.maximum(a[:, None, :2], b[None, :, :2])
    high = np.minimum((a[:, :2] + a[:, 2:])[:, None], (b[:, :2] + b[:, 2:])[None])
    common = np.clip(high - low, 0, None).prod(2)
    return common / (a[:, 2:].prod(1)[:, None] + b[:, 2:].prod(1)[None] - common)


def match(truth, found, least):
    """Pairs of indices of boxes that overlap by `least`, as many as can be."""
    shares = overlaps(truth, found)
    pairs = zip(*linear_sum_assignment(-np.where(shares >= least, shares, 0)))
    return [(i, j) for i, j in pairs if shares[i, j] >= least]

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures regions and their motion: against true flow, known shifts, and a still scene.

usage: flow.py [--gate] [--build FOLDER] [--pairs FOLDER] [--clip VIDEO]

--pairs  folder of folders with frame10.png, frame11.png and flow10.flo (Middlebury's layout)
--clip   any video: its frame 200 is shifted by known vectors (the demo's vtest.avi)
--gate   exits 1 when a figure misses its gate

Pairs: EPE is the error of a region's vector against the mean of the truth over it, by area; half is
the more reliable half of the area; DIS is OpenCV's flow (fast), averaged over the same regions;
px is the error of the field of vectors at each pixel, best the least that one vector a region
allows;
quarters is the error of the least reliable quarter of the area by that of the most reliable; rank
is the rank correlation of reliability with minus the error. Recall is the share of motion borders
(where the truth jumps by a pixel) within 2 px of a region's border, leak the share of pixels that
move by more than a pixel otherwise than their region (under-segmentation). Shifts: cover is the
share of the area of cells with texture that reliable regions hold, exact that of the reliable
regions whose vector is right after a shift by whole pixels, within that of those within 0.15 px
after one by quarters. Still, two noisy takes (sigma 2) of one picture: borders kept is the share
of the pairs of neighbouring pixels parted in either take that are parted in both, overlap the
intersection by union of a region with its best match in the other take, by area.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIFTS = [(20, -20), (-20, 7), (3, -11), (0, 20), (-14, 0), (7.25, 3), (-2.5, 11.75), (13.5, -8.25)]
MARGIN = 24
AT_MOST = {'EPE': 0.60, 'half': 0.30}
AT_LEAST = {'regions': 100, 'cover': 0.80, 'exact': 1.0, 'within': 0.95, 'quarters': 2.5,
            'recall': 0.75}
LESS_THAN = {'half': 'DIS half', 'px': 'DIS px'}


class Elements:
    def __init__(self, build):
        self.build = build

    def run(self, previous, current, folder):
        """Labels of the second of two pictures, and {label: (dx, dy, reliability)}."""
        for index, picture in enumerate((previous, current)):
            cv2.imwrite(f'{folder}/in{index}.png', picture)
        line = (f'multifilesrc location={folder}/in%d.png caps=image/png,framerate=25/1 ! pngdec ! '
                'videoconvert ! hsvsegment ! srg ! prmmotion ! mrfmerge ! '
                f'regionwrite format=regions location={folder}/regions.csv ! regionmask '
                'source=labels ! video/x-raw,format=GRAY16_BE ! pngenc ! '
                f'multifilesink location={folder}/labels%d.png')
        subprocess.run(['meson', 'devenv', '-C', str(self.build), 'gst-launch-1.0', '-q',
                        *line.split()], check=True, capture_output=True, timeout=300)
        labels = [cv2.imread(f'{folder}/labels{i}.png', cv2.IMREAD_UNCHANGED) for i in (0, 1)]
        with open(f'{folder}/regions.csv', encoding='ascii') as table:
            rows = {int(r['id']): (float(r['dx']), float(r['dy']), float(r['reliability']))
                    for r in csv.DictReader(table) if int(r['frame']) == 2}
        return labels, rows


def read_flow(path):
    raw = path.read_bytes()
    width, height = np.frombuffer(raw, np.int32, 2, 4)
    return np.frombuffer(raw, np.float32, 2 * width * height, 12).reshape(height, width, 2)


def best_vector(vectors):
    """The geometric median: no vector has a smaller mean distance."""
    best = vectors.mean(0)
    for _ in range(30):
        weight = 1 / np.maximum(np.hypot(*(vectors - best).T), 1e-3)
        best = (vectors * weight[:, None]).sum(0) / weight.sum()
    return best


def ranks(values):
    order = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(order[2])
    return (ends - (order[2] - 1) / 2)[order[1]]


def border_recall(labels, flow, valid):
    """Recall of motion borders."""
    def edges(differ):
        out = np.zeros(labels.shape, bool)
        out[:, 1:] |= differ[0]
        out[1:] |= differ[1]
        return out
    known = (valid[:, 1:] & valid[:, :-1], valid[1:] & valid[:-1])
    jump = edges((known[0] & (np.hypot(*(flow[:, 1:] - flow[:, :-1]).transpose(2, 0, 1)) > 1),
                  known[1] & (np.hypot(*(flow[1:] - flow[:-1]).transpose(2, 0, 1)) > 1)))
    border = edges((labels[:, 1:] != labels[:, :-1], labels[1:] != labels[:-1]))
    near = cv2.dilate(border.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    return (near & jump).sum() / max(jump.sum(), 1)


def measure_pair(folder, elements):
    current, previous = (cv2.imread(str(folder / f'frame{i}.png')) for i in (10, 11))
    flow = read_flow(folder / 'flow10.flo')
    valid = (np.abs(flow) < 1e9).all(2)
    with tempfile.TemporaryDirectory() as work:
        (_, labels), rows = elements.run(previous, current, work)
    grey = [cv2.cvtColor(p, cv2.COLOR_BGR2GRAY) for p in (current, previous)]
    dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_FAST).calc(*grey, None)
    table, misses, leak = [], np.zeros(3), 0
    for label in np.unique(labels[valid & (labels > 0)]):
        truth = flow[(labels == label) & valid]
        dx, dy, reliability = rows[int(label)]
        mean, own = truth.mean(0), np.array([-dx, -dy])
        inside = (labels == label) & valid
        table.append((len(truth), reliability, np.hypot(*(own - mean)),
                      np.hypot(*(dis[inside].mean(0) - mean))))
        best = best_vector(truth)
        misses += [np.hypot(*(truth - own).T).sum(), np.hypot(*(truth - best).T).sum(),
                   np.hypot(*(dis[inside] - truth).T).sum()]
        leak += (np.hypot(*(truth - best).T) > 1).sum()
    area, reliability, error, other = np.array(table).T
    order = np.argsort(-reliability, kind='stable')
    area, error, other = area[order], error[order], other[order]
    before, total = np.cumsum(area) - area, area.sum()
    mean_of = lambda values, part: (values * area)[part].sum() / area[part].sum()
    half = before < total / 2
    px, best, dis_px = misses / total
    last, first = before >= total * 3 / 4, before < total / 4
    return {'regions': len(area), 'EPE': mean_of(error, area > 0), 'half': mean_of(error, half),
            'DIS half': mean_of(other, half), 'px': px, 'DIS px': dis_px, 'best': best,
            'px/best': px / best,
            'quarters': mean_of(error, last) / mean_of(error, first),
            'rank': np.corrcoef(ranks(reliability[order]), ranks(-error))[0, 1],
            'recall': border_recall(labels, flow, valid), 'leak': leak / total}


def shifted(picture, dx, dy):
    matrix = np.float64([[1, 0, dx], [0, 1, dy]])
    moved = cv2.warpAffine(picture, matrix, picture.shape[1::-1], flags=cv2.INTER_CUBIC)
    return moved[MARGIN:-MARGIN, MARGIN:-MARGIN]


def textured(picture):
    """The 8x8 cells whose luma varies by more than 8 levels."""
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    height, width = (n // 8 * 8 for n in grey.shape)
    cells = grey[:height, :width].reshape(height // 8, 8, width // 8, 8)
    rough = cells.max((1, 3)).astype(int) - cells.min((1, 3)) > 8
    mask = np.zeros(grey.shape, bool)
    mask[:height, :width] = np.kron(rough, np.ones((8, 8), bool))
    return mask


def measure_shifts(picture, elements):
    covered, area, hits = 0, 0, {True: [], False: []}
    for dx, dy in SHIFTS:
        current = shifted(picture, dx, dy)
        with tempfile.TemporaryDirectory() as work:
            (_, labels), rows = elements.run(shifted(picture, 0, 0), current, work)
        is_whole = dx == int(dx) and dy == int(dy)
        sure = {label: row for label, row in rows.items() if row[2] > 0}
        mask = textured(current)
        covered += np.isin(labels[mask], list(sure)).sum()
        area += mask.sum()
        limit = 0 if is_whole else 0.15
        hits[is_whole] += [max(abs(x - dx), abs(y - dy)) <= limit for x, y, _ in sure.values()]
    return {'cover': covered / area, 'exact': np.mean(hits[True]), 'within': np.mean(hits[False]),
            'regions': len(hits[True]) + len(hits[False])}


def measure_still(picture, elements, sigma=2):
    random = np.random.default_rng(1)
    takes = [np.clip(np.rint(picture + random.normal(0, sigma, picture.shape)), 0, 255)
             .astype(np.uint8) for _ in range(2)]
    with tempfile.TemporaryDirectory() as work:
        labels, _ = elements.run(*takes, work)
    apart = [np.concatenate([(l[:, 1:] != l[:, :-1]).ravel(), (l[1:] != l[:-1]).ravel()])
             for l in labels]
    joint = np.unique(labels[0].astype(np.int64) << 16 | labels[1], return_counts=True)
    size = [np.bincount(l.ravel(), minlength=65536) for l in labels]
    union = size[0][joint[0] >> 16] + size[1][joint[0] & 65535] - joint[1]
    best = np.zeros(65536)
    np.maximum.at(best, joint[0] >> 16, joint[1] / union)
    return {'regions': len(np.unique(labels[0])),
            'borders kept': (apart[0] & apart[1]).sum() / (apart[0] | apart[1]).sum(),
            'overlap': (best * size[0]).sum() / size[0].sum()}


def show(name, figures):
    text = ', '.join(f'{key} {value:.3f}' if isinstance(value, float) else f'{key} {value}'
                     for key, value in figures.items())
    missed = [key for key, limit in AT_MOST.items() if figures.get(key, limit) > limit]
    missed += [key for key, limit in AT_LEAST.items() if figures.get(key, limit) < limit]
    missed += [key for key, other in LESS_THAN.items() if key in figures
               and figures[key] >= figures[other]]
    print(f'| {name} | {text} | {"missed: " + ", ".join(missed) if missed else ""} |', flush=True)
    return bool(missed)


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('--pairs', type=pathlib.Path)
    parser.add_argument('--clip', type=pathlib.Path)
    parser.add_argument('--gate', action='store_true')
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build')
    return parser.parse_args()


def main():
    options = parse()
    elements = Elements(options.build.resolve())
    missed = False
    print('| what | figures | gate |\n|---|---|---|')
    for folder in sorted(options.pairs.glob('*/')) if options.pairs else []:
        missed |= show(folder.name, measure_pair(folder, elements))
        missed |= show(f'{folder.name}, still',
                       measure_still(cv2.imread(str(folder / 'frame10.png')), elements))
    if options.clip:
        clip = cv2.VideoCapture(str(options.clip))
        clip.set(cv2.CAP_PROP_POS_FRAMES, 200)
        _, picture = clip.read()
        missed |= show('shifts', measure_shifts(picture, elements))
        missed |= show('clip, still', measure_still(picture, elements))
    sys.exit(1 if options.gate and missed else 0)


if __name__ == '__main__':
    main()

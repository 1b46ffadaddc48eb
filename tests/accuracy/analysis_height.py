#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What regiontrack's analysis-height costs in accuracy and saves in time, on a scaled-up clip.

usage: analysis_height.py [--build DIR] [--rows N] [--size WxH] [--frames N]
                          [--least-speedup TIMES] [--least-near PERCENT] [CLIP | ball]

Scales CLIP (default: that of examples/demo.sh) to SIZE and follows what moves once in whole frames
and once with analysis-height=ROWS, one thread each. Prints

  the processor time a frame of both, less that of decoding and scaling;
  how many edges of the boxes of the whole frames' analysis lie within 4 px, for boxes of more than
  40 px a side. A box goes to the one that it overlaps most, by 0.3 of their union at least; all
  four edges of one that overlaps none are off.

CLIP may be the word ball: GStreamer's test pattern. Exits with 1 where it is less fast, or fewer
edges are near, than is asked for.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

NEAR_PX, LEAST_SIDE_PX, LEAST_OVERLAP = 4, 40, 0.3
CACHE = pathlib.Path(os.environ.get('XDG_CACHE_HOME', pathlib.Path.home() / '.cache'))
CLIP = CACHE / 'gst-regiongraph' / 'vtest.avi'


def source(arguments):
    width, height = arguments.size.split('x')
    if arguments.clip == 'ball':
        frames = (f'videotestsrc pattern=ball num-buffers={arguments.frames} ! '
                  'video/x-raw,format=I420,width=768,height=576')
    else:
        frames = (f'filesrc location={arguments.clip} ! decodebin ! videoconvert ! '
                  f'video/x-raw,format=I420 ! identity eos-after={arguments.frames + 1}')
    return (f'{frames} ! videoscale add-borders=false ! video/x-raw,width={width},'
            f'height={height},pixel-aspect-ratio=1/1')


def play(build, pipeline):
    """Seconds of processor time."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(['meson', 'devenv', '-C', build, 'gst-launch-1.0', '-q', *pipeline.split()],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime


def boxes(path):
    """For each frame the edges (left, top, right, bottom) of its boxes."""
    with open(path, encoding='utf-8') as lines:
        return [[(o['x'], o['y'], o['x'] + o['w'], o['y'] + o['h'])
                 for o in json.loads(line)['objects']] for line in lines]


def overlap(a, b):
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0
    area = [(box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)]
    return width * height / (sum(area) - width * height)


def partners(whole, reduced):
    """For each box of the one frame that of the other, or none; nobody has two."""
    pairs = sorted(((overlap(a, b), i, j) for i, a in enumerate(whole)
                    for j, b in enumerate(reduced)), reverse=True)
    found, taken = {}, set()
    for share, i, j in pairs:
        if share >= LEAST_OVERLAP and i not in found and j not in taken:
            found[i] = reduced[j]
            taken.add(j)
    return [found.get(i) for i in range(len(whole))]


def near_edges(whole, reduced):
    """How many edges are near, of how many, and how many boxes have no partner."""
    near = count = lost = 0
    for a, b in zip(whole, reduced):
        for box, partner in zip(a, partners(a, b)):
            if min(box[2] - box[0], box[3] - box[1]) <= LEAST_SIDE_PX:
                continue
            count += 4
            lost += partner is None
            near += sum(abs(p - q) <= NEAR_PX for p, q in zip(box, partner or ()))
    return near, count, lost


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('--build', default='build')
    parser.add_argument('--rows', type=int, default=540)
    parser.add_argument('--size', default='3840x2160')
    parser.add_argument('--frames', type=int, default=200)
    parser.add_argument('--least-speedup', type=float, default=0)
    parser.add_argument('--least-near', type=float, default=0)
    parser.add_argument('clip', nargs='?', default=str(CLIP))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seconds, found = [], []
        for name, track in (('none', ''), ('whole', 'regiontrack threads=1 ! '),
                            ('reduced', 'regiontrack threads=1 '
                                        f'analysis-height={arguments.rows} ! ')):
            lines = f'{folder}/{name}'
            write = f'regionwrite location={lines} ! ' if track else ''
            seconds.append(play(arguments.build,
                                f'{source(arguments)} ! {track}{write}fakesink'))
            found.append(boxes(lines) if track else [])
    frames = max(len(found[1]), 1)
    whole, reduced = seconds[1] - seconds[0], seconds[2] - seconds[0]
    if reduced <= 0:
        sys.exit('analysis_height: so few frames that their time is lost in that of scaling')
    speedup = whole / reduced
    print(f'{arguments.size}, {frames} frames: {1000 * whole / frames:.1f} ms a frame, '
          f'{1000 * reduced / frames:.1f} with analysis-height={arguments.rows}: '
          f'{speedup:.1f} times as fast')
    near, count, lost = near_edges(found[1], found[2])
    percent = 100 * near / max(count, 1)
    print(f'{percent:.1f} % of {count} edges within {NEAR_PX} px; '
          f'{lost} of {count // 4} boxes are not there')
    sys.exit(speedup < arguments.least_speedup or percent < arguments.least_near)


if __name__ == '__main__':
    main()

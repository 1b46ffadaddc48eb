#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a camera costs: processor time of regiontrack a frame, and so cameras a core.

usage: camera.py [--camera WIDTHxHEIGHT@RATE]... VIDEO [ELEMENT...]
ELEMENTs: with their properties (default: regiontrack threads=1)

Takes the VIDEO's frames at each size and rate (one that has fewer of them a second is played
faster), decoded beforehand, and runs them through the element and through nothing. Counts the
processor time of both, without the first frames, in which the background is learnt; the median
of three runs. The elements must be found: installed, or meson devenv -C build in front.
"""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

CAMERAS = ('640x360@5', '1920x1080@15')
LEARNT, MOST, RUNS = 60, 360, 3


def decode(video, width, height, rate, path):
    """How many frames there are."""
    subprocess.run(['gst-launch-1.0', '-q', 'filesrc', f'location={video}', '!', 'decodebin', '!',
                    'videorate', 'drop-only=true', f'max-rate={rate}', '!', 'videoconvert', '!',
                    'videoscale', '!', f'video/x-raw,format=I420,width={width},height={height}',
                    '!', 'identity', f'eos-after={MOST + 1}', '!', 'filesink', f'location={path}'],
                   check=True)
    return path.stat().st_size // (width * height * 3 // 2)


def processor_seconds(path, width, height, rate, frames, element):
    size = width * height * 3 // 2
    before = os.times()
    subprocess.run(['gst-launch-1.0', '-q', 'filesrc', f'location={path}', f'blocksize={size}',
                    f'num-buffers={frames}', '!', 'rawvideoparse', 'format=i420', f'width={width}',
                    f'height={height}', f'framerate={rate}/1', '!', *element.split(), '!',
                    'fakesink'], check=True)
    after = os.times()
    return (after.children_user + after.children_system
            - before.children_user - before.children_system)


def cost_ms(clip, frames, element):
    """Of one frame behind the first ones."""
    def later():
        return (processor_seconds(*clip, frames, element)
                - processor_seconds(*clip, LEARNT, element))
    return statistics.median(later() for _ in range(RUNS)) / (frames - LEARNT) * 1000


def numbers_of(camera):
    found = re.fullmatch(r'(\d+)x(\d+)@(\d+)', camera)
    if not found:
        raise argparse.ArgumentTypeError('not of the form 640x360@5')
    return tuple(map(int, found.groups()))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('--camera', action='append', type=numbers_of)
    parser.add_argument('video')
    parser.add_argument('elements', nargs='*', default=['regiontrack threads=1'])
    options = parser.parse_args()
    for width, height, rate in options.camera or map(numbers_of, CAMERAS):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'clip.raw')
            frames = decode(options.video, width, height, rate, path)
            if frames < 2 * LEARNT:
                sys.exit(f'camera.py: {frames} frames are too few')
            clip = (path, width, height, rate)
            nothing = cost_ms(clip, frames, 'identity')
            for element in options.elements:
                spent = max(cost_ms(clip, frames, element) - nothing, 0.01)
                print(f'{width}x{height}, {rate} frames a second: {element}: {spent:.2f} ms of a '
                      f'core a frame, {1000 / spent / rate:.1f} cameras a core')


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Saves the frame with the most objects in view as a picture.

usage: still.py FOLDER      reads FOLDER/objects.jsonl and annotated.mp4, writes FOLDER/still.png
"""
import json
import pathlib
import sys

import cv2

VISIBLE = ('tracked', 'stopped')


def best_frame(lines):
    """Number, from 1, of the frame with the most objects; the middle one where none has any."""
    counts = [sum(o['state'] in VISIBLE for o in json.loads(line)['objects']) for line in lines]
    most = max(counts, default=0)
    return counts.index(most) + 1 if most else len(counts) // 2 + 1


def frame_of(video, number):
    capture = cv2.VideoCapture(str(video))
    image = None
    for _ in range(number):
        is_read, frame = capture.read()
        if not is_read:
            break
        image = frame
    return image


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    lines = (folder / 'objects.jsonl').read_text(encoding='utf-8').splitlines()
    image = frame_of(folder / 'annotated.mp4', best_frame(lines))
    if image is None or not cv2.imwrite(str(folder / 'still.png'), image):
        sys.exit(f'still.py: no frame in {folder}/annotated.mp4')


if __name__ == '__main__':
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The applications in examples/ find the object of a generated clip, and agree on it.

usage: test_examples.py READ_OBJECTS READ_OBJECTS.PY      (GST_PLUGIN_PATH names the built plugin)
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy

IN_CPP, IN_PYTHON = [sys.argv[1]], [sys.executable, sys.argv[2]]
SIZE, FRAMES, ENTERS = (240, 160), 120, 30


def frames():
    """A person-sized body of two colours that crosses a textured yard after a while."""
    noise = numpy.random.default_rng(7)
    width, height = SIZE
    yard = noise.integers(90, 130, (height // 4, width // 4, 3)).repeat(4, 0).repeat(4, 1)
    for number in range(FRAMES):
        picture = yard + noise.integers(-2, 3, yard.shape)
        left = 3 * (number - ENTERS) - 20
        if left > -20:
            columns = slice(max(left, 0), max(left + 20, 0))
            picture[60:90, columns] = (200, 60, 50)
            picture[90:125, columns] = (40, 50, 160)
        yield picture.astype(numpy.uint8).tobytes()


def write_clip(path):
    subprocess.run(['gst-launch-1.0', '-q', 'fdsrc', 'fd=0', '!', 'rawvideoparse', 'format=rgb',
                    f'width={SIZE[0]}', f'height={SIZE[1]}', 'framerate=25/1', '!', 'videoconvert',
                    '!', 'jpegenc', 'quality=95', '!', 'avimux', '!', 'filesink',
                    f'location={path}'], input=b''.join(frames()), check=True, timeout=60)


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def objects(text):
    """{(frame, id)} of the printed lines."""
    return {tuple(map(int, found)) for found in re.findall(r'^frame (\d+)  \S+ (\d+) ', text, re.M)}


class Examples(unittest.TestCase):
    def test_both_readers_find_the_body(self):
        with tempfile.TemporaryDirectory() as folder:
            clip = str(pathlib.Path(folder, 'clip.avi'))
            write_clip(clip)
            in_cpp, in_python = run(*IN_CPP, clip), run(*IN_PYTHON, clip)
        self.assertEqual((in_cpp[0], in_python[0]), (0, 0), in_cpp[2] + in_python[2])
        found = objects(in_cpp[1])
        self.assertGreater(len({frame for frame, _ in found}), (FRAMES - ENTERS) // 2)
        self.assertTrue(objects(in_python[1]))
        self.assertLessEqual(objects(in_python[1]), found)

    def test_both_readers_say_what_failed(self):
        for reader in (IN_CPP, IN_PYTHON):
            status, _, errors = run(*reader, '/does/not/exist.avi')
            self.assertEqual(status, 1)
            self.assertIn('read_objects', errors)

    def test_both_readers_want_one_video(self):
        for reader in (IN_CPP, IN_PYTHON):
            status, _, errors = run(*reader)
            self.assertNotEqual(status, 0)
            self.assertIn('usage:', errors)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

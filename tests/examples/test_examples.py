#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The applications in examples/ find the object of a generated clip, and agree on it.

usage: test_examples.py READ_OBJECTS READ_OBJECTS.PY GRAPH.PY

GST_PLUGIN_PATH names the built plugin.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree

import numpy

IN_CPP, IN_PYTHON = [sys.argv[1]], [sys.executable, sys.argv[2]]
GRAPH = [sys.executable, sys.argv[3]]
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


def graph_line(number, broken):
    region = {'area': 50, 'centroid': {'x': 9.5, 'y': 4.0}, 'colour': '#102030', 'group': 0,
              'motion': {'x': 1.0, 'y': 0.0}, 'reliability': 0.5, 'expected': 0, 'object': 4}
    arc = {'a': 1, 'b': 2, 'motion': 3.5, 'border': 2.0, 'arc': 1.0, 'prediction': 0.0,
           'weight': -0.5, 'kept': not broken}
    return json.dumps({'frame': number, 'resolution': {'width': 20, 'height': 10},
                       'regions': [{**region, 'id': 1}, {**region, 'id': 2}], 'arcs': [arc]})


class Graph(unittest.TestCase):
    LINES = '\n'.join(graph_line(number, number == 2) for number in (1, 2, 3))

    def draw(self, *arguments, lines=LINES):
        return subprocess.run([*GRAPH, '-', *arguments], input=lines, capture_output=True,
                              text=True, timeout=60)

    def test_draws_the_frame_with_most_broken_arcs(self):
        picture = ElementTree.fromstring(self.draw().stdout)
        titles = [title.text for title in picture.iter('{http://www.w3.org/2000/svg}title')]
        self.assertEqual(len(titles), 3)
        self.assertIn('1–2 broken: weight -0.5', titles[0])
        self.assertEqual(len(list(picture.iter('{http://www.w3.org/2000/svg}circle'))), 2)

    def test_draws_the_frame_that_is_asked_for(self):
        self.assertIn('1–2 kept', self.draw('3').stdout)
        self.assertIn('1 -- 2 [style=solid', self.draw('1', '--dot').stdout)

    def test_says_what_is_wrong(self):
        self.assertIn('no such frame', self.draw('9').stderr)
        self.assertIn('format=graph', self.draw(lines='{"frame": 1}').stderr)


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

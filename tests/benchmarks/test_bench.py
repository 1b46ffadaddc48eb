#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""bench and bench-peers print what they promise, read .y4m files and refuse what they don't know.

usage: test_bench.py PROGRAM LAST_LINE...      LAST_LINE: names of the sums that PROGRAM ends with
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SUMS = sys.argv[1], sys.argv[2:]
QUICK = ('--frames', '2', '--threads', '1')
SYNTHETIC = ('--scene', 'synthetic')


def bench(*arguments, env=None):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120,
                          env=env)
    return done.returncode, done.stdout.splitlines(), done.stderr


def y4m(folder, header, frame):
    path = pathlib.Path(folder, 'clip.y4m')
    path.write_bytes(header.encode() + b'\n' + (b'FRAME\n' + frame) * 3)
    return str(path)


class Bench(unittest.TestCase):
    def sums(self, lines):
        found = dict(line.split('=') for line in lines if re.fullmatch(r'\w+_ms=\d+\.\d+', line))
        self.assertEqual(list(found), SUMS)
        return [float(value) for value in found.values()]

    def check_sums(self, lines):
        for value in self.sums(lines):
            self.assertGreater(value, 0)

    def test_times_the_synthetic_scene(self):
        status, lines, errors = bench('--size', '96x64', '--regions', '20', '--shift', '4', *QUICK,
                                      *SYNTHETIC)
        self.assertEqual((status, errors), (0, ''))
        self.assertTrue(lines[0].startswith('96x64, threads 1, frames 2'), lines[0])
        self.check_sums(lines)

    def test_sums_contain_every_row_of_the_table(self):
        _, lines, _ = bench('--size', '96x64', '--frames', '1', '--threads', '1', *SYNTHETIC)
        rows = [float(line.split()[-1]) for line in lines if re.match(r'^\S.*\s\d+\.\d{3}$', line)]
        self.assertAlmostEqual(sum(rows), self.sums(lines)[-1], delta=0.02)

    def test_says_where_it_looked_for_the_clip(self):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, 'XDG_CACHE_HOME': folder, 'REGIONGRAPH_CLIP': ''}
            status, _, errors = bench('--scene', 'clip', *QUICK, env=environment)
        if status != 0:  # Installed as Debian's package it is always found.
            self.assertIn('REGIONGRAPH_CLIP', errors)

    def test_measures_frames_made_to_be_expensive(self):
        for pattern in ('checkerboard', 'dots', 'spiral'):
            status, lines, errors = bench('--scene', pattern, '--size', '48x32', '--min-area', '1',
                                          *QUICK)
            self.assertEqual((status, errors), (0, ''))
            self.assertTrue(lines[0].endswith(pattern), lines[0])

    @unittest.skipUnless('total_ms' in SUMS, 'of bench only')
    def test_compares_expensive_frames_with_typical_ones(self):
        status, lines, errors = bench('--worst', '--size', '48x32', '--warm-up', '1', *QUICK,
                                      *SYNTHETIC)
        self.assertEqual((status, errors), (0, ''))
        self.assertTrue(lines[0].startswith('times typical'), lines[0])
        self.assertEqual([line.split()[0] for line in lines[1:]],
                         ['typical', 'flat', 'checkerboard', 'noise', 'comb', 'spiral', 'dots',
                          'pan', '60-objects'])

    @unittest.skipUnless('total_ms' in SUMS, 'of bench only')
    def test_compares_with_the_clip_and_the_scene_where_there_is_a_clip(self):
        if bench('--scene', 'clip', '--size', '48x32', *QUICK)[0] != 0:
            self.skipTest('no clip')
        _, lines, _ = bench('--worst', '--size', '48x32', '--warm-up', '1', *QUICK)
        self.assertEqual([line.startswith('typical CPU ms') for line in lines[1:4]],
                         [True, True, False])

    def test_measures_the_processor_on_the_foreground(self):
        status, lines, errors = bench('--size', '96x64', '--scope', 'foreground', '--cpu', *QUICK,
                                      *SYNTHETIC)
        self.assertEqual((status, errors), (0, ''))
        self.sums(lines)

    @unittest.skipUnless('total_ms' in SUMS, 'of bench only')
    def test_counts_the_frames_of_several_streams(self):
        status, lines, errors = bench('--streams', '3', '--size', '96x64', '--warm-up', '1',
                                      *QUICK, *SYNTHETIC)
        self.assertEqual((status, errors), (0, ''))
        self.assertTrue(lines[0].startswith('96x64, streams 3, frames 2 each'), lines[0])
        figures = dict(line.split('=') for line in lines[1:])
        self.assertEqual(list(figures), ['frames_per_s', 'streams_of_30'])
        self.assertAlmostEqual(float(figures['frames_per_s']) / 30,
                               float(figures['streams_of_30']), delta=.1)

    @unittest.skipUnless('total_ms' in SUMS, 'of bench only')
    def test_works_on_a_gpu_or_says_why_not(self):
        status, lines, errors = bench('--backend', 'cuda', '--size', '96x64', *QUICK, *SYNTHETIC)
        if status == 0:
            self.assertIn(', on ', lines[0])
        else:
            self.assertIn('CUDA', errors)

    @unittest.skipUnless('total_ms' in SUMS, 'of bench only')
    def test_times_the_papers_own_system(self):
        status, lines, errors = bench('--size', '96x64', '--regions', '20', '--shift', '4',
                                      '--literal', *QUICK, *SYNTHETIC)
        self.assertEqual((status, errors), (0, ''))
        self.assertIn('0.00 % of the cells took the shortcut', lines[2])
        self.check_sums(lines)

    def test_reads_a_file_from_its_start_again(self):
        with tempfile.TemporaryDirectory() as folder:
            clip = y4m(folder, 'YUV4MPEG2 W16 H8 F25:1 C420jpeg', bytes(range(192)))
            status, lines, errors = bench('--input', clip, *QUICK)
        self.assertEqual((status, errors), (0, ''))
        self.assertTrue(lines[0].startswith('16x8,'), lines[0])
        self.check_sums(lines)

    def test_refuses_files_that_it_can_not_read(self):
        with tempfile.TemporaryDirectory() as folder:
            for header, frame in (('JPEG', b''), ('YUV4MPEG2 W16 H8 C444', bytes(384)),
                                  ('YUV4MPEG2 W-16 H8', bytes(192)), ('YUV4MPEG2', b''),
                                  ('YUV4MPEG2 W16 H8', bytes(3))):
                status, _, errors = bench('--input', y4m(folder, header, frame), *QUICK)
                self.assertEqual(status, 1, header)
                self.assertNotEqual(errors, '')
        for missing in ('/does/not/exist.y4m', '/does/not/exist.avi'):
            self.assertEqual(bench('--input', missing)[0], 1)

    def test_refuses_unknown_options_and_values(self):
        for wrong in (['--speed', '9'], ['--frames'], ['--frames', '0'], ['--frames', '2x'],
                      ['--size', '640'], ['--size', '0x480'], ['--threads', '-1'], ['clip.y4m'],
                      ['--input', 'a.y4m', '--size', '8x8'], ['--scene', 'desert'],
                      ['--scope', 'moon'], ['--backend', 'abacus'], ['--streams', '0'],
                      ['--streams', '2', '--table'], ['--table', '--size', '8x8']):
            status, _, errors = bench(*wrong)
            self.assertEqual(status, 2, wrong)
            self.assertIn('usage:', errors)

    def test_explains_itself(self):
        status, lines, _ = bench('--help')
        self.assertEqual(status, 0)
        self.assertTrue(lines[0].startswith('usage: bench'))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

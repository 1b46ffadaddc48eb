#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""bench-areas finds the same in areas as in the frame, and prints both tables.

usage: test_bench_areas.py PROGRAM
"""
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv[1]


class BenchAreas(unittest.TestCase):
    def test_prints_both_tables_and_that_all_is_the_same(self):
        done = subprocess.run([PROGRAM, '--size', '320x240', '--frames', '4', '--threads', '2'],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        rows = re.findall(r'^ +(\d+) +[\d.]+ +[\d.]+ +[\d.]+ \|', done.stdout, re.M)
        self.assertEqual([int(things) for things in rows], [1, 3, 5, 7, 10, 13] * 2)
        self.assertIn('same foreground in 24 of 24 frames', done.stdout)
        self.assertRegex(done.stdout, r'\nmotion_ratio_of_1=\d+\.\d+\n')

    def test_refuses_unknown_options(self):
        done = subprocess.run([PROGRAM, '--speed', '9'], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

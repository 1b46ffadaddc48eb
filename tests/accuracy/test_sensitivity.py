#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""sensitivity moves the numbers that it says it moves, and only those."""
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import sensitivity

NAMES = list(sensitivity.names(sensitivity.HEADER.read_text(encoding='utf-8')))


def run(*args):
    return subprocess.run([TOOL, *args], capture_output=True, text=True)


class Sensitivity(unittest.TestCase):
    def test_the_names_are_those_of_all_numbers(self):
        beyond = run('pan', '1:1', '--numbers', f'0:{len(NAMES) + 1}')
        self.assertEqual(beyond.returncode, 2)
        self.assertIn('usage: sensitivity', beyond.stderr)
        self.assertEqual(len(NAMES), len(set(NAMES)))

    def test_a_number_that_matters_changes_what_is_tracked_and_others_do_not(self):
        # One that nobody reads behind a moving camera, and the heights that a thing has to go.
        last = NAMES.index('life.leave')
        first = NAMES.index('sizes.uniformWidthMost')
        done = run('pan', '1:1', '--numbers', f'{first}:{last + 1}', '--by', '90')
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {tuple(line.split()[:2]): line.split()[2:] for line in done.stdout.splitlines()}
        self.assertEqual(len(rows), 1 + 2 * (last + 1 - first))
        usual = rows['-', '0']
        self.assertGreater(float(usual[1]), 0.8)
        self.assertEqual(rows[str(first), '1'], usual)
        self.assertNotEqual(rows[str(last), '1'], usual)

    def test_wrong_arguments_are_told(self):
        for args in ([], ['still'], ['still', '2:1'], ['pan', '1:1', '--numbers', '3:3'],
                     ['pan', '1:1', '--by', '100'], ['a.avi', '0', '1', '.'], ['a.avi', '25']):
            with self.subTest(args=args):
                self.assertEqual(run(*args).returncode, 2)


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

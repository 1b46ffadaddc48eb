#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report on the paper's figures is complete without any data, and says so when it is not.

usage: test_reproduce.py REPRODUCE.SH BUILD
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPT, BUILD = sys.argv[1:3]
ITEMS = ('claims', 'fig-1', 'fig-2', 'table-1', 'roi-share', 'fig-3', 'fig-5', 'fig-8', 'fig-9',
         'fig-9-claim', 'table-2', 'fig-11', 'fig-12', 'fig-13', 'fig-14', 'sizes', 'fig-18',
         'fig-19', 'fig-20', 'fig-21')


def reproduce(folder, *arguments, build=BUILD):
    done = subprocess.run([SCRIPT, *arguments], cwd=folder, capture_output=True, text=True,
                          timeout=600, env={**os.environ, 'BUILD_DIR': str(build)})
    return done.returncode, done.stdout + done.stderr


def page_in(folder):
    return pathlib.Path(folder, 'paper-report', 'index.html').read_text(encoding='utf-8')


def cells_of(page, item):
    section = re.search(rf'<section id="{item}">(.*?)</section>', page, re.S)[1]
    return re.findall(r'<td[^>]*>([^<]*)</td>', section)


class Reproduce(unittest.TestCase):
    def test_the_report_is_complete_without_data(self):
        with tempfile.TemporaryDirectory() as folder:
            status, output = reproduce(folder, '--quick')
            self.assertEqual(status, 0, output[-3000:])
            page = page_in(folder)
            self.assertEqual(tuple(re.findall(r'<section id="([\w-]+)">', page)), ITEMS)
            self.assertNotIn('class="failed"', page)
            for name in ('MovedObject', 'TimeOfDay', 'LightSwitch', 'WavingTrees', 'Camouflage',
                         'Bootstrap', 'ForegroundAperture', 'pets09_s2l1'):
                self.assertIn(name, output)
            pictures = re.findall(r'<img src="([^"]+)"', page)
            self.assertGreater(len(pictures), 15)
            for name in pictures:
                head = pathlib.Path(folder, 'paper-report', name).read_bytes()[:200]
                self.assertTrue(head.startswith(b'\x89PNG') or b'<?xml' in head, name)
            # Numbers within a decade too: its curves may lie in one.
            phases = pathlib.Path(folder, 'paper-report', 'fig-20.svg').read_text(encoding='utf-8')
            self.assertIn('<!-- 0.5 -->', phases)
        self.assertIn('modelled, not measured', page)
        times = [float(cell) for cell in cells_of(page, 'fig-20')
                 if re.fullmatch(r'\d+\.\d+', cell)]
        self.assertGreater(len(times), 20)
        self.assertGreater(min(times), 0)
        self.assertIn('176093', page)

    def test_a_missing_item_makes_it_fail(self):
        with tempfile.TemporaryDirectory() as folder:
            status, output = reproduce(folder, '--quick', '--only', 'fig-18,fig-19')
            page = page_in(folder)
        self.assertNotEqual(status, 0)
        self.assertIn('the report lacks claims, fig-1,', output)
        self.assertNotIn('fig-18', output.splitlines()[-1])
        self.assertEqual(re.findall(r'<section id="([\w-]+)">', page), ['fig-18', 'fig-19'])

    def test_an_item_that_fails_is_missing_and_says_why(self):
        with tempfile.TemporaryDirectory() as folder:
            # As reproduce.sh does it, but with a build that has no programs.
            done = subprocess.run(
                [sys.executable, '-m', 'report', '--build', folder, '--quick', '--only', 'table-1'],
                cwd=folder, capture_output=True, text=True, timeout=60,
                env={**os.environ, 'PYTHONPATH': str(pathlib.Path(SCRIPT).parent)})
            page = page_in(folder)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('table-1', done.stderr.splitlines()[-1])
        self.assertIn('This item is missing: FileNotFoundError', page)

    def test_refuses_what_it_does_not_know(self):
        with tempfile.TemporaryDirectory() as folder:
            for wrong, words in ((['--fast'], 'unknown argument'), (['--data'], 'needs a value'),
                                 (['--data', '/does/not/exist'], 'no such folder'),
                                 (['--only', 'fig-99'], 'no such item: fig-99')):
                status, output = reproduce(folder, *wrong)
                self.assertNotEqual(status, 0)
                self.assertIn(words, output)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])

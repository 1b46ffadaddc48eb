#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""sensitivity moves the numbers that it says it moves, and only those."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import sensitivity

NAMES = list(sensitivity.names(sensitivity.HEADER.read_text(encoding='utf-8')))


def run(*args):
    return subprocess.run([TOOL, *args], capture_output=True, text=True)


WIDTH, HEIGHT, FRAMES = 160, 120, 80


def block_at(frame):
    """Left edge, upper edge, width and height of what moves, once the ground is known."""
    return 2 * frame - 60, 40, 20, 40


def paint(path, frame, colour=(220, 120, 40)):
    ground = [40 + (37 * (x // 8) + 91 * (y // 8)) % 60
              for y in range(HEIGHT) for x in range(WIDTH)]
    pixels = bytearray(value for grey in ground for value in (grey, grey, grey))
    left, top, width, height = block_at(frame)
    for y in range(top, top + height):
        for x in range(max(0, left), max(0, left + width)):
            at = 3 * (y * WIDTH + x)
            pixels[at:at + 3] = bytes(colour)
    path.write_bytes(b'P6\n%d %d\n255\n' % (WIDTH, HEIGHT) + pixels)


class Copies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.pictures = pathlib.Path(cls.folder.name) / 'pictures'
        cls.pictures.mkdir()
        for frame in range(1, FRAMES + 1):
            paint(cls.pictures / f'{frame:03d}.ppm', frame)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def lines(self, *args, pictures=None):
        with tempfile.TemporaryDirectory() as out:
            done = run(f'{pictures or self.pictures}/%03d.ppm', '25', str(FRAMES), out,
                       '--numbers', '0:1', *args)
            self.assertEqual(done.returncode, 0, done.stderr)
            return [[int(v) for v in line.split(',')[:6]]
                    for line in (pathlib.Path(out) / '-.0.txt').read_text().splitlines()]

    def test_each_copy_shows_what_the_video_shows_where_and_when_it_does(self):
        listed = dict(line.split() for line in run('copies').stdout.splitlines())
        self.assertEqual(next(iter(listed)), 'same')
        self.assertEqual(self.lines(), self.lines('--copy', 'same'))
        for copy, every in listed.items():
            with self.subTest(copy=copy):
                lines = self.lines('--copy', copy)
                self.assertEqual({line[0] % int(every) for line in lines}, {1 % int(every)})
                self.assertGreater(len(lines), 20 / int(every))
                frame, _, *box = lines[-1]
                for seen, true in zip(box, block_at(frame)):
                    self.assertAlmostEqual(seen, true, delta=6)

    def test_a_copy_is_another_one(self):
        with tempfile.TemporaryDirectory() as faint:
            for frame in range(1, FRAMES + 1):
                paint(pathlib.Path(faint) / f'{frame:03d}.ppm', frame, (88, 88, 80))
            usual = self.lines(pictures=faint)
            for copy in run('copies').stdout.split()[2::2]:
                with self.subTest(copy=copy):
                    self.assertNotEqual(self.lines('--copy', copy, pictures=faint), usual)

    def test_truth_is_that_of_the_frames_that_are_shown(self):
        truth = '1,7,0,0,1,1\n2,7,1,0,1,1\n3,7,2,0,1,1\n'
        self.assertEqual(sensitivity.thinned(truth, 1), truth)
        self.assertEqual(sensitivity.thinned(truth, 2), '1,7,0,0,1,1\n3,7,2,0,1,1\n')

    def test_a_change_is_judged_copy_by_copy(self):
        usual, changed = [(0.5, 0.7), (0.9, 0.3)], [(0.6, 0.7), (1.0, 0.5)]
        off = sensitivity.differences(changed, usual)
        for seen, true in zip(sensitivity.means(off) + sensitivity.spread(off),
                              (0.1, 0.1, 0, 0.1414)):
            self.assertAlmostEqual(seen, true, places=3)


class Sensitivity(unittest.TestCase):
    def test_the_names_are_those_of_all_numbers(self):
        beyond = run('pan', '1:1', '--numbers', f'0:{len(NAMES) + 1}')
        self.assertEqual(beyond.returncode, 2)
        self.assertIn('usage: sensitivity', beyond.stderr)
        self.assertEqual(len(NAMES), len(set(NAMES)))

    def test_a_number_that_matters_changes_what_is_tracked_and_others_do_not(self):
        # One that nobody reads behind a moving camera, and the heights that a thing has to go.
        last = NAMES.index('life.leave')
        first = NAMES.index('sizes.usual')
        done = run('pan', '1:1', '--numbers', f'{first}:{last + 1}', '--by', '90')
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {tuple(line.split()[:2]): line.split()[2:] for line in done.stdout.splitlines()}
        self.assertEqual(len(rows), 1 + 2 * (last + 1 - first))
        usual = rows['-', '0']
        self.assertGreater(float(usual[1]), 0.8)
        self.assertEqual(rows[str(first), '1'], usual)
        self.assertNotEqual(rows[str(last), '1'], usual)

    def test_terms_are_left_out_or_weighed(self):
        rows = {}
        for percent in '100', '0':
            done = run('pan', '1:1', '--terms', percent)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows[percent] = {line.split()[0]: line.split()[1:] for line in done.stdout.splitlines()}
            self.assertEqual(list(rows[percent]),
                             ['-', 'U1', 'U2', 'U3', 'prediction', 'appearance', 'all'])
        usual = rows['0']['-']
        self.assertGreater(float(usual[2]), 0.8)
        self.assertEqual(set(map(tuple, rows['100'].values())), {tuple(usual)})
        for term in 'U1', 'all':
            self.assertLess(float(rows['0'][term][2]), 0.5)

    def test_wrong_arguments_are_told(self):
        for args in ([], ['copies', 'of'], ['still', '1:1', '--copy', 'same'],
                     ['pan', '1:1', '--size', '9x9'], ['a.avi', '25', '1', '.', '--copy', 'none'],
                     ['a.avi', '25', '1', '.', '--fps', '5'], ['still'], ['still', '2:1'],
                     ['pan', '1:1', '--numbers', '3:3'], ['pan', '1:1', '--by', '100'],
                     ['pan', '1:1', '--terms', '-1'],
                     ['a.avi', '0', '1', '.'], ['a.avi', '25']):
            with self.subTest(args=args):
                self.assertEqual(run(*args).returncode, 2)


if __name__ == '__main__':
    TOOL = sys.argv.pop(1)
    unittest.main()

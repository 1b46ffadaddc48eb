#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the made-up scenes are still those on which figures were told, and whether their options
do what the usage says.

usage: test_scenes.py SCENES
"""
import re
import subprocess
import sys

# Frames and truth of the seeds 1 to 10 at 640x480, 25 frames a second and the default noise.
STILL = ('c5cc2dcb79b2389d', 'cf8ead12adbf6d52', 'abaeba7c61f09adc', 'c555d5622a0f5ba3',
         'b1d003b91dc7080e', '59b77a29dcba1234', '5f2ff9af8d5f3843', '9287192a29870b14',
         '3ee18e7ea400c79d', '936b47bcf847dbb9')
PAN = ('cd6b1413d2db6b7c', '536e33ed81598bcb', 'e217d0b47916e35a', 'ac5a06d94dc79c18',
       'da3ea5a770123fd8', '6feca16ce5fb0c3a', 'c2a3d0c93a22450c', '7559d58072e5e5b3',
       'dc0f473fd82c0983', '926dff97c0c3a6b4')
LINE = re.compile(r'seed 1: IDF1 ([\d.]+), found ([\d.]+), false ([\d.]+) per frame')


def run(*arguments):
    return subprocess.run(arguments, check=True, capture_output=True, text=True).stdout


def digests(scenes, *arguments):
    return tuple(line.split()[-1] for line in run(scenes, '--digest', *arguments).splitlines())


def main():
    scenes = sys.argv[1]
    assert digests(scenes, '--seeds', '1:10') == STILL
    assert digests(scenes, '--pan', '--seeds', '1:10') == PAN

    first = ['--seeds', '1:1']
    seen = {digests(scenes, *first, *other) for other in (
        [], ['--size', '320x240'], ['--fps', '12.5'], ['--noise', '8'], ['--every', '5'])}
    assert len(seen) == 5, 'an option changes nothing'

    harder = {digests(scenes, '--pan', *first, '--size', '160x120', *other) for other in (
        [], ['--zoom', '2'], ['--roll', '2'], ['--cover', '33'],
        ['--parallax', '30'])}
    assert len(harder) == 5, 'a hardship changes nothing'

    for kind in [], ['--pan'], ['--pan', '--zoom', '1', '--roll', '1', '--cover', '33']:
        told = run(scenes, *kind, *first, '--size', '160x120', '--fps', '12.5')
        figures = [float(figure) for figure in LINE.match(told).groups()]
        assert 0 <= figures[0] <= 1 and 0 <= figures[1] <= 1, told
        corners = re.search(r'^corners=([\d.]+)$', told, re.MULTILINE)
        assert bool(corners) == ('--pan' in kind), told
        assert not corners or 0 <= float(corners[1]) <= 1, told

    for wrong in (['--fps', '0'], ['--size', '8x8'], ['--noise', '-1'], ['--zoom', '1'],
                  ['--pan', '--roll', '-1'], ['--pan', '--cover', '90'], ['--unknown']):
        failed = subprocess.run([scenes, *wrong], capture_output=True, text=True)
        assert failed.returncode == 2 and failed.stderr.startswith('usage: '), wrong
    options = set(re.findall(r"--[a-z]+", failed.stderr))
    assert options == {'--pan', '--zoom', '--roll', '--cover', '--parallax', '--gate', '--seeds',
                       '--size', '--fps', '--noise', '--explain', '--digest', '--background',
                       '--pictures', '--every'}, options


if __name__ == '__main__':
    main()

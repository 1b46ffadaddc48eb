# SPDX-License-Identifier: LGPL-2.1-or-later
"""The programs and folders that the measurements use."""
import os
import pathlib
import platform
import re
import subprocess

TIMEOUT_S = 900
STAGES = ('hsvsegment', 'srg', 'prmmotion', 'mrfmerge')


class Workshop:
    """build: a build folder; data: of sequences, or None; output: where the report goes."""

    def __init__(self, build, data, output, is_quick):
        self.build, self.data, self.output, self.is_quick = build, data, output, is_quick
        self.kept = {}

    def choose(self, full, quick):
        return quick if self.is_quick else full

    def once(self, key, measure):
        """What several items need is measured once."""
        if key not in self.kept:
            self.kept[key] = measure()
        return self.kept[key]

    def run(self, program, *arguments):
        command = [str(self.build / program), *map(str, arguments)]
        clip = self.data and self.data / 'pets09_s2l1' / 'vtest.avi'  # For bench's frames.
        known = {'REGIONGRAPH_CLIP': str(clip)} if clip and clip.is_file() else {}
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S,
                              env={**os.environ, **known})
        if done.returncode:
            raise RuntimeError(f'{" ".join(command)} failed: {(done.stdout + done.stderr)[-2000:]}')
        return done.stdout

    def bench(self, size, regions, shift, is_literal=False):
        """Of each stage and of the four together the median ms that a frame of that size takes
        one core, whatever else runs on the machine."""
        frames, warm_up = self.choose((30, 30), (3, 3))
        if is_literal:  # It takes a hundred times as long.
            frames, warm_up = self.choose((8, 55), (2, 3))
        text = self.run('tests/benchmarks/bench', '--size', f'{size[0]}x{size[1]}', '--regions',
                        regions, '--shift', shift, '--frames', frames, '--warm-up', warm_up,
                        '--threads', 1, '--cpu',
                        *(['--literal'] if is_literal else []))
        ms = {stage: float(re.search(rf'^{stage} .* ([\d.]+)$', text, re.M)[1])
              for stage in STAGES}
        ms['total'] = float(re.search(r'^total_ms=([\d.]+)$', text, re.M)[1])
        ms['regions'] = int(re.search(r' to (\d+) regions in a frame', text)[1])
        ms['scene'] = text.splitlines()[0].split(', ', 3)[-1]
        return ms

    def model(self, size, regions=160, shift=20):
        """What an H200 is modelled to take, in ms: of work and of launches, by stage."""
        text = self.run('tests/kernels/kernel-model', *size, regions, shift)
        found = re.findall(r'^stage (\w+): ([\d.]+) us of work on an H200, .* graphs do .*: '
                           r'(\d+) us instead of \d+$', text, re.M)
        return {stage: (float(work) / 1000, float(launches) / 1000)
                for stage, work, launches in found}


def machine():
    """What the report says of the machine that it was made on."""
    def first(path, pattern):
        try:
            found = re.search(pattern, pathlib.Path(path).read_text(encoding='utf-8'), re.M)
        except OSError:
            return None
        return found and found[1].strip()
    compiler = subprocess.run(['c++', '--version'], capture_output=True, text=True, check=False)
    return [('processor', first('/proc/cpuinfo', r'^model name\s*: (.*)$') or platform.machine()),
            ('cores', str(len(os.sched_getaffinity(0)))),
            ('memory', f"{int(first('/proc/meminfo', r'^MemTotal: *([0-9]+)') or 0) >> 20} GiB"),
            ('system', first('/etc/os-release', r'^PRETTY_NAME="(.*)"$') or platform.system()),
            ('compiler', (compiler.stdout.splitlines() or ['unknown'])[0]),
            ('others on the machine', f'{os.getloadavg()[0]:.1f} threads busy when this began'),
            ('GPU', 'none measured')]

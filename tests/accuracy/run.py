#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the elements on data with ground truth, has a referee score them and prints a table.

usage: run.py DATA SCORE.PY [--gate] [--method paper | --literal] [--build FOLDER] [--jobs N]
              [SET...]

DATA     folder of the sets; a SET is named by its path below it (default: all that have a truth)
SCORE.PY the referee: "score.py masks SET DIR", "tracks SET FILE", "flow SET FILE LABELS" print a
         dict of figures, and its source(SET) names a GStreamer source of the frames in order
--gate   only the sets that GATES names; exits 1 when a figure misses its gate
--method of bgremove (default: the element's own)
--literal  every stage as the paper says; of masks those of the objects count
"""
import argparse
import ast
import concurrent.futures
import fnmatch
import importlib.util
import operator
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT_S = 900
AT_LEAST, AT_MOST = operator.ge, operator.le
GATES = {  # Set: figures that must be reached with default properties.
    'pets09_s2l1': [('MOTA', AT_LEAST, 0.78), ('IDF1', AT_LEAST, 0.72), ('HOTA', AT_LEAST, 0.56),
                    ('MOTA_mot15', AT_LEAST, 0.68)],
    'cdnet_highway': [('F', AT_LEAST, 0.95)],
    'cdnet_office': [('F', AT_LEAST, 0.93)],
    'sbi_IBMtest2': [('F', AT_LEAST, 0.93)],
    'sbi_CAVIAR2': [('F', AT_LEAST, 0.80)],
    'wallflower/WavingTrees': [('TE8', AT_MOST, 200)],
    'wallflower*/ForegroundAperture': [('TE8', AT_MOST, 1000)],
    'wallflower*/MovedObject': [('TE8', AT_MOST, 2)],
    'wallflower/TimeOfDay': [('TE8', AT_MOST, 450)],
    'middlebury_flow/*': [('EPE_reliable_half', AT_MOST, 0.6), ('regions', AT_LEAST, 60),
                          ('covered', AT_LEAST, 0.95)],
}
OBJECT_GATES = {  # The same of source=objects; "saved" = errors of bgremove's mask that it hasn't.
    'cdnet_highway': [('F', AT_LEAST, 0.90)],
    'cdnet_office': [('F', AT_LEAST, 0.93)],
    'wallflower/WavingTrees': [('TE8_saved', AT_LEAST, 0)],
    'wallflower/ForegroundAperture': [('TE8_saved', AT_LEAST, 0)],
}
DECODE_GATES = {  # Of means over decodes(): where boxes are as near to the referee's limit of one
                  # half as here, a single decode may say anything.
    'tud_campus': [('MOTA', AT_LEAST, 0.13), ('IDF1', AT_LEAST, 0.38)],
}
MOVING_GATES = {  # Of the objects of regiontrack, whose camera moves.
    'davis_car-roundabout': [('J', AT_LEAST, 0.70)],
    'davis_dance-twirl': [('J', AT_LEAST, 0.44)],
    'davis_drift-straight': [('J', AT_LEAST, 0.43)],
    'davis_scooter-black': [('J', AT_LEAST, 0.53)],
    'davis_soapbox': [('J', AT_LEAST, 0.54)],
    'ucsd/cyclists': [('F', AT_LEAST, 0.50)],
}
PAPER_GATES = {  # Of method=paper: what regions save of the errors of a mask.
    'wallflower/WavingTrees': [('TE_left', AT_MOST, 0.75)],
    'wallflower/ForegroundAperture': [('TE_left', AT_MOST, 0.75)],
}
LATER_STAGES = 'hsvsegment ! srg ! prmmotion ! mrfmerge'
LITERAL_STAGES = ('hsvsegment colour-space=hsv analysis-height=0 ! srg ! '
                  'prmmotion method=literal ! mrfmerge method=literal')
SHOWN = {'masks': ('F', 'precision', 'recall', 'TE', 'TE8'),
         'objects': ('F', 'precision', 'recall', 'TE', 'TE_saved', 'TE_left', 'TE8', 'TE8_saved'),
         'moving': ('J', 'F', 'precision', 'recall'),
         'tracks': ('MOTA', 'IDF1', 'HOTA', 'MOTA_mot15', 'IDF1_mot15', 'FP', 'FN', 'IDSW'),
         'decodes': ('MOTA', 'IDF1', 'HOTA', 'deviation'),
         'flow': ('EPE', 'EPE_reliable_half', 'EPE_pixels', 'regions', 'covered')}


class Runner:
    def __init__(self, options):
        self.data = options.data.resolve()
        self.referee = options.score.resolve()
        self.build = options.build.resolve()
        self.is_literal = options.literal
        method = 'paper' if options.literal else options.method
        self.method = f'method={method}' if method else ''
        self.stages = LITERAL_STAGES if options.literal else LATER_STAGES
        spec = importlib.util.spec_from_file_location('referee', self.referee)
        self.module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.module)

    def sets(self):
        """Name and kind of each set that has a truth."""
        for folder in self.module.all_sets(str(self.data)):
            path = pathlib.Path(folder)
            kind = ('tracks' if (path / 'gt.txt').exists() else
                    'flow' if (path / 'flow10.flo').exists() else
                    'masks' if self.module.truth(folder) else None)
            if kind:
                name = path.relative_to(self.data).as_posix()
                yield name, kind
                if name in OBJECT_GATES and not self.is_literal:
                    yield name, 'objects'
                if name in DECODE_GATES and not self.is_literal:
                    yield name, 'decodes'
                if name in MOVING_GATES and not self.is_literal:
                    yield name, 'moving'

    def launch(self, line):
        command = ['meson', 'devenv', '-C', str(self.build), 'gst-launch-1.0', '-q', *line.split()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
        if done.returncode:
            raise RuntimeError(f'{line}\n{done.stdout}{done.stderr}')

    def score(self, kind, name, *files):
        command = [sys.executable, str(self.referee), kind, str(self.data / name), *files]
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
        if done.returncode:
            raise RuntimeError(f'{name}: {done.stdout}{done.stderr}')
        return ast.literal_eval(done.stdout.strip().splitlines()[-1])

    def masks(self, name, folder):
        shown = (f'{self.stages} ! regionmask source=objects' if self.is_literal else
                 'regionmask source=foreground')
        self.launch(f'{self.module.source(str(self.data / name))} ! videoconvert ! '
                    f'bgremove {self.method} ! {shown} ! '
                    f'pngenc compression-level=1 ! multifilesink location={folder}/%06d.png')
        return self.score('masks', name, folder)

    def objects(self, name, folder):
        """The objects' masks, compared with the foreground that they were made from."""
        ours, before = pathlib.Path(folder, 'objects'), pathlib.Path(folder, 'foreground')
        ours.mkdir()
        before.mkdir()
        to_files = 'pngenc compression-level=1 ! multifilesink location={}/%06d.png'
        self.launch(f'{self.module.source(str(self.data / name))} ! videoconvert ! '
                    f'bgremove {self.method} ! tee name=fork ! queue ! '
                    f'regionmask source=foreground ! {to_files.format(before)} '
                    f'fork. ! queue ! {self.stages} ! '
                    f'regionmask source=objects ! {to_files.format(ours)}')
        figures, mask = (self.score('masks', name, str(place)) for place in (ours, before))
        for key in ('TE', 'TE8'):
            if key in figures:
                figures[f'{key}_saved'] = mask[key] - figures[key]
        if mask.get('TE'):
            figures['TE_left'] = round(figures['TE'] / mask['TE'], 3)
        return figures

    def moving(self, name, folder):
        self.launch(f'{self.module.source(str(self.data / name))} ! videoconvert ! '
                    f'regiontrack {self.method} ! regionmask source=objects ! '
                    f'pngenc compression-level=1 ! multifilesink location={folder}/%06d.png')
        return self.score('masks', name, folder)

    def tracks(self, name, folder, change='identity'):
        self.launch(f'{self.module.source(str(self.data / name))} ! videoconvert ! {change} ! '
                    f'bgremove {self.method} ! {self.stages} ! '
                    f'regionwrite format=mot location={folder}/tracks.txt ! fakesink sync=false')
        return self.score('tracks', name, f'{folder}/tracks.txt')

    def decodes(self, name, folder):
        """Means over the video with other contrasts and brightnesses, each by a few grey levels."""
        figures = [self.tracks(name, folder, f'videobalance contrast={contrast} brightness={light}')
                   for contrast in (0.96, 0.98, 1.02, 1.04) for light in (-0.02, 0, 0.02)]
        means = {key: round(statistics.mean(one[key] for one in figures), 4)
                 for key in ('MOTA', 'IDF1', 'HOTA')}
        return {**means, 'deviation': round(statistics.stdev(one['MOTA'] for one in figures), 4)}

    def flow(self, name, folder):
        """Frame 11 first: the truth leads from 10 to 11, the elements look back in time."""
        for index, number in enumerate((11, 10)):
            link = pathlib.Path(folder, f'in{index}.png')
            link.symlink_to(self.data / name / f'frame{number}.png')
        self.launch(f'multifilesrc location={folder}/in%d.png caps=image/png,framerate=25/1 ! '
                    f'pngdec ! videoconvert ! {self.stages} ! '
                    f'regionwrite format=regions location={folder}/regions.csv ! '
                    'regionmask source=labels ! video/x-raw,format=GRAY16_BE ! '
                    f'pngenc ! multifilesink location={folder}/labels%d.png')
        return self.score('flow', name, f'{folder}/regions.csv', f'{folder}/labels1.png')

    def run(self, name, kind):
        with tempfile.TemporaryDirectory() as folder:
            return getattr(self, kind)(name, folder)


def way_of(options):
    return 'literal' if options.literal else options.method


def gates_of(name, kind, method):
    if method == 'literal':
        return []
    if method == 'paper':
        table = PAPER_GATES if kind == 'objects' else {}
    else:
        table = {'objects': OBJECT_GATES, 'moving': MOVING_GATES,
                 'decodes': DECODE_GATES}.get(kind, GATES)
    return [gate for pattern, gates in table.items() if fnmatch.fnmatch(name, pattern)
            for gate in gates]


def row(name, kind, method, figures):
    shown = ', '.join(f'{key} {figures[key]}' for key in SHOWN[kind] if key in figures)
    gates = gates_of(name, kind, method)
    missed = [f'{key} {"≥" if compare is AT_LEAST else "≤"} {limit}'
              for key, compare, limit in gates if not compare(figures[key], limit)]
    verdict = f'missed: {", ".join(missed)}' if missed else 'reached' if gates else ''
    title = name + f' ({kind})' * (kind in ('objects', 'moving', 'decodes'))
    return f'| {title} | {shown} | {verdict} |', bool(missed)


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('score', type=pathlib.Path)
    parser.add_argument('sets', nargs='*')
    parser.add_argument('--gate', action='store_true')
    way = parser.add_mutually_exclusive_group()
    way.add_argument('--method')
    way.add_argument('--literal', action='store_true')
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build')
    parser.add_argument('--jobs', type=int, default=2)
    return parser.parse_args()


def main():
    options = parse()
    runner = Runner(options)
    chosen = [(name, kind) for name, kind in runner.sets()
              if (not options.gate or gates_of(name, kind, way_of(options)))
              and (not options.sets or name in options.sets)]
    if not chosen:
        sys.exit('run.py: none of these sets is there')
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = [pool.submit(runner.run, name, kind) for name, kind in chosen]
        rows = [row(*task, way_of(options), future.result())
                for task, future in zip(chosen, futures)]
    print('\n'.join(['| set | figures | gate |', '|---|---|---|'] + [text for text, _ in rows]))
    sys.exit(1 if options.gate and any(missed for _, missed in rows) else 0)


if __name__ == '__main__':
    main()

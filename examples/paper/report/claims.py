# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's claims in one table, with what this run measured."""
from . import areas, phases, published, windows
from .section import Section


def formulas():
    """What is wrong in the equations, with the reading that works."""
    return [
        ['(1) W, H ≥ V / DT', 'the units don\'t match: a speed by a time',
         'W, H ≥ 2 V DT + the thing\'s size'],
        ['(2)', f'a pole at id {windows.pole():.0f}; true for one set of windows at most',
         'a table of first ids, exact'],
        ['(4), (5) W_PR = I − W Scale / Step', 'brackets, rounding and "+ 1" are missing; rows '
         'take the width', '⌊(I − W Scale) / Step⌋ + 1, rows with the height'],
        ['(6) WID = W_range + WID', 'contradicts (9)', 'WID − W_range'],
        ['(7) y = d / |d|', '0 / 0 at the start of a range', 'y = sign(d)'],
        ['(8) z = ⌊(y + 1) / 2⌋, 1 for y ≥ 0', 'is 0 for y = 0', 'z = 1 where WID ≥ the start'],
        ['(9) WID z', 'has no upper bound: no test of a range', 'z (1 − z of the next range)'],
        ['(10) X', 'mod and min are lost in print', 'min((WID mod W_PR) Step, i_width)'],
        ['(12) Y = ⌊WID / W_PR Step⌋', 'rows drift: the inner floor is missing',
         '⌊WID / W_PR⌋ Step'],
    ]


def measured(shop):
    cpu, gpu = published.CPU_MS, published.GPU_MS
    ours = phases.bench(shop, (640, 480), 160, 20)['total']
    literal = phases.literal_at_160(shop)['total']
    rows = areas.measure(shop)['640x480']
    motion, colour = (areas.reduction(*areas.columns(rows[kind])[1:])
                      for kind in ('motion', 'colour'))
    paper, extra = published.TABLE_1, published.TABLE_1_OVERHEAD_MS
    raw = areas.reduction(paper['areas'], paper['frame'])
    both = areas.reduction([v + extra for v in paper['areas']],
                           [v + extra for v in paper['frame']])
    first = 100 * (1 - sum(published.TABLE_2['areas']) / sum(published.TABLE_2['frame']))
    return [
        ['GPU enhancement "of an order of 64 %", "64 times"',
         f'{cpu} / {gpu} ms = {cpu / gpu:.1f} times; 64 % is wrong',
         f'{ours:.2f} ms of one core ({cpu / ours:.0f} times); literally {literal:.0f} ms'],
        ['Table 1: about 60 % less',
         f'{raw:.1f} % as printed, {both:.1f} % with 150 ms on both rows',
         f'{motion:.0f} % less'],
        ['Table 2: enhancement of 54 %', f'{first:.1f} % less: areas take 52 % of the time',
         f'{colour:.0f} % less'],
        ['62 frames a second at 640x480', '86 (10 regions) to 44 (160 regions) on its GPU',
         f'{1000 / ours:.0f} with 160 regions on one core'],
        ['Frames of 460x480 (abstract)', '640x480 in section 3.3 and its figures', 'at 640x480'],
        ['The GPU "enhanced the accuracy"', 'the same algorithm can not',
         'kernels give the CPU\'s bits, as tests show'],
    ]


def table_of_claims(shop):
    made = Section()
    rate = 1000 / phases.bench(shop, (640, 480), 160, 20)['total']
    made.finding = (f'{rate:.0f} frames a second of 640x480 with 160 regions on one core, where '
                    f'the paper needs {published.NEEDED_FPS[0]} to {published.NEEDED_FPS[1]} and '
                    f'made {published.GPU_FPS[160]} on its GPU. Several of its own figures and '
                    'equations contradict each other.')
    made.table(['the paper says', 'what its own figures give', 'measured here'], measured(shop))
    made.table(['equation', 'what is wrong', 'what works'], formulas(),
               'Equations (1) to (12): what they must be')
    return made

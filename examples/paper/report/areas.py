# SPDX-License-Identifier: LGPL-2.1-or-later
"""Areas round the things against the whole frame: tables 1 and 2, figures 2 and 8, equation (1)."""
import re

import numpy as np

from . import plots, published
from .section import Section

ROW = re.compile(r'^ +(\d+) +([\d.]+) +([\d.]+) +([\d.]+) \|', re.M)


def measure(shop):
    """{'motion' or 'colour': [(things, ms in areas, ms of the frame)]} at 640x480 and at 400x400,
    and what bench-areas says of both sides' results."""
    def at(size):
        text = shop.run('tests/benchmarks/bench-areas', '--size', size, '--threads', 1, '--frames',
                        shop.choose(40, 3))
        rows = [(int(n), float(a), float(f)) for n, a, f, _ in ROW.findall(text)]
        half = len(published.OBJECTS)
        return {'motion': rows[:half], 'colour': rows[half:],
                'same': re.search(r'same foreground in .*', text)[0]}
    return shop.once('areas', lambda: {size: at(size) for size in ('640x480', '400x400')})


def columns(rows):
    return [list(column) for column in zip(*rows)]


def table(shop, kind, paper, overhead):
    """Our rows beside the paper's, with the ratios."""
    rows = measure(shop)['640x480'][kind]
    header = ['things', 'areas [ms]', 'frame [ms]', 'ratio', 'paper: areas', 'paper: frame',
              'paper: ratio']
    if overhead:
        header.append(f'paper: ratio with {overhead} ms on both')
    body = []
    for (things, areas, frame), theirs, whole in zip(rows, paper['areas'], paper['frame']):
        cells = [things, f'{areas:.3f}', f'{frame:.3f}', f'{areas / frame:.2f}', theirs, whole,
                 f'{theirs / whole:.2f}']
        if overhead:
            cells.append(f'{(theirs + overhead) / (whole + overhead):.2f}')
        body.append(cells)
    return header, body


def reduction(areas, frame):
    """Percent by which the mean falls."""
    return 100 * (1 - sum(areas) / sum(frame))


def table_1(shop):
    made = Section()
    header, body = table(shop, 'motion', published.TABLE_1, published.TABLE_1_OVERHEAD_MS)
    _, areas, frame = columns(measure(shop)['640x480']['motion'])
    paper, extra = published.TABLE_1, published.TABLE_1_OVERHEAD_MS
    raw = reduction(paper['areas'], paper['frame'])
    both = reduction([v + extra for v in paper['areas']], [v + extra for v in paper['frame']])
    made.finding = (f'Searching areas takes {reduction(areas, frame):.0f} % less time than the '
                    f'whole frame here. The paper says about 60 %.')
    made.table(header, body, 'bgremove method=frame-difference, search=areas against search=frame, '
                             '640x480, one thread, least times of the frames')
    made.text(f'The paper\'s own table gives {raw:.1f} %. Only with its overhead of {extra} ms on '
              f'both rows does it come to {both:.1f} %: it belongs to both sides. '
              f'{measure(shop)["640x480"]["same"].capitalize()}: what areas find is bit for bit '
              'what the frame finds.')
    return made


def figure_2(shop):
    made = Section()
    rows = measure(shop)['640x480']['motion']
    things, areas, frame = columns(rows)
    slope = np.polyfit(things, areas, 1)[0]
    made.finding = (f'{areas[0]:.2f} ms for one thing, {areas[-1]:.2f} ms for 13; the whole frame '
                    f'takes {min(frame):.2f} to {max(frame):.2f} ms.')
    made.picture(plots.lines(shop.output, 'fig-2', things,
                             {'areas': areas, 'whole frame': frame}, ('things', 'ms a frame')),
                 'Time of motion detection by number of things, measured here')
    paper = published.TABLE_1
    made.picture(plots.lines(shop.output, 'fig-2-ratio', things,
                             {'areas / frame': [a / f for a, f in zip(areas, frame)],
                              'paper': [a / f for a, f in zip(paper['areas'], paper['frame'])]},
                             ('things', 'share of the whole frame\'s time')),
                 'The same as a share of the time of the whole frame, with the paper\'s (table 1)')
    made.text(f'Each thing adds {1000 * slope:.1f} µs; the paper\'s added 2.4 ms.')
    return made


def roi_share(shop):
    """The claim of 19 to 59 % in section 2.1."""
    made = Section()
    found = measure(shop)
    rows = [(size, things, 100 * areas / frame) for size in found
            for things, areas, frame in found[size]['motion']]
    few = [share for _, things, share in rows if things <= 7]
    low, high = published.ROI_SHARE_PERCENT
    made.finding = (f'With up to 7 things areas take {min(few):.0f} to {max(few):.0f} % of the '
                    f'whole frame\'s time here; the paper says {low} to {high} %.')
    made.table(['frame', *published.OBJECTS],
               [[size, *(f'{share:.0f} %' for s, _, share in rows if s == size)] for size in found],
               'Share of the whole frame\'s time by number of things (40x40 pixels each)')
    made.text('The paper\'s range does not follow from its table 1 (9 to 17 % as printed, 39 to 42 '
              '% with the overhead on both rows). The share depends on how much of the frame the '
              'areas cover: it grows with the number of things and as the frame gets smaller. '
              'Equation (1), W, H ≥ V / DT, has pixels per second divided by seconds. An area must '
              'hold the thing after its largest move: W, H ≥ 2 V DT + the thing\'s own size.')
    return made


def table_2(shop):
    made = Section()
    header, body = table(shop, 'colour', published.TABLE_2, 0)
    _, areas, frame = columns(measure(shop)['640x480']['colour'])
    paper = published.TABLE_2
    share = 100 * sum(paper['areas']) / sum(paper['frame'])
    made.finding = (f'Dividing areas into regions takes {reduction(areas, frame):.0f} % less time '
                    f'than dividing the frame here, {100 - share:.0f} % less in the paper.')
    made.table(header, body, 'hsvsegment scope=areas against scope=frame, 640x480, one '
                             'thread')
    made.text(f'The paper calls this an enhancement of 54 %; its table says that areas take '
              f'{share:.0f} % of the time, 49 % with one object and 56 % with thirteen.')
    return made


def figure_8(shop):
    made = Section()
    things, areas, frame = columns(measure(shop)['400x400']['colour'])
    slope, start = np.polyfit(things, areas, 1)
    whole = float(np.median(frame))
    count = max(0, int((whole - start) / slope)) if slope > 0 else 0
    times = np.linspace(0, whole, 8)
    objects = [max(0.0, (t - start) / slope) for t in times]
    made.finding = (f'In the {whole:.2f} ms that a whole 400x400 frame takes, areas round {count} '
                    f'things can be converted and divided here; the paper says theoretically more '
                    f'than {published.ROIS_IN_A_FRAME}.')
    made.picture(plots.lines(shop.output, 'fig-8', [float(t) for t in times],
                             {'things': objects,
                              'paper\'s claim: 50': [published.ROIS_IN_A_FRAME] * len(times)},
                             ('ms', 'things whose areas are done')),
                 'Things of 40x40 pixels by the time there is, up to that of the whole frame')
    made.picture(plots.lines(shop.output, 'fig-8-times', things,
                             {'areas': areas, 'whole frame': frame}, ('things', 'ms a frame')),
                 'What it is drawn from: times at 400x400 by number of things')
    made.text(f'A line through the measured times: {start:.3f} ms and {slope:.4f} ms for each '
              'thing. Areas that overlap are divided once.')
    return made

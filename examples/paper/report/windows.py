# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search windows of section 3: figure 18 (how many there are) and figure 19 (equation (2)).

Windows are listed one by one here, scale by scale, row by row. As equations (3) to (5) have it, a
row has ⌊(width − window scale) / step⌋ of them, in fractions of a pixel, brackets put where they
must be.

Where core/detection is built, its windows are shown too, and its equation (2) has to agree.
"""
import dataclasses
import json
import math

import numpy as np
from scipy.optimize import curve_fit

from . import plots, published
from .section import Section

PRINTED = (1.08, -9.24e-6, 1.79e-11, -1.05e-5, 2.74e-11)
PRINTED_R2 = 0.996
PRINTED_COUNT = 176000
SAMPLED = 293  # Every so many windows: as many points as a fit by hand would take, some 600.
SIDES = (100, 150, 200, 300, 400, 600, 800, 1000)


@dataclasses.dataclass(frozen=True)
class Windows:
    """side: of the trained window, px. step: as a share of the scaled window, or in px."""
    size: tuple
    side: float = 25
    share: float = 1 / 8
    step_px: float = 0
    factor: float = 1.05
    first: float = 1.05

    def scales(self):
        """[(scale, windows in a row, rows)] of those that have windows."""
        found, scale = [], self.first
        while self.side * scale <= min(self.size):
            window = self.side * scale
            step = self.step_px or window * self.share
            columns, rows = (math.floor((length - window) / step) for length in self.size)
            if columns > 0 and rows > 0:
                found.append((scale, columns, rows))
            scale *= self.factor
        return found

    def count(self):
        return sum(columns * rows for _, columns, rows in self.scales())


# Among the sets of windows that equation (2) fits best as it is printed (its own is not told).
BEST_FIT = Windows((460, 480))


def scale_by_id(windows):
    """The scale of every window, by its id."""
    return np.concatenate([np.full(columns * rows, scale)
                           for scale, columns, rows in windows.scales()])


def ratio(ids, n0, n1, n2, d1, d2):
    return (n0 + (n1 + n2 * ids) * ids) / (1 + (d1 + d2 * ids) * ids)


def r_squared(values, model):
    return 1 - ((values - model) ** 2).sum() / ((values - values.mean()) ** 2).sum()


def refit(ids, values):
    """Least squares, ids as shares of their largest: well scaled. From the printed coefficients, as
    if that were the largest id before their pole."""
    top = ids[-1]
    start = [PRINTED[i] * PRINTED_COUNT ** power for i, power in enumerate((0, 1, 2, 1, 2))]
    fitted, _ = curve_fit(ratio, ids / top, values, start, maxfev=20000)
    return fitted / [1, top, top ** 2, top, top ** 2]


def pole():
    """The least id at which the printed denominator is 0."""
    return min(np.roots([PRINTED[4], PRINTED[3], 1]).real)


def detector(shop):
    """What tests/benchmarks/search_windows.cpp prints; nothing where it is not built."""
    program = 'tests/benchmarks/search-windows'
    if not (shop.build / program).exists():
        return []
    return [json.loads(line) for line in shop.once('windows', lambda: shop.run(program))
            .splitlines()]


def compare_models(shop, count, r2):
    """The two ways to the same figures: one by one here, by tables there."""
    for told in detector(shop):
        if told.get('equation') == 2 and (told['windows'] != count
                                          or abs(told['r2_printed_all'] - r2) > 1e-3):
            raise RuntimeError(f'core/detection says otherwise: {told}')


def exponent(sides, counts):
    """Of the power of the side that the number of windows grows with."""
    return np.polyfit(np.log(sides), np.log(counts), 1)[0]


def every_scale(side):
    """Windows of every whole size, one by one pixel apart: what does grow fast."""
    return sum((side - w + 1) ** 2 for w in range(25, side + 1))


def figure_18(shop):
    made = Section()
    sides = shop.choose(SIDES, SIDES[:4])
    rules = {'step 1/8 of the window, factor 1.05': [Windows((s, s)).count() for s in sides],
             'step 2 px at all scales': [Windows((s, s), step_px=2).count() for s in sides]}
    scaled, fixed = rules.values()
    powers = [exponent(sides[-3:], counts[-3:]) for counts in (scaled, fixed)]
    every = exponent(sides[-3:], [every_scale(s) for s in sides[-3:]])
    made.finding = (f'The number grows with the {powers[0]:.1f}th power of the side where steps '
                    f'scale with the window, with the {powers[1]:.1f}th where they don\'t. The '
                    f'paper says with the third: so it does ({every:.1f}) only if every whole size '
                    'of window at every pixel is searched.')
    made.picture(plots.lines(shop.output, 'fig-18', sides, rules,
                             ('side of a square image [px]', 'search windows'), is_log=True),
                 'Search windows of 25 px and up by image size, logarithmic')
    body = []
    for size in published.SIZES:
        windows = Windows(size)
        body.append([f'{size[0]}x{size[1]}', windows.count(), len(windows.scales()),
                     Windows(size, step_px=2).count()])
    made.table(['image', 'windows', 'scales', 'with steps of 2 px'], body,
               'The paper\'s seven sizes: window 25 px, factor 1.05, step 1/8 of the scaled window')
    counted = [[f'{told["width"]}x{told["height"]}', told['factor'], told['scales'],
                told['windows']] for told in detector(shop) if told.get('figure') == 18]
    if counted:
        made.table(['image', 'factor', 'scales', 'windows'], counted,
                   'What haardetect searches in a whole frame, window 24 px')
    return made


def figure_19(shop):
    made = Section()
    values = scale_by_id(BEST_FIT)
    ids = np.arange(len(values), dtype=float)
    fitted = refit(ids, values)
    printed = ratio(ids, *PRINTED)
    compare_models(shop, len(values), r_squared(values, printed))
    some, some_fitted = (r_squared(values[::SAMPLED], ratio(ids[::SAMPLED], *model))
                         for model in (PRINTED, refit(ids[::SAMPLED], values[::SAMPLED])))
    r2, r2_fitted = r_squared(values, printed), r_squared(values, ratio(ids, *fitted))
    made.finding = (f'For 460x480, {len(values)} windows of {len(BEST_FIT.scales())} scales, '
                    f'equation (2) as printed has R² = {some:.4f} at every {SAMPLED}rd window and '
                    f'{r2:.4f} over all; refitted {some_fitted:.4f} and {r2_fitted:.4f}. The paper '
                    f'reports {PRINTED_R2}.')
    step = shop.choose(200, 2000)
    shown = np.arange(0, 215000, step, dtype=float)
    exact = np.array([values[int(i)] if i < len(values) else np.nan for i in shown])
    models = {'equation (2) as printed': ratio(shown, *PRINTED),
              'refitted': np.where(shown < len(values), ratio(shown, *fitted), np.nan)}
    made.picture(plots.scales(shop.output, 'fig-19', shown, exact, models,
                              (values[-1] * 1.15, 0.6)),
                 'Scale by window id: 460x480, window 25 px, step 1/8 of the scaled window, '
                 f'factor 1.05. There are no windows from {len(values)} on; the printed formula '
                 f'has its pole at {pole():.0f}')
    names = ('n0', 'n1', 'n2', 'd1', 'd2')
    made.table(['', *names, f'R², every {SAMPLED}rd', 'R², all'],
               [['as printed', *(f'{v:.3g}' for v in PRINTED), f'{some:.4f}', f'{r2:.4f}'],
                ['refitted', *(f'{v:.4g}' for v in fitted), f'{some_fitted:.4f}',
                 f'{r2_fitted:.4f}']],
               'scale = (n0 + n1 ID + n2 ID²) / (1 + d1 ID + d2 ID²)')
    made.table(['image', 'windows', 'R² as printed', 'R² refitted'], other_sizes(shop),
               'The same windows in the paper\'s other sizes')
    beyond = ratio(210000.0, *PRINTED)
    made.text(f'The printed formula has a pole at id {pole():.0f}: from there on it means nothing '
              f'(scale {ratio(180000.0, *PRINTED):.2f} at id 180000, {beyond:.1f} '
              'at 210000), and for another number of windows it does not hold at '
              'all. Which image, window and step it was fitted to can not be told: they trade off '
              'exactly. A table of the first id of each scale is exact for all of them and needs a '
              'handful of comparisons.')
    return made


def other_sizes(shop):
    rows = []
    for size in shop.choose(published.SIZES, published.SIZES[:4]):
        values = scale_by_id(Windows(size))
        ids = np.arange(len(values), dtype=float)
        try:
            own = f'{r_squared(values, ratio(ids, *refit(ids, values))):.4f}'
        except RuntimeError:  # The fit does not come to an end.
            own = 'no fit found'
        rows.append([f'{size[0]}x{size[1]}', len(values),
                     f'{r_squared(values, ratio(ids, *PRINTED)):.3g}', own])
    return rows

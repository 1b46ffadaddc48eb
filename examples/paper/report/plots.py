# SPDX-License-Identifier: LGPL-2.1-or-later
"""All drawing. Each function writes an SVG into the report's folder and returns its name."""
import matplotlib

matplotlib.use('svg')
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib import ticker  # noqa: E402

OURS, PAPERS, OTHERS = '#0b6e4f', '#c1440e', '#8a9299'
COLOURS = ('#0b6e4f', '#2a6fbb', '#b5179e', '#e09f3e', '#5f0f40', '#577590')
MANY_DECADES = 3e3  # From the least to the greatest value.
plt.rcParams.update({'font.size': 9, 'svg.fonttype': 'path', 'axes.grid': True, 'grid.alpha': 0.3,
                     'axes.spines.top': False, 'axes.spines.right': False,
                     'svg.hashsalt': 'report', 'figure.constrained_layout.use': True})


def save(figure, folder, name):
    figure.savefig(folder / f'{name}.svg', metadata={'Date': None})
    plt.close(figure)
    return f'{name}.svg'


def label(axes, x, y, title=None):
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    if title:
        axes.set_title(title, fontsize=10)


def make_log(axes):
    """Numbers stand at 1, 2 and 5 of each decade, as curves may lie within one; where there are
    many, at each decade alone."""
    axes.set_yscale('log')
    low, high = axes.get_ylim()
    if high / low < MANY_DECADES:
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(ticker.StrMethodFormatter('{x:g}'))
        axes.yaxis.set_minor_formatter(ticker.NullFormatter())


def lines(folder, name, x, curves, labels, is_log=False, from_zero=True):
    """curves: {name: values}; values None where there are none. Names that begin with "paper" are
    drawn as the paper's, dashed."""
    figure, axes = plt.subplots(figsize=(7.6, 3.6))
    colours = iter(COLOURS * 3)
    for curve, values in curves.items():
        is_paper = curve.startswith('paper')
        known = [(a, b) for a, b in zip(x, values) if b is not None]
        axes.plot(*zip(*known), marker='s' if is_paper else 'o', markersize=4,
                  linestyle='--' if is_paper else '-', label=curve,
                  color=PAPERS if curve == 'paper' else next(colours))
    label(axes, *labels)
    if is_log:
        make_log(axes)
    elif from_zero:
        axes.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc='upper left', bbox_to_anchor=(1.01, 1))
    return save(figure, folder, name)


def panels(folder, name, x, groups, labels, is_log=False):
    """The same, two in a row: groups = {title: curves}, one scale for all."""
    rows = (len(groups) + 1) // 2
    figure, all_axes = plt.subplots(rows, 2, figsize=(8.4, 3 * rows), sharey=True, squeeze=False)
    for axes, (title, curves) in zip(all_axes.flat, groups.items()):
        for colour, (curve, values) in zip(COLOURS, curves.items()):
            axes.plot(x, values, marker='o', markersize=3.5, label=curve, color=colour)
        label(axes, labels[0], labels[1] if axes in all_axes[:, 0] else '', title)
        if is_log:
            make_log(axes)
        else:
            axes.set_ylim(bottom=0)
    all_axes[0][1].legend(fontsize=8, loc='upper left', bbox_to_anchor=(1.01, 1))
    return save(figure, folder, name)


def stacked(folder, name, names, parts, labels):
    """Bars of parts one on the other: parts = {name: values}."""
    figure, axes = plt.subplots(figsize=(6.2, 3.6))
    base = [0.0] * len(names)
    for colour, (part, values) in zip(COLOURS, parts.items()):
        axes.bar(names, values, bottom=base, label=part, color=colour, width=0.65)
        base = [b + v for b, v in zip(base, values)]
    label(axes, *labels)
    axes.legend(fontsize=8)
    return save(figure, folder, name)


def ranked(folder, name, values, ours, label_of_x):
    """Horizontal bars, the least on top; those named in `ours` stand out."""
    order = sorted(values, key=values.get, reverse=True)
    figure, axes = plt.subplots(figsize=(6.4, 0.9 + 0.22 * len(order)))
    colours = [OURS if one in ours else OTHERS for one in order]
    bars = axes.barh(order, [values[one] for one in order], color=colours)
    axes.bar_label(bars, fontsize=7, padding=2)
    axes.margins(x=0.12, y=0.01)
    axes.grid(axis='y', alpha=0)
    axes.set_xlabel(label_of_x)
    return save(figure, folder, name)


def paths(folder, name, size, truth, measured):
    """Where things were and where they were found: {name: ([x], [y])}."""
    figure, axes = plt.subplots(figsize=(5.2, 4.6))
    for colour, (thing, (x, y)) in zip(COLOURS, truth.items()):
        axes.plot(x, y, color=colour, linewidth=3, alpha=0.35, label=f'{thing}, actual')
        axes.plot(*measured[thing], color='black', linewidth=0.8, linestyle='--',
                  label=f'{thing}, measured')
    axes.set_xlim(0, size[0])
    axes.set_ylim(size[1], 0)
    axes.set_aspect('equal')
    label(axes, 'x [px]', 'y [px]')
    axes.legend(fontsize=8, loc='upper center', ncol=2)
    return save(figure, folder, name)


def scales(folder, name, ids, exact, models, limits):
    """A window's scale by its id, and below it what models of it are off by. limits: of the scale
    and of the error."""
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 5.2), sharex=True)
    upper.plot(ids, exact, color='black', linewidth=3, alpha=0.35, label='exact')
    for colour, (model, values) in zip((PAPERS, OURS), models.items()):
        upper.plot(ids, values, color=colour, linewidth=1.1, label=model)
        lower.plot(ids, values - exact, color=colour, linewidth=1, label=model)
    upper.set_ylim(0, limits[0])
    lower.set_ylim(-limits[1], limits[1])
    label(upper, '', 'scale')
    label(lower, 'window id', 'model less exact')
    upper.legend(fontsize=8)
    return save(figure, folder, name)

# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figure 3: the error of measured trajectories."""
import itertools
import math

from . import plots, published, scenes, streams
from .section import Section

SYSTEMS = {'our defaults': streams.OURS,
           'section 2.1 (frame difference)': streams.BY_DIFFERENCE,
           'the paper\'s own, literally': streams.LITERAL}


def follow(shop, condition, line):
    """Of each thing [(frame, true centre, measured centre or None)] while all of it is in view."""
    frames = itertools.islice(scenes.frames(condition), shop.choose(scenes.FRAMES, 150))
    told = streams.objects(frames, line)
    rows = {0: [], 1: []}
    for time in range(scenes.ENTER + 20, len(told)):
        for thing, row in rows.items():
            truth = scenes.centre_of(thing, time)
            if truth is None:
                continue
            centres = [(o['centroid']['x'], o['centroid']['y']) for o in told[time]
                       if o['state'] in ('tracked', 'stopped')]
            near = min(centres, key=lambda c: math.dist(c, truth), default=None)
            is_it = near is not None and math.dist(near, truth) < scenes.THING[0]
            row.append((time, truth, near if is_it else None))
    return rows


def errors(rows):
    """Mean and largest error in pixels, and the share of the frames in which things were found."""
    seen = [math.dist(truth, found) for row in rows.values() for _, truth, found in row if found]
    count = sum(len(row) for row in rows.values())
    return sum(seen) / max(len(seen), 1), max(seen, default=0.0), len(seen) / count


def coordinates(row, which):
    points = [entry[which] for entry in row if entry[2]]
    return [p[0] for p in points], [p[1] for p in points]


def stopped(rows):
    """Frames in which the second thing stands still and is found, and how many it stands."""
    standing = [found for time, _, found in rows[1]
                if scenes.corner_of(1, time) == scenes.corner_of(1, time - 1)]
    return sum(found is not None for found in standing), len(standing)


def figure_3(shop):
    made = Section()
    diagonal = math.hypot(*scenes.SIZE)
    conditions = shop.choose(scenes.CONDITIONS, scenes.CONDITIONS[:1])
    body, shown = [], None
    for system, line in SYSTEMS.items():
        for condition in conditions:
            rows = follow(shop, condition, line)
            shown = shown or rows
            mean, most, share = errors(rows)
            found, standing = stopped(rows)
            body.append([f'{system}, {condition.name}', f'{mean:.2f}', f'{most:.2f}',
                         f'{100 * mean / diagonal:.3f}', f'{100 * share:.1f}',
                         f'{found} of {standing}'])
    mean, most, share = errors(shown)
    limit = published.TRAJECTORY_ERROR_PERCENT
    made.finding = (f'With our defaults the mean error of the centre is {mean:.2f} px, '
                    f'{100 * mean / diagonal:.3f} % of the diagonal; the paper says less than '
                    f'{limit} %, without saying of what ({limit} % of this diagonal are '
                    f'{limit * diagonal / 100:.2f} px).')
    names = {f'thing {thing + 1}': row for thing, row in shown.items()}
    made.picture(plots.paths(shop.output, 'fig-3', scenes.SIZE,
                             {n: coordinates(row, 1) for n, row in names.items()},
                             {n: coordinates(row, 2) for n, row in names.items()}),
                 'Actual and measured trajectories, our defaults, little noise')
    made.table(['system and scene', 'mean [px]', 'largest [px]', 'mean [% of the diagonal]',
                'found [% of the frames]', 'found while it stands'], body,
               f'Made-up scene of {shop.choose(scenes.FRAMES, 150)} frames, '
               f'{scenes.SIZE[0]}x{scenes.SIZE[1]}: two things whose paths are known, one of which '
               'stops for two seconds')
    return made

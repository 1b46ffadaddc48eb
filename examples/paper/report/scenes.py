# SPDX-License-Identifier: LGPL-2.1-or-later
"""Made-up frames with known truth: things of two colours before a wall, with noise."""
import dataclasses
import math

import numpy as np

SIZE = (400, 400)  # Width and height, of the paper's figure 8.
THING = (28, 44)
FRAMES = 220
ENTER = 30  # The wall alone comes first.


@dataclasses.dataclass
class Condition:
    name: str
    noise: float = 2
    light: float = 1.0


CONDITIONS = (Condition('little noise'), Condition('strong noise', noise=8),
              Condition('dim light', noise=3, light=0.4))


def wall(rng):
    tiles = rng.integers(70, 130, (SIZE[1] // 20, SIZE[0] // 20, 3))
    return tiles.repeat(20, 0).repeat(20, 1).astype(float)


def corner_of(thing, time):
    """Left upper corner, in whole pixels. The second thing stands still for two seconds."""
    t = time - ENTER
    if thing == 0:
        return round(-30 + 2.2 * t), round(90 + 40 * math.sin(t / 25))
    t = t if t < 80 else max(80, t - 50)
    return round(420 - 2.6 * t), round(240 + 30 * math.sin(t / 18))


def paint(picture, thing, corner):
    width, height = THING
    colours = ((40, 60, 210), (190, 90, 40)) if thing == 0 else ((60, 190, 70), (50, 170, 200))
    for y in range(max(corner[1], 0), min(corner[1] + height, SIZE[1])):
        columns = slice(max(corner[0], 0), max(min(corner[0] + width, SIZE[0]), 0))
        picture[y, columns] = colours[y - corner[1] >= height // 2]


def frames(condition, seed=3):
    rng = np.random.default_rng(seed)
    ground = wall(rng)
    for time in range(FRAMES):
        picture = ground.copy()
        for thing in (0, 1):
            paint(picture, thing, corner_of(thing, time))
        picture = picture * condition.light + rng.normal(0, condition.noise, picture.shape)
        yield np.clip(np.rint(picture), 0, 255).astype(np.uint8)


def centre_of(thing, time):
    """Mean position of its pixels, or None where a part of it is outside."""
    x, y = corner_of(thing, time)
    width, height = THING
    if x < 0 or y < 0 or x + width > SIZE[0] or y + height > SIZE[1]:
        return None
    return x + (width - 1) / 2, y + (height - 1) / 2

# SPDX-License-Identifier: LGPL-2.1-or-later
"""What has to be in the report, in the order of the paper."""
import dataclasses
from collections.abc import Callable

from . import areas, claims, masks, phases, tracking, trajectories, windows


@dataclasses.dataclass(frozen=True)
class Item:
    id: str
    title: str
    make: Callable  # Of the workshop; gives a Section.


ITEMS = (
    Item('claims', 'What the paper says, and what we found', claims.table_of_claims),
    Item('fig-1', 'Fig. 1: motion tracking', tracking.figure_1),
    Item('fig-2', 'Fig. 2: time by number of objects', areas.figure_2),
    Item('table-1', 'Table 1: areas against the whole frame', areas.table_1),
    Item('roi-share', 'Section 2.1: 19 to 59 % of the time', areas.roi_share),
    Item('fig-3', 'Fig. 3: trajectories', trajectories.figure_3),
    Item('fig-5', 'Fig. 5: background removal on Wallflower', masks.figure_5),
    Item('fig-8', 'Fig. 8: objects in the time of a frame', areas.figure_8),
    Item('fig-9', 'Fig. 9: motion and colour tracking', tracking.figure_9),
    Item('fig-9-claim', 'Fig. 9: 120 frames without false alarm or miss', tracking.claim_of_120),
    Item('table-2', 'Table 2: colour tracking in areas', areas.table_2),
    Item('fig-11', 'Fig. 11: false positives', masks.figure_11),
    Item('fig-12', 'Fig. 12: false negatives', masks.figure_12),
    Item('fig-13', 'Fig. 13: total error', masks.figure_13),
    Item('fig-14', 'Fig. 14: time of the phases, 200x200', phases.figure_14),
    Item('sizes', 'Sections 2.3.1 and 3.3: the seven frame sizes', phases.sizes),
    Item('fig-18', 'Fig. 18: number of search windows', windows.figure_18),
    Item('fig-19', 'Fig. 19: scale by window id, equation (2)', windows.figure_19),
    Item('fig-20', 'Fig. 20: time of the phases, 640x480', phases.figure_20),
    Item('fig-21', 'Fig. 21: frames a second', phases.figure_21),
)

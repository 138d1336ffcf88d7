"""Arrangements built greedily: what the integer program must beat.

Shapes: n objects, c columns, s of them standing on areas.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from placing.joint.joint_columns import Columns
from placing.joint.options import Options
from placing.joint.stacking import stack_below, stacked_boxes
from placing.overlap import TOUCH_M, grown, overlaps

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def as_choice(columns: Columns, picked: Ints) -> tuple[Ints, Ints]:
    """Return choice and lower object of the picked columns, each (n,)."""
    return columns.option[picked], columns.lower[picked]


def too_high(
    objects: Sequence[Options], choice: Ints, on: Ints, boxes: Array
) -> NDArray[np.bool_]:
    """Return which objects reach above the free height of their option, (n,)."""
    found = np.zeros(len(choice), np.bool_)
    for i in np.flatnonzero(on >= 0).tolist():
        height = boxes[[i, *stack_below(on, i)], 5].sum()
        found[i] = height > objects[i].clearance_m[choice[i]] + TOUCH_M
    return found


def build(
    objects: Sequence[Options],
    columns: Columns,
    conflict: NDArray[np.bool_],
    priority: Array,
    margin_m: float,
) -> Ints:
    """Return one column per object (n,), taken in falling priority where they fit."""
    n, c = len(objects), len(columns.owner)
    picked = np.arange(c - n, c)  # nowhere
    # Nowhere is what remains, whatever its priority; -inf means not at all.
    is_left = (columns.option >= 0) & np.isfinite(priority)
    is_arc = columns.level > 0
    holds = np.zeros(c, np.bool_)  # arcs whose lower object is there
    while (ready := is_left & (holds | ~is_arc)).any():
        at = int(np.argmax(np.where(ready, priority, -np.inf)))
        i = columns.owner[at]
        trial = picked.copy()
        trial[i] = at
        is_left[at] = False
        if _is_clear(objects, columns, trial, i, margin_m):
            picked = trial
            is_left &= columns.owner != i
            if not is_arc[at]:
                is_left[: columns.n_standing] &= ~conflict[at]
            else:
                is_left &= columns.lower != columns.lower[at]
            is_on = (columns.lower == i) & (columns.level == columns.level[at] + 1)
            holds |= is_on & (columns.lower_option == columns.option[at])
    return picked


def _is_clear(
    objects: Sequence[Options],
    columns: Columns,
    picked: Ints,
    i: int,
    margin_m: float,
) -> bool:
    """Return whether object i hits nothing and is not too high where it is put."""
    choice, on = as_choice(columns, picked)
    if (on < 0).all():
        return True  # what stands on areas was kept apart by its conflicts
    boxes = stacked_boxes(objects, choice, on)
    if too_high(objects, choice, on, boxes)[i]:
        return False
    others = boxes[(choice >= 0) & (np.arange(len(choice)) != i)]
    wide = grown(boxes[[i]], margin_m)
    return not overlaps(wide, grown(others, margin_m)).any()

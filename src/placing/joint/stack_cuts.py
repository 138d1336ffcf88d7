"""Cuts against stacks that are too high or that hit something.

Where a raised box is depends on all that is below it, so that its conflicts are found
in a solution and forbidden one by one, each together with all that is alike.

Shapes: n objects, c columns.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from placing.joint.incumbent import as_choice, too_high
from placing.joint.joint_columns import Columns
from placing.joint.options import Options
from placing.joint.stacking import stack_below, stacked_boxes
from placing.overlap import grown, overlaps

Ints = NDArray[np.int64]
Cut = tuple[Ints, int]
"""Columns, and how many of them may be chosen at most."""


def stack_cuts(
    objects: Sequence[Options], columns: Columns, picked: Ints, margin_m: float
) -> list[Cut]:
    """Return cuts that the picked columns (n,) violate because of raised boxes."""
    choice, on = as_choice(columns, picked)
    boxes = stacked_boxes(objects, choice, on)
    is_high = too_high(objects, choice, on, boxes)
    wide = grown(boxes, margin_m)
    cuts: list[Cut] = []
    for i in np.flatnonzero(on >= 0).tolist():
        stack = _fixing(picked, on, i)
        if is_high[i]:
            cuts.append((stack, len(stack) - 1))
        for j in np.flatnonzero(choice >= 0).tolist():
            if i == j or not overlaps(wide[[i]], wide[[j]])[0, 0]:
                continue
            if on[j] >= 0:
                both = np.union1d(stack, _fixing(picked, on, j))
                cuts.append((both, len(both) - 1))
            else:
                alike = _standing_in(objects, columns, j, wide[[i]], margin_m)
                cuts.append((np.concatenate([stack, alike]), len(stack)))
    return cuts


def _fixing(picked: Ints, on: Ints, i: int) -> Ints:
    """Return the arcs that tell where a raised object is."""
    stack = [i, *stack_below(on, i)]
    return picked[np.array(stack[:-1])]


def _standing_in(
    objects: Sequence[Options],
    columns: Columns,
    j: int,
    wide: NDArray[np.float64],
    margin_m: float,
) -> Ints:
    """Return the columns of object j on an area that overlap a box."""
    at = np.flatnonzero(columns.owner[: columns.n_standing] == j)
    boxes = objects[j].boxes[columns.option[at]]
    return at[overlaps(grown(boxes, margin_m), wide)[:, 0]]

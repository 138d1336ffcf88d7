"""Linear stacks: objects on one another at the place where the lowest one stands.

Each object stands on at most one other and carries at most one. An arc says that one
object, with one of its options, stands on one option of another at a given level; the
lowest object of a stack is at level 0.

Shapes: n objects, o options of an object, a arcs.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from placing.joint.options import Options

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class StackPair:
    """One object may stand on another; both are indices of objects."""

    upper: int
    lower: int
    log_score: float
    """Added to the score of the upper one's own option at that place."""


@dataclass(frozen=True)
class Arcs:
    """Ways to stand on another object; all arrays have shape (a,)."""

    upper: Ints
    option: Ints
    """Of the upper object, at the place of the lower one's option."""
    lower: Ints
    lower_option: Ints
    level: Ints
    """Of the upper object, 1 or more."""
    log_score: Array
    """Of the upper object at that place, and of the pair."""


def find_arcs(
    objects: Sequence[Options],
    pairs: Sequence[StackPair],
    max_levels: int,
    max_overhang: float,
) -> Arcs:
    """Return the arcs of all pairs that are low enough and supported below."""
    tables, scores = [np.empty((0, 5), np.int64)], [np.empty(0)]
    for pair in pairs:
        upper, lower = objects[pair.upper], objects[pair.lower]
        a, b = _supported(upper, lower, max_overhang)
        for level in range(1, max_levels):
            who = (np.full(len(a), value) for value in (pair.upper, pair.lower, level))
            i, j, at = who
            tables.append(np.column_stack([i, a, j, b, at]))
            scores.append(upper.log_score[a] + pair.log_score)
    i, a, j, b, level = np.concatenate(tables).T
    return Arcs(i, a, j, b, level, np.concatenate(scores))


def _supported(
    upper: Options, lower: Options, max_overhang: float
) -> tuple[Ints, Ints]:
    """Return options of the upper and of the lower object that may be stacked."""
    a, b = np.nonzero(upper.place[:, None] == lower.place[None])
    is_low = upper.size[a, 2] + lower.size[b, 2] <= _clearance(upper, lower, a, b)
    is_usable = upper.is_usable[a] & lower.is_usable[b]
    a, b = a[is_low & is_usable], b[is_low & is_usable]
    is_held = overhangs(upper.boxes[a], lower.boxes[b]) <= max_overhang
    return a[is_held], b[is_held]


def _clearance(upper: Options, lower: Options, a: Ints, b: Ints) -> Array:
    """Return the free height at pairs of options of one place [m]."""
    return np.minimum(upper.clearance_m[a], lower.clearance_m[b])


def overhangs(upper: Array, lower: Array) -> Array:
    """Return the share of the footprint of each box that lies off the box below, (a,).

    `upper` and `lower` (a, 7) = centre, size and yaw.
    """
    above, below = footprints(upper), footprints(lower)
    common = shapely.area(shapely.intersection(above, below))
    return 1 - common / np.maximum(shapely.area(above), 1e-12)


def footprints(boxes: Array) -> NDArray[np.object_]:
    """Return the rectangles of boxes seen from above, polygons of shape (a,)."""
    corners = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) / 2  # (4, 2)
    local = boxes[:, None, 3:5] * corners  # (a, 4, 2)
    cos, sin = np.cos(boxes[:, 6])[:, None], np.sin(boxes[:, 6])[:, None]
    x = boxes[:, None, 0] + cos * local[..., 0] - sin * local[..., 1]
    y = boxes[:, None, 1] + sin * local[..., 0] + cos * local[..., 1]
    return np.asarray(shapely.polygons(np.stack([x, y], -1)))


def stacked_boxes(objects: Sequence[Options], choice: Ints, on: Ints) -> Array:
    """Return the box of every object, uppers raised onto their lowers: (n, 7).

    The boxes of objects that are not placed are NaN.
    """
    boxes = np.full((len(objects), 7), np.nan)
    for i, options in enumerate(objects):
        if choice[i] >= 0:
            boxes[i] = options.boxes[choice[i]]
    for i in _lowest_first(on):
        if on[i] >= 0:
            below = boxes[on[i]]
            boxes[i, 2] = below[2] + below[5] / 2 + boxes[i, 5] / 2
    return boxes


def _lowest_first(on: Ints) -> Ints:
    """Return the objects ordered so that each comes after what it stands on, (n,)."""
    levels = np.array([len(stack_below(on, i)) for i in range(len(on))])
    return np.argsort(levels, kind="stable")


def stack_below(on: Ints, i: int) -> list[int]:
    """Return the objects below object i, the nearest one first."""
    below: list[int] = []
    while on[i] >= 0 and len(below) < len(on):
        i = int(on[i])
        below.append(i)
    return below

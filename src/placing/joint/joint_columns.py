"""The integer program of the joint placement: its columns and its fixed rows.

A column is one state of one object: standing on an area with one of its options, or
on another object (an arc), or nowhere. Each object is in exactly one state.

Shapes: n objects, c columns of which the first s stand on areas, r rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from placing.joint.options import Options
from placing.joint.stacking import Arcs
from placing.overlap import TOUCH_M, covers, grown, overlaps

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

LAYER_M = 0.002
"""Bottoms of boxes that differ by less share a layer of points."""


@dataclass(frozen=True)
class Columns:
    """The states of all objects; standing ones first, then arcs, then nowhere."""

    owner: Ints
    """(c,) index of the object."""
    option: Ints
    """(c,) its option, -1 nowhere."""
    lower: Ints
    """(c,) object it stands on, -1 for none."""
    lower_option: Ints
    """(c,) option of that one, -1 for none."""
    level: Ints
    """(c,) 0 on an area, -1 nowhere."""
    value: Array
    """(c,) log score."""
    place: Ints
    """(c,) index of the place, -1 nowhere."""
    height_m: Array
    """(c,) of the object's box."""
    n_standing: int


def make_columns(
    objects: Sequence[Options], arcs: Arcs, unplaced_penalty: float
) -> Columns:
    """Return the columns of all objects."""
    at = [np.flatnonzero(options.is_usable) for options in objects]
    standing = [[np.full(len(o), i), o] for i, o in enumerate(at)]
    i, o = np.concatenate([np.empty((2, 0), np.int64), *standing], 1).astype(int)
    scores = [options.log_score[k] for options, k in zip(objects, at, strict=True)]
    none = np.arange(len(objects))
    nowhere = [s.min() - unplaced_penalty if len(s) else 0.0 for s in scores]
    owner = np.concatenate([i, arcs.upper, none])
    option = np.concatenate([o, arcs.option, np.full(len(none), -1)])
    rest = np.full(len(none), -1)
    return Columns(
        owner,
        option,
        np.concatenate([np.full(len(i), -1), arcs.lower, rest]),
        np.concatenate([np.full(len(i), -1), arcs.lower_option, rest]),
        np.concatenate([np.zeros(len(i), np.int64), arcs.level, rest]),
        np.concatenate([*scores, arcs.log_score, nowhere]),
        _gather([options.place for options in objects], owner, option, -1),
        _gather([options.size[:, 2] for options in objects], owner, option, 0.0),
        len(i),
    )


def _gather(tables: list[NDArray], owner: Ints, option: Ints, other: float) -> NDArray:
    """Return the entry of each column's object and option, `other` nowhere: (c,)."""
    starts = np.cumsum([0, *(len(table) for table in tables)])[:-1]
    flat = np.concatenate([*tables, np.array([other])])
    at = np.where(option >= 0, starts[owner] + option, len(flat) - 1)
    return flat[at]


def standing_boxes(
    objects: Sequence[Options], columns: Columns, margin_m: float
) -> Array:
    """Return the boxes of the columns that stand on areas, grown: (s, 7)."""
    boxes = np.concatenate([np.empty((0, 7)), *(options.boxes for options in objects)])
    starts = np.cumsum([0, *(len(options.yaw) for options in objects)])[:-1]
    s = columns.n_standing
    return grown(boxes[starts[columns.owner[:s]] + columns.option[:s]], margin_m)


def conflicts(columns: Columns, boxes: Array) -> NDArray[np.bool_]:
    """Return which standing columns exclude each other, symmetric (s, s).

    Their boxes (s, 7) overlap, or they are of one object, or at one place: a place has
    one stack.
    """
    s = columns.n_standing
    owner, place = columns.owner[:s], columns.place[:s]
    found = overlaps(boxes, boxes)
    found |= owner[:, None] == owner
    found |= place[:, None] == place
    return found


def point_rows(columns: Columns, boxes: Array, spacing_m: float) -> sparse.csr_array:
    """Return rows of: at most one box covers a point, (r, c).

    Boxes that cover one point overlap, so that these rows follow from the problem.
    The points lie just above the bottoms of the boxes, where the others stand as well.
    """
    bottom = boxes[:, 2] - boxes[:, 5] / 2
    step = np.array([spacing_m, spacing_m, LAYER_M])
    low = np.column_stack([boxes[:, :2], bottom])
    cells = np.unique(np.round(low / step).astype(np.int64), axis=0)
    around = np.array([(0, 0, 0), (0.5, 0, 0), (0, 0.5, 0), (0.5, 0.5, 0)])
    points = (cells[:, None] + around).reshape(-1, 3) * step
    points[:, 2] += LAYER_M
    inside = sparse.csr_array(
        covers(boxes, np.asarray(points, np.float64)).astype(np.int8)
    )
    is_shared = np.diff(inside.indptr) > 1
    rows = inside[is_shared].astype(float)
    n_others = len(columns.owner) - columns.n_standing
    return sparse.csr_array(
        sparse.hstack([rows, sparse.csr_array((rows.shape[0], n_others))])
    )


def fixed_rows(
    columns: Columns, objects: Sequence[Options]
) -> tuple[sparse.csr_array, Array]:
    """Return A (r, c) and b (r,) with A x <= b: supports, and heights of stacks."""
    support, height = _support_rows(columns), _height_rows(columns, objects)
    rows = sparse.vstack([support, height[0]], format="csr")
    return rows, np.concatenate([np.zeros(support.shape[0]), height[1]])


def _support_rows(columns: Columns) -> sparse.csr_array:
    """Return rows of: what stands on an option of a level is at most what is there."""
    arcs = np.flatnonzero(columns.level > 0)
    above = _key(columns.lower, columns.lower_option, columns.level - 1)[arcs]
    here = _key(columns.owner, columns.option, columns.level)
    spots, row = np.unique(above, return_inverse=True)
    below = np.flatnonzero(np.isin(here, spots) & (columns.option >= 0))
    entries = np.concatenate([np.ones(len(arcs)), -np.ones(len(below))])
    rows = np.concatenate([row, np.searchsorted(spots, here[below])])
    at = (rows, np.concatenate([arcs, below]))
    shape = (len(spots), len(columns.owner))
    return sparse.csr_array(sparse.coo_array((entries, at), shape=shape))


def _key(i: Ints, option: Ints, level: Ints) -> Ints:
    """Return one number for an object with an option at a level, (c,)."""
    return (i << 40) + (option << 8) + level


def _height_rows(
    columns: Columns, objects: Sequence[Options]
) -> tuple[sparse.csr_array, Array]:
    """Return rows of: the heights at a place with arcs add up to its free height."""
    clearance = _gather(
        [options.clearance_m for options in objects], columns.owner, columns.option, 0
    )
    places = np.unique(columns.place[columns.level > 0])
    row = np.searchsorted(places, columns.place)
    is_there = np.isin(columns.place, places)
    shape = (len(places), len(columns.owner))
    at = (row[is_there], np.flatnonzero(is_there))
    rows = sparse.coo_array((columns.height_m[is_there], at), shape=shape)
    free = np.full(len(places), 0.0)
    np.maximum.at(free, at[0], clearance[is_there])
    return sparse.csr_array(rows), free + TOUCH_M

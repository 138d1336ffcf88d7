"""Tiles: the level patches of a cloud, one per column and height, and their groups.

Points of one column that face up and lie close in height make a tile. Neighbouring
tiles belong to one group if they are equally high, if the free heights above them are
alike, and if no wall, board or rail stands between them.

Letters for shapes: n points, t tiles, e pairs of neighbouring tiles.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from placing.areas.columns import MARGIN_M, SIDE, Columns, bounds


@dataclass(frozen=True)
class Tiles:
    """Level patches as large as a column, sorted by column and height."""

    cell: NDArray[np.int64]
    """(t, 2) column along x and along y."""
    height_m: NDArray[np.float64]
    """(t,) mean of its points."""
    clearance_m: NDArray[np.float64]
    """(t,) free height above it."""
    is_border: NDArray[np.bool_]
    """(t,) whether something upright stands in its column, just above it."""

    def take(self, chosen: NDArray) -> "Tiles":
        """Return the tiles `chosen` by mask or by index."""
        return Tiles(
            self.cell[chosen],
            self.height_m[chosen],
            self.clearance_m[chosen],
            self.is_border[chosen],
        )


def find_tiles(
    columns: Columns, max_tilt_rad: float, max_height_m: float, merge_m: float
) -> Tiles:
    """Return the tiles of a cloud up to a height, those with nothing above included."""
    z = columns.points[:, 2]
    is_level = (columns.rise > np.cos(max_tilt_rad)) & (z < max_height_m + merge_m)
    # ASSUME: what lies lower than a hand below the floor is a reflection or a pit.
    is_level &= z > -0.1
    level = np.flatnonzero(is_level)
    column = np.repeat(np.arange(len(columns.start) - 1), np.diff(columns.start))[level]
    z = z[level].astype(float)
    is_first = (np.diff(column, prepend=-1) != 0) | (np.diff(z, prepend=-1) > merge_m)
    starts = np.flatnonzero(is_first)
    count = np.diff(starts, append=len(level))
    height = np.add.reduceat(z, starts) / count
    clearance, is_border = _look_up(
        column[starts], height, columns.start, columns.points[:, 2], columns.facing
    )
    cell = np.stack(np.divmod(column[starts], columns.shape[1]), axis=1)
    return Tiles(cell, height, clearance, is_border)


def pair_neighbors(tiles: Tiles, merge_m: float) -> NDArray[np.int64]:
    """Return the pairs of tiles side by side at one height, shape (e, 2)."""
    n_y = int(tiles.cell[:, 1].max()) + 2
    column = tiles.cell[:, 0] * n_y + tiles.cell[:, 1]
    start = np.searchsorted(column, np.arange(column[-1] + 2))
    room = np.empty((4 * len(column), 2), np.int64)
    return room[: _pair(column, tiles.height_m, start, n_y, merge_m, room)]


def smooth_clearance(tiles: Tiles, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the median clearance of each tile and its neighbours, shape (t,) [m]."""
    return _medians(tiles.clearance_m, pairs)


def group(
    tiles: Tiles, pairs: NDArray[np.int64], clearance_step_m: float
) -> NDArray[np.int64]:
    """Return the group of each tile, shape (t,).

    Tiles at a border join the group beside them, but do not join two groups.
    """
    # ASSUME: more than 2 m of free height is as good as any.
    clearance = np.minimum(tiles.clearance_m, 2.0)
    step = np.abs(clearance[pairs[:, 0]] - clearance[pairs[:, 1]])
    pairs = pairs[step <= clearance_step_m]
    n_border = tiles.is_border[pairs].sum(axis=1)  # (e,)
    labels = components(len(tiles.cell), pairs[n_border != 1])
    crossing = pairs[n_border == 1]
    is_first = tiles.is_border[crossing[:, 0]]
    border = np.where(is_first, crossing[:, 0], crossing[:, 1])
    inner = np.where(is_first, crossing[:, 1], crossing[:, 0])
    joined, pick = np.unique(border, return_index=True)
    labels[joined] = labels[inner[pick]]
    return labels


def components(n: int, pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the connected component of each of `n` things, shape (n,)."""
    links = coo_array((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(n, n))
    return connected_components(links, directed=False)[1].astype(np.int64)


@njit(cache=True)
def _look_up(
    column: NDArray, height: NDArray, start: NDArray, z: NDArray, facing: NDArray
) -> tuple[NDArray, NDArray]:
    """Return the free height above each tile, and whether it is a border."""
    free = np.full(len(column), np.inf)
    is_border = np.zeros(len(column), np.bool_)
    for t in range(len(column)):
        for p in range(start[column[t]], start[column[t] + 1]):
            above = z[p] - height[t]
            if facing[p] == SIDE:
                is_border[t] |= MARGIN_M < above < 3 * MARGIN_M
            elif bounds(above, facing[p]):
                free[t] = max(above, 0.0)
                break
    return free, is_border


@njit(cache=True)
def _pair(
    column: NDArray,
    height: NDArray,
    start: NDArray,
    n_y: int,
    merge_m: float,
    pairs: NDArray,
) -> int:
    """Write the pairs of equally high tiles side by side, return their number."""
    n = 0
    for t in range(len(column)):
        for step in (1, n_y):
            if column[t] + step + 1 >= len(start):
                continue
            for s in range(start[column[t] + step], start[column[t] + step + 1]):
                if abs(height[s] - height[t]) <= merge_m and n < len(pairs):
                    pairs[n, 0], pairs[n, 1] = t, s
                    n += 1
    return n


@njit(cache=True)
def _medians(values: NDArray, pairs: NDArray) -> NDArray:
    """Return the lower median of each value and up to four neighbours, shape (t,)."""
    around = np.empty((len(values), 5))
    around[:, 0] = values
    n = np.ones(len(values), np.int64)
    for side in range(2):
        for e in range(len(pairs)):
            t = pairs[e, side]
            if n[t] < 5:
                around[t, n[t]] = values[pairs[e, 1 - side]]
                n[t] += 1
    middle = np.empty(len(values))
    for t in range(len(values)):
        middle[t] = np.sort(around[t, : n[t]])[(n[t] - 1) // 2]
    return middle

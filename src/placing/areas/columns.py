"""Columns of a cloud: which points lie above which cell of the floor plan.

A column is one cell of a grid on the floor plan with its points sorted by height.
Points that face down, such as the underside of a board, and points that face up, such
as the top of a box, bound the free height of what lies below them.

Letters for shapes: n points, c columns, t tiles, q queries.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.clouds.ply import Cloud
from placing.clouds.voxels import lowest

UP, SIDE, DOWN = 1, 0, -1
STEEPEST = 0.5
"""Points face sideways when the height of their unit normal is below this."""
# ASSUME: points up to 2.5 cm above a level are its noise, or belong to a thin layer on
# it; what faces down bounds it from 5 mm below, since what stands on it touches it.
MARGIN_M, CONTACT_M = 0.025, 0.005


@dataclass(frozen=True)
class Columns:
    """The points of a cloud, sorted into columns and by height within each."""

    cell_m: float
    origin_m: NDArray[np.float64]
    """(2,) lower corner of the first column."""
    shape: tuple[int, int]
    """Columns along x and along y; the outermost ones are empty."""
    start: NDArray[np.int64]
    """(c + 1,) first point of each column, and the end of the last one."""
    points: NDArray[np.float32]
    """(n, 3) [m]."""
    rise: NDArray[np.float32]
    """(n,) height of the unit normal: 1 faces up, -1 faces down."""
    facing: NDArray[np.int8]
    """(n,) `UP`, `SIDE` or `DOWN`."""
    softness: NDArray[np.float32] | None = None
    """(n,) 0 hard to 1 soft, NaN where unknown; None where nothing is known of it."""


def sort_columns(cloud: Cloud, cell_m: float) -> Columns:
    """Return the points of the cloud sorted into columns."""
    low = lowest(cloud.points)
    origin = low[:2].astype(float) - cell_m
    cells, start, shape = _count(cloud.points, origin, cell_m)
    # One integer key sorts three times as fast as two keys: tenths of millimetres.
    height = ((cloud.points[:, 2] - low[2]) * 1e4).astype(np.int64)
    order = np.argsort(cells * (int(height.max()) + 1) + height, kind="stable")
    rise = cloud.normals[:, 2].take(order)
    facing = np.sign(rise) * (np.abs(rise) > STEEPEST)
    return Columns(
        cell_m=cell_m,
        origin_m=origin,
        shape=shape,
        start=start,
        points=cloud.points.take(order, axis=0),
        rise=rise,
        facing=facing.astype(np.int8),
        softness=None if cloud.softness is None else cloud.softness.take(order),
    )


def free_heights(
    columns: Columns, xy_m: NDArray, heights_m: NDArray, radius_m: float
) -> NDArray[np.float64]:
    """Return the free height above points, `inf` without bound, shape (q,) [m].

    All points of the cloud within `radius_m` count, whatever way they face.
    """
    return _free_heights(
        np.asarray(xy_m, float) - columns.origin_m,
        np.asarray(heights_m, float),
        radius_m,
        (columns.cell_m, *columns.shape),
        columns.start,
        columns.points[:, :2] - columns.origin_m,
        columns.points[:, 2],
        columns.facing,
    )


def points_at(
    columns: Columns,
    chosen: NDArray[np.int64],
    heights_m: NDArray[np.float64],
    merge_m: float,
    least_rise: float,
) -> NDArray[np.int64]:
    """Return which points of chosen columns (t,) face up at a height, shape (n,)."""
    count = columns.start[chosen + 1] - columns.start[chosen]
    found = np.empty(count.sum(), np.int64)
    near = (merge_m, least_rise)
    sorted_points = (columns.start, columns.points, columns.rise)
    return found[: _pick(chosen, heights_m, near, *sorted_points, found)]


@njit(cache=True)
def _pick(
    chosen: NDArray,
    heights: NDArray,
    near: tuple[float, float],
    start: NDArray,
    points: NDArray,
    rise: NDArray,
    found: NDArray,
) -> int:
    """Write which points of the chosen columns are near their heights, count them."""
    n = 0
    for t in range(len(chosen)):
        for p in range(start[chosen[t]], start[chosen[t] + 1]):
            if abs(points[p, 2] - heights[t]) <= near[0] and rise[p] > near[1]:
                found[n] = p
                n += 1
    return n


@njit(cache=True)
def _count(
    points: NDArray, origin: NDArray, cell_m: float
) -> tuple[NDArray, NDArray, tuple[int, int]]:
    """Return column of each point (n,), first point of each column, and the shape."""
    cells = np.empty((len(points), 2), np.int64)
    n_x, n_y = 0, 0
    for p in range(len(points)):
        cells[p, 0] = np.int64((points[p, 0] - origin[0]) / cell_m)
        cells[p, 1] = np.int64((points[p, 1] - origin[1]) / cell_m)
        n_x, n_y = max(n_x, cells[p, 0] + 2), max(n_y, cells[p, 1] + 2)
    column = cells[:, 0] * n_y + cells[:, 1]
    count = np.zeros(n_x * n_y + 1, np.int64)
    for c in column:
        count[c + 1] += 1
    return column, np.cumsum(count), (n_x, n_y)


@njit(cache=True)
def _free_heights(
    xy: NDArray,
    heights: NDArray,
    radius: float,
    grid: tuple[float, int, int],
    start: NDArray,
    points_xy: NDArray,
    points_z: NDArray,
    facing: NDArray,
) -> NDArray:
    """Return the height of the lowest bound within the radius of each query."""
    cell, n_x, n_y = grid
    free = np.full(len(xy), np.inf)
    for k in range(len(xy)):
        x, y = xy[k]
        i_first, i_last = int((x - radius) // cell), int((x + radius) // cell)
        j_first, j_last = int((y - radius) // cell), int((y + radius) // cell)
        for i in range(max(0, i_first), min(n_x, i_last + 1)):
            for j in range(max(0, j_first), min(n_y, j_last + 1)):
                for p in range(start[i * n_y + j], start[i * n_y + j + 1]):
                    above = points_z[p] - heights[k]
                    if above >= free[k]:
                        break
                    gap = np.hypot(points_xy[p, 0] - x, points_xy[p, 1] - y)
                    if gap <= radius and bounds(above, facing[p]):
                        free[k] = max(above, 0.0)
    return free


@njit(cache=True)
def bounds(above_m: float, facing: int) -> bool:
    """Tell whether a point at this height above a level lies above what is there."""
    return above_m > -CONTACT_M if facing == DOWN else above_m > MARGIN_M

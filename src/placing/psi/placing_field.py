"""What the cloud of a scene says near a placement, prepared once per scene.

Two tables over the floor plan: the points in columns, and levels. Each point that faces
up or down is spread over the cells of the floor plan between it and its neighbours, so
that a tabletop of a point every 2.5 cm has no holes, while a wire stays narrow.

Letters for shapes: n points, c columns or cells, e levels.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.clouds.ply import Cloud

COLUMN_M = 0.05
"""Width of a column of points; neighbours of a point are in the columns around it."""
NEIGHBOR_M = 0.04
"""Points this near make the surface that a point belongs to."""
# ASSUME: a point stands for a disc that reaches the next but one, since voxels may be
# empty by chance; for less at the edge of a board, and for a cell across a wire.
SPREAD, NARROWEST_M, WIDEST_M = 2.0, 0.003, 0.028
MERGE_M = 0.012
"""Levels of a cell no further apart are one: noise of a scan."""
STEEPEST = 0.5
"""Points face sideways when the height of their unit normal is below this."""


class Plan(NamedTuple):
    """Cells of the floor plan, for compiled code."""

    x_m: float
    y_m: float
    cell_m: float
    per_m: float
    """Cells in a metre."""
    n_x: int
    n_y: int


class Points(NamedTuple):
    """The points of a scene in columns, by height in each."""

    plan: Plan
    start: NDArray[np.int32]
    """(c + 1,) first point of each column."""
    points: NDArray[np.float32]
    """(n, 3) [m]."""


class Levels(NamedTuple):
    """Where surfaces that face up or down cross each cell, by height in each."""

    plan: Plan
    start: NDArray[np.int32]
    """(c + 1,) first level of each cell."""
    surfaces: NDArray[np.float32]
    """(e, 2) height in the middle of the cell [m], and height of the unit normal."""


@dataclass(frozen=True, eq=False)
class PlacingField:
    """What the cloud of a scene says near its placing areas."""

    cloud: Cloud
    cell_m: float
    """Edge of the cells of the levels."""

    @cached_property
    def points(self) -> Points:
        """The points in columns."""
        return self._sorted[0]

    @cached_property
    def levels(self) -> Levels:
        """The surfaces that face up or down, over a finer floor plan."""
        points, normals = self._sorted
        shape = _shapes_of_surface(points.points, normals, points.start, points.plan)
        plan = _plan(points.points, self.cell_m)
        start = _count_levels(points.points, normals, shape, plan)
        surfaces = np.empty((start[-1], 2), np.float32)
        _fill_levels(points.points, normals, shape, plan, start, surfaces)
        return Levels(plan, *_merge_levels(start, surfaces))

    @cached_property
    def _sorted(self) -> tuple[Points, NDArray[np.float32]]:
        """The points in columns, and their normals in the same order."""
        points, plan = self.cloud.points, _plan(self.cloud.points, COLUMN_M)
        x = ((points[:, 0] - plan.x_m) / plan.cell_m).astype(np.int64)
        y = ((points[:, 1] - plan.y_m) / plan.cell_m).astype(np.int64)
        column = x * plan.n_y + y
        order = np.lexsort((points[:, 2], column))
        count = np.bincount(column, minlength=plan.n_x * plan.n_y)
        start = np.concatenate([[0], np.cumsum(count)]).astype(np.int32)
        held = Points(plan, start, points[order].astype(np.float32))
        return held, self.cloud.normals[order].astype(np.float32)


def _plan(points: NDArray, cell_m: float) -> Plan:
    """Return cells that cover the points, with an empty border."""
    low = points[:, :2].min(axis=0).astype(float) - 2 * cell_m
    high = points[:, :2].max(axis=0).astype(float) + 2 * cell_m
    n_x, n_y = (int(n) for n in np.ceil((high - low) / cell_m))
    return Plan(float(low[0]), float(low[1]), float(cell_m), 1 / cell_m, n_x, n_y)


@njit(cache=True)
def _shapes_of_surface(
    points: NDArray, normals: NDArray, start: NDArray, plan: Plan
) -> NDArray:
    """Return how far around each point its surface extends, xx xy yy, (n, 3) [m2].

    The covariance of its neighbours on the floor plan; 0 for points that face sideways.
    """
    shape = np.zeros((len(points), 3), np.float32)
    for p in range(len(points)):
        if abs(normals[p, 2]) <= STEEPEST:
            continue
        x, y, z = points[p]
        i, j = int((x - plan.x_m) / plan.cell_m), int((y - plan.y_m) / plan.cell_m)
        n, sums = 0.0, np.zeros(5)
        for column in range(9):
            at = (i + column // 3 - 1) * plan.n_y + j + column % 3 - 1
            # All columns have a border of empty ones.
            first = start[at] + np.searchsorted(
                points[start[at] : start[at + 1], 2], z - NEIGHBOR_M
            )
            for q in range(first, start[at + 1]):
                if points[q, 2] > z + NEIGHBOR_M:
                    break
                dx, dy, dz = points[q, 0] - x, points[q, 1] - y, points[q, 2] - z
                if (
                    dx * dx + dy * dy + dz * dz > NEIGHBOR_M**2
                    or normals[p, 2] * normals[q, 2] < 0.25
                ):
                    continue
                n += 1
                sums += np.array([dx, dy, dx * dx, dx * dy, dy * dy])
        sums /= n
        shape[p, 0] = sums[2] - sums[0] ** 2 + NARROWEST_M**2
        shape[p, 1] = sums[3] - sums[0] * sums[1]
        shape[p, 2] = sums[4] - sums[1] ** 2 + NARROWEST_M**2
    return shape


@njit(cache=True)
def _window(point: NDArray, plan: Plan) -> tuple[int, int, int, int]:
    """Return first and last cells that a point may be spread over."""
    x, y = point[0] - plan.x_m, point[1] - plan.y_m
    return (
        max(int((x - WIDEST_M) / plan.cell_m), 0),
        min(int((x + WIDEST_M) / plan.cell_m), plan.n_x - 1),
        max(int((y - WIDEST_M) / plan.cell_m), 0),
        min(int((y + WIDEST_M) / plan.cell_m), plan.n_y - 1),
    )


@njit(cache=True)
def _covers(point: NDArray, shape: NDArray, plan: Plan, i: int, j: int) -> bool:
    """Tell whether a point is spread over a cell."""
    dx = plan.x_m + (i + 0.5) * plan.cell_m - point[0]
    dy = plan.y_m + (j + 0.5) * plan.cell_m - point[1]
    if max(abs(dx), abs(dy)) <= plan.cell_m / 2:
        return True  # The cell that the point is in.
    det = shape[0] * shape[2] - shape[1] ** 2
    far = shape[2] * dx * dx - 2 * shape[1] * dx * dy + shape[0] * dy * dy
    return far <= SPREAD * det and dx * dx + dy * dy <= WIDEST_M**2


@njit(cache=True)
def _count_levels(
    points: NDArray, normals: NDArray, shape: NDArray, plan: Plan
) -> NDArray:
    """Return the first level of each cell and the end of the last, shape (c + 1,)."""
    count = np.zeros(plan.n_x * plan.n_y + 1, np.int64)
    for p in range(len(points)):
        if abs(normals[p, 2]) <= STEEPEST:
            continue
        i_first, i_last, j_first, j_last = _window(points[p], plan)
        for i in range(i_first, i_last + 1):
            for j in range(j_first, j_last + 1):
                if _covers(points[p], shape[p], plan, i, j):
                    count[i * plan.n_y + j + 1] += 1
    return np.cumsum(count)


@njit(cache=True)
def _fill_levels(
    points: NDArray,
    normals: NDArray,
    shape: NDArray,
    plan: Plan,
    start: NDArray,
    surfaces: NDArray,
) -> None:
    """Write height and rise of the levels of each cell in the order of height."""
    end = start[:-1].copy()
    for p in range(len(points)):
        if abs(normals[p, 2]) <= STEEPEST:
            continue
        i_first, i_last, j_first, j_last = _window(points[p], plan)
        for i in range(i_first, i_last + 1):
            for j in range(j_first, j_last + 1):
                if not _covers(points[p], shape[p], plan, i, j):
                    continue
                dx = plan.x_m + (i + 0.5) * plan.cell_m - points[p, 0]
                dy = plan.y_m + (j + 0.5) * plan.cell_m - points[p, 1]
                drop = (normals[p, 0] * dx + normals[p, 1] * dy) / normals[p, 2]
                at, c = points[p, 2] - drop, i * plan.n_y + j
                e = end[c]
                while e > start[c] and surfaces[e - 1, 0] > at:
                    surfaces[e] = surfaces[e - 1]
                    e -= 1
                surfaces[e, 0], surfaces[e, 1] = at, normals[p, 2]
                end[c] += 1


@njit(cache=True)
def _merge_levels(start: NDArray, surfaces: NDArray) -> tuple[NDArray, NDArray]:
    """Return the levels with those averaged that are close and face the same way."""
    new_start, merged = np.zeros(len(start), np.int32), np.empty_like(surfaces)
    m = 0
    weight = np.zeros(len(surfaces), np.float32)
    for c in range(len(start) - 1):
        latest = np.array([-1, -1])  # facing down, and up
        for e in range(start[c], start[c + 1]):
            z, rise = surfaces[e]
            way = 1 if rise > 0 else 0
            k = latest[way]
            if k >= 0 and z - merged[k, 0] <= MERGE_M:
                weight[k] += 1
                merged[k, 0] += (z - merged[k, 0]) / weight[k]
                merged[k, 1] += (rise - merged[k, 1]) / weight[k]
            else:
                merged[m, 0], merged[m, 1], weight[m] = z, rise, 1
                latest[way] = m
                m += 1
        new_start[c + 1] = m
    return new_start, merged[:m].copy()

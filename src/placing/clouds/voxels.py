"""Cells of a cubic grid: which points share one, and how many are around each.

Points are put in order by whole numbers that name their cells: what belongs to a cell
is a stretch of that order. All loops over points are compiled.

Letters for shapes: n points, m voxels and sides.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True)
def lowest(points: NDArray) -> NDArray:
    """Return the lower corner of the box around points, shape (3,) [m]."""
    low = points[0].copy()
    for p in range(len(points)):
        for k in range(3):
            low[k] = min(low[k], points[p, k])
    return low


@njit(cache=True)
def cell_keys(
    points: NDArray, low: NDArray, cell_m: float
) -> tuple[NDArray, tuple[int, int, int]]:
    """Return a number for the cell of each point (n,), and how many cells there are.

    Neighbours along z have successive numbers.
    """
    n = np.ones(3, np.int64)
    for p in range(len(points)):
        for k in range(3):
            n[k] = max(n[k], np.int64((points[p, k] - low[k]) / cell_m) + 1)
    n += 1  # An empty border: neighbours never wrap around.
    keys = np.empty(len(points), np.int64)
    for p in range(len(points)):
        x = np.int64((points[p, 0] - low[0]) / cell_m)
        y = np.int64((points[p, 1] - low[1]) / cell_m)
        z = np.int64((points[p, 2] - low[2]) / cell_m)
        keys[p] = (x * n[1] + y) * n[2] + z
    return keys, (n[0], n[1], n[2])


@njit(cache=True)
def add_sides(keys: NDArray, normals: NDArray) -> NDArray:
    """Return the numbers times 8 plus the side that each point faces, shape (n,).

    Sides are the six main directions, and one for points without normal.
    """
    sided = np.empty_like(keys)
    for p in range(len(keys)):
        axis = 0
        for k in range(1, 3):
            if abs(normals[p, k]) > abs(normals[p, axis]):
                axis = k
        along = normals[p, axis]
        side = 6 if along == 0 else 2 * axis + (1 if along > 0 else 0)
        sided[p] = keys[p] * 8 + side
    return sided


@njit(cache=True)
def average(
    keys: NDArray, order: NDArray, points: NDArray, normals: NDArray, colors: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """Return mean points, unit normals and colours of equal keys, each (m, 3)."""
    mean_points, mean_normals = np.empty_like(points), np.empty_like(normals)
    mean_colors = np.empty_like(colors)
    total = np.zeros((3, 3))
    m, first = 0, 0
    while first < len(order):
        total[:] = 0.0
        end = first
        while end < len(order) and keys[order[end]] == keys[order[first]]:
            p = order[end]
            for k in range(3):
                total[0, k] += points[p, k]
                total[1, k] += normals[p, k]
                total[2, k] += colors[p, k]
            end += 1
        length = np.sqrt(total[1, 0] ** 2 + total[1, 1] ** 2 + total[1, 2] ** 2)
        for k in range(3):
            mean_points[m, k] = total[0, k] / (end - first)
            mean_normals[m, k] = total[1, k] / length if length > 0 else 0.0
            mean_colors[m, k] = np.uint8(np.round(total[2, k] / (end - first)))
        m, first = m + 1, end
    return mean_points[:m], mean_normals[:m], mean_colors[:m]


@njit(cache=True)
def average_known(keys: NDArray, order: NDArray, values: NDArray) -> NDArray:
    """Return the means of the values of equal keys that are not NaN, shape (m,)."""
    mean = np.empty_like(values)
    m, first = 0, 0
    while first < len(order):
        total, n_known, end = 0.0, 0, first
        while end < len(order) and keys[order[end]] == keys[order[first]]:
            if not np.isnan(values[order[end]]):
                total += values[order[end]]
                n_known += 1
            end += 1
        mean[m] = total / n_known if n_known > 0 else np.nan
        m, first = m + 1, end
    return mean[:m]


@njit(cache=True)
def count_around(keys: NDArray, order: NDArray, shape: tuple[int, int, int]) -> NDArray:
    """Return how many points are in the cell of each and the 26 around, shape (n,)."""
    sorted_keys = keys[order]
    around = np.zeros(len(order), np.int64)
    for column in range(9):
        step = ((column // 3 - 1) * shape[1] + column % 3 - 1) * shape[2]
        first, end = 0, 0  # Of the three cells of that column; both only ever grow.
        for k in range(len(order)):
            middle = sorted_keys[k] + step
            while end < len(order) and sorted_keys[end] <= middle + 1:
                end += 1
            while first < end and sorted_keys[first] < middle - 1:
                first += 1
            around[order[k]] += end - first
    return around

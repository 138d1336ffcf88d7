"""Which of many things a recording keeps; the same ones in every run."""

import numpy as np
from numpy.typing import NDArray

from placing import seeds

FINEST_M = 0.025
"""Spacing below which a cloud is not worth looking at."""


def thin(n: int, n_kept: int) -> NDArray[np.int64]:
    """Return sorted indices of at most `n_kept` of `n` things drawn at random."""
    if n <= n_kept:
        return np.arange(n)
    return np.sort(seeds.generator(0, "thin").permutation(n)[:n_kept])


def voxel_means(
    points: NDArray[np.floating], values: NDArray[np.floating], n_kept: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return about `n_kept` points (m, 3), their values (m, v) and their spacing [m].

    Both are means over voxels, just so large that few enough are occupied.
    """
    # A first guess that rarely has to be widened: points are on surfaces.
    spacing = FINEST_M * np.clip(np.sqrt(len(points) / n_kept), 1, 2)
    axes = [column - column.min() for column in points.T.copy()]
    while True:
        voxel = _voxels(axes, spacing)
        counts = np.bincount(voxel)
        occupied = np.flatnonzero(counts)
        if len(occupied) <= n_kept:
            break
        spacing *= 1.02 * np.sqrt(len(occupied) / n_kept)
    # Sums over the occupied voxels only: a room is mostly air.
    rank = np.empty(len(counts), np.int64)
    rank[occupied] = np.arange(len(occupied))
    row = rank[voxel]
    sums = [np.bincount(row, column) for column in (*points.T, *values.T)]
    means = np.column_stack(sums) / counts[occupied, None]
    return means[:, :3], means[:, 3:], float(spacing)


def _voxels(axes: list[NDArray[np.float64]], spacing: float) -> NDArray[np.int64]:
    """Return the number of the voxel of each point, shape (n,), in the order x y z."""
    number = np.zeros(len(axes[0]), np.int64)
    for axis in axes:
        cell = (axis / axis.dtype.type(spacing)).astype(np.int32)
        number = number * (int(cell.max()) + 1) + cell
    return number


def evenly(values: NDArray[np.int64], n_kept: int) -> NDArray[np.int64]:
    """Return at most `n_kept` of `values` evenly, with the first and the last one."""
    rows = np.linspace(0, len(values) - 1, min(n_kept, len(values)))
    return values[rows.round().astype(int)]

"""Which of many things a recording keeps; the same ones in every run."""

import numpy as np
from numpy.typing import NDArray

from placing import seeds

FINEST_M = 0.025
"""Spacing below which a cloud is not worth looking at."""


def thin(n: int, n_kept: int) -> NDArray[np.int64]:
    """Return sorted indices of at most `n_kept` of `n` things drawn at random."""
    return np.sort(seeds.generator(0, "thin").permutation(n)[:n_kept])


def voxel_means(
    points: NDArray[np.float64], values: NDArray[np.float64], n_kept: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return about `n_kept` points (m, 3), their values (m, v) and their spacing [m].

    Both are means over voxels, just so large that few enough are occupied.
    """
    low, spacing = points.min(axis=0), FINEST_M
    while True:
        cells = np.floor((points - low) / spacing).astype(np.int64)
        keys = (cells[:, 0] << 42) + (cells[:, 1] << 21) + cells[:, 2]
        _, voxel, counts = np.unique(keys, return_inverse=True, return_counts=True)
        if len(counts) <= n_kept:
            break
        spacing *= 1.02 * np.sqrt(len(counts) / n_kept)  # points are on surfaces
    columns = np.column_stack([points, values]).T
    sums = [np.bincount(voxel, column) for column in columns]
    means = np.column_stack(sums) / counts[:, None]
    return means[:, :3], means[:, 3:], spacing


def evenly(values: NDArray[np.int64], n_kept: int) -> NDArray[np.int64]:
    """Return at most `n_kept` of `values` evenly, with the first and the last one."""
    rows = np.linspace(0, len(values) - 1, min(n_kept, len(values)))
    return values[rows.round().astype(int)]

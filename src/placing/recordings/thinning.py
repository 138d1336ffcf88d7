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
    # A first guess that rarely has to be widened: points are on surfaces.
    wider = np.clip(np.sqrt(len(points) / n_kept), 1, 2)
    low, spacing = points.min(axis=0), FINEST_M * wider
    while True:
        cells = np.floor((points - low) / spacing).astype(np.int64)
        spans = cells.max(axis=0) + 1
        flat = np.ravel_multi_index(cells.T, spans)
        counts = np.bincount(flat)
        occupied = np.flatnonzero(counts)
        if len(occupied) <= n_kept:
            break
        spacing *= 1.02 * np.sqrt(len(occupied) / n_kept)
    columns = np.column_stack([points, values]).T
    sums = [np.bincount(flat, column)[occupied] for column in columns]
    means = np.column_stack(sums) / counts[occupied, None]
    return means[:, :3], means[:, 3:], spacing


def evenly(values: NDArray[np.int64], n_kept: int) -> NDArray[np.int64]:
    """Return at most `n_kept` of `values` evenly, with the first and the last one."""
    rows = np.linspace(0, len(values) - 1, min(n_kept, len(values)))
    return values[rows.round().astype(int)]

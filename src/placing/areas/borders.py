"""Borders of a set of cells: closed rings along the edges of the cells.

A ring has the cells on its left, so the outer one is counter-clockwise and those of
holes are clockwise. Rings of a connected set may touch in corners, but never cross.

Letters for shapes: v corners.
"""

from itertools import pairwise

import numpy as np
from numba import njit
from numpy.typing import NDArray
from shapely import Polygon


def cover(mask: NDArray[np.bool_]) -> Polygon:
    """Return the polygon of a connected mask, cells as squares of width 1."""
    corners, start = _trace(np.pad(mask, 1))
    rings = [corners[a:b] - 1 for a, b in pairwise(start)]
    # Rings are found from the lowest row upward, so the outer one comes first.
    return Polygon(rings[0], rings[1:])


@njit(cache=True)
def _trace(mask: NDArray) -> tuple[NDArray, NDArray]:
    """Return the corners of all rings (v, 2) and where each ring starts and ends."""
    n_edges = 0
    is_new = np.zeros_like(mask)  # Cells whose lower edge no ring has yet.
    for i in range(1, mask.shape[0] - 1):
        for j in range(1, mask.shape[1] - 1):
            is_new[i, j] = mask[i, j] and not mask[i, j - 1]
            n_edges += is_new[i, j]
    # As many edges go back as forth, and each has two corners at most.
    corners = np.empty((4 * n_edges, 2), np.int64)
    start = np.zeros(n_edges + 1, np.int64)
    n_rings = 0
    for j in range(1, mask.shape[1] - 1):
        for i in range(1, mask.shape[0] - 1):
            if is_new[i, j]:
                n = _follow(mask, is_new, i, j, corners[start[n_rings] :])
                start[n_rings + 1] = start[n_rings] + n
                n_rings += 1
    return corners[: start[n_rings]], start[: n_rings + 1]


@njit(cache=True)
def _follow(mask: NDArray, is_new: NDArray, i: int, j: int, corners: NDArray) -> int:
    """Write the corners of the ring that holds the lower edge of a cell, count them."""
    first = (i, j)
    dx, dy, n = 1, 0, 0
    while True:
        if dx == 1:
            is_new[i, j] = False
        i, j = i + dx, j + dy
        # The cells ahead to the left and to the right of corner (i, j).
        left = mask[i + (dx - dy - 1) // 2, j + (dy + dx - 1) // 2]
        right = mask[i + (dx + dy - 1) // 2, j + (dy - dx - 1) // 2]
        if right or not left:
            corners[n] = i, j
            n += 1
            # Cells that touch in a corner are one: the outer ring walks around both.
            dx, dy = (dy, -dx) if right else (-dy, dx)
        if (i, j) == first and (dx, dy) == (1, 0):
            return n

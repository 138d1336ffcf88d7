"""Sets of cells as masks: closing small gaps, and what is wide enough to keep.

Cells beyond a mask count as set wherever a whole square is asked for.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import ndimage


def close(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the mask with the gaps filled that hold no square of 3 cells."""
    return erode(~erode(~mask, 3), 3)


def keep_wide(mask: NDArray[np.bool_], n_cells: int) -> NDArray[np.bool_]:
    """Return the connected parts of a mask that hold a square of cells."""
    parts, n_parts = ndimage.label(mask)
    is_wide = np.zeros(n_parts + 1, bool)
    is_wide[parts[erode(mask, n_cells)]] = True
    return is_wide[parts]


@njit(cache=True)
def erode(mask: NDArray, n_cells: int) -> NDArray:
    """Return the middles of the squares of cells that are all set."""
    n_x, n_y = mask.shape
    total = np.zeros((n_x + 1, n_y + 1), np.int64)  # Of all cells to the lower left.
    for i in range(n_x):
        for j in range(n_y):
            before = total[i, j + 1] + total[i + 1, j] - total[i, j]
            total[i + 1, j + 1] = before + mask[i, j]
    is_middle = np.zeros((n_x, n_y), np.bool_)
    half = n_cells // 2
    for i in range(n_x):
        a, b = max(0, i - half), min(n_x, i - half + n_cells)
        for j in range(n_y):
            c, d = max(0, j - half), min(n_y, j - half + n_cells)
            inside = total[b, d] - total[a, d] - total[b, c] + total[a, c]
            is_middle[i, j] = mask[i, j] and inside == (b - a) * (d - c)
    return is_middle

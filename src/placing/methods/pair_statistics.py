"""Where the objects of an arrangement lie in the frames of each other, added up.

Shapes: n objects.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from placing.learning.fitting import STATISTICS
from placing.people.potential import MIN_DISTANCE_M

Array = NDArray[np.float64]

NO_PAIRS = np.zeros(len(STATISTICS))
"""The sums of `fitting.STATISTICS` over no pair at all."""


def pair_sums(
    categories: Sequence[str], location: Array, yaw: Array
) -> dict[tuple[str, str], Array]:
    """Return the sums of `fitting.STATISTICS` by wanted and given category, (10,) each.

    `location` (n, 3) of the centres, `yaw` (n,) NaN for an object without a front.
    """
    table = _pair_statistics(location, yaw)
    sums: dict[tuple[str, str], Array] = {}
    for i, wanted in enumerate(categories):
        # ASSUME: of several given objects of a category the nearest one matters: a
        # mouse lies beside its own keyboard, wherever there are others.
        away = np.linalg.norm(location - location[i], axis=1)
        nearest: dict[str, int] = {}
        for j in map(int, np.argsort(away, kind="stable")):
            if j != i:
                nearest.setdefault(categories[j], j)
        for given, j in nearest.items():
            total = sums.get((wanted, given), NO_PAIRS)
            sums[wanted, given] = total + table[i, j]
    return sums


def _pair_statistics(location: Array, yaw: Array) -> Array:
    """Return `fitting.STATISTICS` of each object seen from each other, (n, n, 10)."""
    dx, dy, height = np.moveaxis(location[:, None] - location[None], 2, 0)  # (n, n)
    distance = np.maximum(np.hypot(dx, dy), MIN_DISTANCE_M)
    log_d, ones = np.log(distance), np.ones_like(distance)
    front = np.exp(-1j * yaw)  # (n,) turns into the frame of the object
    bearing = np.nan_to_num((dx + 1j * dy) / distance * front)
    orientation = np.conj(front)[:, None] * front
    has_both = ~np.isnan(orientation)
    orientation = np.nan_to_num(orientation)
    columns = [
        *(ones, log_d, log_d**2, np.real(bearing), np.imag(bearing), height, height**2),
        *(has_both, np.real(orientation), np.imag(orientation)),
    ]
    return np.stack(columns, -1)

"""Regions of places that hold a labelled object with a stated probability.

Split conformal prediction (Vovk, Gammerman and Shafer, 2005): the rank of a place is
the mass of the places at least as dense. Ranks of labelled objects in training scenes,
under models that have not seen these scenes, tell how high a rank must be allowed for
a region to hold a labelled object with a stated probability, whatever is wrong with
the density, as long as training and test scenes are exchangeable.

Shapes: p places, k of them, l levels, n calibration ranks.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

REGION_LEVELS = (0.5, 0.8, 0.9)
"""Stated probabilities of the regions whose areas are written."""

TOLERANCE = 1e-6
"""Rounding that ranks are allowed: files hold six decimals."""


def ranks_of(density: Array, places: ArrayLike) -> Array:
    """Return the mass of the places at least as dense as each of `places`, 0 to 1.

    The shape is that of `places`, indices. Places that are just as dense count in full,
    so that a region holds all or none of them: the less a method tells places apart,
    the larger are its regions.
    """
    values, at = np.asarray(density, float), np.asarray(places)
    masses = [values[values >= values[place]].sum() for place in at.ravel()]
    share = np.array(masses, float) / max(values.sum(), 1e-300)
    return np.clip(share, 0, 1).reshape(at.shape)


def calibrate(ranks: Array, levels: Sequence[float] | Array) -> Array:
    """Return the highest rank in the region of each level, shape (l,).

    It is the calibration rank number ceil((n + 1) * level), so that a new rank is at
    most as high with at least the probability `level`; 1, the rank of the whole set,
    where there are too few calibration ranks to tell.
    """
    ordered = np.append(np.sort(ranks), 1.0)
    number = np.ceil((len(ranks) + 1) * np.asarray(levels) - TOLERANCE).astype(int)
    return ordered[np.clip(number, 1, len(ordered)) - 1]


def region_areas(density: Array, thresholds: Array, spacing_m: float) -> Array:
    """Return the area of the region of each threshold, shape (l,), in m²."""
    falling = np.sort(np.asarray(density, float))[::-1]
    mass = np.cumsum(falling)
    limits = np.asarray(thresholds, float) + TOLERANCE
    n = np.searchsorted(mass, limits * max(mass[-1], 1e-300), side="right")
    # A region that would end between equal densities ends before the first of them.
    following = falling[np.minimum(n, len(falling) - 1)]
    first = np.searchsorted(-falling, -following, side="left")
    n = np.where(limits >= 1, len(falling), np.minimum(n, first))
    return n * spacing_m**2

"""Averages over categories and scenes, and how far they would be elsewhere.

Every category counts once, every scene that has it counts once within it. Leaving one
scene out gives the standard error of an average, drawing scenes with replacement the
interval of a difference; both are averages in which scenes have other weights.

Shapes: c categories, s scenes, b sets of weights.
"""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]

N_RESAMPLES = 10_000
LEVEL = 0.95
"""Share of the resamples inside an interval."""


def average(values: Array, weights: Array) -> Array:
    """Return the mean over categories of the weighted means over scenes, shape (b,).

    `values` (c, s) are NaN where a scene lacks a category; `weights` (b, s). A category
    of which no scene has weight is left out.
    """
    known = np.isfinite(values)
    count = weights @ known.T.astype(float)  # (b, c)
    total = weights @ np.where(known, values, 0.0).T
    has_any = count > 0
    means = np.divide(total, count, out=np.zeros_like(total), where=has_any)
    n = has_any.sum(1)
    return np.divide(means.sum(1), n, out=np.full(len(n), np.nan), where=n > 0)


def mean_of(values: Array) -> float:
    """Return the average with every scene at weight 1."""
    return float(average(values, np.ones((1, values.shape[1])))[0])


def jackknife_se(values: Array) -> float:
    """Return the standard error of the average over the scenes that have any value."""
    values = values[:, np.isfinite(values).any(0)]
    n = values.shape[1]
    if n < 2:
        return np.nan
    left_out = average(values, 1 - np.eye(n))
    return float(np.sqrt((n - 1) * left_out.var()))


def resamples(rng: Generator, n_scenes: int, n: int = N_RESAMPLES) -> Array:
    """Return how often each scene is drawn in each resample, shape (n, s)."""
    share = np.full(n_scenes, 1 / n_scenes)
    return rng.multinomial(n_scenes, share, size=n).astype(float)


@dataclass(frozen=True)
class Side:
    """One side of a comparison: its average, also in every resample of the scenes."""

    mean: float
    resampled: Array
    """(b,)"""
    has_any: NDArray[np.bool_]
    """(s,) whether a scene has a value."""

    @staticmethod
    def of(values: Array, weights: Array) -> "Side":
        """Return the side with the values (c, s), resampled by weights (b, s)."""
        has_any = np.asarray(np.isfinite(values).any(0))
        return Side(mean_of(values), average(values, weights), has_any)


def difference(one: Side, other: Side) -> tuple[float, float, float]:
    """Return the difference of two averages and the ends of its interval.

    Both sides are resampled by the same weights over the same scenes, so that what
    makes a scene hard for both cancels. With fewer than two scenes there is no
    interval.
    """
    found = one.mean - other.mean
    if (one.has_any & other.has_any).sum() < 2:
        return found, np.nan, np.nan
    outside = (1 - LEVEL) / 2
    spread = one.resampled - other.resampled
    low, high = np.nanquantile(spread, [outside, 1 - outside])
    return found, float(low), float(high)

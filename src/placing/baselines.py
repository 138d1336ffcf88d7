"""Methods without humans: chance, learned heights, learned places in the room.

A baseline learns how often a category lies in each bin of some features of a place and
gives every place its bin's share divided by the number of places in that bin; `chance`
has a single bin. They answer with a density over the same places as every method.

ASSUME: the paper names six baselines and explains few; `height` and `room` are our
reading of "using height" and of a position relative to the room.

Shapes: p places, b bins.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from placing.candidates import Candidates

Array = NDArray[np.float64]

FEATURES_OF = {"height": ("height_m",), "room": ("height_m", "wall_distance_m")}
"""The features of a place that each learned baseline looks at."""


@dataclass(frozen=True)
class BaselinesConfig:
    """Bins and smoothing of the baselines; the values live in `config/config.yaml`."""

    height_bin_m: float
    height_sigma_m: float
    wall_bin_m: float
    wall_sigma_m: float
    max_m: float
    """Upper end of the last bin; what lies beyond counts into it."""
    prior_strength: float
    """How many objects the histogram of all categories counts for in each."""


def learn_histograms(
    values: Mapping[str, Array], method: str, config: BaselinesConfig
) -> dict[str, Array]:
    """Return the share of every bin for each category; `values` (n, f) per category."""
    counts = {name: _histogram(v, method, config) for name, v in values.items()}
    common = sum(counts.values()) / max(sum(len(v) for v in values.values()), 1)
    smooth = {}
    for name, count in counts.items():
        count = count + config.prior_strength * common
        sigma = [s / b for s, b in zip(*_scales(method, config), strict=True)]
        blurred = gaussian_filter(count, sigma, mode="nearest")
        smooth[name] = blurred / blurred.sum()
    return smooth


def histogram_density(
    histogram: Array, candidates: Candidates, method: str, config: BaselinesConfig
) -> Array:
    """Return the density of a category over the places, shape (p,), sum 1."""
    values = np.column_stack([candidates.feature(f) for f in FEATURES_OF[method]])
    bins = _bins(values, method, config)
    n_places = np.zeros(histogram.shape)
    np.add.at(n_places, bins, 1.0)
    density = histogram[bins] / n_places[bins]
    return density / max(density.sum(), 1e-300)  # guards bins never seen in training


def chance_density(candidates: Candidates) -> Array:
    """Return the uniform density over the places, shape (p,)."""
    return np.full(len(candidates.location), 1 / max(len(candidates.location), 1))


def _histogram(values: Array, method: str, config: BaselinesConfig) -> Array:
    """Return how many of `values` (n, f) lie in each bin."""
    bins = [round(config.max_m / b) for b in _scales(method, config)[1]]
    count = np.zeros(bins)
    np.add.at(count, _bins(values, method, config), 1.0)
    return count


def _bins(
    values: Array, method: str, config: BaselinesConfig
) -> tuple[NDArray[np.int64], ...]:
    """Return the bin of each value, one index array per feature."""
    widths = np.array(_scales(method, config)[1])
    last = np.round(config.max_m / widths).astype(np.int64) - 1
    cells = np.clip(np.floor(values / widths).astype(np.int64), 0, last)
    return tuple(cells.T)


def _scales(method: str, config: BaselinesConfig) -> tuple[list[float], list[float]]:
    """Return the smoothing and the bin width of each feature [m]."""
    both = [
        (config.height_sigma_m, config.height_bin_m),
        (config.wall_sigma_m, config.wall_bin_m),
    ][: len(FEATURES_OF[method])]
    return [sigma for sigma, _ in both], [width for _, width in both]

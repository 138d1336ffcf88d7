"""Methods without humans or other objects: chance, heights, rooms and placing areas.

A baseline learns how often a category lies in each bin of some features of a place and
gives every place its bin's share divided by the number of places in that bin; `chance`
has a single bin. They answer with a density over the same places as every method.

ASSUME: the paper names six baselines and explains few. `height` and `room` are our
reading of "using height" and of a position relative to the room; `area` is the
semantics of object and placing area (Section 3.1) from geometry alone.
ASSUME: of ten sets of features of `area`, and of products of one histogram per feature,
these three together have the largest held-out likelihood on the training folds of
`rooms`, whichever fold is held out.

Shapes: p places, b bins.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from placing.candidates import Candidates

Array = NDArray[np.float64]

FEATURES_OF = {
    "height": ("height_m",),
    "room": ("height_m", "wall_distance_m"),
    "area": ("height_m", "extent_doublings", "edge_distance_m"),
}
"""The features of a place that each learned baseline looks at."""
MIN_EXTENT_M2 = 0.01
"""Extent of a placing area from which its doublings count."""


@dataclass(frozen=True)
class BaselinesConfig:
    """Bins and smoothing of the baselines; the values live in `config/config.yaml`."""

    height_bin_m: float
    height_sigma_m: float
    wall_bin_m: float
    wall_sigma_m: float
    max_m: float
    """Upper end of the last bin of both; what lies beyond counts into it."""
    prior_strength: float
    """How many objects the histogram of all categories counts for in each."""
    extent_bin_doublings: float
    extent_sigma_doublings: float
    max_doublings: float
    """Upper end of the last bin of extents."""
    edge_bin_m: float
    edge_sigma_m: float
    max_edge_m: float
    """Upper end of the last bin of distances to the edge."""


def place_features(candidates: Candidates, method: str) -> Array:
    """Return the features of the places that a baseline looks at, shape (p, f)."""
    columns = [
        _extent_doublings(candidates)
        if name == "extent_doublings"
        else candidates.feature(name)
        for name in FEATURES_OF[method]
    ]
    return np.column_stack(columns)


def learn_histograms(
    values: Mapping[str, Array], method: str, config: BaselinesConfig
) -> dict[str, Array]:
    """Return the share of every bin for each category; `values` (n, f) per category."""
    counts = {name: _histogram(v, method, config) for name, v in values.items()}
    common = sum(counts.values()) / max(sum(len(v) for v in values.values()), 1)
    smooth = {}
    for name, count in counts.items():
        blurred = _smooth(count + config.prior_strength * common, method, config)
        smooth[name] = blurred / blurred.sum()
    return smooth


def histogram_density(
    histogram: Array, candidates: Candidates, method: str, config: BaselinesConfig
) -> Array:
    """Return the density of a category over the places, shape (p,), sum 1."""
    bins = _bins(place_features(candidates, method), method, config)
    n_places = np.zeros(histogram.shape)
    np.add.at(n_places, bins, 1.0)
    # Places are smoothed as objects were, or bins with few places would gain.
    density = histogram[bins] / _smooth(n_places, method, config)[bins]
    return density / max(density.sum(), 1e-300)  # guards bins never seen in training


def chance_density(candidates: Candidates) -> Array:
    """Return the uniform density over the places, shape (p,)."""
    return np.full(len(candidates.location), 1 / max(len(candidates.location), 1))


def _extent_doublings(candidates: Candidates) -> Array:
    """Return how often `MIN_EXTENT_M2` doubles to the extent of an area, shape (p,)."""
    if len(candidates.area) == 0:
        return np.empty(0)
    coordinates = np.unique(np.round(candidates.location[:, :2], 6))
    gaps = np.diff(coordinates)
    spacing_m = gaps.min() if len(gaps) else np.sqrt(MIN_EXTENT_M2)
    extent_m2 = np.bincount(candidates.area)[candidates.area] * spacing_m**2
    return np.log2(np.maximum(extent_m2 / MIN_EXTENT_M2, 1.0))


def _histogram(values: Array, method: str, config: BaselinesConfig) -> Array:
    """Return how many of `values` (n, f) lie in each bin."""
    count = np.zeros([n for _, _, n in _scales(method, config)])
    np.add.at(count, _bins(values, method, config), 1.0)
    return count


def _smooth(count: Array, method: str, config: BaselinesConfig) -> Array:
    """Return a histogram smoothed over its bins, same shape."""
    sigmas = [sigma / width for sigma, width, _ in _scales(method, config)]
    return gaussian_filter(count, sigmas, mode="nearest")


def _bins(
    values: Array, method: str, config: BaselinesConfig
) -> tuple[NDArray[np.int64], ...]:
    """Return the bin of each value, one index array per feature."""
    scales = _scales(method, config)
    widths, n_bins = np.array([w for _, w, _ in scales]), [n for *_, n in scales]
    cells = np.floor(values / widths).astype(np.int64)
    return tuple(np.clip(cells, 0, np.array(n_bins) - 1).T)


def _scales(method: str, config: BaselinesConfig) -> list[tuple[float, float, int]]:
    """Return smoothing and width of the bins and their number, for each feature."""
    c = config
    scales = {
        "height_m": (c.height_sigma_m, c.height_bin_m, c.max_m),
        "wall_distance_m": (c.wall_sigma_m, c.wall_bin_m, c.max_m),
        "extent_doublings": (
            c.extent_sigma_doublings,
            c.extent_bin_doublings,
            c.max_doublings,
        ),
        "edge_distance_m": (c.edge_sigma_m, c.edge_bin_m, c.max_edge_m),
    }
    return [
        (sigma, width, max(round(last / width), 1))
        for sigma, width, last in (scales[name] for name in FEATURES_OF[method])
    ]

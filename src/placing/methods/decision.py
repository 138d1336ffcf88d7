"""From a density over places to placements: the mode of the smoothed density.

ASSUME: the paper asks for the arrangement of largest likelihood without saying how a
place is chosen; the mode after smoothing by about the size of an object is the best of
the rules tried, and objects of one category keep a distance from each other.

Shapes: p places.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.random import Generator
from numpy.typing import NDArray

from placing.candidates import Candidates

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DecisionConfig:
    """Settings of the choice of a place; the values live in `config/config.yaml`."""

    smoothing_m: float
    """Standard deviation of the Gaussian on each placing area."""
    min_distance_m: float
    """Between the centres of two objects of one category."""


class Smoother:
    """Gaussian smoothing of a density on each placing area of a scene."""

    def __init__(
        self, candidates: Candidates, spacing_m: float, sigma_m: float
    ) -> None:
        """Lay out the places of each area on a grid of its own."""
        steps = np.arange(-round(3 * sigma_m / spacing_m), 1) * spacing_m / sigma_m
        self._kernel = np.exp(-0.5 * steps**2)  # its left half and the middle
        self._grids = []
        cells = np.round(candidates.location[:, :2] / spacing_m).astype(np.int64)
        for area in np.unique(candidates.area):
            of_area = np.flatnonzero(candidates.area == area)
            at = cells[of_area] - cells[of_area].min(0)
            mask = np.zeros(at.max(0) + 1)
            mask[tuple(at.T)] = 1.0
            share = _blur(mask, self._kernel)[tuple(at.T)]
            self._grids.append((of_area, tuple(at.T), mask.shape, share))

    def __call__(self, density: Array) -> Array:
        """Return the density averaged over its surroundings on the same area, (p,)."""
        smooth = np.zeros_like(density)
        for of_area, at, shape, share in self._grids:
            if not density[of_area].any():
                continue
            grid = np.zeros(shape)
            grid[at] = density[of_area]
            smooth[of_area] = _blur(grid, self._kernel)[at] / share
        return smooth


def choose_places(
    rng: Generator,
    smooth: Array,
    feasible: list[NDArray[np.bool_]],
    candidates: Candidates,
    config: DecisionConfig,
) -> list[int | None]:
    """Return a place for each object of one category, None where none is left.

    `smooth` (p,) smoothed density; `feasible` per object, which places it fits.
    """
    is_left = np.ones(len(smooth), np.bool_)
    chosen: list[int | None] = []
    for fits in feasible:
        place = _mode(rng, smooth, fits & is_left)
        chosen.append(place)
        if place is not None:
            offset = candidates.location - candidates.location[place]
            is_left &= np.linalg.norm(offset, axis=1) >= config.min_distance_m
    return chosen


def _mode(rng: Generator, smooth: Array, allowed: NDArray[np.bool_]) -> int | None:
    """Return the allowed place of highest density; ties are drawn, as in `chance`."""
    if not allowed.any():
        return None
    highest = smooth[allowed].max()
    ties = np.flatnonzero(allowed & (smooth >= highest * (1 - 1e-9)))
    return int(rng.choice(ties))


@njit(cache=True)
def _blur(grid, kernel):  # noqa: ANN001, ANN202
    """Return a grid convolved with a symmetric kernel along x, then along y.

    SciPy's filter takes longer to be called than small areas take to be filtered.
    """
    half = len(kernel) - 1
    for _ in range(2):
        blurred = np.zeros_like(grid)
        for i in range(grid.shape[0]):
            for k in range(max(0, i - half), min(grid.shape[0], i + half + 1)):
                share = kernel[half - abs(i - k)]
                for j in range(grid.shape[1]):
                    blurred[i, j] += share * grid[k, j]
        grid = blurred.T.copy()
    return grid

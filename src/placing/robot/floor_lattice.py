"""The lattice of base poses on a floor, and which of them are neighbours.

Letters: n poses of the lattice, e edges.
"""

import numpy as np
from numpy.typing import NDArray

from placing.rigid import Array
from placing.robot.checker import SceneChecker
from placing.robot.planning import PlanningConfig

Ints = NDArray[np.int64]

STEPS = ((1, 0), (0, 1), (1, 1), (1, -1))
"""Cells to half of the neighbours at one heading; the others are their own."""


def grid(
    checker: SceneChecker, config: PlanningConfig
) -> tuple[tuple[int, int, int], Array]:
    """Return the numbers of cells and headings, and the first cell's centre (2,)."""
    field = checker.field
    size_m = np.array(field.distance_m.shape[:2]) * field.cell_m
    nx, ny = np.maximum(1, np.ceil(size_m / config.floor_cell_m)).astype(int)
    return (int(nx), int(ny), config.n_headings), field.origin_m[:2].copy()


def poses(
    shape: tuple[int, int, int], origin_m: Array, config: PlanningConfig
) -> Array:
    """Return the poses of the lattice, by x, then y, then heading, shape (n, 3)."""
    i, j, k = (axis.ravel() for axis in np.indices(shape))
    xy = origin_m + np.column_stack([i, j]) * config.floor_cell_m
    return np.column_stack([xy, 2 * np.pi * k / config.n_headings])


def pairs(shape: tuple[int, int, int]) -> Ints:
    """Return the neighbours of the lattice, each pair once, shape (e, 2)."""
    number = np.arange(np.prod(shape)).reshape(shape)
    pairs = [(number, np.roll(number, -1, axis=2))]
    for di, dj in STEPS:
        low, high = max(0, -dj), shape[1] - max(0, dj)
        here = number[: shape[0] - di, low:high]
        there = number[di:, low + dj : high + dj]
        pairs.append((here, there))
    return np.concatenate([np.column_stack([a.ravel(), b.ravel()]) for a, b in pairs])

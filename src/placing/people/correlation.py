"""Correlations of the planar part of Psi_loc with poses and places on the lattice.

Sums over places go through cumulative sums of the kernel, block by block; sums over
poses go through Fourier transforms, since they are wanted at every place. The height
factor, the only part that ties levels to poses, is separated into few products of a
function of the level and one of the pose.

Shapes: p places, q poses, u sites, m blocks, g groups of blocks, l levels, k products,
a headings, f phases, (x, y) the size of the transforms.
"""

from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import fft

from placing.people.lattice import Lattice
from placing.people.potential import Theta, planar_table

Array = NDArray[np.float64]


NEGLIGIBLE = 1e-12
"""What a site gives to a level, relative to the most, that is left out of a sum."""


@lru_cache(maxsize=64)
def cumulative_table(
    theta: Theta, spacing_m: float, radius_m: float, n_headings: int
) -> Array:
    """Return the sums of `planar_table` below both indices, shape (a, w + 1, w + 1)."""
    table = planar_table(theta, spacing_m, radius_m, n_headings)
    sums = np.zeros(table.shape + np.array([0, 1, 1]))
    sums[:, 1:, 1:] = table.cumsum(1, np.float64).cumsum(2)
    return sums


@njit(cache=True)
def sum_blocks(sums, sites, blocks, n_groups):  # noqa: ANN001, ANN201
    """Return the kernel of each site summed over each group of places, shape (u, g).

    Short and unsigned integers halve its time: no index can then count from the end.
    """
    width = np.int32(sums.shape[1] - 1)
    half = width // 2
    total = np.zeros((len(sites), n_groups))
    for s in range(len(sites)):
        below, to = sums[sites[s, 0]], total[s]
        x, y = np.int32(half - sites[s, 1]), np.int32(half - sites[s, 2])
        for m in range(len(blocks)):
            x0 = np.uint32(min(max(blocks[m, 0] + x, 0), width))
            x1 = np.uint32(min(max(blocks[m, 1] + x, 0), width))
            y0 = np.uint32(min(max(blocks[m, 2] + y, 0), width))
            y1 = np.uint32(min(max(blocks[m, 3] + y, 0), width))
            inside = (below[x1, y1] - below[x0, y1]) - (below[x1, y0] - below[x0, y0])
            to[np.uint32(blocks[m, 4])] += inside
    return np.maximum(total, 0)


@lru_cache(maxsize=24)
def kernel_transform(
    theta: Theta,
    spacing_m: float,
    stride: int,
    radius_m: float,
    n_headings: int,
    size: tuple[int, int],
) -> NDArray[np.complex128]:
    """Return the transforms of the planar part of Psi_loc, shape (f, a, x, y // 2 + 1).

    Phase (i, j) holds the displacements (i, j) beyond a multiple of `stride` cells. The
    transforms are kept, as all scenes of a fold share them: do not write to them.
    """
    table = planar_table(theta, spacing_m, radius_m, n_headings)
    half = table.shape[1] // 2
    grid = np.zeros((stride, stride, n_headings, *size))
    for i, j in np.ndindex(stride, stride):
        x, from_x = _window(half, stride, i, size[0])
        y, from_y = _window(half, stride, j, size[1])
        grid[i, j][:, x[:, None], y] = table[:, from_x[:, None], from_y]
    return fft.rfft2(grid.reshape(-1, n_headings, *size), workers=1)


def _window(
    half: int, stride: int, phase: int, size: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return indices of a phase's displacements in the transform and in the table."""
    steps = np.arange(-((size - 1) // 2), (size - 1) // 2 + 1)
    at = steps * stride + phase + half
    is_inside = (at >= 0) & (at <= 2 * half)
    return steps[is_inside] % size, at[is_inside]


def separate(height: Array, tolerance: float) -> tuple[Array, Array]:
    """Return factors (l, k) and (k, n) whose product is `height` (l, n).

    `tolerance` is what an entry may be off, relative to the largest one.
    Crosses through the largest entry of what is left are taken off until nothing is:
    the height factor is smooth, so that few of them do (adaptive cross approximation).
    """
    rest, left, right = height.copy(), [], []
    floor = tolerance * rest.max(initial=0.0)
    while (largest := np.abs(rest).max(initial=0.0)) > floor and largest > 0:
        i, j = np.unravel_index(np.argmax(np.abs(rest)), rest.shape)
        left.append(rest[:, j] / rest[i, j])
        right.append(rest[i].copy())
        rest -= np.outer(left[-1], right[-1])
    shape = len(left), *height.shape
    return np.reshape(left, shape[:2]).T, np.reshape(right, (shape[0], shape[2]))


def spread(
    lattice: Lattice,
    kernel: NDArray[np.complex128],
    factors: tuple[Array, Array],
    value: Array,
) -> Array:
    """Return the sum over poses of value (q,) times Psi_loc at every place, shape (p,).

    `factors` as returned by `separate` for the levels and references of the lattice.
    """
    of_level, of_reference = factors
    span, size = lattice.span, lattice.size
    n_grid = lattice.n_headings * span[0] * span[1]
    cells = lattice.site_at[lattice.site]
    grids = [
        np.bincount(cells, value * factor[lattice.reference], n_grid)
        for factor in of_reference
    ]
    shape = len(grids), lattice.n_headings, *span
    grid = np.reshape(grids, shape)
    # Most of a grid is padding: its rows are left out where all of them are zero.
    waves = fft.fft(fft.rfft(grid, size[1], workers=1), size[0], axis=2, workers=1)
    waves = fft.ifft(_mix(kernel, waves), axis=2, workers=1)[:, :, : span[0]]
    spread_out = fft.irfft(waves, size[1], workers=1)  # (k, f, x, y)
    return _gather(spread_out, lattice.phase, lattice.at, lattice.level, of_level)


@njit(cache=True)
def spread_runs(table, sites, gain, runs, stride, n_places):  # noqa: ANN001, ANN201
    """Return the sum over sites of gain (u, l) times the kernel at every place, (p,).

    `sites` (u, 3) heading, x and y; `runs` of places as `Lattice` lays them out.
    """
    found = np.zeros(n_places)
    width = table.shape[1]
    floor = NEGLIGIBLE * gain.max() if gain.size else 0.0
    for s in range(len(sites)):
        planar = table[sites[s, 0]]
        x0 = width // 2 - sites[s, 1] * stride
        y0 = width // 2 - sites[s, 2] * stride
        for m in range(len(runs)):
            factor, x, y = gain[s, runs[m, 4]], runs[m, 2] + x0, runs[m, 3] + y0
            if factor > floor and 0 <= x < width:
                low, high, row = max(0, -y), min(runs[m, 1], width - y), planar[x]
                # Unsigned integers: no index can count from the end.
                at, to = np.uint64(y + low), np.uint64(runs[m, 0] + low)
                for j in range(np.uint64(max(0, high - low))):
                    found[to + j] += factor * row[at + j]
    return found


@njit(cache=True)
def _mix(kernel, waves):  # noqa: ANN001, ANN202
    """Return the sums over headings of kernel times waves, shape (k, f, x, y).

    Row by row, so that a row of all of them stays in the cache.
    """
    n_phases, n_headings, n_x, n_y = kernel.shape
    mixed = np.zeros((len(waves), n_phases, n_x, n_y), np.complex128)
    for i in range(n_x):
        for f in range(n_phases):
            for k in range(len(waves)):
                total = mixed[k, f, i]
                for a in range(n_headings):
                    factor, wave = kernel[f, a, i], waves[k, a, i]
                    for j in range(n_y):
                        total[j] += factor[j] * wave[j]
    return mixed


@njit(cache=True)
def _gather(grids, phase, at, level, of_level):  # noqa: ANN001, ANN202
    """Return the sum of the products at each place, shape (p,)."""
    found = np.zeros(len(at))
    for k in range(len(grids)):
        for p in range(len(at)):
            here = grids[k, phase[p], at[p, 0], at[p, 1]]
            found[p] += of_level[level[p], k] * here
    return found

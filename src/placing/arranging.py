"""Where an object goes, given sampled human poses: the density of its placement.

With the placements of wanted objects summed out, the row of a wanted object is
Z(h) = sum over places of Psi_loc(place, h), and the density of its placement is read
off the sampled poses afterwards (Rao-Blackwell):

    p(place) = sum_h w(h) Psi_loc(place, h) / Z(h)

with w(h) the share of samples in which the object picked pose h.

Shapes: p places, q valid poses.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.human import HumanPoses
from placing.potential import Theta, height_factor, log_psi_ori, planar_table

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ArrangingConfig:
    """Settings of the density; the values live in `config/config.yaml`."""

    radius_m: float
    """An object further than this from a person is not used by that person."""
    row_spacing_m: float
    """Lattice on which Z(h) adds up places; places and poses lie on multiples of it."""


class UseOfObject:
    """Psi_loc of one category between the places and the human poses of a scene."""

    def __init__(
        self,
        theta: Theta,
        candidates: Candidates,
        poses: HumanPoses,
        spacing_m: float,
        half_height_m: float,
        config: ArrangingConfig,
    ) -> None:
        """Keep places and poses as cells of the lattice that both lie on.

        `half_height_m` lifts the centre of the object above its place.
        """
        self.theta, self.poses = theta, poses
        self._spacing, self._config = spacing_m, config
        self._cells = _cells(candidates.location, spacing_m)
        self._pose_cells = _cells(poses.location, spacing_m)
        self._n_headings = _n_headings(poses.yaw)
        turn = poses.yaw / (2 * np.pi) * self._n_headings
        self._heading = np.round(turn).astype(np.int64)
        self._table = self._table_of(spacing_m)
        levels, self._level = np.unique(candidates.location[:, 2], return_inverse=True)
        z, self._reference = np.unique(poses.references()[:, 2], return_inverse=True)
        self._height = height_factor(theta, levels + half_height_m, z)

    def row(self) -> Array:
        """Return Z of every pose up to a common factor, shape (q,).

        Places above each other share a cell, weighted by their heights.
        """
        stride = round(self._config.row_spacing_m / self._spacing)
        kept = (self._cells % stride == 0).all(1)
        cells, level = self._cells[kept] // stride, self._level[kept]
        if len(cells) == 0 or (self._pose_cells % stride).any():
            raise ValueError("places and poses must lie on multiples of row_spacing_m")
        low, spans = cells.min(0), np.ptp(cells, axis=0) + 1
        flat = np.ravel_multi_index((cells - low).T, spans)
        grids = np.stack(
            [np.bincount(flat, w[level], spans.prod()) for w in self._height.T]
        )
        return _add_up(
            self._table_of(self._config.row_spacing_m),
            grids.reshape(-1, *spans).astype(np.float32),
            self._pose_cells // stride - low,
            self._heading,
            self._reference,
        )

    def density(self, weight: Array, row: Array) -> Array:
        """Return the density of the object over the places, shape (p,), sum 1.

        `weight` (q,) share of samples in which the object picked each pose; `row` (q,)
        as returned by `row`.
        """
        used = np.flatnonzero(weight)
        density = _spread(
            self._table,
            self._height,
            self._cells,
            self._level,
            self._pose_cells[used],
            self._heading[used],
            self._reference[used],
            weight[used] / np.maximum(row[used], 1e-300),  # guards a pose without use
        )
        return density / max(density.sum(), 1e-300)  # guards a scene without use

    def heading(self, place: int, weight: Array, row: Array, yaws: Array) -> float:
        """Return the likeliest of `yaws` for an object at one place [rad]."""
        used = np.flatnonzero(weight)
        offset = self._cells[place] - self._pose_cells[used] + self._table.shape[1] // 2
        is_near = ((offset >= 0) & (offset < self._table.shape[1])).all(1)
        used, offset = used[is_near], offset[is_near]
        near = self._table[self._heading[used], offset[:, 0], offset[:, 1]]
        near = near * self._height[self._level[place], self._reference[used]]
        near *= weight[used] / np.maximum(row[used], 1e-300)
        psi_ori = np.exp(log_psi_ori(self.theta, yaws[:, None], self.poses.yaw[used]))
        return float(yaws[np.argmax(psi_ori @ near)])

    def _table_of(self, spacing_m: float) -> NDArray[np.float32]:
        """Return the planar part of Psi_loc on a lattice."""
        radius = self._config.radius_m
        return planar_table(self.theta, spacing_m, radius, self._n_headings)


def _cells(location: Array, spacing_m: float) -> NDArray[np.int64]:
    """Return the lattice numbers of points of the lattice, shape (n, 2)."""
    return np.round(location[:, :2] / spacing_m).astype(np.int64)


def _n_headings(yaw: Array) -> int:
    """Return how many headings the poses take."""
    used = np.unique(np.round(yaw, 9))
    return round(2 * np.pi / np.diff(used).min()) if len(used) > 1 else 1


@njit(cache=True)
def _add_up(table, grids, pose_cells, heading, reference):  # noqa: ANN001, ANN202
    """Return the sum of Psi_loc over a grid of weighted places per pose, shape (q,).

    Columns add up side by side, which vectorises and keeps the order of the sums.
    """
    n_x, n_y = grids.shape[1:]
    width = table.shape[1]
    half = width // 2
    row = np.empty(len(pose_cells))
    column = np.empty(n_y, np.float32)
    for h in range(len(pose_cells)):
        x, y = half - pose_cells[h, 0], half - pose_cells[h, 1]
        first, last = max(0, -y), min(n_y, width - y)
        column[:] = 0
        part = column[first:last]
        for i in range(max(0, -x), min(n_x, width - x)):
            planar = table[heading[h], i + x, first + y : last + y]
            weight = grids[reference[h], i, first:last]
            for j in range(len(part)):
                part[j] += weight[j] * planar[j]
        total = 0.0
        for j in range(n_y):
            total += column[j]
        row[h] = total
    return row


@njit(cache=True)
def _spread(table, height, cells, level, pose_cells, heading, reference, weight):  # noqa: ANN001, ANN202
    """Return the sum of weighted Psi_loc over the poses for every place, shape (p,)."""
    width = table.shape[1]
    half = width // 2
    density = np.zeros(len(cells))
    for h in range(len(pose_cells)):
        x0, y0 = half - pose_cells[h, 0], half - pose_cells[h, 1]
        planar = table[heading[h]]
        for p in range(len(cells)):
            i, j = cells[p, 0] + x0, cells[p, 1] + y0
            if 0 <= i < width and 0 <= j < width:
                psi = planar[i, j] * height[level[p], reference[h]]
                density[p] += weight[h] * psi
    return density

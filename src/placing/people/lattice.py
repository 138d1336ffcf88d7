"""Places and human poses of a scene as cells of the lattice that both lie on.

Poses lie on the coarse lattice of `row_spacing_m`, places on the fine one of their own
spacing: a place is a cell of the coarse lattice and one of a few phases within it.
Everything here depends on the scene alone and is shared by all categories.

Shapes: p places, q valid poses, u sites (a cell and a heading, which poses of several
kinds share), m blocks (rectangles full of places of one level), l levels, b bins.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.people.human import HumanPoses

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

BIN_M = 0.5
"""Edge of the squares in which placements are counted per level."""
SIZE_STEP = 16
"""Transforms have multiples of this size, so that scenes share those of a kernel."""


@dataclass(frozen=True)
class ArrangingConfig:
    """Settings of the density; the values live in `config/config.yaml`."""

    radius_m: float
    """An object further than this from a person is not used by that person."""
    row_spacing_m: float
    """Lattice on which Z(h) adds up places; poses lie on multiples of it."""


class Lattice:
    """Where the places and the poses of a scene are on the lattice."""

    def __init__(
        self,
        candidates: Candidates,
        poses: HumanPoses,
        spacing_m: float,
        config: ArrangingConfig,
    ) -> None:
        """Number the cells of places and poses; a pose off the lattice is an error."""
        self.poses, self.spacing_m, self.config = poses, spacing_m, config
        self.stride = round(config.row_spacing_m / spacing_m)
        fine = _cells(candidates.location, spacing_m)
        pose_cells = _cells(poses.location, spacing_m)
        if (pose_cells % self.stride).any():
            raise ValueError("poses must lie on multiples of row_spacing_m")
        self.fine, cells = fine, fine // self.stride
        self.phase = (fine % self.stride) @ [self.stride, 1]
        self.levels, self.level = np.unique(
            candidates.location[:, 2], return_inverse=True
        )
        self.people = poses.references()  # (q, 5)
        self.references, self.reference = np.unique(
            self.people[:, 2], return_inverse=True
        )
        self.n_headings = _n_headings(poses.yaw)
        turn = poses.yaw / (2 * np.pi) * self.n_headings
        heading = np.round(turn).astype(np.int64) % self.n_headings
        self._lay_out_transforms(cells, pose_cells // self.stride)
        self._lay_out_sites(heading, pose_cells // self.stride)
        self._lay_out_blocks(candidates.location[:, :2], cells)
        self.runs = _runs(fine, self.level)

    def _lay_out_transforms(self, cells: Indices, pose_cells: Indices) -> None:
        """Choose the size of the transforms, and where each place is in them."""
        every = np.concatenate([cells, pose_cells])
        self.low = every.min(0) if len(every) else np.zeros(2, np.int64)
        self.span = np.ptp(every, axis=0) + 1 if len(every) else np.ones(2, np.int64)
        self.at = cells - self.low  # (p, 2)
        # Displacements within the scene must neither wrap around onto each other nor
        # onto those within the radius of the kernel.
        reach = int(np.ceil(self.config.radius_m / self.config.row_spacing_m))
        needed = np.minimum(2 * self.span - 1, self.span + reach)
        size = -(-needed // SIZE_STEP) * SIZE_STEP
        self.size = int(size[0]), int(size[1])

    def _lay_out_sites(self, heading: Indices, pose_cells: Indices) -> None:
        """Number the sites of the poses: heading, x and y of each, (u, 3)."""
        grid = self.n_headings, *self.span
        at = np.ravel_multi_index((heading, *(pose_cells - self.low).T), grid)
        self.site_at, self.site = np.unique(at, return_inverse=True)  # (u,), (q,)
        sites = np.column_stack(np.unravel_index(self.site_at, grid))
        sites[:, 1:] += self.low
        self.sites = sites.astype(np.int32)

    def _lay_out_blocks(self, xy: Array, cells: Indices) -> None:
        """Cut the places of the coarse lattice into blocks, by level and by bin."""
        kept = self.phase == 0
        square = np.floor(xy[kept] / BIN_M + 1e-9).astype(np.int64)
        square -= square.min(0) if len(square) else 0
        grid = len(self.levels), *(square.max(0, initial=0) + 1)
        at = np.ravel_multi_index((self.level[kept], *square.T), grid)
        bins, of_bin = np.unique(at, return_inverse=True)
        level = np.unravel_index(bins, grid)[0]  # (b,), sorted
        self.first_bin = np.searchsorted(level, np.arange(len(self.levels) + 1))
        self.level_blocks = _blocks(cells[kept], self.level[kept])
        self.bin_blocks = _blocks(cells[kept], of_bin)


def _cells(location: Array, spacing_m: float) -> Indices:
    """Return the lattice numbers of points of the lattice, shape (n, 2)."""
    return np.round(location[:, :2] / spacing_m).astype(np.int64)


def _n_headings(yaw: Array) -> int:
    """Return how many headings the poses take."""
    used = np.unique(np.round(yaw, 9))
    return round(2 * np.pi / np.diff(used).min()) if len(used) > 1 else 1


def _runs(fine: Indices, level: Indices) -> NDArray[np.int32]:
    """Return the runs of places that follow each other along y, (n, 5).

    First place, how many, x and y of the first, level.
    """
    steps = np.diff(np.column_stack([level, fine]), axis=0)
    goes_on = (steps == [0, 0, 1]).all(1)
    first = np.flatnonzero(np.append(True, ~goes_on)[: len(fine)])
    length = np.diff(np.append(first, len(fine)))
    return np.column_stack([first, length, fine[first], level[first]]).astype(np.int32)


def _blocks(cells: Indices, group: Indices) -> NDArray[np.int32]:
    """Return first and past-the-last x and y, and the group, of each block, (m, 5)."""
    runs = _merge(np.column_stack([group, cells[:, 0], cells[:, 1]]))
    group, x, y, n = runs.T  # runs of places along y, merged along x where alike
    group, y, n, x, width = _merge(np.column_stack([group, y, n, x])).T
    return np.column_stack([x, x + width, y, y + n, group]).astype(np.int32)


def _merge(table: Indices) -> Indices:
    """Return rows (n, c) sorted and merged where the last column counts on, (m, c + 1).

    The column added holds how many rows each one stands for.
    """
    table = table[np.lexsort(table.T[::-1])]
    goes_on = (np.diff(table, axis=0) == np.eye(table.shape[1])[-1]).all(1)
    first = np.flatnonzero(np.append(True, ~goes_on)[: len(table)])
    return np.column_stack([table[first], np.diff(np.append(first, len(table)))])

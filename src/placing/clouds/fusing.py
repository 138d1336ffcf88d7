"""Points of many images as one cloud: averaged in voxels by how sure they are.

Letters for shapes: n points, m voxels.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from placing.clouds.planes import fit_planes
from placing.clouds.ply import Cloud
from placing.clouds.voxels import cell_keys

Array = NDArray[np.float64]


class Seen(NamedTuple):
    """Points that were seen, or means of such points."""

    points: Array
    """(n, 3) [m]."""
    back: Array
    """(n, 3) directions to the camera, unit length but for means."""
    colors: Array
    """(n, 3) red, green, blue."""
    softness: Array
    """(n,) 0 hard to 1 soft."""
    weight: Array
    """(n,) inverse variance [1/m²], or the sum of those of a mean."""
    surest: Array
    """(n,) inverse variance [1/m²], or the largest of those of a mean."""

    def take(self, rows: NDArray) -> "Seen":
        """Return the points chosen by mask or by index."""
        return Seen._make(values[rows] for values in self)


def joined(seen: Sequence[Seen]) -> Seen:
    """Return all points one after the other."""
    columns = [np.concatenate(values) for values in zip(*seen, strict=True)]
    return Seen._make(columns)


def fuse(seen: Seen, voxel_m: float) -> Seen:
    """Return the means of the points of each voxel, weighted by inverse variance."""
    if len(seen.points) == 0:
        return seen
    # Whole voxels from the origin, so that they are the same for all points.
    low = (np.floor(seen.points.min(axis=0) / voxel_m) - 1) * voxel_m
    keys = cell_keys(seen.points, low, voxel_m)[0]
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    share = seen.weight[order]
    total = np.add.reduceat(share, starts)
    surest = np.maximum.reduceat(seen.surest[order], starts)

    def mean(values: Array) -> Array:
        """Return the weighted mean of a column in each voxel, shape (m,)."""
        return np.add.reduceat(values[order] * share, starts) / total

    points, back, colors = (
        np.stack([mean(column) for column in values.T], axis=1)
        for values in (seen.points, seen.back, seen.colors)
    )
    return Seen(points, back, colors, mean(seen.softness), total, surest)


def keep_surest(seen: Seen, cell_m: float, reach_m: float, least_share: float) -> Seen:
    """Return the points that are about as sure as any before or behind them.

    A wall seen from afar is a thick layer of noise along the rays: where it was seen
    from nearby too, only that counts.
    """
    n_steps = round(reach_m / cell_m)
    low, high = seen.points.min(axis=0), seen.points.max(axis=0)
    low = low - (n_steps + 1) * cell_m
    _, n_y, n_z = ((high - low) / cell_m).astype(np.int64) + n_steps + 2

    def cell_of(points: Array) -> NDArray[np.int64]:
        """Return a number for the cell of each point, shape (n,)."""
        x, y, z = ((points - low) / cell_m).astype(np.int64).T
        return (x * n_y + y) * n_z + z

    cells, place = np.unique(cell_of(seen.points), return_inverse=True)
    surest = np.zeros(len(cells))
    np.maximum.at(surest, place, seen.surest)
    most = surest[place]
    back = seen.back / np.linalg.norm(seen.back, axis=1, keepdims=True)
    for step in range(-n_steps, n_steps + 1):
        wanted = cell_of(seen.points + step * cell_m * back)
        found = np.minimum(np.searchsorted(cells, wanted), len(cells) - 1)
        most = np.maximum(most, np.where(cells[found] == wanted, surest[found], 0.0))
    return seen.take(seen.surest >= least_share * most)


def fuse_to(seen: Seen, voxel_m: float, n_points: int) -> Seen:
    """Return the means of voxels that are large enough to be at most `n_points`."""
    seen = fuse(seen, voxel_m)
    while len(seen.points) > n_points:
        # Slower than the square of the edge, with which their number goes on surfaces.
        voxel_m *= max(1.02, (len(seen.points) / n_points) ** 0.25)
        seen = fuse(seen, voxel_m)
    return seen


def cloud_of(seen: Seen, normal_neighbors: int) -> Cloud:
    """Return the points with normals of fitted planes that face the camera."""
    points = seen.points.astype(np.float32)
    normals = fit_planes(points, normal_neighbors)
    normals[np.einsum("nk,nk->n", normals, seen.back) < 0] *= -1
    colors = np.round(seen.colors).astype(np.uint8)
    softness = seen.softness.astype(np.float32)
    return Cloud(points, normals.astype(np.float32), colors, softness)

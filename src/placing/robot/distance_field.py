"""How far from everything scanned each spot of a scene is.

The robot's planner knows furniture by its cloud alone. Letters: p points, x y z cells.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import ndimage

from placing.rigid import Array

Mask = NDArray[np.bool_]
Floats = NDArray[np.float32]


OPEN_M = 1e4
"""Distance to everything in a world without furniture; no scene is as wide."""


@dataclass(frozen=True)
class FieldConfig:
    """How a cloud becomes a distance field; values: config/config.yaml."""

    cell_m: float
    """Width of a cell."""
    floor_m: float
    """What is lower counts as floor: the base rolls over it, the arm does not."""
    top_m: float
    """Least height of the field; above what was scanned is open air."""
    hole_m: float
    """Gaps of the cloud up to twice this wide are closed."""
    ground_reach_m: float
    """How far around a spot its ground is the highest."""


class DistanceField(NamedTuple):
    """Distances to what was scanned, at the centres of cells."""

    origin_m: Array
    """(3,) centre of the first cell in the world."""
    cell_m: float
    distance_m: Floats
    """(x, y, z); 0 in what is closed off or outside of the scan."""
    ground_m: Floats
    """(x, y) height of the highest ground around, furniture left out."""


def distance_field(points_m: NDArray, config: FieldConfig) -> DistanceField:
    """Return the distance field of a cloud (p, 3) with its floor at z = 0 [m].

    Occupied is also what lies outside of the scan, and each cavity that is not
    connected to the open air above the floor.
    """
    points = np.asarray(points_m, float)
    origin, shape = _grid(points, config)
    cells = np.floor((points - origin) / config.cell_m + 0.5).astype(np.int64)
    cells = np.clip(cells, 0, np.array(shape) - 1)  # (p, 3)
    is_high = points[:, 2] > config.floor_m
    ground = _ground(cells, points[:, 2], is_high, shape[:2], config)
    is_scanned = _scanned(cells, shape[:2], config)
    scaled, start = points[is_high] / config.cell_m, origin / config.cell_m
    distance = _distances(cells[is_high], scaled, start, is_scanned, shape[2])
    distance *= np.float32(config.cell_m)
    air = _open_air(distance > config.hole_m, is_scanned, config)
    distance[~air & (distance > config.hole_m)] = 0.0
    return DistanceField(origin, config.cell_m, distance, ground)


def _grid(points: Array, config: FieldConfig) -> tuple[Array, tuple[int, int, int]]:
    """Return the centre of the first cell (3,) [m] and the number of cells.

    There is a rim of one cell beside the cloud; the lowest cells lie on the floor.
    """
    low = points.min(0) - config.cell_m
    high = points.max(0) + config.cell_m
    low[2], high[2] = config.cell_m / 2, max(high[2], config.top_m)
    nx, ny, nz = (np.ceil((high - low) / config.cell_m).astype(int) + 1).tolist()
    return low, (nx, ny, nz)


def _ground(
    cells: NDArray[np.int64],
    height_m: Array,
    is_high: Mask,
    shape: tuple[int, int],
    config: FieldConfig,
) -> Floats:
    """Return the height of the highest ground around each column, shape (x, y) [m]."""
    ground = np.zeros(shape, np.float32)
    is_furnished = np.zeros(shape, bool)
    is_furnished[cells[is_high, 0], cells[is_high, 1]] = True
    # The foot of a wall is no ground: what is above it keeps the arm away.
    low = ~is_high & ~is_furnished[cells[:, 0], cells[:, 1]]
    np.maximum.at(ground, (cells[low, 0], cells[low, 1]), height_m[low])
    n = int(np.ceil(config.ground_reach_m / config.cell_m))
    return ndimage.maximum_filter(ground, 2 * n + 1)


def _scanned(
    cells: NDArray[np.int64], shape: tuple[int, int], config: FieldConfig
) -> Mask:
    """Return which columns hold a point, gaps of the cloud closed, shape (x, y)."""
    is_seen = np.zeros(shape, bool)
    is_seen[cells[:, 0], cells[:, 1]] = True
    n = 2 * int(np.ceil(config.hole_m / config.cell_m))
    closed = ndimage.binary_closing(np.pad(is_seen, n), iterations=n)
    return closed[n:-n, n:-n]


def _distances(
    cells: NDArray[np.int64], points: Array, origin: Array, is_scanned: Mask, nz: int
) -> Floats:
    """Return the distance of each cell to points and to the outside, (x, y, z) [cells].

    The nearest occupied cell is found first; what counts are the points in it, and
    those in the cells nearest to the cells around.
    """
    outside = ndimage.distance_transform_edt(is_scanned).astype(np.float32)  # (x, y)
    shape = (*is_scanned.shape, nz)
    if not len(cells):
        return np.repeat(outside[..., None], nz, axis=2)
    flat = np.asarray(np.ravel_multi_index(tuple(cells.T), shape))
    order = np.argsort(flat, kind="stable")
    occupied, first = np.unique(flat[order], return_index=True)
    number = np.full(shape, -1, np.int32)
    number.ravel()[occupied] = np.arange(len(occupied))
    nearest = ndimage.distance_transform_edt(
        number < 0, return_distances=False, return_indices=True
    )
    number = number[tuple(nearest)]
    first = np.append(first, len(flat))
    return _refine(number, first, points[order] - origin, outside)


@njit(cache=True)
def _refine(
    number: NDArray[np.int32], first: NDArray, points: Array, outside: Floats
) -> Floats:
    """Return the distances to the points of the cells named by and around each."""
    distance = np.empty(number.shape, np.float32)
    nx, ny, nz = number.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                least, last = outside[i, j] ** 2, -1
                for u in range(max(i - 1, 0), min(i + 2, nx)):
                    for v in range(max(j - 1, 0), min(j + 2, ny)):
                        for w in range(max(k - 1, 0), min(k + 2, nz)):
                            cell = number[u, v, w]
                            if cell != last:
                                last = cell
                                for n in range(first[cell], first[cell + 1]):
                                    x, y, z = points[n]
                                    square = (x - i) ** 2 + (y - j) ** 2 + (z - k) ** 2
                                    least = min(least, square)
                distance[i, j, k] = np.sqrt(least)
    return distance


def _open_air(is_wide: Mask, is_scanned: Mask, config: FieldConfig) -> Mask:
    """Return the cells of the air above most of the floor, shape (x, y, z)."""
    pieces, n_pieces = ndimage.label(is_wide)
    above = pieces[:, :, int(np.ceil(config.hole_m / config.cell_m)) + 1]
    counts = np.bincount(above[is_scanned], minlength=n_pieces + 1)
    counts[0] = 0
    return pieces == (counts.argmax() if counts.any() else -1)


def open_field() -> DistanceField:
    """Return the field of a world without furniture."""
    far = np.full((3, 3, 3), OPEN_M, np.float32)
    corner = np.array([-OPEN_M, -OPEN_M, 0.0])
    return DistanceField(corner, OPEN_M, far, np.zeros((3, 3), np.float32))

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
from placing.robot.kernels import inner

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
    distance = distances(cells[is_high], scaled, start, is_scanned, shape[2])
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


def distances(
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
    points = points[order] - origin
    boxes = np.minimum.reduceat(points, first), np.maximum.reduceat(points, first)
    first = np.append(first, len(flat))
    return _refine(nearest_cells(occupied, shape), boxes, first, points, outside)


def nearest_cells(
    occupied: NDArray[np.int64], shape: tuple[int, int, int]
) -> NDArray[np.int32]:
    """Return the number of the occupied cell (o,) nearest to each cell, (x, y, z).

    Line by line along each axis. The transform of scipy finds the same, but holds three
    indices of each cell: more than all else that a planner keeps.
    """
    at = np.stack(np.unravel_index(occupied, shape), axis=-1)
    number = np.full(shape, -1, np.int32)
    number.ravel()[occupied] = np.arange(len(occupied))
    for axes in ((1, 2, 0), (0, 2, 1), (0, 1, 2)):
        _spread(number.transpose(axes), np.ascontiguousarray(at[:, axes]))
    return number


@njit(cache=True)
def _spread(number: NDArray[np.int32], at: NDArray[np.int64]) -> None:
    """Name in each cell the nearest of what its line along the last axis names.

    A negative number names nothing; of cells as near the first on the line is named.
    """
    nu, nv, n = number.shape
    place, name, square = np.empty((3, n), np.int64)
    for u in range(nu):
        for v in range(nv):
            m = 0
            for k in range(n):
                cell = number[u, v, k]
                if cell < 0:
                    continue
                beside = (at[cell, 0] - u) ** 2 + (at[cell, 1] - v) ** 2
                while m > 1 and _is_never_nearest(place, square, m - 1, k, beside):
                    m -= 1
                place[m], name[m], square[m] = k, cell, beside
                m += 1
            if m > 0:
                _name(number[u, v], place[:m], name, square)


@inner
def _is_never_nearest(
    place: NDArray, square: NDArray, m: int, k: int, beside: int
) -> bool:
    """Return whether the one before m or one at k is nearer than m all along a line."""
    before, after = place[m] - place[m - 1], k - place[m]
    both = before + after
    least = after * square[m - 1] + before * beside + before * after * both
    return both * square[m] > least


@njit(cache=True)
def _name(
    line: NDArray[np.int32], place: NDArray, name: NDArray, square: NDArray
) -> None:
    """Write the name of the nearest into the cells of a line."""
    m = 0
    for k in range(len(line)):
        while m + 1 < len(place) and (
            square[m] + (place[m] - k) ** 2 > square[m + 1] + (place[m + 1] - k) ** 2
        ):
            m += 1
        line[k] = name[m]


@njit(cache=True)
def _refine(
    number: NDArray[np.int32],
    boxes: tuple[Array, Array],
    first: NDArray,
    points: Array,
    outside: Floats,
) -> Floats:
    """Return the distances to the points of the cells named by and around each.

    The points of a cell are looked at if the box around them is near enough; boxes
    have least and greatest corners, (o, 3) each.
    """
    distance = np.zeros(number.shape, np.float32)
    nx, ny, nz = number.shape
    for i in range(nx):
        for j in range(ny):
            for k in range(nz if outside[i, j] > 0 else 0):
                own, least = number[i, j, k], outside[i, j] ** 2
                least = _nearer(own, boxes, first, points, (i, j, k), least)
                last = own
                for u in range(max(i - 1, 0), min(i + 2, nx)):
                    for v in range(max(j - 1, 0), min(j + 2, ny)):
                        for w in range(max(k - 1, 0), min(k + 2, nz)):
                            cell = number[u, v, w]
                            if cell not in (own, last):
                                last = cell
                                spot = (i, j, k)
                                least = _nearer(cell, boxes, first, points, spot, least)
                distance[i, j, k] = np.sqrt(least)
    return distance


@inner
def _nearer(
    cell: int,
    boxes: tuple[Array, Array],
    first: NDArray,
    points: Array,
    spot: tuple[int, int, int],
    least: float,
) -> float:
    """Return the square of the distance to a cell's points, or the least if less."""
    low, high = boxes
    i, j, k = spot
    x = max(low[cell, 0] - i, i - high[cell, 0], 0.0)
    y = max(low[cell, 1] - j, j - high[cell, 1], 0.0)
    z = max(low[cell, 2] - k, k - high[cell, 2], 0.0)
    if x**2 + y**2 + z**2 >= least:
        return least
    for n in range(first[cell], first[cell + 1]):
        x, y, z = points[n, 0] - i, points[n, 1] - j, points[n, 2] - k
        least = min(least, x**2 + y**2 + z**2)
    return least


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

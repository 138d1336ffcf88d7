"""Valid human poses of a scene: the discrete set on which P0 lives.

A pose is a kind, a place and a heading on a lattice. It is valid when its body is free
of the cloud's points and its weight is supported: the feet of standing kinds on the
floor, the pelvis of sitting kinds on a placing area of sitting height with room for
the legs. Such poses still sit on tables and shelves (Figure 4b of the paper); it is
the objects that make some poses likelier than others.

Shapes: q poses, v voxels.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray
from shapely import Polygon, contains_xy

from placing.people import skeleton
from placing.people.human import HumanPoses, headings, prior_of
from placing.scene import PlacingArea

Array = NDArray[np.float64]

NEIGHBOURS_M = (0.4, 1.6)
"""Edges of the squares, and of squares of squares, whose poses follow each other."""
MAX_STEP_M = 0.05
"""What is lower than this belongs to the floor: people stand on rugs."""


@dataclass(frozen=True)
class PosesConfig:
    """Which poses are tried; the values live in `config/config.yaml`."""

    standing_spacing_m: float
    """Lattice of places for the standing kinds."""
    sitting_spacing_m: float
    """Lattice of places for the sitting kinds, finer since seats are small."""
    n_headings: int
    voxel_m: float
    """Edge of the voxels in which bodies and the cloud are compared."""
    min_seat_m: float
    max_seat_m: float


def valid_poses(
    points: NDArray[np.floating],
    areas: tuple[PlacingArea, ...],
    config: PosesConfig,
) -> HumanPoses:
    """Return the valid poses of a scene of `points` (v, 3) with placing `areas`."""
    origin, is_occupied = _occupancy(points, config.voxel_m)
    blocks = []
    for kind_index, kind in enumerate(skeleton.KINDS):
        places = _places(kind, areas, config)
        for yaw in headings(config.n_headings):
            body = _body_voxels(kind, yaw, config.voxel_m)
            bases = _base_voxels(places, origin, config.voxel_m)
            free = places[_is_free(is_occupied, bases, body)]
            columns = [np.full(len(free), kind_index), free, np.full(len(free), yaw)]
            blocks.append(np.column_stack(columns))
    table = np.concatenate(blocks)
    table = table[neighbours_first(table[:, 0], table[:, 1:4], table[:, 4])]
    kind = table[:, 0].astype(np.uint8)
    return HumanPoses(kind, table[:, 1:4], table[:, 4], prior_of(kind))


def neighbours_first(
    kind: NDArray[np.integer], location: Array, yaw: Array
) -> NDArray[np.int64]:
    """Return an order in which poses that follow each other are near, shape (q,).

    The sampler looks at poses that follow each other together, and at fewer of them
    where they are liked alike.
    """
    x, y = location[:, :2].T
    square = [np.floor(a / size) for size in NEIGHBOURS_M for a in (y, x)]
    return np.lexsort((y, x, kind, yaw, *square))


def lattice(polygon_m: Array, spacing_m: float) -> Array:
    """Return the points of the world lattice inside a polygon, shape (p, 2) [m]."""
    low = np.floor(polygon_m.min(0) / spacing_m)
    high = np.ceil(polygon_m.max(0) / spacing_m)
    axes = [np.arange(a, b + 1) * spacing_m for a, b in zip(low, high, strict=True)]
    x, y = (grid.ravel() for grid in np.meshgrid(*axes, indexing="ij"))
    is_inside = contains_xy(Polygon(polygon_m), x, y)
    return np.column_stack([x, y])[is_inside]


def _places(kind: str, areas: tuple[PlacingArea, ...], config: PosesConfig) -> Array:
    """Return where a kind can be supported, shape (p, 3) [m]."""
    if kind in skeleton.SITTING:
        spacing = config.sitting_spacing_m
        seats = (config.min_seat_m, config.max_seat_m)
        used = [a for a in areas if seats[0] <= a.height_m <= seats[1]]
    else:
        spacing = config.standing_spacing_m
        used = [a for a in areas if a.is_floor or a.height_m < MAX_STEP_M]
    grids = [(lattice(area.polygon_m, spacing), area.height_m) for area in used]
    places = [np.column_stack([xy, np.full(len(xy), z)]) for xy, z in grids]
    return np.concatenate([np.empty((0, 3)), *places])


def _occupancy(
    points: NDArray[np.floating], voxel_m: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the origin of a voxel grid and which of its voxels hold a point.

    The lowest layer is the floor, on which every body stands, and counts as free.
    """
    origin = np.floor(points.min(0).astype(float) / voxel_m) * voxel_m
    origin[2] = 0.0
    cells = np.floor((points - origin) / voxel_m + 1e-6).astype(np.int64)
    is_occupied = np.zeros(np.maximum(cells.max(0) + 1, 1), np.bool_)
    cells = cells[cells[:, 2] > 0]
    is_occupied[tuple(cells.T)] = True
    return origin, is_occupied


def _base_voxels(places: Array, origin: Array, voxel_m: float) -> NDArray[np.int64]:
    """Return the voxel just above the supporting point of each place, shape (p, 3)."""
    cells = np.floor((places - origin) / voxel_m + 1e-6).astype(np.int64)
    cells[:, 2] += 1
    return cells


@lru_cache(maxsize=256)
def _body_voxels(kind: str, yaw: float, voxel_m: float) -> NDArray[np.int64]:
    """Return the voxels that a body fills, relative to its base voxel, shape (v, 3)."""
    spheres = skeleton.capsule_samples(kind)
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    steps = np.linspace(-1, 1, 7)
    ball = np.stack(np.meshgrid(steps, steps, steps), -1).reshape(-1, 3)
    ball = ball[np.linalg.norm(ball, axis=1) <= 1]
    points = spheres[:, None, :3] @ turn.T + ball * spheres[:, None, 3:]  # (s, b, 3)
    cells = np.floor(points.reshape(-1, 3) / voxel_m + 1e-6).astype(np.int64)
    low, spans = cells.min(0), np.ptp(cells, axis=0) + 1
    packed = np.unique(np.ravel_multi_index((cells - low).T, spans))
    return np.column_stack(np.unravel_index(packed, spans)) + low


@njit(cache=True)
def _is_free(is_occupied, bases, body):  # noqa: ANN001, ANN202
    """Return whether no voxel of a body at each base is occupied, shape (p,).

    Beside the grid is outside the scene and counts as occupied; above and below it
    is free.
    """
    free = np.ones(len(bases), np.bool_)
    size_x, size_y, size_z = is_occupied.shape
    for p in range(len(bases)):
        for v in range(len(body)):
            x = bases[p, 0] + body[v, 0]
            y = bases[p, 1] + body[v, 1]
            z = bases[p, 2] + body[v, 2]
            if not (0 <= x < size_x and 0 <= y < size_y):
                free[p] = False
                break
            if 0 <= z < size_z and is_occupied[x, y, z]:
                free[p] = False
                break
    return free

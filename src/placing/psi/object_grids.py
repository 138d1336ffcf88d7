"""What is asked of an object's cloud for every placement, prepared once per cloud.

A grid around the object that knows how far from its surface each place is, a few points
spread over it, and the features of its own shape in an orientation.

Letters for shapes: n points, s spread points, g cells, u orientations, d directions.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from placing.psi.object_clouds import ObjectCloud

Array = NDArray[np.float64]

N_SPREAD = 192
"""Points that stand for the surface of an object in every placement."""
N_CELLS = 40_000
"""Cells of the grid around an object, about."""
LEAST_CELL_M = 0.004
REACH_M = 0.03
"""How far the grid extends beyond the object."""
SHAPE_FEATURES = (
    "shape_height_m",
    "shape_mass_height",
    "shape_base_margin_m",
    "shape_base_tipping",
    "shape_base_width_m",
    "shape_base_length_m",
    "shape_base_growth",
    "shape_base_share",
    "shape_slenderness",
)
"""Features of the object alone, in an orientation; turning about the vertical changes
none of them."""
N_AROUND = 24
BASE_M, TIGHT_M, WIDE_M = 0.006, 0.003, 0.015
"""What is no higher above the lowest point belongs to the base, three times."""


class ObjectGrid(NamedTuple):
    """Signed distances to the surface of an object in its frame, for compiled code."""

    x_m: float
    y_m: float
    z_m: float
    """Lower corner of the first cell."""
    per_m: float
    """Cells in a metre."""
    cells: NDArray[np.float32]
    """(x, y, z, 4) distance at the centre [m], positive outside, and its gradient."""


def around(n: int) -> Array:
    """Return unit vectors all around in the plane, shape (n, 2)."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


@lru_cache(maxsize=256)
def object_grid(cloud: ObjectCloud) -> ObjectGrid:
    """Return the distances around an object."""
    low = cloud.points.min(axis=0) - REACH_M
    extent = cloud.points.max(axis=0) + REACH_M - low
    cell = max(LEAST_CELL_M, float(np.cbrt(extent.prod() / N_CELLS)))
    shape = np.ceil(extent / cell).astype(int)
    lattice = np.indices(shape).reshape(3, -1).T  # (g, 3)
    centres = low + (lattice + 0.5) * cell
    distance, gradient = _signed_distance(cloud, centres)
    cells = np.concatenate([distance[:, None], gradient], axis=1)
    cells = cells.reshape(*shape, 4).astype(np.float32)
    x, y, z = low.tolist()
    return ObjectGrid(x, y, z, 1 / cell, cells)


def _signed_distance(cloud: ObjectCloud, places: Array) -> tuple[Array, Array]:
    """Return distance (g,) to the surface and the way out (g, 3) at some places."""
    tree = cKDTree(cloud.points)
    spacing = np.median(tree.query(cloud.points, 2)[0][:, 1])
    reach, nearest = tree.query(places, 8)  # (g, k)
    points, normals = cloud.points[nearest], cloud.normals[nearest]  # (g, k, 3)
    along = ((places[:, None] - points) * normals).sum(axis=2)  # (g, k)
    alike = (normals * normals[:, :1]).sum(axis=2)
    # Points that face the same way as the nearest are one face: walls may be thin.
    weight = (alike > 0.5) / (reach + 0.5 * spacing) ** 2
    weight /= weight.sum(axis=1, keepdims=True)
    distance = (weight * along).sum(axis=1)
    way = (weight[..., None] * normals).sum(axis=1)
    # Beyond a convex edge there is another face, and a place must be below both.
    drop = ((points - points[:, :1]) * normals[:, :1]).sum(axis=2)
    is_other = (np.abs(alike) <= 0.5) & (drop < 0)
    other = np.where(is_other, along, -np.inf)
    k, row = other.argmax(axis=1), np.arange(len(places))
    is_beyond = other[row, k] > distance
    distance = np.where(is_beyond, other[row, k], distance)
    way = np.where(is_beyond[:, None], normals[row, k], way)
    # Far beside the nearest point the plane through it says little: outside.
    is_beside = (reach[:, 0] > 2 * spacing) & (np.abs(distance) < 0.5 * reach[:, 0])
    distance = np.where(is_beside, reach[:, 0], distance)
    way = np.where(is_beside[:, None], places - points[:, 0], way)
    return distance, way / np.linalg.norm(way, axis=1, keepdims=True)


@lru_cache(maxsize=256)
def spread_points(cloud: ObjectCloud) -> tuple[Array, Array]:
    """Return extreme points, then points far from each other, and normals, (s, 3)."""
    n = min(N_SPREAD, len(cloud.points))
    corners = np.unique((cloud.points @ _all_directions(n // 2).T).argmax(axis=0))
    chosen = list(corners)
    distance = cKDTree(cloud.points[corners]).query(cloud.points)[0]
    while len(chosen) < n:
        chosen.append(distance.argmax())
        step = np.linalg.norm(cloud.points - cloud.points[chosen[-1]], axis=1)
        distance = np.minimum(distance, step)
    return cloud.points[chosen], cloud.normals[chosen]


def _all_directions(n: int) -> Array:
    """Return unit vectors spread over the sphere along a spiral, shape (n, 3)."""
    z = 1 - (2 * np.arange(n) + 1) / n
    angle = np.pi * (1 + np.sqrt(5)) * np.arange(n)
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)


def shape_features(cloud: ObjectCloud, up: Array) -> Array:
    """Return the features of the shape when `up` (u, 3) points up, shape (u, f)."""
    # Equal orientations are looked at once: most placements differ in place and yaw.
    keys = np.round(up, 4)
    order = np.lexsort(keys.T)
    is_new = np.ones(len(up), bool)
    is_new[1:] = (np.diff(keys[order], axis=0) != 0).any(axis=1)
    rows = np.array([_shape_row(cloud, u) for u in up[order[is_new]]])
    group = np.empty(len(up), int)
    group[order] = np.cumsum(is_new) - 1
    return rows.reshape(-1, len(SHAPE_FEATURES))[group]


def _shape_row(cloud: ObjectCloud, up: Array) -> list[float]:
    """Return the features of the shape in one orientation, in order of their names."""
    height = cloud.points @ up  # (n,)
    height, mass_height = height - height.min(), cloud.mass_centre @ up - height.min()
    side = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    side /= np.linalg.norm(side)
    plane = np.stack([side, np.cross(up, side)], axis=1)  # (3, 2)
    flat = (cloud.points - cloud.mass_centre) @ plane @ around(N_AROUND).T  # (n, d)
    widths = {}
    for band in (TIGHT_M, BASE_M, WIDE_M):
        reach = flat[height <= band].max(axis=0)
        widths[band] = reach[: N_AROUND // 2] + reach[N_AROUND // 2 :]
    margin = flat[height <= BASE_M].max(axis=0).min()
    width = widths[BASE_M].min()
    top = max(height.max(), 1e-3)  # Guards against flat things of no height.
    return [
        top,
        mass_height / top,
        margin,
        float(np.arctan2(margin, max(mass_height, 1e-3))),
        width,
        widths[BASE_M].max(),
        widths[TIGHT_M].min() / max(widths[WIDE_M].min(), 1e-3),
        float(np.mean(height <= BASE_M)),
        mass_height / (width / 2 + 0.01),
    ]

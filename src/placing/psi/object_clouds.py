"""The cloud of an object: points of its surface and where its mass is.

What a robot knows of an object that it holds: points with normals all around, and no
name. The centre of its mass follows from them.

Letters for shapes: n points, v corners, f faces.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from placing.clouds.cloud import sample_cloud
from placing.scene import SceneObject
from placing.seeds import generator
from placing.shapes.objects import object_shape

Array = NDArray[np.float64]

FEWEST, MOST = 300, 1500
"""Points of a cloud: a pen has no fewer, a television no more."""
MAX_GAP = 0.1
"""Largest sum of outward areas of a closed surface, as a share of its area."""


@dataclass(frozen=True)
class LookingConfig:
    """How closely objects and what is around them are looked at.

    What is learned and what it is applied to must agree; the values live in
    `config/config.yaml`.
    """

    object_spacing_m: float
    """Mean distance of the points of an object's cloud."""
    cell_m: float
    """Cells of the floor plan in which a cloud is looked up."""


@dataclass(frozen=True, eq=False)
class ObjectCloud:
    """Points of an object's surface in its frame; each cloud equals only itself."""

    object_id: str
    points: Array
    """(n, 3) from the centre of the object's bounding box [m]."""
    normals: Array
    """(n, 3) unit vectors that point outwards."""
    mass_centre: Array
    """(3,) [m]."""


def object_cloud(item: SceneObject, spacing_m: float) -> ObjectCloud:
    """Return a cloud with one point per square of `spacing_m`, within 300 to 1500."""
    points, normals, mass_centre = _sample(item.shape, item.size_m, spacing_m)
    return ObjectCloud(item.object_id, points, normals, mass_centre)


@cache
def _sample(
    shape: str, size_m: tuple[float, float, float], spacing_m: float
) -> tuple[Array, Array, Array]:
    """Return points, normals and centre of mass of a shape, made once."""
    mesh = object_shape(shape, size_m).mesh
    least, most = np.sqrt(mesh.area / MOST), np.sqrt(mesh.area / FEWEST)
    rng = generator(0, "object cloud", shape, *(f"{edge:.4f}" for edge in size_m))
    cloud = sample_cloud(rng, [mesh], float(np.clip(spacing_m, least, most)))
    points, normals = cloud.points.astype(float), cloud.normals.astype(float)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points, normals, mass_centre_of(points, normals)


def mass_centre_of(points: Array, normals: Array) -> Array:
    """Return the centre of the solid that a cloud bounds, shape (3,) [m]."""
    # ASSUME: objects are of one material and filled; a mug counts as its walls, since
    # its cloud has them, but a closed bottle as full.
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    p = points - middle
    # The points lie on a lattice in the coordinate plane that their face is closest to.
    area = 1 / np.abs(normals).max(axis=1)  # (n,) in cells of the lattice
    is_closed = (
        np.linalg.norm(area @ normals) < MAX_GAP * area.sum()
    )  # as Gauss demands of a closed surface
    volume = (area[:, None] * p * normals).sum() / 3
    if is_closed and volume > 0:
        centre = area @ (p * p * normals) / (2 * volume)
        if (np.abs(centre) <= np.abs(p).max(axis=0)).all():
            return middle + centre
    return middle + _hull_centre(p)


def _hull_centre(points: Array) -> Array:
    """Return the centre of the convex hull, the mean of what is flat, shape (3,)."""
    try:
        hull = ConvexHull(points)
    except QhullError:
        return points.mean(axis=0)
    inside = points.mean(axis=0)
    corners = points[hull.simplices] - inside  # (f, 3, 3)
    volume = np.abs(np.linalg.det(corners))  # (f,)
    return inside + volume @ corners.sum(axis=1) / (4 * volume.sum())

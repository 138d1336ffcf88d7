"""Collision shapes of links as the convex hulls that the physics engine makes."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from placing.errors import BadInput
from placing.robot.urdf import Shape

Array = NDArray[np.float64]

MAX_TRIANGLES = 200_000
"""Guards the hull: a collision mesh in use has at most 2,000."""

N_ROUND = 24
"""Sides of the prism around a cylinder, rings and meridians of that around a ball."""

PLANE_DIGITS = 9
"""Planes that agree in so many digits are one: a nanometre is below any tolerance."""

TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("flags", "V2")])
"""One triangle of a binary STL file."""


@dataclass(frozen=True)
class Hull:
    """A convex solid, the collision shape of a link in the frame of the link."""

    link: str
    points_m: Array
    """Corners, (p, 3)."""
    planes: Array
    """Outward unit normals and offsets: `n @ x + d <= 0` inside, (m, 4)."""
    triangles: NDArray[np.int64]
    """Corners of each face, (m, 3)."""


def hull_of(shape: Shape) -> Hull:
    """Return the convex hull of a collision shape in the frame of its link."""
    points = _points(shape) @ shape.T_link_shape[:3, :3].T + shape.T_link_shape[:3, 3]
    return hull_of_points(shape.link, points)


def hull_of_points(link: str, points_m: Array) -> Hull:
    """Return the convex hull of points, (p, 3)."""
    try:
        hull = ConvexHull(points_m)
    except (QhullError, ValueError) as error:
        raise BadInput(f"link {link!r}: its collision shape has no volume") from error
    number = np.full(len(points_m), -1)
    number[hull.vertices] = np.arange(len(hull.vertices))
    triangles = number[hull.simplices].astype(np.int64)
    # Triangles of one flat face share its plane.
    planes = np.unique(hull.equations.round(PLANE_DIGITS), axis=0)
    return Hull(link, points_m[hull.vertices], planes, triangles)


def _points(shape: Shape) -> Array:
    """Return points whose hull contains a shape, in the shape's frame, (p, 3)."""
    if shape.mesh is not None:
        return _read_stl(shape.mesh) * np.array(shape.size)
    if shape.kind == "box":
        return _corners() * np.array(shape.size) / 2
    if shape.kind == "cylinder":
        radius, length = shape.size[0], shape.size[-1]
        return _ring(radius, np.array([-length / 2, length / 2]))
    # Rings closer than the step of the meridians: a slightly larger ball holds all.
    heights = shape.size[0] * np.cos(np.linspace(0, np.pi, N_ROUND // 2 + 1))
    widths = np.sqrt(np.maximum(shape.size[0] ** 2 - heights**2, 0))
    rings = [_ring(w, h) for w, h in zip(widths, heights[:, None], strict=True)]
    return np.concatenate(rings) / np.cos(np.pi / N_ROUND) ** 2


def _corners() -> Array:
    """Return the corners of a cube of edge 2, (8, 3)."""
    return np.array(np.meshgrid([-1.0, 1], [-1.0, 1], [-1.0, 1])).reshape(3, 8).T


def _ring(radius: float, heights_m: Array) -> Array:
    """Return a prism that contains a round cylinder, (p, 3)."""
    angle = 2 * np.pi * np.arange(N_ROUND) / N_ROUND
    outer = radius / np.cos(np.pi / N_ROUND)
    circle = np.column_stack([outer * np.cos(angle), outer * np.sin(angle)])
    return np.concatenate(
        [np.column_stack([circle, np.full(N_ROUND, z)]) for z in heights_m]
    )


@lru_cache(maxsize=64)
def _read_stl(path: Path) -> Array:
    """Return the different corners of a binary STL file, (p, 3)."""
    with path.open("rb") as file:
        header = file.read(84)
        n = int.from_bytes(header[80:84], "little")
        size = path.stat().st_size
        if len(header) < 84 or n > MAX_TRIANGLES or size != 84 + 50 * n:
            raise BadInput(
                f"{path}: {size} bytes; expected a binary STL file of at most "
                f"{MAX_TRIANGLES} triangles"
            )
        triangles = np.frombuffer(file.read(), TRIANGLE)
    corners = triangles["corners"].reshape(-1, 3).astype(float)
    if not np.isfinite(corners).all():
        raise BadInput(f"{path}: holds numbers that are not finite")
    return np.unique(corners, axis=0)

"""Rigid things as a simulator wants them: convex solids and, rarely, triangles.

Simulators keep a thin shell, the margin, around convex shapes: each is therefore shrunk
by the margin first, so that shell and mesh have the same surface.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection

from placing.rigid import Array

MAX_CORNERS = 96
"""Most corners of a convex piece; the time of a step grows with their number."""


@dataclass(frozen=True)
class Piece:
    """A connected piece of a mesh."""

    vertices_m: Array
    """(v, 3) corners."""
    faces: NDArray[np.int64]
    """(f, 3) corners of the triangles; those of the hull where it is convex."""
    is_convex: bool


@dataclass(frozen=True)
class Body:
    """A rigid thing that can move, in its own frame."""

    pieces: tuple[Piece, ...]
    """Convex, and relative to the mass centre."""
    mass_kg: float
    mass_centre_m: Array
    """(3,) in the frame of the mesh."""
    inertia_kg_m2: Array
    """(3,) diagonal of the inertia about the mass centre."""

    @property
    def corners_m(self) -> Array:
        """All corners in the frame of the mesh, shape (v, 3)."""
        corners = np.concatenate([piece.vertices_m for piece in self.pieces])
        return corners + self.mass_centre_m


@dataclass(frozen=True)
class Solids:
    """What is really in a scene."""

    fixed: Mapping[str, tuple[Piece, ...]]
    """Walls and furniture in the world, by the id of the furniture."""
    bodies: Mapping[str, Body]
    """Objects that can be moved, by id."""


def box_body(size_m: Array, mass_kg: float, margin_m: float) -> Body:
    """Return a box (3,) about its centre."""
    corners = (np.indices((2, 2, 2)).reshape(3, 8).T - 0.5) * size_m
    squares = np.square(size_m)
    inertia = mass_kg / 12 * (squares.sum() - squares)
    return Body((shrunk_hull(corners, margin_m),), mass_kg, np.zeros(3), inertia)


def shrunk_hull(vertices_m: Array, margin_m: float) -> Piece:
    """Return the convex hull with each face moved inwards by the margin.

    What is thinner than the margin allows keeps half of its thickness.
    """
    hull = ConvexHull(vertices_m)
    planes = np.unique(hull.equations.round(9), axis=0)  # (p, 4), n x + d <= 0 inside
    inside = vertices_m[hull.vertices].mean(0)
    depth = -(planes[:, :3] @ inside + planes[:, 3])
    planes[:, 3] += min(margin_m, depth.min() / 2)
    corners = HalfspaceIntersection(planes, inside).intersections
    corners = np.unique(corners.round(7), axis=0)
    corners = spread(corners, MAX_CORNERS)
    shrunk = ConvexHull(corners)
    return Piece(corners, shrunk.simplices.astype(np.int64), True)


def spread(points_m: Array, n_most: int) -> Array:
    """Return up to `n_most` of the points: the outermost, then those farthest apart."""
    if len(points_m) <= n_most:
        return points_m
    directions = np.array(list(np.ndindex(3, 3, 3))) - 1
    chosen = list(dict.fromkeys((points_m @ directions.T).argmax(0).tolist()))
    away = np.linalg.norm(points_m[:, None] - points_m[chosen], axis=2).min(1)  # (v,)
    while len(chosen) < n_most:
        chosen.append(int(away.argmax()))
        away = np.minimum(away, np.linalg.norm(points_m - points_m[chosen[-1]], axis=1))
    return points_m[chosen]

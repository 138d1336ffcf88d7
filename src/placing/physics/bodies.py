"""Meshes as a rigid-body simulator wants them: convex solids and, rarely, triangles.

What can move is cut into few convex parts by planes. Simulators keep a thin shell, the
margin, around convex shapes: each is therefore shrunk by the margin first, so that
shell and mesh have the same surface.
"""

from dataclasses import dataclass

import numpy as np
import trimesh
from manifold3d import Manifold, Mesh64
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

Array = NDArray[np.float64]
Axis = tuple[float, float, float]

CONVEX_SHARE = 0.98
"""A piece that fills this share of its hull counts as convex."""

AXES: tuple[Axis, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
MAX_PARTS = 10
"""Convex parts of a body: enough for a lamp with a bent arm."""
MIN_GAIN = 0.03
"""A cut must free this share of the hull's volume: bowls stay as they look outside."""
MAX_CUTS = 10
"""Places along each axis where a cut is tried."""
MAX_CORNERS = 96
"""Most corners of a convex piece; the time of a step grows with their number."""
FLAT_M = 1e-4
"""Guards against slivers that a cut leaves along a face."""


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
class Cut:
    """A plane across a solid."""

    gain_m3: float
    """By how much the hulls of the halves are smaller than the hull of the whole."""
    axis: tuple[float, float, float]
    """Normal."""
    place_m: float
    """Along the axis."""


def fixed_pieces(mesh: trimesh.Trimesh, margin_m: float) -> tuple[Piece, ...]:
    """Return the pieces of a mesh that stays where it is: hollow ones as triangles."""
    return tuple(
        shrunk_hull(piece.vertices, margin_m)
        if is_convex(piece)
        else Piece(np.asarray(piece.vertices), np.asarray(piece.faces), False)
        for piece in pieces_of(mesh)
    )


def body_of(mesh: trimesh.Trimesh, mass_kg: float, margin_m: float) -> Body:
    """Return the body of a mesh, cut into convex parts where it is far from convex."""
    whole = mesh if mesh.is_volume else mesh.convex_hull
    centre = np.asarray(whole.center_mass)
    inertia = np.diag(whole.moment_inertia) * mass_kg / whole.volume
    parts = convex_parts(whole)
    pieces = tuple(shrunk_hull(corners - centre, margin_m) for corners in parts)
    return Body(pieces, mass_kg, centre, inertia)


def pieces_of(mesh: trimesh.Trimesh) -> list[trimesh.Trimesh]:
    """Return the connected pieces of a mesh."""
    return list(mesh.split(only_watertight=False))


def convex_parts(mesh: trimesh.Trimesh) -> list[Array]:
    """Return corners of few convex parts that cover a closed mesh, each (v, 3).

    Greedy: the cut that takes most away from the sum of the hulls comes next.
    """
    whole = Manifold(
        Mesh64(np.asarray(mesh.vertices), np.asarray(mesh.faces, np.uint64))
    )
    if whole.is_empty():  # the library refuses what is not closed
        return [np.asarray(mesh.vertices)]
    least = MIN_GAIN * hull_volume(corners_of(whole))
    parts = [whole]
    cuts = [best_cut(whole, least)]
    while len(parts) < MAX_PARTS and any(cut.gain_m3 >= least for cut in cuts):
        i = max(range(len(cuts)), key=lambda k: cuts[k].gain_m3)
        halves = parts[i].split_by_plane(cuts[i].axis, cuts[i].place_m)
        halves = [half for half in halves if hull_volume(corners_of(half)) > 0]
        parts[i : i + 1] = halves
        cuts[i : i + 1] = [best_cut(half, least) for half in halves]
    return [corners_of(part) for part in parts]


def best_cut(part: Manifold, least_m3: float) -> Cut:
    """Return the cut along an axis that frees the most; none frees less than asked."""
    mesh = part.to_mesh64()
    corners = np.array(mesh.vert_properties[:, :3])
    triangles = np.asarray(mesh.tri_verts)
    ends = np.unique(
        np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0
    )
    volume = hull_volume(corners)
    best = Cut(0.0, AXES[2], 0.0)
    if volume - part.volume() < least_m3:
        return best
    for axis in AXES:
        for place in places_to_cut(corners @ axis):
            halves = cut_corners(corners, ends, axis, place)
            gain = volume - sum(hull_volume(half) for half in halves)
            if gain > best.gain_m3:
                best = Cut(gain, axis, float(place))
    return best


def cut_corners(
    corners_m: Array, edges: NDArray[np.integer], axis: Axis, place_m: float
) -> tuple[Array, Array]:
    """Return the corners of a solid's two sides of a plane, each (v, 3)."""
    height = corners_m @ axis - place_m  # (v,)
    start, end = height[edges].T  # (e,)
    crosses = start * end < 0
    share = start[crosses] / (start[crosses] - end[crosses])
    a, b = corners_m[edges[crosses]].swapaxes(0, 1)
    between = a + share[:, None] * (b - a)
    above, below = corners_m[height >= 0], corners_m[height <= 0]
    return np.concatenate([above, between]), np.concatenate([below, between])


def places_to_cut(coordinates: Array) -> Array:
    """Return a few different coordinates of corners between the outermost."""
    places = np.unique(coordinates.round(4))[1:-1]
    if len(places) <= MAX_CUTS:
        return places
    return places[np.linspace(0, len(places) - 1, MAX_CUTS).round().astype(int)]


def corners_of(part: Manifold) -> Array:
    """Return the corners of a solid, shape (v, 3) [m]."""
    return np.array(part.to_mesh64().vert_properties[:, :3])


def hull_volume(corners_m: Array) -> float:
    """Return the volume of the convex hull, 0 for what is flat or empty [m3]."""
    if len(corners_m) < 4 or np.ptp(corners_m, axis=0).min() < FLAT_M:
        return 0.0
    try:
        return float(ConvexHull(corners_m).volume)
    except QhullError:
        return 0.0


def is_convex(mesh: trimesh.Trimesh) -> bool:
    """Return whether a mesh is closed and fills its convex hull."""
    if not mesh.is_watertight:
        return False
    return abs(mesh.volume) >= CONVEX_SHARE * mesh.convex_hull.volume


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

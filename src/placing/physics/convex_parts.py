"""Few convex parts that cover a solid, found by cutting it along planes."""

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np
import trimesh
from manifold3d import Manifold, Mesh64
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from placing.rigid import Array

Axis = tuple[float, float, float]

AXES: tuple[Axis, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
MAX_PARTS = 10
"""Convex parts of a body: enough for a lamp with a bent arm."""
MIN_GAIN = 0.03
"""A cut must free this share of the hull's volume: bowls stay as they look outside."""
MAX_CUTS = 10
"""Places along each axis where a cut is tried."""
FLAT_M = 1e-4
"""Guards against slivers that a cut leaves along a face."""
ROUNDING = 1e-6
"""Guards bounds on volumes against round-off, as a share of the whole."""


@dataclass(frozen=True)
class Cut:
    """A plane across a solid."""

    gain_m3: float
    """By how much the hulls of the halves are smaller than the hull of the whole."""
    axis: Axis
    """Normal."""
    place_m: float
    """Along the axis."""


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
    """Return the cut along an axis that frees the most; none frees less than asked.

    Of cuts that free the same the first is meant, in the order of axes and places.
    """
    mesh = part.to_mesh64()
    corners = np.array(mesh.vert_properties[:, :3])
    triangles = np.asarray(mesh.tri_verts)
    ends = np.unique(
        np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0
    )
    places = [places_to_cut(corners @ axis) for axis in AXES]
    volume = hull_volume(corners)
    gains = {}
    if volume - part.volume() >= least_m3:
        gains = gains_of(corners, ends, places, volume, least_m3)
    best = max(sorted(gains), key=lambda cut: gains[cut], default=None)
    if best is None or gains[best] < least_m3:
        return Cut(0.0, AXES[2], 0.0)
    axis, place = best
    return Cut(gains[best], AXES[axis], float(places[axis][place]))


def gains_of(
    corners_m: Array,
    edges: NDArray[np.integer],
    places_m: list[Array],
    volume_m3: float,
    least_m3: float,
) -> dict[tuple[int, int], float]:
    """Return what cuts free [m3] by axis and place, but for those that free too little.

    What is above a place holds all that is above a higher one, and so does its hull:
    between two places the hulls of both sides are bounded by those already known.
    """
    gains, most = {}, least_m3 - ROUNDING * volume_m3
    # Least volume of both hulls, axis, places around, volumes below and above.
    gaps = [(0.0, i, -1, len(places), 0.0, 0.0) for i, places in enumerate(places_m)]
    while gaps and volume_m3 - gaps[0][0] >= most:
        _, axis, first, last, below, above = heappop(gaps)
        middle = (first + last) // 2
        if middle == first:
            continue
        sides = cut_corners(corners_m, edges, AXES[axis], places_m[axis][middle])
        upper, lower = hull_volume(sides[0]), below
        if volume_m3 - (upper + below) >= most:
            lower = hull_volume(sides[1])
            gains[axis, middle] = volume_m3 - (upper + lower)
            most = max(most, gains[axis, middle] - ROUNDING * volume_m3)
        heappush(gaps, (upper + below, axis, first, middle, below, upper))
        heappush(gaps, (above + lower, axis, middle, last, lower, above))
    return gains


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

"""Few spheres that together contain a convex solid, and stand out of it by little.

A greedy choice covers sample points of the solid; what is left between the samples is
found by halving boxes until each is outside the solid or inside one sphere, and the
nearest sphere grows by what it misses. Letters for shapes: c candidates, p points.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.robot.meshes import Hull

Array = NDArray[np.float64]

SPACINGS = 1.6
"""Steps between samples in one bulge."""
SPARE = 0.25
"""Share of a step by which spheres are smaller while they are chosen."""
N_PUSHES, INSIDE_M = 4, 1e-3
"""Samples next to the hull are pushed onto it; what is still outside is dropped."""
LEAF_M = 0.002
"""Boxes of this edge are not halved: the sphere next to one grows to contain it."""


def cover(hull: Hull, bulge_m: float) -> tuple[Array, Array]:
    """Return centres (s, 3) and radii (s,) of spheres that contain the hull [m]."""
    points = _samples(hull, bulge_m / SPACINGS)
    depth = -_outside_by(hull, points)
    # A little less than they may have, so that what is between the samples is inside.
    chosen = choose(points, depth + (1 - SPARE / SPACINGS) * bulge_m)
    centres, radii = points[chosen], (depth + bulge_m)[chosen]
    low, high = hull.points_m.min(axis=0), hull.points_m.max(axis=0)
    grow(hull.planes, low, high, centres, radii)
    return centres, radii


def _samples(hull: Hull, step_m: float) -> Array:
    """Return points throughout the hull and on it, about a step apart, (p, 3)."""
    low, high = hull.points_m.min(axis=0), hull.points_m.max(axis=0)
    counts = np.maximum(np.ceil((high - low) / step_m).astype(int) + 1, 2)
    axes = [np.linspace(low[i], high[i], counts[i]) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    heights = _heights(hull, points)
    is_inside, is_near = heights.max(axis=1) <= 0, heights.max(axis=1) < step_m
    near = points[~is_inside & is_near]
    for _ in range(N_PUSHES):
        heights = _heights(hull, near)
        normals = hull.planes[np.argmax(heights, axis=1), :3]
        near = near - np.maximum(heights.max(axis=1), 0)[:, None] * normals
    near = near[_outside_by(hull, near) < INSIDE_M]
    return np.concatenate([points[is_inside], near, hull.points_m])


def _heights(hull: Hull, points: Array) -> Array:
    """Return how high points are above each face [m], (p, m)."""
    return points @ hull.planes[:, :3].T + hull.planes[:, 3]


def _outside_by(hull: Hull, points: Array) -> Array:
    """Return how far points are outside, negative for inside [m], (p,)."""
    return np.max(_heights(hull, points), axis=1)


@njit(cache=True)
def choose(points: Array, radii: Array) -> NDArray[np.int64]:
    """Return which points contain all points with spheres of their radii, (s,).

    The point that fewest spheres contain is next, and of these the sphere that contains
    most of what is left; at last the spheres go that the others make superfluous.
    """
    n, at, squares = len(points), points.T.copy(), radii**2
    n_holders, gain, times = np.zeros((3, n), np.int64)
    for p in range(n):
        n_holders[p] = _count(at, squares, p, 1, gain)
    chosen, holds = [], np.empty(n, np.bool_)
    for _ in range(n):
        hardest = _hardest(times, n_holders)
        if hardest < 0:
            break
        _holders(at, squares, hardest, holds)
        best = _best(holds, gain)
        chosen.append(best)
        _held(at, squares, best, holds)
        for p in range(n):
            if holds[p]:
                if times[p] == 0:
                    _count(at, squares, p, -1, gain)
                times[p] += 1
    return _needed(at, squares, times, chosen)


@njit(cache=True)
def _count(
    at: Array, squares: Array, p: int, sign: int, gain: NDArray[np.int64]
) -> int:
    """Return how many spheres hold a point, and add it to what each of them gains.

    Asked twice of each point: a table of all pairs would take longer to look up.
    """
    px, py, pz = at[0, p], at[1, p], at[2, p]
    x, y, z, n = at[0], at[1], at[2], 0
    for c in range(len(squares)):
        u, v, w = x[c] - px, y[c] - py, z[c] - pz
        is_held = int(u * u + v * v + w * w <= squares[c])
        gain[c] += sign * is_held
        n += is_held
    return n


@njit(cache=True)
def _holders(at: Array, squares: Array, p: int, out: NDArray[np.bool_]) -> None:
    """Write which spheres hold a point, (c,)."""
    for c in range(len(squares)):
        u, v, w = at[0, c] - at[0, p], at[1, c] - at[1, p], at[2, c] - at[2, p]
        out[c] = u * u + v * v + w * w <= squares[c]


@njit(cache=True)
def _held(at: Array, squares: Array, c: int, out: NDArray[np.bool_]) -> None:
    """Write which points a sphere holds, (p,)."""
    for p in range(len(squares)):
        u, v, w = at[0, c] - at[0, p], at[1, c] - at[1, p], at[2, c] - at[2, p]
        out[p] = u * u + v * v + w * w <= squares[c]


@njit(cache=True)
def _hardest(times: NDArray[np.int64], n_holders: NDArray[np.int64]) -> int:
    """Return the point not yet contained that fewest spheres contain, or -1."""
    hardest = -1
    for p in range(len(times)):
        if times[p] == 0 and (hardest < 0 or n_holders[p] < n_holders[hardest]):
            hardest = p
    return hardest


@njit(cache=True)
def _best(holds: NDArray[np.bool_], gain: NDArray[np.int64]) -> int:
    """Return the sphere that contains most of what is left, of those with a point."""
    best = -1
    for c in range(len(gain)):
        if holds[c] and (best < 0 or gain[c] > gain[best]):
            best = c
    return best


@njit(cache=True)
def _needed(
    at: Array, squares: Array, times: NDArray[np.int64], chosen: list[int]
) -> NDArray[np.int64]:
    """Return the chosen spheres without those whose points others contain too."""
    needed, holds = [], np.empty(len(times), np.bool_)
    for c in chosen:
        _held(at, squares, c, holds)
        if np.min(times[holds]) > 1:
            times -= holds
        else:
            needed.append(c)
    return np.array(needed)


@njit(cache=True)
def grow(planes: Array, low: Array, high: Array, centres: Array, radii: Array) -> None:
    """Enlarge spheres until every point of the hull is inside one [m]."""
    boxes = [(low[0], low[1], low[2], high[0], high[1], high[2])]
    while len(boxes) > 0:
        x0, y0, z0, x1, y1, z1 = boxes.pop()
        half = np.array([x1 - x0, y1 - y0, z1 - z0]) / 2
        middle = np.array([x0 + x1, y0 + y1, z0 + z1]) / 2
        if _is_outside(planes, middle, half):
            continue
        nearest, missing = _missing(centres, radii, middle, half)
        if missing <= 0:
            continue
        if np.max(half) * 2 <= LEAF_M:
            radii[nearest] += missing
            continue
        axis = np.argmax(half)
        cut = middle[axis]
        a = (x1 if axis != 0 else cut, y1 if axis != 1 else cut)
        b = (x0 if axis != 0 else cut, y0 if axis != 1 else cut)
        boxes.append((x0, y0, z0, a[0], a[1], z1 if axis != 2 else cut))
        boxes.append((b[0], b[1], z0 if axis != 2 else cut, x1, y1, z1))


@njit(cache=True)
def _is_outside(planes: Array, middle: Array, half: Array) -> bool:
    """Return whether one face has the whole box on its outer side."""
    for m in range(len(planes)):
        near = planes[m, 3]
        for i in range(3):
            near += planes[m, i] * middle[i] - abs(planes[m, i]) * half[i]
        if near > 0:
            return True
    return False


@njit(cache=True)
def _missing(
    centres: Array, radii: Array, middle: Array, half: Array
) -> tuple[int, float]:
    """Return the sphere that lacks least to contain a box, and what it lacks [m]."""
    nearest, least = 0, np.inf
    for s in range(len(centres)):
        square = 0.0
        for i in range(3):
            square += (abs(middle[i] - centres[s, i]) + half[i]) ** 2
        lack = np.sqrt(square) - radii[s]
        if lack < least:
            nearest, least = s, lack
    return nearest, least

"""Planes through the nearest neighbours of every point of a cloud.

Neighbours are looked for in the cells of a grid around that of a point. On the evenly
thinned points of a scan this is several times as fast as a search tree, which is left
with the points that have too few or too many others around them.

Letters for shapes: n points, k neighbours.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from placing.clouds.voxels import cell_keys, lowest

MOST_RINGS = 3
"""Cells that are looked through to each side of a point."""
MOST_POINTS = 64
"""Cells are looked through while they hold at most so many times k points."""
N_CELLS = 256
"""Cells along the longest side of a cloud in which its density is measured."""
ROUNDS = 12
"""Rounds of Jacobi's rotations; each squares the error, so six are enough."""


def fit_planes(points: NDArray[np.float32], n_neighbors: int) -> NDArray[np.float64]:
    """Return the normals of planes through the neighbours of points, (n, 3).

    Which of its two sides a plane faces is arbitrary. A point is a neighbour of itself,
    and those as far as the last neighbour count as well.
    """
    k = min(n_neighbors, len(points))
    cell_m = _cell_m(points, k)
    # As many empty cells below as are looked through: no neighbour is met twice.
    low = lowest(points).astype(float) - MOST_RINGS * cell_m
    keys, shape = cell_keys(points, low, cell_m)
    order = np.argsort(keys, kind="stable")
    packed = points.take(order, axis=0).astype(float)
    normals = np.empty((len(points), 3))
    is_found = _search(packed, keys.take(order), shape, low, cell_m, k, normals)
    if not is_found.all():
        rest = np.flatnonzero(~is_found)
        found = cKDTree(packed).query(packed[rest], [*range(1, k + 1)])[1]
        normals[rest] = _fit(packed, found)
    unsorted = np.empty_like(normals)
    unsorted[order] = normals
    return unsorted


def _cell_m(points: NDArray[np.float32], k: int) -> float:
    """Return the edge of cells that hold about half of `k` points [m]."""
    extent = float(np.ptp(points, axis=0).max())
    if extent == 0:
        return 1.0
    keys = cell_keys(points, lowest(points), extent / N_CELLS)[0]
    keys.sort()
    mean = len(points) / (1 + np.count_nonzero(np.diff(keys)))
    # On a surface the points of a cell go with the square of its edge.
    return extent / N_CELLS * float(np.sqrt(k / 2 / mean))


@njit(cache=True)
def _search(
    points: NDArray,
    keys: NDArray,
    shape: tuple[int, int, int],
    low: NDArray,
    cell_m: float,
    k: int,
    normals: NDArray,
) -> NDArray:
    """Write the normals of points sorted by cell; return which were found, (n,)."""
    is_found = np.zeros(len(points), np.bool_)
    near = np.empty((MOST_POINTS * k, 3))
    gaps, sorted_gaps = np.empty(len(near)), np.empty(len(near))
    first = 0
    for end in range(1, len(points) + 1):
        if end < len(points) and keys[end] == keys[first]:
            continue
        # From here the points from first to end share a cell, and its surroundings.
        for rings in range(1, MOST_RINGS + 1):
            n = _gather(points, keys, shape, keys[first], rings, near)
            for p in range(first, end):
                if k <= n <= len(near) and not is_found[p]:
                    last = _farthest(points[p], near[:n], k, gaps, sorted_gaps)
                    if last < (_seen(points[p], low, cell_m, rings)) ** 2:
                        normals[p] = _normal(near[:n], gaps, last, points[p])
                        is_found[p] = True
            if n > len(near) or is_found[first:end].all():
                break
        first = end
    return is_found


@njit(cache=True)
def _seen(point: NDArray, low: NDArray, cell_m: float, rings: int) -> float:
    """Return the distance within which all points are in the cells around one [m]."""
    inside = np.inf
    for a in range(3):
        at = (point[a] - low[a]) / cell_m
        at -= np.floor(at)
        inside = min(inside, at + rings, 1 - at + rings)
    return (inside - 1e-6) * cell_m  # The cell of a point is right to rounding.


@njit(cache=True)
def _farthest(
    point: NDArray, near: NDArray, k: int, gaps: NDArray, sorted_gaps: NDArray
) -> float:
    """Write the squared distances of points; return that of the k-th nearest [m2]."""
    n = len(near)
    for q in range(n):
        x, y = near[q, 0] - point[0], near[q, 1] - point[1]
        gaps[q] = x**2 + y**2 + (near[q, 2] - point[2]) ** 2
        sorted_gaps[q] = gaps[q]
    return _select(sorted_gaps, n, k - 1)


@njit(cache=True)
def _gather(
    points: NDArray,
    keys: NDArray,
    shape: tuple[int, int, int],
    cell: int,
    rings: int,
    near: NDArray,
) -> int:
    """Write the points in the cells around one; return their number, or too large."""
    n = 0
    for i in range(-rings, rings + 1):
        for j in range(-rings, rings + 1):
            middle = cell + (i * shape[1] + j) * shape[2]
            for q in range(np.searchsorted(keys, middle - rings), len(keys)):
                if keys[q] > middle + rings:
                    break
                if n == len(near):
                    return n + 1
                for a in range(3):
                    near[n, a] = points[q, a]
                n += 1
    return n


@njit(cache=True)
def _select(values: NDArray, n: int, rank: int) -> float:
    """Return which of `n` values has a rank, by Hoare's search, which reorders them."""
    low, high = 0, n - 1
    while low < high:
        pivot = values[(low + high) // 2]
        i, j = low, high
        while i <= j:
            while values[i] < pivot:
                i += 1
            while values[j] > pivot:
                j -= 1
            if i <= j:
                values[i], values[j] = values[j], values[i]
                i, j = i + 1, j - 1
        if rank <= j:
            high = j
        elif rank >= i:
            low = i
        else:
            break
    return values[rank]


@njit(cache=True)
def _fit(points: NDArray, neighbors: NDArray) -> NDArray:
    """Return the normals of planes through rows of neighbours, shape (n, 3)."""
    normals = np.empty((len(neighbors), 3))
    gaps = np.zeros(neighbors.shape[1])
    for p in range(len(neighbors)):
        near = points[neighbors[p]]
        normals[p] = _normal(near, gaps, 0.0, near[0])
    return normals


@njit(cache=True)
def _normal(near: NDArray, gaps: NDArray, last: float, middle: NDArray) -> NDArray:
    """Return where points with gaps up to the last spread least, unit length, (3,)."""
    total, spread, n = np.zeros(3), np.zeros((3, 3)), 0
    for q in range(len(near)):
        if gaps[q] <= last:
            x, y = near[q, 0] - middle[0], near[q, 1] - middle[1]
            z = near[q, 2] - middle[2]
            total[0], total[1], total[2] = total[0] + x, total[1] + y, total[2] + z
            spread[0, 0] += x * x
            spread[0, 1] += x * y
            spread[0, 2] += x * z
            spread[1, 1] += y * y
            spread[1, 2] += y * z
            spread[2, 2] += z * z
            n += 1
    for a in range(3):
        for b in range(a, 3):
            spread[a, b] -= total[a] * total[b] / n
            spread[b, a] = spread[a, b]
    return _least(spread)


@njit(cache=True)
def _least(A: NDArray) -> NDArray:
    """Return the eigenvector of the least eigenvalue by Jacobi's rotations, (3,)."""
    V = np.eye(3)
    for _ in range(ROUNDS):
        off = A[0, 1] ** 2 + A[0, 2] ** 2 + A[1, 2] ** 2
        if off <= 1e-30 * (A[0, 0] ** 2 + A[1, 1] ** 2 + A[2, 2] ** 2):
            break
        for a in range(2):
            for b in range(a + 1, 3):
                if A[a, b] != 0.0:
                    slope = (A[b, b] - A[a, a]) / (2 * A[a, b])
                    t = 1.0 / (abs(slope) + np.sqrt(slope * slope + 1))
                    t = t if slope >= 0 else -t
                    c = 1.0 / np.sqrt(t * t + 1)
                    _rotate(A, V, a, b, c, t * c)
    least = 0
    for a in range(1, 3):
        if A[a, a] < A[least, least]:
            least = a
    return V[:, least].copy()


@njit(cache=True)
def _rotate(A: NDArray, V: NDArray, a: int, b: int, c: float, s: float) -> None:
    """Turn two axes of a symmetric matrix, and of the vectors found so far."""
    for k in range(3):
        A[k, a], A[k, b] = c * A[k, a] - s * A[k, b], s * A[k, a] + c * A[k, b]
        V[k, a], V[k, b] = c * V[k, a] - s * V[k, b], s * V[k, a] + c * V[k, b]
    for k in range(3):
        A[a, k], A[b, k] = c * A[a, k] - s * A[b, k], s * A[a, k] + c * A[b, k]

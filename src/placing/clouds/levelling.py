"""Normals of a scan, and the rigid motion that levels it on its floor.

Letters for shapes: n points.
"""

from dataclasses import replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing import rigid
from placing.clouds.planes import fit_planes
from placing.clouds.ply import Cloud
from placing.errors import BadInput

BIN_M = 0.01
"""Height of the bins in which levels of a scene are counted."""
# ASSUME: half a millimetre on five metres is level, as in scenes that were drawn.
LEVEL_RAD = 1e-4
"""A cloud that is tilted by less is not turned."""


def estimate_normals(
    cloud: Cloud, n_neighbors: int, up: tuple[float, float, float], max_tilt_rad: float
) -> Cloud:
    """Return the cloud with normals of planes through the neighbours of each point."""
    normals = fit_planes(cloud.points, n_neighbors)
    normals *= _orientation(cloud.points, normals, np.asarray(up), max_tilt_rad)[
        :, None
    ]
    return replace(cloud, normals=normals.astype(np.float32))


def level(
    cloud: Cloud, up: tuple[float, float, float], max_tilt_rad: float, fraction: float
) -> Cloud:
    """Return the cloud turned upright and moved until its floor is at z = 0."""
    direction = vertical(cloud, np.asarray(up, float), max_tilt_rad)
    if np.hypot(*direction[:2]) < LEVEL_RAD and direction[2] > 0:
        points, normals = cloud.points.copy(), cloud.normals
    else:
        R = rigid.turn_up(direction)  # (3, 3)
        points, normals = _turn(cloud.points, R), _turn(cloud.normals, R)
    points[:, 2] -= floor_height(points, normals, max_tilt_rad, fraction)
    return replace(cloud, points=points, normals=normals)


def vertical(
    cloud: Cloud, up: NDArray[np.float64], max_tilt_rad: float
) -> NDArray[np.float64]:
    """Return the normal that most near-horizontal points share, unit length, (3,)."""
    direction = up / np.linalg.norm(up)
    for angle in (max_tilt_rad, max_tilt_rad / 2, max_tilt_rad / 4, max_tilt_rad / 8):
        rows = _near(cloud.normals, direction, np.cos(angle))
        if len(rows) == 0:
            raise BadInput(
                f"cloud: field up is {up.tolist()}, but no point faces there within"
                f" {max_tilt_rad:.2f} rad; expected the direction of the ceiling"
            )
        before = direction
        shared = cloud.normals.take(rows, axis=0)
        direction = np.array([np.median(shared[:, k]) for k in range(3)], float)
        direction /= np.linalg.norm(direction)
        if np.linalg.norm(direction - before) < LEVEL_RAD / 10:
            break  # Fewer points around the same direction would give it again.
    return direction


def floor_height(
    points: NDArray[np.float32],
    normals: NDArray[np.float32],
    max_tilt_rad: float,
    fraction: float,
) -> float:
    """Return the height of the lowest well-filled level that faces up [m]."""
    z = points[normals[:, 2] > np.cos(max_tilt_rad), 2]
    bins = np.floor((z - z.min()) / BIN_M).astype(np.intp)
    count = np.convolve(np.bincount(bins), np.ones(3), mode="same")
    lowest = int(np.argmax(count >= fraction * count.max()))
    near = slice(lowest, lowest + 5)  # The peak is just above the first full bin.
    peak = z.min() + (lowest + int(np.argmax(count[near])) + 0.5) * BIN_M
    return float(np.median(z[np.abs(z - peak) < 2 * BIN_M]))


def _orientation(
    points: NDArray[np.float32],
    normals: NDArray[np.float64],
    up: NDArray[np.float64],
    max_tilt_rad: float,
) -> NDArray[np.float64]:
    """Return the sign that makes each normal point to free space, shape (n,).

    Level points face up but for those of the ceiling; all others face the middle.
    """
    up = up / np.linalg.norm(up)
    rise = normals @ up
    height = points @ up
    # ASSUME: level points in the top tenth of the scene's height belong to the ceiling.
    low, high = np.quantile(height, [0.01, 0.99])
    is_ceiling = height > high - 0.1 * (high - low)
    level_sign = np.where(is_ceiling, -np.sign(rise), np.sign(rise))
    inwards = np.sign(np.sum((np.median(points, axis=0) - points) * normals, axis=1))
    sign = np.where(np.abs(rise) > np.cos(max_tilt_rad), level_sign, inwards)
    return np.where(sign == 0, 1.0, sign)


@njit(cache=True)
def _near(normals: NDArray, direction: NDArray, least: float) -> NDArray:
    """Return which normals have more than the least cosine to a direction."""
    rows = np.empty(len(normals), np.int64)
    n = 0
    for p in range(len(normals)):
        cosine = 0.0
        for k in range(3):
            cosine += normals[p, k] * direction[k]
        if cosine > least:
            rows[n] = p
            n += 1
    return rows[:n]


@njit(cache=True)
def _turn(vectors: NDArray, R: NDArray) -> NDArray:
    """Return the turned vectors, shape (n, 3)."""
    turned = np.empty_like(vectors)
    for p in range(len(vectors)):
        x, y, z = vectors[p]
        for k in range(3):
            turned[p, k] = R[k, 0] * x + R[k, 1] * y + R[k, 2] * z
    return turned

"""Rigid motions: the only place with rotation formulas, but for compiled kernels.

A pose `T_a_b` is (7,) = quaternion wxyz + translation xyz [m] and maps coordinates
of frame b to frame a; adjacent names cancel in a product. Frames are right-handed
with z up; yaw is the angle about z from x towards y, in radians.
"""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

IDENTITY = (1.0, 0.0, 0.0, 0.0)
ON_EDGE = (0.5, 0.5, -0.5, 0.5)
"""Quaternion of the stance `edge`: x turns up, z points to -y, y points to -x."""

UPSIDE_DOWN = (0.0, 1.0, 0.0, 0.0)
"""Quaternion of half a turn about x."""

STANCES = {"upright": IDENTITY, "edge": ON_EDGE}
"""How an object rests before it is turned about the vertical."""


def from_yaw(yaw: float, translation: Array | tuple[float, float, float]) -> Array:
    """Return the pose that turns by `yaw` about z, then translates, shape (7,)."""
    return np.concatenate([yaw_quaternion(yaw), np.asarray(translation, float)])


def yaw_quaternion(yaw: float) -> Array:
    """Return the rotation by `yaw` about z as quaternion wxyz, shape (4,)."""
    return np.array([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])


def about(axis: Array | tuple[float, float, float], angle: float) -> Array:
    """Return the rotation by `angle` [rad] about a unit axis, wxyz, shape (4,)."""
    half = angle / 2
    return np.concatenate([[np.cos(half)], np.sin(half) * np.asarray(axis, float)])


def turn_down(direction: Array) -> Array:
    """Return the smallest rotation that turns a unit vector to -z, wxyz, shape (4,)."""
    axis = np.cross(direction, [0.0, 0.0, -1.0])
    quaternion = np.concatenate([[1.0 - direction[2]], axis])
    length = np.linalg.norm(quaternion)
    return np.array(UPSIDE_DOWN) if length < 1e-6 else quaternion / length


def turn_up(direction: Array) -> Array:
    """Return the smallest rotation that turns a unit vector to z, shape (3, 3)."""
    x, y, z = direction
    if z < -1 + 1e-12:  # Opposite to z the smallest rotation is not unique.
        return np.diag([1.0, -1.0, -1.0])
    skew = np.array([[0.0, 0.0, -x], [0.0, 0.0, -y], [x, y, 0.0]])
    return np.eye(3) + skew + skew @ skew / (1 + z)


def yaw_of(quaternion: Array) -> Array:
    """Return the heading of the turned x axis on the floor, shape (...,) [rad].

    Where the x axis has turned upright (stance `edge`) its heading is undefined and
    the heading of the turned -y axis, the spine of a book on edge, is returned.
    """
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    along_x = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z)])
    along_y = np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z)])
    is_upright = np.hypot(*along_x) < 0.5
    heading = np.where(is_upright, -along_y, along_x)
    return np.arctan2(heading[1], heading[0])


def upward(quaternion: Array) -> Array:
    """Return the z axis of the world as the turned frame sees it, shape (..., 3)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    up = [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    return np.stack(up, axis=-1)


def matrix(quaternion: Array) -> Array:
    """Return the rotation matrix of a quaternion wxyz, shape (3, 3)."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def homogeneous(T_a_b: Array) -> Array:
    """Return the pose as a homogeneous matrix, shape (4, 4)."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = matrix(T_a_b[:4]), T_a_b[4:]
    return T


def from_homogeneous(T: Array) -> Array:
    """Return the pose of a homogeneous matrix, its w not negative, shape (7,)."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z) = T[:3].tolist()
    # SOURCE: Shepperd's method; the largest of the four is found first, w if positive.
    squares = (1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i)
    rows = (
        (squares[0], h - f, c - g, d - b),
        (h - f, squares[1], b + d, c + g),
        (c - g, b + d, squares[2], f + h),
        (d - b, c + g, f + h, squares[3]),
    )
    row = rows[max(range(4), key=squares.__getitem__)]
    sign = -1.0 if row[0] < 0 else 1.0
    scale = sign / math.sqrt(sum(value * value for value in row))
    return np.array([*(scale * value for value in row), x, y, z])


def multiply(p: Array, q: Array) -> Array:
    """Return the product of two quaternions wxyz: first q, then p, shape (4,)."""
    w, v = p[0] * q[0] - p[1:] @ q[1:], p[0] * q[1:] + q[0] * p[1:]
    _, a, b, c = map(float, p)
    _, d, e, f = map(float, q)
    # Spelled out: a product of vectors takes NumPy ten times as long.
    across = np.array([b * f - c * e, c * d - a * f, a * e - b * d])
    return np.concatenate([[w], v + across])


def compose(T_a_b: Array, T_b_c: Array) -> Array:
    """Return `T_a_c`, shape (7,)."""
    rotation = multiply(T_a_b[:4], T_b_c[:4])
    return np.concatenate([rotation, apply(T_a_b, T_b_c[None, 4:])[0]])


def inverse(T_a_b: Array) -> Array:
    """Return `T_b_a`, shape (7,)."""
    conjugate = T_a_b[:4] * np.array([1.0, -1.0, -1.0, -1.0])
    return np.concatenate([conjugate, -matrix(conjugate) @ T_a_b[4:]])


def turn_about_z(yaw: Array, vectors: Array) -> Array:
    """Return vectors (..., 2) or (..., 3) turned by yaws (...) that broadcast [rad]."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y, *z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    turned = np.broadcast_arrays(cos * x - sin * y, sin * x + cos * y, *z)
    return np.stack(turned, axis=-1)


def apply(T_a_b: Array, points_b: Array) -> Array:
    """Return points of frame b in frame a, shape (n, 3)."""
    return points_b @ matrix(T_a_b[:4]).T + T_a_b[4:]


def difference(T_world_a: Array, T_world_b: Array) -> tuple[float, float]:
    """Return how far two poses are apart [m] and how far they are turned [deg]."""
    cosine = min(1.0, float(abs(T_world_a[:4] @ T_world_b[:4])))
    way = float(np.linalg.norm(T_world_a[4:] - T_world_b[4:]))
    return way, float(np.rad2deg(2 * np.arccos(cosine)))


def wrap(angle: Array) -> Array:
    """Return the angle in [-pi, pi), same shape [rad]."""
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi


def near(angle: Array, other: Array) -> Array:
    """Return angles turned by whole turns to within half a turn of others [rad]."""
    return other + wrap(angle - other)

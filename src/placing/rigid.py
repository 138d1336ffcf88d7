"""Rigid motions: the only place with rotation formulas.

A pose `T_a_b` is (7,) = quaternion wxyz + translation xyz [m] and maps coordinates
of frame b to frame a; adjacent names cancel in a product. Frames are right-handed
with z up; yaw is the angle about z from x towards y, in radians.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

IDENTITY = (1.0, 0.0, 0.0, 0.0)
ON_EDGE = (0.5, 0.5, -0.5, 0.5)
"""Quaternion of the stance `edge`: x turns up, z points to -y, y points to -x."""

STANCES = {"upright": IDENTITY, "edge": ON_EDGE}
"""How an object rests before it is turned about the vertical."""


def from_yaw(yaw: float, translation: Array | tuple[float, float, float]) -> Array:
    """Return the pose that turns by `yaw` about z, then translates, shape (7,)."""
    return np.concatenate([yaw_quaternion(yaw), np.asarray(translation, float)])


def yaw_quaternion(yaw: float) -> Array:
    """Return the rotation by `yaw` about z as quaternion wxyz, shape (4,)."""
    return np.array([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])


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


def apply(T_a_b: Array, points_b: Array) -> Array:
    """Return points of frame b in frame a, shape (n, 3)."""
    return points_b @ matrix(T_a_b[:4]).T + T_a_b[4:]


def wrap(angle: Array) -> Array:
    """Return the angle in [-pi, pi), same shape [rad]."""
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi

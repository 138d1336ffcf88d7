"""Whether upright boxes overlap: rectangles turned about z by separating axes, and z.

A box is a row of seven numbers: centre, size in its own frame and yaw. Boxes that only
touch do not overlap.

Shapes: a, b boxes of two lists.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOUCH_M = 1e-6
"""Rounding: boxes that reach no further into each other only touch."""


def grown(boxes: Array, margin_m: float) -> Array:
    """Return boxes wider by half a margin on each of their four sides, (a, 7).

    Two grown boxes that do not overlap stand at least a margin apart. Nothing is added
    above or below: what stands on another box touches it.
    """
    wider = np.array(boxes, float)
    wider[:, 3:5] += margin_m
    return wider


def overlaps(boxes: Array, others: Array) -> NDArray[np.bool_]:
    """Return which pairs of boxes overlap, shape (a, b)."""
    return _overlaps(_prepared(boxes), _prepared(others))


def covers(boxes: Array, points: Array) -> NDArray[np.bool_]:
    """Return which points (b, 3) lie inside which boxes, shape (b, a)."""
    return _covers(_prepared(boxes), np.asarray(points, float))


def _prepared(boxes: Array) -> Array:
    """Return centre, half-size, axis x, radius of the footprint: (a, 9)."""
    boxes = np.asarray(boxes, float).reshape(-1, 7)
    half, yaw = boxes[:, 3:6] / 2, boxes[:, 6]
    radius = np.hypot(half[:, 0], half[:, 1])
    return np.column_stack([boxes[:, :3], half, np.cos(yaw), np.sin(yaw), radius])


@njit(cache=True)
def _overlaps(boxes, others):  # noqa: ANN001, ANN202
    """Return which prepared boxes overlap, (a, b); cheap tests come first."""
    found = np.zeros((len(boxes), len(others)), np.bool_)
    for i in range(len(boxes)):
        x, y, z, depth, width, height, cos, sin, radius = boxes[i]
        for j in range(len(others)):
            dx, dy = others[j, 0] - x, others[j, 1] - y
            reach = radius + others[j, 8]
            if dx * dx + dy * dy >= reach * reach:
                continue
            if abs(others[j, 2] - z) >= height + others[j, 5] - TOUCH_M:
                continue
            c, s, a, b = others[j, 6], others[j, 7], others[j, 3], others[j, 4]
            turn, skew = abs(cos * c + sin * s), abs(cos * s - sin * c)
            found[i, j] = (
                abs(cos * dx + sin * dy) < depth + turn * a + skew * b - TOUCH_M
                and abs(cos * dy - sin * dx) < width + skew * a + turn * b - TOUCH_M
                and abs(c * dx + s * dy) < a + turn * depth + skew * width - TOUCH_M
                and abs(c * dy - s * dx) < b + skew * depth + turn * width - TOUCH_M
            )
    return found


@njit(cache=True)
def _covers(boxes, points):  # noqa: ANN001, ANN202
    """Return which points lie inside which prepared boxes, (b, a)."""
    found = np.zeros((len(points), len(boxes)), np.bool_)
    for j in range(len(boxes)):
        x, y, z, depth, width, height, cos, sin, radius = boxes[j]
        for i in range(len(points)):
            dx, dy = points[i, 0] - x, points[i, 1] - y
            if abs(dx) >= radius or abs(dy) >= radius:
                continue
            found[i, j] = (
                abs(points[i, 2] - z) < height - TOUCH_M
                and abs(cos * dx + sin * dy) < depth - TOUCH_M
                and abs(cos * dy - sin * dx) < width - TOUCH_M
            )
    return found

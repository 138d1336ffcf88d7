"""What is held as spheres that cover its true shape, and not all of its box.

Letters: h cubes and spheres, p planes of a hull.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from placing import rigid
from placing.physics.bodies import Body
from placing.rigid import Array
from placing.robot.checker import Held

CELL_M = 0.05
"""Edge of the cubes; a sphere is around each that the object reaches into."""
MOST_CELLS = 4000
"""Most cubes along the box of an object; larger objects get larger cubes."""
SLACK_M = 0.004
"""How far a shape may stand out of the convex parts that stand for it."""
LOOKS = 5
"""Points of a cube, along each edge, that are looked for in the object."""

N_TOGETHER = 64
"""Cubes looked at together; only speed and memory depend on it."""


def cells_of(body: Body) -> tuple[Array, float]:
    """Return the centres (h, 3) of the cubes a body reaches into, and their radius."""
    corners = body.corners_m
    low, high = corners.min(0) - SLACK_M, corners.max(0) + SLACK_M
    size = high - low
    cell_m = max(CELL_M, float(np.prod(size) / MOST_CELLS) ** (1 / 3))
    counts = np.maximum(np.ceil(size / cell_m), 1).astype(int)
    cell = size / counts
    centres = (np.indices(counts).reshape(3, -1).T + 0.5) * cell + low
    is_reached = np.zeros(len(centres), bool)
    for piece in body.pieces:
        planes = ConvexHull(piece.vertices_m).equations
        is_reached |= _reached(centres - body.mass_centre_m, cell, planes)
    return centres[is_reached], float(np.linalg.norm(cell) / 2)


def _reached(centres: Array, cell: Array, planes: Array) -> NDArray[np.bool_]:
    """Return which cubes hold a point of a convex piece, shape (h,)."""
    steps = np.linspace(-0.5, 0.5, LOOKS)
    looks = np.stack(np.meshgrid(steps, steps, steps), -1).reshape(-1, 3) * cell
    # What is thinner than the distance of two looks is thickened until it is seen.
    slack = SLACK_M + np.linalg.norm(cell) / (LOOKS - 1) / 2
    outside = centres @ planes[:, :3].T + planes[:, 3]  # (h, p)
    is_reached = np.all(outside <= slack, axis=1)
    near = np.all(outside <= np.linalg.norm(cell) / 2 + slack, axis=1)
    unsure = np.flatnonzero(near & ~is_reached)
    for some in np.split(unsure, range(N_TOGETHER, len(unsure), N_TOGETHER)):
        points = (centres[some, None] + looks).reshape(-1, 3)
        inside = np.all(points @ planes[:, :3].T + planes[:, 3] <= slack, axis=1)
        is_reached[some] = inside.reshape(-1, len(looks)).any(1)
    return is_reached


def carried(
    object_id: str,
    size_m: Sequence[float],
    cells: tuple[Array, float],
    T_tool_object: Array,
) -> Held:
    """Return an object in the gripper, covered by spheres around its cubes."""
    centres, radius_m = cells
    at = rigid.apply(T_tool_object, centres)
    radius = np.full(len(centres), radius_m)
    T, size = np.asarray(T_tool_object, float), np.asarray(size_m, float)
    return Held(object_id, T, size, at, radius)

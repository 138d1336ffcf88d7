"""The eye sees the whole room from outside, and no wall is in its way."""

import numpy as np
import pytest

from placing.recordings.blueprint import (
    ASPECT,
    VERTICAL_VIEW_DEG,
    Eye,
    eye_of_room,
    is_in_front,
)

SIZE = np.array([5.0, 3.0, 2.6])


def room(outline: list[list[float]]) -> np.ndarray:
    """Return points every 5 cm on the walls of a room with this outline, (n, 3)."""
    heights = np.arange(0, SIZE[2], 0.05)
    walls = []
    for a, b in zip(outline, outline[1:] + outline[:1], strict=True):
        length = np.linalg.norm(np.subtract(b, a))
        along = np.linspace(a, b, int(length / 0.05))
        walls.append(
            np.column_stack(
                [np.tile(along, (len(heights), 1)), np.repeat(heights, len(along))]
            )
        )
    return np.concatenate(walls)


RECTANGLE = [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [0.0, 3.0]]


def on_screen(points: np.ndarray, eye: Eye) -> np.ndarray:
    """Return where an eye sees points, 1 at the edges of its view, shape (n, 2)."""
    forward = (eye.target - eye.position) / np.linalg.norm(eye.target - eye.position)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    ray = points - eye.position
    slope = np.tan(np.deg2rad(VERTICAL_VIEW_DEG) / 2) * (ray @ forward)
    up = np.cross(right, forward)
    return np.column_stack([ray @ right / (slope * ASPECT), ray @ up / slope])


@pytest.mark.parametrize("corner", [(1, 1), (4, 1), (1, 2), (4, 2)])
def test_the_room_fills_the_view_and_nothing_of_its_floor_is_outside(corner):
    points = room(RECTANGLE)
    eye = eye_of_room(points, np.array([[*corner, 0.8]]))
    seen = on_screen(points[points[:, 2] < 1.6], eye)
    assert 0.98 < np.abs(seen).max() < 1.0 + 1e-9


def test_the_eye_is_outside_and_objects_are_at_the_far_side():
    points = room(RECTANGLE)
    eye = eye_of_room(points, np.array([[4.5, 2.5, 0.8]]))
    assert eye.position[0] < SIZE[0] / 2
    assert eye.position[1] < 0
    assert eye.position[2] > SIZE[2]


CORNERED = [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [2.5, 3.0], [2.5, 1.5], [0.0, 1.5]]


@pytest.mark.parametrize(
    ("outline", "near"),
    [
        (RECTANGLE, [(0, 0.0), (1, 3.0)]),
        (CORNERED, [(0, 0.0), (1, 3.0), (0, 2.5), (1, 1.5)]),
    ],
)
def test_walls_towards_the_eye_are_cut_and_those_behind_the_room_are_kept(
    outline, near
):
    points = room(outline)
    eye = eye_of_room(points, np.array([[4.5, 1.0, 0.8]]))  # seen from -x, +y
    cut = is_in_front(points, eye)
    is_high = points[:, 2] > 0.5
    for axis, at in near:
        wall = is_high & (points[:, axis] == at)
        assert cut[wall].mean() > 0.9, "all but the strip at an inner corner"
    is_amid = (points[:, :2] > 0.4).all(axis=1) & (points[:, 1] < 2.6)
    assert not cut[(points[:, 0] == 5.0) & is_amid].any()
    assert not cut[(points[:, 1] == 0.0) & (points[:, 0] > 0.4)].any()
    assert not cut[points[:, 2] < 0.05].any(), "the edge of the floor stays"

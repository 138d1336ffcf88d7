"""Room is a box without points beside it, and a floor below all of it."""

import numpy as np
import pytest

from placing.clouds.ply import Cloud
from placing.psi.elbow_room import has_room
from placing.psi.placing_field import PlacingField
from placing.scene import PlacingArea

SQUARE = np.array([(0, 0), (2, 0), (2, 2), (0, 2)], float)


def cloud(points):
    points = np.asarray(points, np.float32)
    up = np.tile(np.float32([0, 0, 1]), (len(points), 1))
    return Cloud(points, up, np.full(points.shape, 128, np.uint8))


def area(is_floor):
    return PlacingArea("area1", SQUARE, 0.0, np.inf, is_floor, None)


def naive(points, box, room_m, lift_m):
    """Return whether no point is in the grown box, point by point."""
    for x, y, z in points:
        cos, sin = np.cos(box[6]), np.sin(box[6])
        a = np.array([[cos, sin], [-sin, cos]])
        along = a @ (np.array([x, y]) - box[:2])
        beside = np.abs(along) < box[3:5] / 2 + room_m
        top = max(box[5], lift_m + room_m)
        if beside.all() and lift_m < z - (box[2] - box[5] / 2) < top:
            return False
    return True


@pytest.mark.parametrize("room_m", [0.0, 0.05])
def test_room_is_that_of_a_loop_over_points(room_m):
    rng = np.random.default_rng(0)
    points = rng.uniform([0, 0, 0], [2, 2, 1], (150, 3)).astype(np.float32)
    boxes = np.column_stack(
        [
            rng.uniform(0.2, 1.8, (200, 2)),
            rng.uniform(0.1, 0.6, 200),
            rng.uniform(0.05, 0.4, (200, 3)),
            rng.uniform(-3, 3, 200),
        ]
    )
    field = PlacingField(cloud(points), 0.01)
    args = boxes, np.zeros(200, int), room_m, 0.02
    found = has_room(field.points, (area(False),), *args)
    truth = [naive(points.astype(float), box, room_m, 0.02) for box in boxes]
    assert found.tolist() == truth
    assert 20 < found.sum() < 180


def test_a_plate_flatter_than_its_lift_keeps_off_a_wall():
    box = np.array([[1.0, 1.0, 0.01, 0.3, 0.3, 0.02, 0.0]])
    wall = [[1.17, 1.0, z] for z in (0.0, 0.04, 0.08)]
    args = np.zeros(1, int), 0.03, 0.03
    for points, is_free in ((wall, False), (wall[:1], True)):
        field = PlacingField(cloud(points), 0.01)
        assert has_room(field.points, (area(False),), box, *args)[0] == is_free


def test_on_the_floor_all_of_it_is_on_what_was_seen():
    box = np.array([[1.9, 1.0, 0.1, 0.3, 0.3, 0.2, 0.0]])
    field = PlacingField(cloud([[1.0, 1.0, 0.0]]), 0.01)
    args = np.zeros(1, int), 0.01, 0.02
    assert not has_room(field.points, (area(True),), box, *args)[0]
    assert has_room(field.points, (area(False),), box, *args)[0]
    box[0, 0] = 1.0
    assert has_room(field.points, (area(True),), box, *args)[0]

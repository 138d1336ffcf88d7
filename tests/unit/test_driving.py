"""Driving: ways on the floor are free, and what is shut off is not reached."""

from functools import cache

import numpy as np
import pytest
from robot_room import DOCUMENT, checker, stowed

from placing.errors import NoFloor
from placing.robot.driving import Floor, shortened
from placing.robot.planning import PlanningConfig

SECTION = {**DOCUMENT["planning"], "floor_cell_m": 0.1}
CONFIG = PlanningConfig(**{**SECTION, "retreat_m": tuple(SECTION["retreat_m"])})


@cache
def floor():
    return Floor(checker(), CONFIG, "room")


def test_the_start_is_free_and_can_be_turned_at():
    start = floor().start
    poses = np.tile(start, (16, 1))
    poses[:, 2] = np.arange(16) / 16 * 2 * np.pi
    assert checker().are_free(poses).all()
    assert floor().is_reachable(*start[:3])


def test_ways_to_reachable_poses_are_free_and_end_there():
    rng = np.random.default_rng(1)
    for i in rng.choice(floor().reachable, 12):
        goal = floor().configurations(floor().poses[i])[0]
        path = floor().path(goal)
        assert path is not None
        assert checker().is_path_free(path)
        assert np.array_equal(path[0], floor().start)
        assert np.allclose(path[-1][:2], goal[:2])
        assert np.isclose(np.cos(path[-1][2] - goal[2]), 1)
        assert np.abs(np.diff(path[:, 2])).max(initial=0) <= np.pi + 1e-9


def test_a_fence_of_boxes_shuts_a_part_of_the_room_off():
    fence = checker().with_boxes([(1.9, 1.5, 0.5, 0.05, 3.4, 1.0, 0.0)])
    fenced = Floor(fence, CONFIG, "room")
    xs = fenced.poses[fenced.reachable][:, 0]
    assert xs.max() < 1.9 or xs.min() > 1.9
    everywhere = floor().poses[floor().reachable][:, 0]
    assert everywhere.min() < 1.9 - 0.3


def test_a_box_in_the_way_is_driven_around_or_refused():
    goal = floor().configurations(floor().poses[floor().reachable[0]])[0]
    middle = (floor().start[:2] + goal[:2]) / 2
    more = checker().with_boxes([(*middle, 0.2, 0.1, 0.1, 0.4, 0.0)])
    path = floor().path(goal, more)
    assert path is None or more.is_path_free(path)


def test_corners_are_left_out_where_the_straight_way_is_free():
    q = stowed(*floor().start[:2])
    zigzag = np.array([q, q + 0, q + 0, q])
    zigzag[1, 2] += 0.2
    zigzag[2, 2] -= 0.2
    assert len(shortened(zigzag, checker(), None)) == 2


def test_a_scene_without_open_floor_is_one_line():
    full = checker().with_boxes([(2.0, 1.5, 0.5, 6.0, 6.0, 1.0, 0.0)])
    with pytest.raises(NoFloor, match="room: floor: no spot where the robot pr2"):
        Floor(full, CONFIG, "room")

"""Driving: ways on the floor are free, and what is shut off is not reached."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from robot_room import DOCUMENT, checker, stowed
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placing import rigid
from placing.errors import NoFloor
from placing.robot.checker import held
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
    assert floor().start_pose in floor().reachable


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


def test_ways_with_an_object_are_as_short_as_those_of_an_exhaustive_search():
    place, lattice = floor(), floor().lattice
    post = checker().with_boxes([(0.7, 0.7, 0.5, 0.1, 0.1, 1.0, 0.0)])
    tray = held("tray", (0.1, 0.3, 0.1), rigid.from_yaw(0.0, (0.05, 0.0, 0.0)))
    is_free = post.are_free(place.configurations(place.poses), tray)
    n = len(place.poses)
    ways = csr_matrix((lattice.length_m, lattice.other, lattice.first), shape=(n, n))
    ways = ways.multiply(is_free[:, None]).multiply(is_free[None]).tocsr()
    ways.eliminate_zeros()
    shortest = dijkstra(ways, indices=place.start_pose)
    assert is_free[place.start_pose]
    n_found = 0
    for goal in np.random.default_rng(2).choice(place.reachable, 40).tolist():
        args = place.start, lattice, goal, place.start_pose, tray
        nodes = post.way(*args)
        assert bool(len(nodes)) == np.isfinite(shortest[goal])
        if len(nodes):
            assert (nodes[0], nodes[-1]) == (goal, place.start_pose)
            length = sum(ways[i, j] for i, j in pairwise(nodes.tolist()))
            assert np.isclose(length, shortest[goal])
            n_found += 1
    assert 5 < n_found < 40


def test_what_has_no_way_is_known_for_all_that_is_joined_to_it():
    place = floor()
    fence = checker().with_boxes([(1.5, 1.5, 0.5, 0.05, 3.4, 1.0, 0.0)])
    goals = place.configurations(place.poses[place.reachable[::61]])
    start, *goals = goals[fence.are_free(goals)]
    is_lost = np.zeros(len(place.poses), np.bool_)
    found = [place.path(q, fence, None, start, is_lost) is None for q in goals]
    assert found == [place.path(q, fence, None, start) is None for q in goals]
    assert found == [(q[0] > 1.5) is not (start[0] > 1.5) for q in goals]
    assert 3 < sum(found) < len(found) - 3
    assert is_lost.sum() > 100

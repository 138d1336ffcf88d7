"""Paths: free, the same for the same seed, and given up after so many checks."""

from dataclasses import replace

import numpy as np
from robot_room import checker, reaching

from placing.robot.paths import Query, connect

QUERY = Query(7, 1500, 1.0)


def ends():
    """Return two free configurations with a box between them, and the checker."""
    start = reaching().copy()
    goal = start.copy()
    goal[4:] = checker().model.settings.stow
    return start, goal


def around():
    """Return a checker with a box on the straight way of the tool."""
    from placing.robot.model import tool_pose

    start, goal = ends()
    middle = tool_pose(checker().model, (start + goal) / 2)[4:]
    box = checker().with_boxes([(*middle, 0.08, 0.08, 0.08, 0.0)])
    assert box.is_free(start)
    assert box.is_free(goal)
    assert not box.is_edge_free(start, goal)
    return box


def test_a_path_is_free_keeps_the_base_and_joins_its_ends():
    start, goal = ends()
    path = connect(around(), start, goal, None, QUERY)
    assert path is not None
    assert around().is_path_free(path)
    assert np.array_equal(path[0], start)
    assert np.array_equal(path[-1], goal)
    assert np.array_equal(path[:, :4], np.repeat(start[None, :4], len(path), axis=0))


def test_the_same_seed_gives_the_same_path_whatever_ran_before():
    start, goal = ends()
    first = connect(around(), start, goal, None, QUERY)
    connect(around(), start, goal, None, replace(QUERY, seed=11))
    assert np.array_equal(first, connect(around(), start, goal, None, QUERY))


def test_a_straight_way_that_is_free_is_taken():
    start, _ = ends()
    near = start.copy()
    near[10] += 0.3
    assert len(connect(checker(), start, near, None, QUERY)) == 2


def test_an_end_in_collision_has_no_path_and_ends_at_once():
    start, goal = ends()
    inside = start.copy()
    inside[0] = -3.0
    before = checker().n_checks
    assert connect(checker(), inside, goal, None, QUERY) is None
    assert checker().n_checks - before < 5


def test_a_query_is_given_up_after_so_many_checks():
    start, goal = ends()
    assert connect(around(), start, goal, None, replace(QUERY, n_checks=1)) is None

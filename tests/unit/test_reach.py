"""Reach: goals put the tool where it should be, and lines are straight."""

from functools import cache

import numpy as np
from robot_room import TOP_M, checker, pr2
from test_driving import CONFIG, floor

from placing import rigid
from placing.robot.grasps import facing
from placing.robot.hands import best_first, hands_at
from placing.robot.model import tool_pose
from placing.robot.reach import standing_places

T_WORLD_OBJECT = rigid.from_yaw(0.3, (2.95, 1.5, TOP_M + 0.06))


@cache
def hands():
    bases = standing_places(floor(), checker(), T_WORLD_OBJECT, CONFIG)
    T = np.concatenate([facing(0.4, np.pi / 4, 0.0), T_WORLD_OBJECT[4:]])
    return bases, T, hands_at(checker(), bases, T)[1]


def test_the_robot_can_stand_at_its_standing_places():
    bases, _, _ = hands()
    settings = pr2().settings
    assert len(bases) > 10
    assert checker().are_free(floor().configurations(bases)).all()
    away = np.hypot(*(bases[:, :2] - T_WORLD_OBJECT[4:6]).T)
    assert away.max() <= settings.reach_m[1] + CONFIG.floor_cell_m


def test_every_solution_brings_the_tool_where_it_is_wanted():
    _, T, rows = hands()
    assert len(rows) > 50
    for q in rows[:: len(rows) // 40]:
        pose = tool_pose(pr2(), q)
        assert np.allclose(pose[4:], T[4:], atol=1e-6)
        assert np.isclose(abs(pose[:4] @ T[:4]), 1)
        assert np.all(q >= pr2().lower - 1e-9)
        assert np.all(q <= pr2().upper + 1e-9)


def test_no_configuration_is_free_where_the_hand_alone_is_not():
    anywhere = np.random.default_rng(3).uniform(-1, 1, (2000, 11))
    low, high = np.maximum(pr2().lower, -3), np.minimum(pr2().upper, 3)
    rows = (low + high) / 2 + anywhere * (high - low) / 2
    Ts = np.array([rigid.homogeneous(tool_pose(pr2(), q)) for q in rows])
    for touching in (False, True):
        are_hands_free = checker().are_hands_free(Ts, None, touching)
        assert 100 < are_hands_free.sum() < len(rows) - 100
        assert not checker().are_free(rows, None, touching)[~are_hands_free].any()


def test_solutions_of_different_bases_come_before_second_ones():
    _, _, rows = hands()
    _, base = np.unique(rows[:, :3], axis=0, return_inverse=True)
    ordered = best_first(rows, base.ravel(), pr2().settings.carry)
    assert sorted(map(tuple, ordered)) == sorted(map(tuple, rows))
    n_bases = len(np.unique(rows[:, :3], axis=0))
    assert len(np.unique(ordered[:n_bases, :3], axis=0)) == n_bases


def test_an_object_in_the_middle_of_a_wall_has_no_standing_place_far_away():
    far = rigid.from_yaw(0.0, (20.0, 20.0, 1.0))
    assert len(standing_places(floor(), checker(), far, CONFIG)) == 0

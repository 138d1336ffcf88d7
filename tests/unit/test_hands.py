"""Hands: arms are those that plain search finds, and are found once."""

import numpy as np
from robot_room import TOP_M, anywhere, checker, pr2
from test_driving import CONFIG, floor

from placing import rigid
from placing.robot.checker import held
from placing.robot.grasps import facing
from placing.robot.hands import Hands, hands_at
from placing.robot.model import tool_pose
from placing.robot.reach import standing_places

T_WORLD_OBJECT = rigid.from_yaw(0.3, (2.95, 1.5, TOP_M + 0.06))
MUG = held("mug", (0.06, 0.06, 0.14), rigid.from_yaw(0.0, (0.0, 0.0, 0.0)))


def asked():
    """Return bases around a place on the table, and a tool there."""
    bases = standing_places(floor(), checker(), T_WORLD_OBJECT, CONFIG)
    return bases, np.concatenate([facing(0.4, np.pi / 4, 0.0), T_WORLD_OBJECT[4:]])


def test_no_configuration_is_free_in_which_the_hand_is_not_clear_of_the_body():
    rows = anywhere(5, 3000)
    low, high = np.maximum(pr2().lower, -3), np.minimum(pr2().upper, 3)
    rows[:, 3:] = np.random.default_rng(6).uniform(low[3:], high[3:], rows[:, 3:].shape)
    for what in (None, MUG):
        clear = [
            checker().are_hands_clear(
                q[None, :4], rigid.homogeneous(tool_pose(pr2(), q)), what
            )[0]
            for q in rows
        ]
        assert 50 < np.sum(clear) < len(rows) - 50
        is_free = checker().are_free(rows, what)
        assert not is_free[~np.array(clear)].any()


def test_arms_are_the_free_ones_of_all_solutions_and_are_found_once():
    (bases, T), hands = asked(), Hands(checker())
    which, rows = hands_at(checker(), bases, T, MUG)
    is_free = checker().are_free(rows, MUG, touching=True)
    found = list(hands.arms(bases, T, MUG))
    assert len(found) > 1
    assert np.array_equal(np.concatenate([a.rows for a in found]), rows[is_free])
    assert np.array_equal(np.concatenate([a.base for a in found]), which[is_free])
    reached = np.any([a.is_reached for a in found], axis=0)
    assert np.array_equal(np.flatnonzero(reached), np.unique(which))
    n_checks = hands.alone.n_checks
    again = list(hands.arms(bases, T, MUG))
    assert [id(a) for a in again] == [id(a) for a in found]
    assert hands.alone.n_checks == n_checks

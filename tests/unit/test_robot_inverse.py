"""Solutions of the inverse bring the tool where the physics engine says it is."""

from dataclasses import replace

import numpy as np
import pytest
from robot_study import Bullet, model, random_configurations, settings

from placing import rigid
from placing.errors import BadInput
from placing.robot.inverse import arm_solutions, follow, solutions_at
from placing.robot.model import load_robot, tool_pose


def reachable(rng, name, n):
    """Configurations with the base at the origin, and the poses of their tools."""
    configurations = random_configurations(rng, name, n)
    configurations[:, :3] = 0
    return [(q, tool_pose(model(name), q)) for q in configurations]


def assert_same_pose(T, wanted):
    assert np.allclose(T[4:], wanted[4:], atol=1e-5)
    turn = abs(np.dot(T[:4], wanted[:4]) / np.linalg.norm(T[:4]))
    assert np.sqrt(max(0, 1 - turn**2)) < 5e-5


def assert_within_limits(robot, arms):
    assert np.all(arms >= robot.lower[4:])
    assert np.all(arms <= robot.upper[4:])


def test_the_closed_form_solves_what_the_arm_can_reach():
    rng = np.random.default_rng(0)
    found = [
        len(arm_solutions(model("pr2"), T, q[3])) > 0
        for q, T in reachable(rng, "pr2", 4000)
    ]
    assert np.mean(found) >= 0.998


def test_each_solution_of_the_closed_form_is_right_in_the_physics_engine():
    robot, rng, n = model("pr2"), np.random.default_rng(1), 0
    with Bullet(robot) as bullet:
        for q, T in reachable(rng, "pr2", 400):
            arms = arm_solutions(robot, T, q[3])
            assert_within_limits(robot, arms)
            for arm in arms[:3]:
                bullet.move(np.array([*q[:4], *arm]))
                assert_same_pose(bullet.pose("r_gripper_tool_frame"), T)
                n += 1
    assert n > 900


def trying(robot, n_tries):
    return replace(robot, settings=replace(robot.settings, n_tries=n_tries))


def test_more_pans_find_more_solutions_in_a_fixed_order():
    robot, rng = model("pr2"), np.random.default_rng(2)
    q, T = reachable(rng, "pr2", 1)[0]
    few, many = (arm_solutions(trying(robot, n), T, q[3]) for n in (20, 80))
    assert len(many) > len(few)
    assert np.array_equal(few, arm_solutions(trying(robot, 20), T, q[3]))


def test_what_is_out_of_reach_has_no_solution():
    T = rigid.from_yaw(0.0, (3.0, 0.0, 1.0))
    assert arm_solutions(model("pr2"), T, 0.1).shape == (0, 7)
    assert len(arm_solutions(trying(model("tiago"), 4), T, 0.1)) == 0


def test_an_arm_of_another_shape_is_refused():
    with pytest.raises(BadInput, match=r"inverse: value 'pr2'; expected 'numerical'"):
        load_robot(replace(settings("tiago"), inverse="pr2"))


def test_the_numerical_inverse_is_right_in_the_physics_engine():
    robot, rng = model("tiago"), np.random.default_rng(3)
    T_frame_tool = rigid.inverse(
        rigid.compose(rigid.inverse(T_of_zero(robot)), T_zero(robot))
    )
    solved = 0
    with Bullet(robot) as bullet:
        for q, T in reachable(rng, "tiago", 40):
            arms = arm_solutions(trying(robot, 12), T, q[3])
            assert_within_limits(robot, arms)
            solved += len(arms) > 0
            for arm in arms[:3]:
                bullet.move(np.array([*q[:4], *arm]))
                frame = bullet.pose(robot.settings.tool_frame)
                assert_same_pose(rigid.compose(frame, rigid.inverse(T_frame_tool)), T)
    assert solved >= 38


def T_zero(robot):
    return tool_pose(robot, np.zeros(11))


def T_of_zero(robot):
    with Bullet(robot) as bullet:
        bullet.move(np.zeros(11))
        return bullet.pose(robot.settings.tool_frame)


def test_the_numerical_inverse_solves_the_pr2_as_the_closed_form_does():
    numerical = load_robot(replace(settings("pr2"), inverse="numerical", n_tries=12))
    rng = np.random.default_rng(4)
    for q, T in reachable(rng, "pr2", 15):
        for arm in arm_solutions(numerical, T, q[3]):
            assert_same_pose(tool_pose(numerical, np.array([*q[:4], *arm])), T)
        assert len(arm_solutions(numerical, T, q[3])) > 0


@pytest.mark.parametrize(("name", "n_lines"), [("pr2", 30), ("tiago", 9)])
def test_a_followed_line_is_straight_and_without_jumps(name, n_lines):
    robot, n = model(name), 0
    configurations = random_configurations(np.random.default_rng(6), name, n_lines)
    for q in configurations:
        line = np.tile(tool_pose(robot, q), (11, 1))
        line[:, 6] += np.linspace(0, 0.1, 11)
        path = follow(robot, q, line)
        if len(path) < len(line):
            continue
        n += 1
        assert np.array_equal(path[:, :4], np.tile(q[:4], (11, 1)))
        assert (
            np.max(np.abs(np.diff(path[:, 4:], axis=0))) < robot.settings.max_step_rad
        )
        assert np.max(np.abs(path[0] - q)) < 1e-3
        for row, T in zip(path, line, strict=True):
            assert_same_pose(tool_pose(robot, row), T)
    assert n >= n_lines // 3


def test_a_followed_line_continues_a_joint_that_has_turned_round():
    robot = model("pr2")
    q = np.array([0, 0, 0, 0.1, *robot.settings.carry])
    q[[8, 10]] += 4 * np.pi
    path = follow(robot, q, np.tile(tool_pose(robot, q), (3, 1)))
    assert len(path) == 3
    assert np.allclose(path, q, atol=1e-6)


def test_a_line_out_of_reach_is_not_followed():
    robot = model("pr2")
    q = np.array([0, 0, 0, 0.1, *robot.settings.carry])
    line = np.tile(tool_pose(robot, q), (100, 1))
    line[:, 4] += np.linspace(0, 1.0, 100)
    path = follow(robot, q, line)
    assert 0 < len(path) < len(line)
    assert len(follow(robot, q, line[: len(path)])) == len(path)
    jump = line[[0, 99]] - np.array([0, 0, 0, 0, 0.7, 0, 0]) * [[0], [1]]
    assert len(follow(robot, q, jump)) == 1


@pytest.mark.parametrize("n", [1, 2, 40])
def test_many_places_together_have_the_solutions_that_each_has(n):
    robot, rng = model("pr2"), np.random.default_rng(7)
    q, T_world_tool = reachable(rng, "pr2", 1)[0]
    low, high = robot.settings.torso_range_m
    places = rng.normal(scale=[0.03, 0.03, 0.1, 0], size=(n, 4))
    places[:, 3] = np.clip(q[3] + rng.normal(scale=0.02, size=n), low, high)
    which, arms = solutions_at(robot, places, rigid.homogeneous(T_world_tool))
    for i, (x, y, yaw, height_m) in enumerate(places):
        T_world_base = rigid.from_yaw(yaw, (x, y, 0.0))
        T = rigid.compose(rigid.inverse(T_world_base), T_world_tool)
        alone, together = arm_solutions(robot, T, height_m), arms[which == i]
        assert len(together) == len(alone) or len(together) == 0
        assert np.allclose(together, alone[: len(together)], atol=1e-9)
    assert len(np.unique(which)) >= 0.8 * n

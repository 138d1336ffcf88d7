"""A certificate that holds passes the replay; one fault of any kind is found."""

from dataclasses import replace

import numpy as np
import pytest
from certified import (
    BLOCK,
    REPLAY,
    SETTLING,
    bodies,
    certificate,
    fixed,
    pillar,
    settings,
    with_segment,
)

from placing import rigid
from placing.physics.bodies import Piece
from placing.physics.simulator import new_world
from placing.robot.model import load_robot, tool_pose
from placing.robot.puppet import Puppet
from placing.robot.replay import judge_all
from placing.robot.walking import finer

GOOD = certificate()
BODIES = bodies()
REACH_M = 0.03
APPROACH, LIFT, DRIVE, LOWER, RETREAT = range(5)


def verdict(given, pieces=None, config=REPLAY):
    pieces = fixed() if pieces is None else pieces
    args = settings(), pieces, BODIES, config, SETTLING, REACH_M
    (found,) = judge_all([given], *args)
    return found


def moved_end(dx_m, dz_m):
    T = GOOD.T_world_object + np.array([0, 0, 0, 0, dx_m, 0, dz_m])
    return replace(GOOD, T_world_object=T)


def test_a_good_certificate_holds():
    found = verdict(GOOD)
    assert found.reason == ""
    assert found.end_error_m < 1e-4
    assert found.moved_m < 1e-3
    assert found.n_looks > 100


def test_the_same_certificate_gives_the_same_numbers():
    assert verdict(GOOD) == verdict(GOOD)


def test_a_way_point_in_the_furniture_is_found():
    path = GOOD.segments[LOWER].path.copy()
    path[2, 3] -= 0.12  # the torso sinks until the gripper is in the pillar
    assert "in pillar2 by" in verdict(with_segment(GOOD, LOWER, path=path)).reason


def test_what_an_earlier_certificate_hit_is_not_hit_again():
    mesh = pillar(-0.7, 0, 1) + pillar(5, 0, 1)  # one mesh, the robot between its ends
    pieces = fixed() | {"fence": (Piece(mesh.vertices, mesh.faces, False),)}
    path = GOOD.segments[APPROACH].path.copy()
    path[:, 0] -= 1.09  # the base is before the first side, and 1 cm in it
    args = settings(), pieces, BODIES, REPLAY, SETTLING, REACH_M
    bad, good = judge_all([with_segment(GOOD, APPROACH, path=path), GOOD], *args)
    assert "in fence by" in bad.reason
    assert good.reason == ""


def test_a_joint_beyond_its_limit_is_found():
    path = GOOD.segments[DRIVE].path.copy()
    path = np.insert(path, 1, path[0], axis=0)
    path[1, 5] = -0.8  # the shoulder lifts up to -0.5236 rad
    reason = verdict(with_segment(GOOD, DRIVE, path=path)).reason
    assert "r_shoulder_lift_joint is -0.5" in reason
    assert "outside its limits" in reason


@pytest.mark.parametrize(("dx_m", "dz_m"), [(0.02, 0), (0, 0.02), (0, -0.04)])
def test_an_end_that_is_elsewhere_is_found(dx_m, dz_m):
    reason = verdict(moved_end(dx_m, dz_m)).reason
    assert "put retreat: the object is" in reason
    assert "from its place" in reason


def test_an_object_that_is_turned_in_the_hand_is_found():
    T = np.array([*rigid.yaw_quaternion(np.deg2rad(3)), 0, 0, 0])
    reason = verdict(replace(GOOD, T_tool_object=T)).reason
    assert "pick lift: the object is 0 mm and 3.0 deg from its place" in reason


def test_an_object_that_is_grasped_elsewhere_is_found():
    T = GOOD.T_world_start + np.array([0, 0, 0, 0, 0, 0.02, 0])
    assert "pick" in verdict(replace(GOOD, T_world_start=T)).reason


def test_an_object_that_nothing_carries_falls():
    pieces = {name: some for name, some in fixed().items() if name != "pillar2"}
    assert "let go: comes to rest" in verdict(GOOD, pieces).reason


def test_an_object_that_stands_on_an_edge_falls():
    pillar = fixed()["pillar2"]
    aside = [
        replace(p, vertices_m=p.vertices_m + np.array([0.08, 0, 0])) for p in pillar
    ]
    assert "let go" in verdict(GOOD, fixed() | {"pillar2": tuple(aside)}).reason


def test_a_jump_between_segments_is_found():
    path = GOOD.segments[DRIVE].path + 0.01
    reason = verdict(with_segment(GOOD, DRIVE, path=path)).reason
    assert reason.startswith("put drive: jumps by 0.010")


def test_a_whole_turn_between_segments_is_no_jump():
    segments = list(GOOD.segments)
    for i in (DRIVE, LOWER, RETREAT):
        path = segments[i].path.copy()
        path[:, [2, 10]] += 2 * np.pi
        segments[i] = replace(segments[i], path=path)
    assert verdict(replace(GOOD, segments=tuple(segments))).reason == ""


def test_fingers_in_the_object_are_allowed_as_far_as_it_gives_way():
    squeezed = with_segment(GOOD, DRIVE, opening_m=0.0)  # 3 cm in each side
    assert verdict(squeezed).reason == ""
    reason = verdict(squeezed, config=replace(REPLAY, finger_m=0.02)).reason
    assert reason.startswith("put drive: r_gripper_")
    assert "finger_tip_link in can1 by 3" in reason


def test_an_object_in_the_way_is_found():
    half = rigid.from_yaw(np.pi / 4, (0, 0, 0))
    T = rigid.compose(half, np.array([1.0, 0, 0, 0, 0.70, -0.25, 0.95]))
    reason = verdict(replace(GOOD, standing={BLOCK.object_id: T})).reason
    assert "block1" in reason


def test_a_robot_that_hits_itself_is_found():
    path = GOOD.segments[RETREAT].path
    end = path[-1].copy()
    end[4:] = [0.7, 0.5, -1.5, -1.8, 0.0, -1.0, 0.0]  # into the other arm
    path = np.vstack([path, end])
    reason = verdict(with_segment(GOOD, RETREAT, path=path)).reason
    assert "r_forearm_link in l_gripper" in reason


def test_an_object_that_is_never_let_go_is_found():
    reason = verdict(replace(GOOD, segments=GOOD.segments[:RETREAT])).reason
    assert reason == "end: the object is never let go"


def test_the_simulator_places_the_tool_where_the_planner_does():
    model, rng = load_robot(settings()), np.random.default_rng(1)
    with new_world(240, 0.7, 0.001) as world:
        puppet = Puppet(world.client, settings(), is_fixed=False)
        for _ in range(20):
            q = np.array([*rng.uniform(-3, 3, 3), 0.1, *rng.uniform(-1, 1, 7)])
            puppet.pose(q, 0.05)
            found, planned = puppet.tool(), tool_pose(model, q)
            np.testing.assert_allclose(found[4:], planned[4:], atol=1e-5)
            assert abs(found[:4] @ planned[:4]) > 1 - 1e-6


def test_a_finer_path_passes_all_way_points_in_small_steps():
    path = GOOD.segments[LIFT].path
    fine = finer(path, REPLAY)
    for row in path:
        assert np.abs(fine - row).max(1).min() < 1e-12
    assert np.abs(np.diff(fine, axis=0)).max() <= REPLAY.step_rad + 1e-12


def test_only_what_the_torso_does_not_lift_may_roll_over_what_is_low():
    with new_world(240, 0.7, 0.001) as world:
        puppet = Puppet(world.client, settings(), is_fixed=False)
        lifted = {name for name, i in puppet.links.items() if puppet.is_lifted(i)}
    assert {
        "torso_lift_link",
        "l_gripper_palm_link",
        *settings().gripper_links,
    } <= lifted
    assert not {"base_link", "fl_caster_l_wheel_link"} & lifted

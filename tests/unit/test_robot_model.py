"""The arrays of a robot agree with the physics engine that reads its description."""

from dataclasses import replace

import numpy as np
import pytest
from robot_study import ROBOTS, Bullet, model, random_configurations, settings
from scipy.spatial.transform import Rotation

from placing import rigid
from placing.errors import BadInput
from placing.robot.meshes import hull_of
from placing.robot.model import link_poses, load_robot, tool_pose
from placing.robot.tree import fixed_values, gripper_values, moving_joints, tree_of
from placing.robot.urdf import read_srdf

HELD_M, HELD_AT_M = (0.3, 0.086, 0.3), (0.12, 0, 0)
"""A large object, 3 cm of which are between the fingers."""


def centres_of(robot, q):
    """Return the centres of all spheres in the world, (s, 3)."""
    T = link_poses(robot.tree, q)[robot.spheres.link]
    return np.einsum("sij,sj->si", T[:, :3, :3], robot.spheres.centre_m) + T[:, :3, 3]


def heights(robot, n):
    return np.linspace(*robot.settings.torso_range_m, n)


def standing(robot, height_m, arm):
    return np.array([0.0, 0.0, 0.0, height_m, *arm])


def names_of(robot, pairs):
    return [(robot.links[i], robot.links[j]) for i, j in pairs]


@pytest.mark.parametrize("name", ROBOTS)
def test_every_link_is_where_the_physics_engine_has_it(name):
    robot, rng = model(name), np.random.default_rng(0)
    with Bullet(robot) as bullet:
        for q in random_configurations(rng, name, 40):
            bullet.move(q)
            wanted = [rigid.homogeneous(bullet.pose(link)) for link in robot.links]
            assert np.allclose(link_poses(robot.tree, q), wanted, atol=2e-6)


def test_joints_along_axes_turn_to_the_last_digit_as_any_joint():
    robot, rng = model("pr2"), np.random.default_rng(2)
    tree = robot.tree
    assert np.all(tree.along >= 0)
    plain = tree._replace(along=np.full_like(tree.along, -1))
    for q in random_configurations(rng, "pr2", 200):
        assert np.array_equal(link_poses(tree, q), link_poses(plain, q))


def test_the_tool_is_the_tool_frame_of_the_description():
    robot, rng = model("pr2"), np.random.default_rng(1)
    with Bullet(robot) as bullet:
        for q in random_configurations(rng, "pr2", 20):
            bullet.move(q)
            wanted = rigid.homogeneous(bullet.pose("r_gripper_tool_frame"))
            T = rigid.homogeneous(tool_pose(robot, q))
            assert np.allclose(T, wanted, atol=2e-6)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_tool_lies_between_fingers_that_close_along_y(name):
    robot = model(name)
    q = standing(robot, 0.1, robot.settings.stow)
    T_tool_world = rigid.inverse(tool_pose(robot, q))
    fingers = []
    for shape in robot.description.shapes:
        if "fingertip" in shape.link.replace("_tip", "tip") and (
            shape.link in robot.settings.gripper_links
        ):
            points = hull_of(shape).points_m @ rigid.matrix([1, 0, 0, 0]).T
            T = link_poses(robot.tree, q)[robot.links.index(shape.link)]
            world = points @ T[:3, :3].T + T[:3, 3]
            fingers.append(rigid.apply(T_tool_world, world))
    left, right = sorted(fingers, key=lambda points: points[:, 1].mean())
    gap = right[:, 1].min() - left[:, 1].max()
    assert gap == pytest.approx(robot.settings.max_opening_m, abs=0.002)
    tips = max(left[:, 0].max(), right[:, 0].max())
    assert 0 < tips < 0.01


@pytest.mark.parametrize("name", ROBOTS)
def test_no_point_of_a_solid_is_outside_the_spheres_of_its_link(name):
    robot, rng = model(name), np.random.default_rng(2)
    for hull in robot.hulls:
        own = robot.spheres.link == robot.links.index(hull.link)
        weights = rng.dirichlet(np.full(len(hull.points_m), 0.05), 300)
        points = np.concatenate([weights @ hull.points_m, hull.points_m])
        gap = np.linalg.norm(points[:, None] - robot.spheres.centre_m[own], axis=2)
        assert np.all(np.min(gap - robot.spheres.radius_m[own], axis=1) < 0), hull.link


def test_spheres_stand_out_no_farther_than_their_limit():
    robot = model("pr2")
    for hull in robot.hulls:
        own = robot.spheres.link == robot.links.index(hull.link)
        centres, radii = robot.spheres.centre_m[own], robot.spheres.radius_m[own]
        out = centres @ hull.planes[:, :3].T + hull.planes[:, 3] + radii[:, None]
        most = max(robot.settings.body_bulge_m)
        assert out.max(axis=1).max() < most + 0.01


@pytest.mark.parametrize("share", [0, 0.3, 1])
def test_fingers_at_any_opening_are_inside_the_spheres(share):
    robot = model("pr2")
    opening_m = share * robot.settings.max_opening_m
    values = fixed_values(robot.settings, robot.description, opening_m)
    chain = moving_joints(robot.settings, robot.description)
    _, opened = tree_of(robot.settings, robot.description, chain, values)
    q = standing(robot, 0.1, robot.settings.stow)
    centres = centres_of(robot, q)
    poses, rng = link_poses(opened, q), np.random.default_rng(3)
    for shape in robot.description.shapes:
        if shape.link in robot.settings.gripper_links:
            corners = hull_of(shape).points_m
            points = rng.dirichlet(np.full(len(corners), 0.1), 300) @ corners
            T = poses[robot.links.index(shape.link)]
            points = points @ T[:3, :3].T + T[:3, 3]
            own = robot.spheres.link == robot.links.index(shape.link)
            gap = np.linalg.norm(points[:, None] - centres[own], axis=2)
            assert np.all(np.min(gap - robot.spheres.radius_m[own], axis=1) < 0)


def test_two_calls_give_the_same_bytes():
    first, second = model("pr2"), load_robot(settings("pr2"))
    for a, b in ((first.spheres, second.spheres), (first.tree, second.tree)):
        assert all(x.tobytes() == y.tobytes() for x, y in zip(a, b, strict=True))


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("pose", ["stow", "carry"])
def test_fixed_poses_of_the_arm_touch_nothing_at_any_height(name, pose):
    robot = model(name)
    with Bullet(robot) as bullet:
        bullet.check_only(names_of(robot, robot.self_pairs))
        for height in heights(robot, 7):
            bullet.move(standing(robot, height, getattr(robot.settings, pose)))
            assert bullet.contacts() == []


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("pose", ["stow", "carry"])
def test_fixed_poses_are_free_by_the_spheres_too(name, pose):
    robot = model(name)
    spheres = robot.spheres
    for height in heights(robot, 3):
        q = standing(robot, height, getattr(robot.settings, pose))
        centres = centres_of(robot, q)
        for i, j in robot.self_pairs:
            a, b = spheres.link == i, spheres.link == j
            gap = np.linalg.norm(centres[a][:, None] - centres[b], axis=2)
            reach = spheres.radius_m[a][:, None] + spheres.radius_m[b]
            assert np.min(gap - reach) > 0.005, (robot.links[i], robot.links[j])


@pytest.mark.parametrize("name", ROBOTS)
def test_a_large_object_is_carried_without_touching_the_robot(name):
    robot = model(name)
    for height in heights(robot, 4):
        q = standing(robot, height, robot.settings.carry)
        with Bullet(robot) as bullet:
            bullet.check_only([])
            bullet.move(q)
            bullet.hold(HELD_M, HELD_AT_M, q)
            assert bullet.contacts() == []


def test_body_and_resting_arm_clear_the_base_at_all_heights():
    robot = model("pr2")
    frame, links = robot.tree.link_frame, robot.links
    listed = set(names_of(robot, load_robot(robot.settings).self_pairs))
    solids = sorted({hull.link for hull in robot.hulls}, key=links.index)
    harmless = read_srdf(robot.settings.srdf)
    pairs = [
        (a, b)
        for a in solids
        for b in solids
        if frame[links.index(a)] == 0 and frame[links.index(b)] == 1
        if frozenset((a, b)) not in harmless
    ]
    assert pairs
    assert not listed & set(pairs)
    with Bullet(robot) as bullet:
        bullet.check_only(pairs)
        for height in heights(robot, 30):
            bullet.move(standing(robot, height, robot.settings.stow))
            assert bullet.contacts() == []


def test_the_arm_stays_near_the_body_when_it_is_stowed_or_carries():
    robot = model("pr2")
    for pose, most_m in (("stow", 0.45), ("carry", 0.55)):
        poses = link_poses(
            robot.tree, standing(robot, 0.02, getattr(robot.settings, pose))
        )
        for hull in robot.hulls:
            T = poses[robot.links.index(hull.link)]
            points = hull.points_m @ T[:3, :3].T + T[:3, 3]
            if robot.tree.link_frame[robot.links.index(hull.link)] > 1:
                assert np.hypot(*points[:, :2].T).max() < most_m


def test_the_gripper_of_the_carrying_arm_points_down():
    for name in ROBOTS:
        robot = model(name)
        T = tool_pose(robot, standing(robot, 0.1, robot.settings.carry))
        assert rigid.matrix(T[:4])[2, 0] < -0.95


def test_values_between_open_the_gripper_partly():
    half = gripper_values(settings("pr2"), settings("pr2").max_opening_m / 2)
    assert half["r_gripper_l_finger_joint"] == pytest.approx(0.26)
    wide = gripper_values(settings("pr2"), 1.0)
    assert wide == settings("pr2").gripper_open


BAD = {
    "tool_frame": ("r_gripper_tool", "unknown link 'r_gripper_tool'"),
    "gripper_links": (("palm",), "unknown link 'palm'"),
    "torso": ("spine", "unknown joint 'spine'"),
    "other_joints": ({"l_elbow": 0.0}, "unknown joint 'l_elbow'"),
    "chain": (("r_elbow",) * 7, "unknown joint 'r_elbow'"),
    "torso_range_m": ((0.0, 0.5), "the limits of torso_lift_joint"),
    "stow": ((0.0,) * 7, "value 0.0 of r_elbow_flex_joint"),
}


@pytest.mark.parametrize("field", BAD)
def test_a_wrong_name_or_value_is_one_line_with_file_and_field(field):
    value, expected = BAD[field]
    with pytest.raises(BadInput) as caught:
        load_robot(replace(settings("pr2"), **{field: value}))
    message = str(caught.value)
    assert message.startswith(f"{settings('pr2').file}: {field}: ")
    assert expected in message
    assert "\n" not in message


def test_an_arm_in_another_order_is_refused():
    chain = settings("pr2").chain
    with pytest.raises(BadInput, match="chain: from the base to"):
        load_robot(replace(settings("pr2"), chain=chain[::-1]))


def test_frames_are_right_handed_rotations():
    robot, rng = model("tiago"), np.random.default_rng(5)
    for q in random_configurations(rng, "tiago", 5):
        R = link_poses(robot.tree, q)[:, :3, :3]
        assert np.allclose(Rotation.from_matrix(R).as_matrix(), R, atol=1e-9)

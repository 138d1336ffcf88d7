"""Rigid motions agree with homogeneous matrices, multiplied as such."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from placing import rigid

METRES = st.floats(-20, 20)
ANGLES = st.floats(-10, 10)
NUMBERS = st.floats(-1, 1)


@st.composite
def poses(draw):
    """Draw any rigid motion, those close to none included."""
    axis_angle = np.array([draw(NUMBERS) for _ in range(4)])
    quaternion = (
        np.array([1.0, 0, 0, 0]) + draw(st.sampled_from([1e-9, 1, 30])) * axis_angle
    )
    if np.linalg.norm(quaternion) < 1e-3:
        quaternion = np.array([0.0, 1, 0, 0])
    quaternion = quaternion / np.linalg.norm(quaternion)
    return np.concatenate([quaternion, [draw(METRES) for _ in range(3)]])


@given(poses(), poses())
def test_compose_multiplies_the_matrices(p, q):
    expected = rigid.homogeneous(p) @ rigid.homogeneous(q)
    actual = rigid.homogeneous(rigid.compose(p, q))
    np.testing.assert_allclose(actual, expected, atol=1e-9)


@given(poses())
def test_inverse_undoes_a_motion(p):
    for both in (
        rigid.compose(p, rigid.inverse(p)),
        rigid.compose(rigid.inverse(p), p),
    ):
        np.testing.assert_allclose(rigid.homogeneous(both), np.eye(4), atol=1e-9)


@given(poses(), st.lists(st.tuples(METRES, METRES, METRES), min_size=1, max_size=5))
def test_apply_is_the_matrix_times_the_point(p, points):
    points = np.array(points)
    ones = np.ones((len(points), 1))
    expected = (rigid.homogeneous(p) @ np.hstack([points, ones]).T).T[:, :3]
    np.testing.assert_allclose(rigid.apply(p, points), expected, atol=1e-9)


@given(poses())
def test_matrix_keeps_lengths_and_handedness(p):
    R = rigid.matrix(p[:4])
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1)


@given(ANGLES, METRES, METRES)
def test_yaw_turns_x_towards_y(yaw, x, y):
    tip = rigid.apply(rigid.from_yaw(yaw, (x, y, 0.0)), np.array([[1.0, 0, 0]]))[0]
    np.testing.assert_allclose(tip, [x + np.cos(yaw), y + np.sin(yaw), 0], atol=1e-9)


@given(ANGLES)
def test_yaw_of_is_the_yaw_that_was_given(yaw):
    difference = rigid.yaw_of(rigid.yaw_quaternion(yaw)) - yaw
    assert abs(rigid.wrap(difference)) < 1e-9


@given(ANGLES)
def test_yaw_of_a_thing_on_its_edge_is_where_its_spine_points(yaw):
    quaternion = rigid.multiply(rigid.yaw_quaternion(yaw), np.array(rigid.ON_EDGE))
    spine = rigid.matrix(quaternion) @ [0, -1, 0]
    np.testing.assert_allclose(spine, [np.cos(yaw), np.sin(yaw), 0], atol=1e-9)
    assert abs(rigid.wrap(rigid.yaw_of(quaternion) - yaw)) < 1e-9


def test_yaw_of_takes_many_quaternions_at_once():
    yaws = np.array([[0.0, 1.0], [2.0, -3.0]])
    quaternions = np.stack([[rigid.yaw_quaternion(y) for y in row] for row in yaws])
    np.testing.assert_allclose(rigid.yaw_of(quaternions), yaws)


@given(poses())
def test_a_pose_comes_back_from_its_matrix(p):
    back = rigid.from_homogeneous(rigid.homogeneous(p))
    turn = Rotation.from_quat(np.roll(p[:4], -1)).as_quat(canonical=True)
    assert back[0] >= 0
    # Half a turn has two quaternions whose w is zero.
    sign = np.sign(back[:4] @ np.roll(turn, 1))
    np.testing.assert_allclose(back[:4], sign * np.roll(turn, 1), atol=1e-9)
    np.testing.assert_array_equal(back[4:], p[4:])


def test_poses_come_back_from_turns_of_half_a_circle_about_every_axis():
    rng = np.random.default_rng(0)
    for axis in [*np.eye(3), *unit_vectors(rng, 20)]:
        R = Rotation.from_rotvec(np.pi * axis).as_matrix()
        back = rigid.from_homogeneous(np.block([[R, np.ones((3, 1))], [0, 0, 0, 1]]))
        np.testing.assert_allclose(rigid.matrix(back[:4]), R, atol=1e-12)


@given(poses(), ANGLES)
def test_about_is_the_rotation_vector(p, angle):
    axis = rigid.matrix(p[:4])[0]
    expected = Rotation.from_rotvec(angle * axis).as_matrix()
    np.testing.assert_allclose(
        rigid.matrix(rigid.about(axis, angle)), expected, atol=1e-9
    )


def test_upward_is_the_last_row_of_each_matrix():
    quaternions = Rotation.random(24, random_state=0).as_quat().reshape(4, 6, 4)
    rows = Rotation.from_quat(quaternions.reshape(-1, 4)).as_matrix()[:, 2]
    up = rigid.upward(np.roll(quaternions, 1, axis=-1))
    np.testing.assert_allclose(up, rows.reshape(4, 6, 3), atol=1e-12)


def unit_vectors(rng, n):
    vectors = rng.normal(size=(n, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


DIRECTIONS = [*unit_vectors(np.random.default_rng(3), 50), [0, 0, 1.0], [0, 0, -1.0]]


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_turning_up_or_down_is_a_rotation_by_no_more_than_the_angle(direction):
    direction = np.array(direction)
    for R, goal in (
        (rigid.turn_up(direction), np.array([0, 0, 1.0])),
        (rigid.matrix(rigid.turn_down(direction)), np.array([0, 0, -1.0])),
    ):
        np.testing.assert_allclose(R @ direction, goal, atol=1e-9)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
        assert np.linalg.det(R) == pytest.approx(1)
        angle = Rotation.from_matrix(R).magnitude()
        assert np.cos(angle) == pytest.approx(direction @ goal)


def test_turn_about_z_is_the_pose_of_each_yaw():
    rng = np.random.default_rng(0)
    yaws, points = rng.uniform(-7, 7, 5), rng.normal(size=(4, 3))
    turned = rigid.turn_about_z(yaws[:, None], points)  # (5, 4, 3)
    for yaw, seen in zip(yaws, turned, strict=True):
        pose = rigid.from_yaw(yaw, (0, 0, 0))
        np.testing.assert_allclose(seen, rigid.apply(pose, points), atol=1e-12)
    flat = rigid.turn_about_z(yaws[:, None], points[:, :2])
    np.testing.assert_array_equal(flat, turned[..., :2])


def test_stances_are_rotations_and_the_edge_is_as_documented():
    R = rigid.matrix(np.array(rigid.STANCES["edge"]))
    np.testing.assert_allclose(R @ [1, 0, 0], [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(R @ [0, 0, 1], [0, -1, 0], atol=1e-12)
    np.testing.assert_allclose(R @ [0, 1, 0], [-1, 0, 0], atol=1e-12)
    np.testing.assert_array_equal(rigid.matrix(np.array(rigid.IDENTITY)), np.eye(3))


@given(ANGLES)
def test_wrap_keeps_the_direction_and_the_range(angle):
    wrapped = rigid.wrap(angle)
    assert -np.pi <= wrapped < np.pi
    np.testing.assert_allclose(np.exp(1j * wrapped), np.exp(1j * angle), atol=1e-9)


@given(ANGLES, ANGLES)
def test_near_keeps_the_direction_and_is_within_half_a_turn(angle, other):
    turned = rigid.near(angle, other)
    assert abs(turned - other) <= np.pi + 1e-9
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * angle), atol=1e-9)

"""The skeletons are adults in six postures, whatever the posture."""

import numpy as np
import pytest

from placing import rigid
from placing.errors import UnknownName
from placing.people import skeleton
from placing.people.skeleton import BONES, JOINTS, KINDS, SITTING


def bone_lengths(kind: str) -> np.ndarray:
    """Return the length of each bone, shape (14,) [m]."""
    joints = skeleton.joints(kind)
    return np.array([np.linalg.norm(joints[a] - joints[b]) for a, b in BONES])


def test_every_kind_has_15_joints_in_one_tree_of_14_bones():
    assert len(JOINTS) == 15
    assert len(BONES) == 14
    reached = {0}
    for a, b in BONES:
        assert a in reached
        reached.add(b)
    assert reached == set(range(15))


@pytest.mark.parametrize("kind", KINDS)
def test_bones_have_the_same_length_in_every_kind(kind):
    np.testing.assert_allclose(bone_lengths(kind), bone_lengths("standing"), atol=1e-9)


def test_a_standing_person_is_as_tall_as_published():
    joints = skeleton.joints("standing")
    height = dict(zip(JOINTS, joints[:, 2], strict=True))
    assert height["head"] == pytest.approx(0.936 * 1.70)
    assert height["left_shoulder"] == pytest.approx(0.818 * 1.70)
    assert height["left_hip"] == pytest.approx(0.530 * 1.70)
    assert height["left_knee"] == pytest.approx(0.285 * 1.70)


@pytest.mark.parametrize("kind", KINDS)
def test_left_mirrors_right_and_the_person_looks_along_x(kind):
    joints = dict(zip(JOINTS, skeleton.joints(kind), strict=True))
    for name in ("shoulder", "elbow", "hand", "hip", "knee", "foot"):
        left, right = joints[f"left_{name}"], joints[f"right_{name}"]
        np.testing.assert_allclose(left * [1, -1, 1], right)
        assert left[1] > 0
    assert joints["left_hand"][0] > joints["neck"][0]


@pytest.mark.parametrize("kind", KINDS)
def test_the_origin_is_on_the_seat_or_between_the_feet(kind):
    joints = dict(zip(JOINTS, skeleton.joints(kind), strict=True))
    feet = (joints["left_foot"] + joints["right_foot"]) / 2
    if kind in SITTING:
        assert -0.45 < feet[2] < -0.35
        assert (joints["left_hip"] + joints["right_hip"])[0] == pytest.approx(0)
    else:
        np.testing.assert_allclose(feet, 0, atol=1e-12)


def test_hands_are_where_the_kind_needs_them():
    hand = {kind: skeleton.joints(kind)[JOINTS.index("left_hand")] for kind in KINDS}
    assert 0.25 < hand["sitting_upright"][2] < 0.35, "a desk above a seat"
    assert 0.90 < hand["standing"][2] < 1.05, "a worktop"
    assert hand["reaching"][2] > 1.5, "a shelf"
    assert hand["sitting_forward"][0] > hand["sitting_upright"][0] + 0.1
    assert hand["leaning_forward"][0] > hand["standing"][0] + 0.1


def test_the_reference_is_the_height_of_the_torso():
    assert skeleton.reference_m("standing") == pytest.approx(0.674 * 1.70)
    assert 0.25 < skeleton.reference_m("sitting_upright") < 0.35


@pytest.mark.parametrize("kind", KINDS)
def test_placing_equals_the_rigid_motion(kind):
    rng = np.random.default_rng(0)
    location, yaw = rng.normal(size=(5, 3)), rng.uniform(-np.pi, np.pi, 5)
    placed = skeleton.place(kind, location, yaw)
    for k in range(5):
        T = rigid.from_yaw(yaw[k], location[k])
        np.testing.assert_allclose(placed[k], rigid.apply(T, skeleton.joints(kind)))


def test_placing_no_pose_gives_no_joints():
    assert skeleton.place("standing", np.zeros((0, 3)), np.zeros(0)).shape == (0, 15, 3)


@pytest.mark.parametrize("kind", KINDS)
def test_spheres_cover_the_body_but_not_its_seat_or_the_floor(kind):
    spheres = skeleton.capsule_samples(kind)
    assert spheres.shape == (71, 4)
    to_spheres = np.linalg.norm(
        skeleton.joints(kind)[:13, None] - spheres[None, :, :3], axis=-1
    )
    assert (to_spheres.min(axis=1) < 1e-9).all(), "every joint but the feet is covered"
    lowest = spheres[:, 2] - spheres[:, 3]
    above = np.abs(spheres[:, 0]) < 0.35 if kind in SITTING else lowest > -np.inf
    assert lowest[above].min() > 0.0


def test_an_unknown_kind_is_refused_with_the_known_ones():
    with pytest.raises(UnknownName, match="known are leaning_forward, reaching"):
        skeleton.joints("lying")

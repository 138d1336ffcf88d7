"""Valid poses are free of the cloud and supported by it."""

import numpy as np
import pytest

from placing.people import skeleton
from placing.people.valid_poses import PosesConfig, lattice, valid_poses
from placing.scene import PlacingArea

CONFIG = PosesConfig(0.2, 0.1, 8, 0.05, 0.3, 0.8)


def grid(x, y, z, step=0.02):
    """Return points that fill a box, flat where a side is a single number."""
    axes = [np.arange(a, b + 1e-9, step) if b > a else [a] for a, b in (x, y, z)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)


def square(name, x, y, height, is_floor=False):
    corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
    return PlacingArea(name, np.array(corners, float), height, np.inf, is_floor, None)


FLOOR = grid((0, 4), (0, 4), (0, 0))
FLOOR_AREA = square("floor", (0, 4), (0, 4), 0.0, is_floor=True)


@pytest.fixture(scope="module")
def seat():
    """Return a scene with a seat of 0.4 x 0.4 m in the middle and a post beside it."""
    points = [FLOOR, grid((1.8, 2.2), (1.8, 2.2), (0.45, 0.45))]
    points.append(grid((3.0, 3.2), (0.5, 0.7), (0, 1.9)))
    areas = (FLOOR_AREA, square("area1", (1.8, 2.2), (1.8, 2.2), 0.45))
    return np.concatenate(points), valid_poses(np.concatenate(points), areas, CONFIG)


def is_sitting(poses):
    sitting = [k in skeleton.SITTING for k in skeleton.KINDS]
    return np.array(sitting)[poses.kind]


def test_prior_gives_every_kind_the_same_share_and_its_poses_too(seat):
    _, poses = seat
    kinds = np.unique(poses.kind)
    for kind in kinds:
        of_kind = poses.prior[poses.kind == kind]
        assert of_kind.sum() == pytest.approx(1 / len(kinds))
        assert np.ptp(of_kind) == 0


def test_sitting_poses_are_on_the_seat_and_standing_ones_on_the_floor(seat):
    _, poses = seat
    sitting = poses.location[is_sitting(poses)]
    assert len(sitting)
    assert ((sitting[:, :2] >= 1.8) & (sitting[:, :2] <= 2.2)).all()
    assert (sitting[:, 2] == 0.45).all()
    assert (poses.location[~is_sitting(poses), 2] == 0).all()


def test_no_joint_of_a_valid_pose_is_inside_a_post(seat):
    points, poses = seat
    post = points[points[:, 2] > 0.6]
    for kind_index, kind in enumerate(skeleton.KINDS):
        of_kind = poses.kind == kind_index
        joints = skeleton.place(kind, poses.location[of_kind], poses.yaw[of_kind])
        inside = (joints >= post.min(0)) & (joints <= post.max(0))
        assert not inside.all(-1).any()


def test_a_seat_walled_in_on_all_sides_has_no_room_for_legs():
    walls = [
        grid((1.5, 2.5), (1.5, 1.5), (0, 1)),
        grid((1.5, 2.5), (2.5, 2.5), (0, 1)),
        grid((1.5, 1.5), (1.5, 2.5), (0, 1)),
        grid((2.5, 2.5), (1.5, 2.5), (0, 1)),
    ]
    points = np.concatenate([FLOOR, grid((1.5, 2.5), (1.5, 2.5), (0.45, 0.45)), *walls])
    areas = (FLOOR_AREA, square("area1", (1.5, 2.5), (1.5, 2.5), 0.45))
    assert not is_sitting(valid_poses(points, areas, CONFIG)).any()


def test_nobody_fits_below_a_low_ceiling():
    points = np.concatenate([FLOOR, grid((0, 4), (0, 4), (1.2, 1.2))])
    assert len(valid_poses(points, (FLOOR_AREA,), CONFIG).kind) == 0


def test_a_scene_without_floor_has_no_standing_pose():
    points = np.concatenate([FLOOR, grid((1.8, 2.2), (1.8, 2.2), (0.45, 0.45))])
    areas = (square("area1", (1.8, 2.2), (1.8, 2.2), 0.45),)
    assert is_sitting(valid_poses(points, areas, CONFIG)).all()


def test_lattice_points_are_multiples_of_the_spacing_inside_the_polygon():
    triangle = np.array([[0.03, 0.02], [1.0, 0.0], [0.5, 0.9]])
    points = lattice(triangle, 0.1)
    assert np.abs(points / 0.1 - np.round(points / 0.1)).max() < 1e-9
    assert ((points >= triangle.min(0)) & (points <= triangle.max(0))).all()

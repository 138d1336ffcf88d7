"""What sampling and preprocessing promise of a cloud."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from placing import rigid
from placing.clouds.cloud import (
    CloudConfig,
    drop_outliers,
    preprocess,
    sample_cloud,
    thin,
)
from placing.clouds.levelling import vertical
from placing.clouds.ply import Cloud, read_ply
from placing.errors import BadInput

SCANS = Path(__file__).parents[2].parent / "shared" / "data" / "scans"
CONFIG = CloudConfig(
    crop_m=None,
    up=(0.0, 0.0, 1.0),
    voxel_m=0.02,
    outlier_cell_m=0.05,
    outlier_neighbors=4,
    normal_neighbors=24,
    max_tilt_rad=0.26,
    floor_fraction=0.2,
    min_points=100,
)


def box(size: tuple, at: tuple, color: tuple = (10, 20, 30)) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(size)
    mesh.apply_translation(at)
    mesh.visual.face_colors = [*color, 255]
    return mesh


def room() -> list[trimesh.Trimesh]:
    """Return a floor, a wall and a table."""
    floor, wall = box((3, 2, 0.1), (0, 0, -0.05)), box((3, 0.1, 2), (0, 1.05, 1))
    return [floor, wall, box((0.8, 0.6, 0.02), (0, 0, 0.7), (200, 0, 0))]


def sampled(seed: int = 1, spacing_m: float = 0.015) -> Cloud:
    return sample_cloud(np.random.default_rng(seed), room(), spacing_m)


def turned(cloud: Cloud, R: np.ndarray) -> Cloud:
    points, normals = cloud.points @ R.T, cloud.normals @ R.T
    return Cloud(points.astype(np.float32), normals.astype(np.float32), cloud.colors)


def test_samples_are_as_dense_as_asked_and_lie_on_their_faces() -> None:
    cloud = sampled()
    area = sum(mesh.area for mesh in room())
    assert len(cloud) == pytest.approx(area / 0.015**2, rel=0.01)
    distance = np.full(len(cloud), np.inf)
    for mesh in room():
        beyond = (
            np.abs(cloud.points - mesh.bounds.mean(axis=0)) - np.ptp(mesh.bounds, 0) / 2
        )
        distance = np.minimum(distance, np.abs(beyond.max(axis=1)))
    assert distance.max() < 1e-6


def test_samples_have_the_normal_and_the_colour_of_their_face() -> None:
    cloud = sampled()
    is_red = cloud.colors[:, 0] == 200
    below = is_red & (np.abs(cloud.points[:, 2] - 0.69) < 1e-5)
    above = is_red & (np.abs(cloud.points[:, 2] - 0.71) < 1e-5)
    assert (cloud.normals[below & (cloud.normals[:, 2] != 0), 2] == -1).all()
    assert (cloud.normals[above & (cloud.normals[:, 2] != 0), 2] == 1).all()
    assert above.sum() == pytest.approx(0.48 / 0.015**2, rel=0.03)


def test_samples_leave_no_gap() -> None:
    cloud = sampled()
    floor = cloud.points[(cloud.points[:, 2] > -0.01) & (cloud.points[:, 2] < 0.01)]
    inside = np.abs(floor[:, 1]) < 0.99
    cells = np.unique((floor[inside, :2] // 0.03).astype(int), axis=0)
    assert len(cells) >= 100 * 66


def test_the_same_stream_samples_the_same_cloud() -> None:
    first, again, other = sampled(1), sampled(1), sampled(2)
    assert np.array_equal(first.points, again.points)
    assert len(first) != len(other) or not np.array_equal(first.points, other.points)


def test_thinning_keeps_both_sides_of_a_thin_board() -> None:
    rng = np.random.default_rng(0)
    cloud = thin(sample_cloud(rng, [box((1, 1, 0.005), (0, 0, 0))], 0.01), 0.02)
    z, rise = cloud.points[:, 2], cloud.normals[:, 2]
    assert (rise > 0.9).sum() == pytest.approx((rise < -0.9).sum(), rel=0.05)
    assert (rise > 0.9).sum() > 2000
    assert np.allclose(z[rise > 0.9], 0.0025, atol=1e-6)
    assert np.allclose(z[rise < -0.9], -0.0025, atol=1e-6)


def test_thinning_is_the_mean_over_voxels_of_a_dictionary() -> None:
    rng = np.random.default_rng(0)
    points = rng.uniform(0, 0.2, (500, 3)).astype(np.float32)
    cloud = Cloud(points, np.zeros_like(points), np.full((500, 3), 7, np.uint8))
    voxels: dict[tuple, list] = {}
    for point in points:
        key = tuple(((point - points.min(axis=0) + 0.37 * 0.05) / 0.05).astype(int))
        voxels.setdefault(key, []).append(point)
    expected = np.sort([np.mean(group, axis=0) for group in voxels.values()], axis=0)
    assert np.allclose(np.sort(thin(cloud, 0.05).points, axis=0), expected, atol=1e-6)


def test_thinning_averages_the_softness_that_is_known() -> None:
    points = np.array([[0, 0, 0], [0, 0, 0], [1, 0, 0], [2, 0, 0]], np.float32)
    softness = np.array([0.2, 0.6, np.nan, np.nan], np.float32)
    softness = np.concatenate([softness, [1.0]]).astype(np.float32)
    points = np.concatenate([points, [[2, 0, 0]]]).astype(np.float32)
    none = np.zeros_like(points)
    thinned = thin(Cloud(points, none, none.astype(np.uint8), softness), 0.1)
    assert thinned.softness is not None
    assert np.allclose(thinned.softness, [0.4, np.nan, 1.0], equal_nan=True)


def test_preprocessing_and_sampling_carry_softness() -> None:
    rng = np.random.default_rng(1)
    cloud = preprocess(sample_cloud(rng, room(), 0.015, [0.0, 0.0, 0.7]), CONFIG)
    assert cloud.softness is not None
    is_red = cloud.colors[:, 0] == 200
    assert np.allclose(cloud.softness[is_red], 0.7)
    assert (cloud.softness[~is_red] == 0).all()
    bare = preprocess(sampled(), CONFIG)
    assert bare.softness is None
    assert np.array_equal(bare.points, cloud.points)


def test_outliers_are_the_points_with_few_others_around() -> None:
    plane = thin(sampled(), 0.02)
    stray = np.array([[0, 0, 1.5], [1.2, -0.7, 1.2], [-1.2, -0.7, 1.2]], np.float32)
    cloud = Cloud(
        np.concatenate([plane.points, stray]),
        np.concatenate([plane.normals, np.zeros_like(stray)]),
        np.concatenate([plane.colors, np.zeros((3, 3), np.uint8)]),
    )
    assert np.array_equal(drop_outliers(cloud, CONFIG).points, plane.points)


def test_outliers_are_counted_like_by_comparing_all_pairs() -> None:
    rng = np.random.default_rng(5)
    points = rng.uniform(0, 0.6, (700, 3)).astype(np.float32)
    cloud = Cloud(points, np.zeros_like(points), np.zeros((700, 3), np.uint8))
    cells = ((points - points.min(axis=0) + 0.05) / 0.05).astype(int)
    steps = np.abs(cells[:, None] - cells[None]).max(axis=2)
    is_kept = (steps <= 1).sum(axis=1) > CONFIG.outlier_neighbors
    assert 0 < is_kept.sum() < 700
    assert np.array_equal(drop_outliers(cloud, CONFIG).points, points[is_kept])


@pytest.mark.parametrize("has_normals", [True, False])
def test_a_tilted_raised_room_comes_out_level_with_its_floor_at_zero(
    has_normals: bool,
) -> None:
    direction = np.array([0.12, -0.08, 1.0])
    R = rigid.turn_up(direction / np.linalg.norm(direction)).T
    cloud = turned(sampled(spacing_m=0.01), R)
    lifted = cloud.points + np.float32([5, 3, 1.3])
    # A scanner sees neither the underside of the slab nor that of the table.
    is_seen = sampled(spacing_m=0.01).normals[:, 2] > -0.5
    normals = cloud.normals if has_normals else np.zeros_like(cloud.normals)
    clean = preprocess(Cloud(lifted, normals, cloud.colors).take(is_seen), CONFIG)
    up = clean.normals[:, 2] > 0.99
    z = clean.points[up, 2]
    assert abs(np.median(z[np.abs(z) < 0.1])) < 0.002
    assert abs(np.median(z[np.abs(z - 0.71) < 0.1]) - 0.71) < 0.004
    assert np.std(z[np.abs(z) < 0.03]) < 0.004


def test_a_level_room_is_not_moved() -> None:
    clean = preprocess(sampled(), CONFIG)
    floor = clean.points[
        (np.abs(clean.points[:, 2]) < 0.01) & (clean.normals[:, 2] > 0.9)
    ]
    assert np.abs(floor[:, 2]).max() < 1e-5
    assert np.allclose(np.abs(clean.points[:, 0]).max(), 1.5, atol=0.01)


def test_cropping_keeps_the_inside() -> None:
    crop = replace(CONFIG, crop_m=((-0.5, -0.5, -0.2), (0.5, 0.5, 1.0)))
    clean = preprocess(sampled(), crop)
    assert np.abs(clean.points[:, :2]).max() <= 0.5
    with pytest.raises(BadInput, match=r"points is .*expected at least 100"):
        preprocess(sampled().take(np.arange(60)), CONFIG)


@pytest.mark.parametrize(
    "name", ["desk_tum_fr2_singleview.ply", "room_pcl_room_scan1_laser.ply"]
)
def test_real_scans_come_out_level(name: str) -> None:
    if not (SCANS / name).is_file():
        pytest.skip(f"no scan {name}")
    clean = preprocess(read_ply(SCANS / name), CONFIG)
    up = vertical(clean, np.array([0.0, 0.0, 1.0]), CONFIG.max_tilt_rad)
    assert np.allclose(up, [0, 0, 1], atol=1e-3)
    level = clean.points[clean.normals[:, 2] > 0.97, 2]
    assert np.abs(level - 0.0).min() < 0.005
    assert np.sum(np.abs(level) < 0.03) > 500
    assert np.quantile(level, 0.01) > -0.1

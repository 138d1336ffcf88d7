"""Two real scans, a desk and a room, and a user's own cloud take the same road.

The truth about the scans was read off their clouds: planes fitted to the points of the
file say where floor and desk are.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shapely

from placing import rigid
from placing.areas.finder import AreaConfig
from placing.areas.outlines import heal
from placing.areas.scans import ScanAreas, find_in_scan, suit_spacing
from placing.clouds.cloud import CloudConfig, drop_outliers, thin
from placing.clouds.planes import fit_planes
from placing.clouds.ply import Cloud, read_ply
from placing.clouds.spacing import floor_noise_m, spacing_m
from placing.rooms.file import read_yaml

ROOT = Path(__file__).parents[2]
SCANS = ROOT.parent / "shared" / "data" / "scans"
DESK, LASER = "desk_tum_fr2_singleview.ply", "room_pcl_room_scan1_laser.ply"
DOCUMENT = read_yaml(ROOT / "config" / "config.yaml")
CLOUD = CloudConfig(**DOCUMENT["cloud"])
AREAS = AreaConfig(**DOCUMENT["areas"])


@cache
def raw(name: str) -> Cloud:
    if not (SCANS / name).is_file():
        pytest.skip(f"no scan {name}")
    return read_ply(SCANS / name)


@cache
def found(name: str) -> ScanAreas:
    return find_in_scan(raw(name), CLOUD, AREAS)


def sizes(areas: ScanAreas) -> np.ndarray:
    return np.array([heal(area.polygon_m).area for area in areas.areas])


def test_the_desk_top_is_found_at_its_height_above_the_floor() -> None:
    """Planes through the raw points: floor at 0.00 m, desk at 0.757 m, tilted by 1.6°.

    The camera bends flat things: over the desk its height rises by 5 cm.
    """
    areas = found(DESK)
    tops = [a for a in areas.areas if abs(a.height_m - 0.757) < 0.02]
    largest = max(tops, key=lambda a: heal(a.polygon_m).area)
    assert heal(largest.polygon_m).area > 0.7
    assert np.isinf(largest.clearance_m)
    white = (raw(DESK).colors.min(axis=1) > 150) & (raw(DESK).points[:, 2] > 0.7)
    desk = raw(DESK).points[white & (raw(DESK).points[:, 2] < 0.79)]
    union = shapely.union_all([heal(a.polygon_m) for a in tops]).buffer(0.03)
    assert shapely.contains_xy(union, desk[:, :2]).mean() > 0.75


def test_the_floor_beside_the_desk_is_found_and_nothing_between_them() -> None:
    areas = found(DESK)
    floor = areas.areas[0]
    assert floor.is_floor
    assert heal(floor.polygon_m).area > 0.6
    assert heal(floor.polygon_m).bounds[2] < 0.3  # The desk stands beyond.
    heights = np.array([a.height_m for a in areas.areas])
    assert ((np.abs(heights) < 0.1) | (np.abs(heights - 0.76) < 0.06)).all()
    assert 8 <= len(heights) <= 16


def test_the_floor_of_the_laser_scan_covers_what_is_seen_of_the_room() -> None:
    """The room is 4.6 m x 5 m, with the floor below the scanner hidden from it."""
    areas = found(LASER)
    floors = [heal(a.polygon_m) for a in areas.areas if abs(a.height_m) < 0.03]
    assert areas.areas[0].is_floor
    assert heal(areas.areas[0].polygon_m).area > 6
    points = raw(LASER).points
    x, y, z = points.T
    is_floor = (np.abs(z) < 0.03) & (np.abs(x + 0.3) < 2) & (np.abs(y) < 2.2)
    union = shapely.union_all(floors).buffer(0.05)
    covered = shapely.contains_xy(union, points[is_floor, :2]).mean()
    assert covered > 0.85
    low_x, low_y, high_x, high_y = union.bounds
    assert high_x - low_x > 3.8
    assert high_y - low_y > 4.5


def test_tables_of_the_laser_scan_are_found_at_their_height() -> None:
    areas = found(LASER)
    z = raw(LASER).points[:, 2]
    histogram, edges = np.histogram(z, np.arange(0.65, 0.8, 0.01))
    peak = edges[histogram.argmax()] + 0.005
    tables = [a for a in areas.areas if abs(a.height_m - peak) < 0.02]
    assert peak == pytest.approx(0.725, abs=0.011)
    assert len(tables) >= 2
    assert sum(heal(a.polygon_m).area for a in tables) > 0.4
    assert all(1.5 < a.clearance_m < 2.5 for a in tables)  # Below the ceiling.


@pytest.mark.parametrize("name", [DESK, LASER])
def test_areas_of_real_scans_have_sensible_sizes(name: str) -> None:
    areas = found(name)
    assert 8 <= len(areas.areas) <= 30
    assert sizes(areas).min() > 0.8 * AREAS.min_width_m**2
    assert sizes(areas).max() < 25
    polygons = [heal(a.polygon_m) for a in areas.areas]
    for k, first in enumerate(polygons):
        for j in range(k):
            gap = abs(areas.areas[k].height_m - areas.areas[j].height_m)
            shared = first.intersection(polygons[j]).area
            assert gap > AREAS.merge_m / 2 or shared < 0.01


@pytest.mark.parametrize("name", [DESK, LASER])
def test_a_scan_whose_up_is_only_roughly_known_has_the_same_areas(name: str) -> None:
    up = np.array([0.1, -0.12, 1.0])
    R = rigid.turn_up(up / np.linalg.norm(up)).T
    points = (raw(name).points @ R.T + [3, 1, 2]).astype(np.float32)
    turned = find_in_scan(replace(raw(name), points=points), CLOUD, AREAS)
    whole = sizes(found(name)).sum()
    assert sizes(turned).sum() == pytest.approx(whole, rel=0.15)
    heights = [
        np.average([a.height_m for a in f.areas], weights=sizes(f))
        for f in (turned, found(name))
    ]
    assert heights[0] == pytest.approx(heights[1], abs=0.06)


def even_cloud(spacing: float) -> Cloud:
    """Return a floor and a wall with a point per square of `spacing`, jittered."""
    rng = np.random.default_rng(3)
    n = int(3 / spacing)
    at = (
        np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1).reshape(-1, 2)
        + rng.random((n * n, 2))
    ) * spacing
    zero, one = np.zeros(n * n), np.ones(n * n)
    floor = np.column_stack([at, zero])
    wall = np.column_stack([at[:, 0], zero, at[:, 1]])
    normals = [np.column_stack([zero, zero, one]), np.column_stack([zero, one, zero])]
    return Cloud(
        np.concatenate([floor, wall]).astype(np.float32),
        np.concatenate(normals).astype(np.float32),
        np.full((2 * n * n, 3), 128, np.uint8),
    )


@pytest.mark.parametrize("spacing", [0.03, 0.05, 0.1])
def test_spacing_is_that_of_the_squares_that_were_sampled(spacing: float) -> None:
    assert spacing_m(even_cloud(spacing)) == pytest.approx(spacing, rel=0.12)


def test_clouds_that_are_sampled_evenly_keep_the_settings_of_the_study() -> None:
    clean = drop_outliers(thin(even_cloud(0.02), CLOUD.voxel_m), CLOUD)
    assert suit_spacing(CLOUD, AREAS, spacing_m(clean)) == (CLOUD, AREAS)
    assert floor_noise_m(clean) == 0
    cloud, areas = suit_spacing(CLOUD, AREAS, 0.06)
    assert areas.cell_m == pytest.approx(2 * AREAS.cell_m)
    assert areas.min_width_m >= 2 * areas.cell_m
    assert cloud.voxel_m == CLOUD.voxel_m
    assert suit_spacing(CLOUD, AREAS, 1e3)[1].cell_m < 0.25


def test_noise_of_the_floor_is_its_standard_deviation() -> None:
    cloud = even_cloud(0.02)
    points = cloud.points.copy()
    points[:, 2] += np.random.default_rng(0).normal(0, 0.008, len(points))
    assert floor_noise_m(replace(cloud, points=points)) == pytest.approx(8e-3, rel=0.1)


def planes_of_all_pairs(points: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return normals of planes through the k nearest, and where they are unique."""
    normals, is_clear = np.empty((len(points), 3)), np.empty(len(points), bool)
    for p, point in enumerate(points.astype(float)):
        gaps = np.linalg.norm(points.astype(float) - point, axis=1)
        near = points[gaps <= np.sort(gaps)[k - 1]].astype(float)
        width, axes = np.linalg.eigh(np.cov(near.T))
        normals[p], is_clear[p] = axes[:, 0], width[1] - width[0] > 1e-3 * width[2]
    return normals, is_clear


@pytest.mark.parametrize("case", ["cube", "plane", "line", "one place", "few", "far"])
def test_planes_are_those_of_comparing_all_pairs(case: str) -> None:
    rng = np.random.default_rng(7)
    points = rng.random((600, 3)).astype(np.float32)
    scale = {"plane": [1, 1, 0.01], "line": [1, 0, 0], "one place": [0, 0, 0]}
    points *= np.array(scale.get(case, [1, 1, 1]), np.float32)
    if case == "few":
        points = points[:5]
    if case == "far":
        points[::7] *= 900
    normals = fit_planes(points, 24)
    expected, is_clear = planes_of_all_pairs(points, min(24, len(points)))
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    cosine = np.abs(np.sum(normals * expected, axis=1))
    assert (cosine[is_clear] > 1 - 1e-6).all()
    assert is_clear.mean() > 0.9 or case in ("line", "one place")

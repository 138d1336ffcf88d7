"""What placing areas are like: enclosed or open, stacked, soft, large."""

from dataclasses import replace

import numpy as np
import pytest
from study import SETTINGS, area, plane, study_scene

from placing.clouds.ply import Cloud
from placing.places import find_candidates
from placing.psi.area_descriptors import (
    AREA_DESCRIPTORS,
    N_DIRECTIONS,
    NEAR_M,
    describe_areas,
    without_softness,
)


def wall(x, y, z):
    """Return points that cover a vertical rectangle along x or y every 2 cm."""
    along, up = np.arange(0, 1, 0.02), np.arange(z[0], z[1], 0.02)
    s, h = (grid.ravel() for grid in np.meshgrid(along, up))
    return np.column_stack([x[0] + s * (x[1] - x[0]), y[0] + s * (y[1] - y[0]), h])


def cloud_of(*parts):
    """Return the cloud of some points, all facing up."""
    points = np.concatenate(parts).astype(np.float32)
    normals = np.tile(np.array([0, 0, 1], np.float32), (len(points), 1))
    return Cloud(points, normals, np.full(points.shape, 128, np.uint8))


def shelf():
    """Return a floor and two boards of which three sides are closed, and a table."""
    boards = [plane((1, 1.3), (1, 2), z) for z in (0.4, 0.8)]
    table = plane((2.2, 2.8), (0.2, 0.8), 0.7)
    sides = [((1, 1.3), (1, 1)), ((1, 1.3), (2, 2)), ((1, 1), (1, 2))]
    walls = [wall(x, y, (0, 1.2)) for x, y in sides]
    cloud = cloud_of(plane((0, 3), (0, 3), 0), *boards, *walls, table)
    areas = (
        area("floor", (0, 3), (0, 3), 0.0, is_floor=True),
        replace(area("area1", (1, 1.3), (1, 2), 0.4), clearance_m=0.4),
        area("area2", (1, 1.3), (1, 2), 0.8),
        area("area3", (2.2, 2.8), (0.2, 0.8), 0.7),
    )
    return cloud, areas


def described(cloud, areas):
    """Return the numbers of each area by name."""
    table = describe_areas(
        cloud, areas, find_candidates(cloud, areas, SETTINGS.candidates)
    )
    return [dict(zip(AREA_DESCRIPTORS, row, strict=True)) for row in table]


def slow_enclosure(cloud, spots, height):
    """Return the share of directions with something near, spot by spot."""
    x, y, z = cloud.points.astype(float).T
    shares = []
    for at_x, at_y in spots:
        near = np.hypot(x - at_x, y - at_y) < NEAR_M
        near &= (z > height + 0.05) & (z < height + 0.3)
        turns = np.arctan2(y[near] - at_y, x[near] - at_x) / (2 * np.pi) + 0.5
        shares.append(len({int(t * N_DIRECTIONS) % N_DIRECTIONS for t in turns}))
    return np.mean(shares) / N_DIRECTIONS


def test_shelves_are_enclosed_and_tables_are_not():
    cloud, areas = shelf()
    _, lower, upper, table = described(cloud, areas)
    assert lower["enclosure"] > 0.4
    assert upper["enclosure"] > 0.4
    assert table["enclosure"] == 0
    places = find_candidates(cloud, areas, SETTINGS.candidates)
    spots = places.location[places.area == 1, :2]
    slow = slow_enclosure(cloud, spots, 0.4)
    assert lower["enclosure"] == pytest.approx(slow, abs=0.05)


def test_boards_know_what_is_above_and_below():
    floor, lower, upper, table = described(*shelf())
    assert (lower["covered_above"], lower["covered_below"]) == (1, 0)
    assert (upper["covered_above"], upper["covered_below"]) == (0, 1)
    assert (table["covered_above"], table["covered_below"]) == (0, 0)
    assert 0 < floor["covered_above"] < 0.5
    ranks = [of["height_rank"] for of in (floor, lower, table, upper)]
    assert ranks == [0, 0.25, 0.5, 0.75]


def test_sizes_are_those_of_the_outline():
    floor, lower, *_ = described(*shelf())
    assert np.exp(lower["log_extent_m2"]) == pytest.approx(0.3)
    assert np.exp(lower["log_width_m"]) == pytest.approx(0.3, abs=0.02)
    assert np.exp(lower["log_clearance_m"]) == pytest.approx(0.4)
    assert floor["is_floor"] == 1 > lower["is_floor"] == 0


def test_softness_may_be_unknown():
    cloud, areas = shelf()
    soft = (*areas[:3], replace(areas[3], softness=0.8))
    numbers = [
        (of["softness"], of["is_softness_known"]) for of in described(cloud, soft)
    ]
    assert numbers == [(0, 0), (0, 0), (0, 0), (0.8, 1)]
    places = find_candidates(cloud, areas, SETTINGS.candidates)
    hidden = without_softness(describe_areas(cloud, soft, places))
    np.testing.assert_array_equal(hidden, describe_areas(cloud, areas, places))


def test_names_and_order_do_not_matter():
    scene, cloud = study_scene()
    renamed = tuple(replace(a, area=f"x{a.area}") for a in scene.areas)
    assert described(cloud, scene.areas) == described(cloud, renamed)
    backwards = described(cloud, scene.areas[::-1])[::-1]
    assert described(cloud, scene.areas) == backwards


def test_an_area_between_the_places_is_described():
    scene, cloud = study_scene()
    sliver = area("area9", (0.51, 0.53), (0.51, 0.9), 0.3)
    found = described(cloud, (*scene.areas, sliver))
    assert np.isfinite(list(found[-1].values())).all()
    assert describe_areas(
        cloud, (), find_candidates(cloud, (), SETTINGS.candidates)
    ).shape == (0, len(AREA_DESCRIPTORS))

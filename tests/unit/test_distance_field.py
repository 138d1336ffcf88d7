"""Distances are those of the cloud, and what nobody can get to counts as occupied."""

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import cKDTree

from placing.robot.distance_field import (
    FieldConfig,
    distance_field,
    distances,
    nearest_cells,
)

CONFIG = FieldConfig(0.025, 0.045, 2.0, 0.025, 0.1)


def sheet(x, y, z, step=0.02):
    """Return points of an axis-parallel rectangle; one of the ranges is a number."""
    axes = [np.arange(*r, step) if isinstance(r, tuple) else [r] for r in (x, y, z)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)


def box(x, y, z):
    """Return points of the six sides of a box."""
    sides = [sheet(a, y, z) for a in x] + [sheet(x, b, z) for b in y]
    return np.concatenate([*sides, *(sheet(x, y, c) for c in z)])


FLOOR = sheet((0.0, 3.0), (0.0, 2.0), 0.0)
CABINET = box((1.0, 2.0), (0.5, 1.5), (0.1, 1.1))


@pytest.fixture(scope="module")
def field():
    rug = sheet((0.1, 0.5), (0.1, 0.5), 0.02)
    return distance_field(np.concatenate([FLOOR, CABINET, rug]), CONFIG)


def lookup(field, x, y, z):
    """Return the distance at the cell of a point."""
    cell = np.round((np.array([x, y, z]) - field.origin_m) / field.cell_m).astype(int)
    return field.distance_m[tuple(cell)]


def test_distances_agree_with_a_search_tree(field):
    rng = np.random.default_rng(0)
    cells = np.stack([rng.integers(0, n, 5000) for n in field.distance_m.shape], -1)
    centres = field.origin_m + cells * field.cell_m
    true = cKDTree(CABINET).query(centres)[0]
    found = field.distance_m[tuple(cells.T)]
    inside = np.all((centres > [1, 0.5, 0.1]) & (centres < [2, 1.5, 1.1]), axis=1)
    # Elsewhere the edge of the scan may be nearer.
    edge = np.min(
        [centres[:, 0], 3 - centres[:, 0], centres[:, 1], 2 - centres[:, 1]], 0
    )
    near = ~inside & (true < 0.4) & (true < edge - 0.05)
    assert near.sum() > 200
    assert np.all(found[near] >= true[near] - 1e-6)
    assert np.all(found[near] <= true[near] + 0.006)


def test_a_closed_cabinet_is_occupied_inside(field):
    assert lookup(field, 1.5, 1.0, 0.6) == 0.0
    assert lookup(field, 0.5, 1.0, 0.6) > 0.3


def test_an_open_cabinet_is_free_inside():
    front = (CABINET[:, 0] == 1.0) & np.all(
        np.abs(CABINET[:, 1:] - [1.0, 0.6]) < 0.4, axis=1
    )
    opened = distance_field(np.concatenate([FLOOR, CABINET[~front]]), CONFIG)
    assert lookup(opened, 1.5, 1.0, 0.6) > 0.4


def test_the_scan_ends_at_its_edge(field):
    assert lookup(field, 0.4, 1.0, 1.5) == pytest.approx(0.4, abs=0.05)
    low = distance_field(FLOOR[FLOOR[:, 0] < 1.5], CONFIG)
    bent = np.concatenate([FLOOR[FLOOR[:, 0] < 1.5], FLOOR[FLOOR[:, 1] < 1.0]])
    assert lookup(distance_field(bent, CONFIG), 2.0, 1.5, 1.0) == 0.0
    assert low.distance_m.max() > 0.7


def test_a_rug_is_ground_and_no_obstacle(field):
    x, y = np.round((np.array([0.3, 0.3]) - field.origin_m[:2]) / 0.025).astype(int)
    assert field.ground_m[x, y] == pytest.approx(0.02)
    assert lookup(field, 0.3, 0.3, 0.03) > 0.2
    assert field.ground_m[x + 60, y] == 0.0


def test_a_bare_floor_has_a_field():
    field = distance_field(FLOOR, CONFIG)
    assert lookup(field, 1.5, 1.0, 1.0) == pytest.approx(1.0, abs=0.06)


def test_the_nearest_cells_are_those_of_a_plain_transform():
    rng = np.random.default_rng(1)
    shape = (7, 9, 8)
    for n in (1, 5, 40, 200):
        occupied = np.sort(rng.choice(np.prod(shape), n, replace=False))
        is_free = np.ones(shape, bool)
        is_free.ravel()[occupied] = False
        found = ndimage.distance_transform_edt(
            is_free, return_distances=False, return_indices=True
        )
        named = occupied[nearest_cells(occupied, shape)]
        assert np.array_equal(named, np.ravel_multi_index(tuple(found), shape))


def test_what_is_skipped_is_no_nearer():
    rng = np.random.default_rng(2)
    shape, n_points = (9, 8, 7), 60
    cells = rng.integers(0, shape, (n_points, 3))
    points = cells + rng.uniform(-0.5, 0.5, cells.shape)
    is_scanned = np.pad(np.ones((7, 6), bool), 1)
    found = distances(cells, points, np.zeros(3), is_scanned, shape[2])
    outside = ndimage.distance_transform_edt(is_scanned)
    is_in = (cells == cells[:, None]).all(-1)  # (p, p)
    named = is_in[named_cells(cells, shape)].reshape(*shape, n_points)
    for cell in np.ndindex(shape):
        around = tuple(slice(max(c - 1, 0), c + 2) for c in cell)
        near = points[named[around].any((0, 1, 2))]
        least = np.sum((near - cell) ** 2, axis=1).min()
        expected = min(np.sqrt(least), outside[cell[:2]])
        assert found[cell] == pytest.approx(expected, rel=1e-6)


def named_cells(cells, shape):
    """Return for each cell of a grid the number of a point in the nearest occupied."""
    number = np.full(shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    nearest = ndimage.distance_transform_edt(
        number < 0, return_distances=False, return_indices=True
    )
    return number[tuple(nearest)].ravel()

"""Places lie on placing areas, and objects fit where they say."""

import numpy as np
import pytest

from placing.candidates import (
    CandidatesConfig,
    fits,
    is_unoccupied,
)
from placing.clouds.ply import Cloud
from placing.places import find_candidates
from placing.scene import PlacingArea, SceneObject

CONFIG = CandidatesConfig(0.05, 8, 0.7, 0.05)
MUG = SceneObject("mug", "dishware", "mug", (0.1, 0.08, 0.1), 0.3, False, True)


@pytest.fixture(scope="module")
def candidates():
    """Return the places of a 2 x 2 m room with a shelf 0.3 m above a table."""
    step = np.arange(0, 2.001, 0.02)
    x, y = (grid.ravel() for grid in np.meshgrid(step, step))
    floor = np.column_stack([x, y, np.zeros_like(x)])
    on_table = (x >= 0.5) & (x <= 1.5) & (y >= 0.5) & (y <= 1.0)
    table, shelf = floor[on_table] + [0, 0, 0.7], floor[on_table] + [0, 0, 1.0]
    points = np.concatenate([floor, table, shelf]).astype(np.float32)
    normals = np.tile(np.float32([0, 0, 1]), (len(points), 1))
    normals[len(floor) + len(table) :, 2] = -1
    cloud = Cloud(points, normals, np.full(points.shape, 128, np.uint8))
    square = np.array([[0.5, 0.5], [1.5, 0.5], [1.5, 1.0], [0.5, 1.0]])
    area = PlacingArea("area1", square, 0.7, 0.3, is_floor=False, softness=None)
    return find_candidates(cloud, (area,), CONFIG)


def test_places_lie_inside_the_area_at_its_height(candidates):
    assert len(candidates.location) == pytest.approx(20 * 10, abs=31)
    assert (candidates.location[:, 2] == 0.7).all()


def test_features_measure_clearance_edge_and_wall(candidates):
    at = np.linalg.norm(candidates.location[:, :2] - [1.0, 0.75], axis=1).argmin()
    assert candidates.feature("clearance_m")[at] == pytest.approx(0.3, abs=0.02)
    assert candidates.feature("edge_distance_m")[at] == pytest.approx(0.25, abs=0.01)
    assert candidates.feature("wall_distance_m")[at] == pytest.approx(0.75, abs=0.1)


def test_a_tall_object_does_not_fit_below_the_shelf(candidates):
    tall = SceneObject("vase", "decoration", "vase", (0.1, 0.1, 0.35), 1, False, False)
    assert fits(candidates, MUG, 0.7).any()
    assert not fits(candidates, tall, 0.7).any()


def test_an_object_keeps_part_of_itself_inside_the_edge(candidates):
    wide = SceneObject("tv", "tv", "tv", (0.4, 0.6, 0.2), 5, True, False)
    kept = fits(candidates, wide, 0.7)
    assert candidates.feature("edge_distance_m")[kept].min() >= 0.7 * 0.2 - 1e-9


def test_given_objects_block_the_places_that_would_overlap_them(candidates):
    box = np.array([[1.0, 0.75, 0.75, 0.2, 0.4, 0.1, np.pi / 2]])
    free = is_unoccupied(candidates, MUG, box)
    x, y = (candidates.location[:, :2] - [1.0, 0.75]).T
    # Turned by a right angle the box is 0.4 m along x and 0.2 m along y.
    overlaps = (np.abs(x) < 0.2 + 0.04 - 1e-6) & (np.abs(y) < 0.1 + 0.04 - 1e-6)
    np.testing.assert_array_equal(free, ~overlaps)


def test_an_object_fits_below_one_that_hangs_above(candidates):
    box = np.array([[1.0, 0.75, 0.95, 0.2, 0.4, 0.1, 0.0]])
    assert is_unoccupied(candidates, MUG, box).all()

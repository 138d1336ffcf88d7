"""Upright boxes overlap when their turned rectangles and their heights do."""

import numpy as np
import pytest
import shapely

from placing.joint.stacking import footprints
from placing.overlap import covers, grown, overlaps


@pytest.fixture
def boxes():
    """Return boxes that crowd each other at any yaw, (120, 7)."""
    rng = np.random.default_rng(0)
    low, high = (0, 0, 0, 0.05, 0.05, 0.05, -4), (1, 1, 0.5, 0.4, 0.3, 0.3, 4)
    return rng.uniform(low, high, (120, 7))


def test_overlap_is_a_common_part_of_rectangles_and_of_heights(boxes):
    polygons = footprints(boxes)
    area = shapely.area(shapely.intersection(polygons[:, None], polygons))
    apart = np.abs(boxes[:, None, 2] - boxes[:, 2])
    reach = (boxes[:, None, 5] + boxes[:, 5]) / 2
    expected = (area > 1e-10) & (apart < reach)
    found = overlaps(boxes, boxes)
    assert 0.02 < expected.mean() < 0.5
    np.testing.assert_array_equal(found, expected)


def test_a_box_on_another_touches_it_only():
    lower = np.array([0, 0, 0.1, 0.2, 0.2, 0.2, 0.3])
    upper = np.array([0, 0, 0.25, 0.1, 0.1, 0.1, 0])
    assert not overlaps(lower[None], upper[None])[0, 0]
    upper[2] -= 0.01
    assert overlaps(lower[None], upper[None])[0, 0]


@pytest.mark.parametrize(("gap", "hits"), [(0.009, True), (0.011, False)])
def test_grown_boxes_that_stay_apart_are_a_margin_apart(gap, hits):
    boxes = np.array([[0, 0, 0.1, 0.2, 0.1, 0.2, 0], [0, 0, 0.1, 0.2, 0.1, 0.2, np.pi]])
    boxes[1, 0] = 0.2 + gap
    wide = grown(boxes, 0.01)
    assert overlaps(wide, wide)[0, 1] == hits


def test_boxes_that_cover_one_point_overlap(boxes):
    points = np.random.default_rng(1).uniform(0, (1, 1, 0.5), (500, 3))
    inside = covers(boxes, points)
    polygons = footprints(boxes)
    is_in = shapely.contains_xy(polygons, points[:, None, 0], points[:, None, 1])
    is_in &= np.abs(points[:, None, 2] - boxes[:, 2]) < boxes[:, 5] / 2
    np.testing.assert_array_equal(inside, is_in)
    together = inside.T.astype(int) @ inside > 0
    assert (overlaps(boxes, boxes) | ~together).all()

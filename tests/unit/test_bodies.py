"""Bodies weigh and turn as their meshes, and are smaller by the margin."""

import numpy as np
import trimesh

from placing.physics.bodies import box_body, shrunk_hull, spread
from placing.physics.cutting import body_of, fixed_pieces


def block(size_m, centre_m=(0.0, 0.0, 0.0)):
    return trimesh.creation.box(size_m).apply_translation(centre_m)


def test_a_shrunk_box_is_smaller_by_the_margin_on_each_side():
    corners = shrunk_hull(block((0.2, 0.1, 0.05)).vertices, 0.001).vertices_m
    assert len(corners) == 8
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.198, 0.098, 0.048])


def test_what_is_thinner_than_the_margin_keeps_half_of_it():
    corners = shrunk_hull(block((0.2, 0.1, 0.001)).vertices, 0.001).vertices_m
    np.testing.assert_allclose(np.ptp(corners, axis=0)[2], 0.0005)


def test_a_body_has_the_mass_centre_and_inertia_of_its_mesh():
    size = np.array([0.2, 0.1, 0.05])
    body = body_of(block(size, (1, 2, 3)), 2.0, 0.001)
    np.testing.assert_allclose(body.mass_centre_m, [1, 2, 3])
    expected = 2.0 / 12 * (np.sum(size**2) - size**2)
    np.testing.assert_allclose(body.inertia_kg_m2, expected)
    np.testing.assert_allclose(body.corners_m.min(0), [1, 2, 3] - size / 2 + 0.001)


def shelf():
    """Return a board around a hollow."""
    return trimesh.boolean.difference([block((0.3, 0.8, 0.4)), block((0.4, 0.7, 0.3))])


def test_a_box_is_the_body_of_its_mesh():
    for size in np.random.default_rng(1).uniform(0.02, 0.5, (20, 3)):
        cut, box = body_of(block(size), 1.3, 0.001), box_body(size, 1.3, 0.001)
        np.testing.assert_array_equal(box.corners_m, cut.corners_m)
        np.testing.assert_array_equal(box.pieces[0].faces, cut.pieces[0].faces)
        np.testing.assert_allclose(box.inertia_kg_m2, cut.inertia_kg_m2)


def test_furniture_keeps_its_hollows():
    table_top = block((1, 1, 0.03), (0, 0, 1))
    both = trimesh.util.concatenate([shelf(), table_top])
    assert sorted(p.is_convex for p in fixed_pieces(both, 0.001)) == [False, True]


def test_spread_keeps_the_outermost_points():
    points = np.random.default_rng(0).normal(size=(500, 3))
    kept = spread(points, 60)
    assert len(np.unique(kept, axis=0)) == 60
    np.testing.assert_array_equal(kept.max(0), points.max(0))
    np.testing.assert_array_equal(kept.min(0), points.min(0))

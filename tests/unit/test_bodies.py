"""Convex parts cover what they stand for, and not much more."""

import numpy as np
import pytest
import trimesh

from placing.physics.bodies import (
    body_of,
    convex_parts,
    fixed_pieces,
    shrunk_hull,
    spread,
)

L_SIZE_M = 0.3


def block(size_m, centre_m=(0.0, 0.0, 0.0)):
    return trimesh.creation.box(size_m).apply_translation(centre_m)


def l_shape():
    """Two boards that meet at a right angle."""
    lying = block((L_SIZE_M, 0.2, 0.02), (0, 0, 0.01))
    standing = block((0.02, 0.2, L_SIZE_M), (-L_SIZE_M / 2 + 0.01, 0, L_SIZE_M / 2))
    return trimesh.boolean.union([lying, standing])


def covers(parts, point):
    hulls = [trimesh.convex.convex_hull(part) for part in parts]
    return any(
        np.all((h.face_normals * (point - h.triangles[:, 0])).sum(1) < 1e-9)
        for h in hulls
    )


def test_two_boards_become_two_parts_of_the_same_volume():
    mesh = l_shape()
    parts = convex_parts(mesh)
    assert len(parts) == 2
    volume = sum(trimesh.convex.convex_hull(part).volume for part in parts)
    assert volume == pytest.approx(mesh.volume, rel=1e-6)


def test_parts_cover_the_mesh_and_leave_its_hollow_free():
    mesh = l_shape()
    parts = convex_parts(mesh)
    inside = mesh.triangles_center - 1e-4 * mesh.face_normals
    assert all(covers(parts, point) for point in inside)
    assert not covers(parts, np.array([0.0, 0.0, 0.1]))


def test_a_convex_mesh_stays_in_one_part():
    assert len(convex_parts(trimesh.creation.cylinder(0.04, 0.1))) == 1


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


def test_furniture_keeps_its_hollows():
    shelf = trimesh.boolean.difference([block((0.3, 0.8, 0.4)), block((0.4, 0.7, 0.3))])
    table_top = block((1, 1, 0.03), (0, 0, 1))
    both = trimesh.util.concatenate([shelf, table_top])
    assert sorted(p.is_convex for p in fixed_pieces(both, 0.001)) == [False, True]


def test_spread_keeps_the_outermost_points():
    points = np.random.default_rng(0).normal(size=(500, 3))
    kept = spread(points, 60)
    assert len(np.unique(kept, axis=0)) == 60
    np.testing.assert_array_equal(kept.max(0), points.max(0))
    np.testing.assert_array_equal(kept.min(0), points.min(0))

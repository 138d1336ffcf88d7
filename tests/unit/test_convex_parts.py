"""Convex parts cover what they stand for, and not much more."""

import numpy as np
import pytest
import trimesh

from placing.physics.convex_parts import convex_parts

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

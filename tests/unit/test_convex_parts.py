"""Convex parts cover what they stand for, and not much more."""

import numpy as np
import pytest
import trimesh
from manifold3d import Manifold, Mesh64

from placing.object_meshes import object_mesh
from placing.physics.convex_parts import (
    AXES,
    best_cut,
    convex_parts,
    corners_of,
    hull_volume,
    places_to_cut,
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


@pytest.mark.parametrize("shape", ["mug", "shoes", "desk_light", "keyboard"])
def test_the_best_cut_is_the_first_best_of_all(shape):
    mesh = object_mesh(shape, (0.2, 0.15, 0.1))
    part = Manifold(
        Mesh64(np.asarray(mesh.vertices), np.asarray(mesh.faces, np.uint64))
    )
    gains = gains_of_all(part)
    first = max(gains, key=gains.get)
    for least_m3 in (1e-9, gains[first] * 0.9):
        found = best_cut(part, least_m3)
        assert (found.axis, found.place_m) == first
        assert found.gain_m3 == pytest.approx(gains[first], rel=1e-6)
    assert best_cut(part, gains[first] * 1.1).gain_m3 == 0.0


def gains_of_all(part):
    """Return what each cut frees, in the order of axes and places."""
    corners = corners_of(part)
    whole, gains = hull_volume(corners), {}
    for axis in AXES:
        for place in places_to_cut(corners @ axis):
            halves = part.split_by_plane(axis, place)
            freed = whole - sum(hull_volume(corners_of(half)) for half in halves)
            gains[axis, float(place)] = freed
    return gains

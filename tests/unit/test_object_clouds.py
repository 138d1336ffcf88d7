"""What the cloud of an object promises."""

import numpy as np
import pytest
import trimesh

from placing.clouds.cloud import sample_cloud
from placing.psi.object_clouds import FEWEST, MOST, mass_centre_of, object_cloud
from placing.scene import SceneObject
from placing.shapes.objects import object_shape

SIZES = {
    "box": (0.3, 0.2, 0.25),
    "bottle": (0.07, 0.07, 0.25),
    "cushion": (0.4, 0.4, 0.15),
    "saucepan": (0.35, 0.2, 0.12),
    "monitor": (0.2, 0.5, 0.45),
    "pen": (0.14, 0.01, 0.01),
    "mug": (0.08, 0.11, 0.1),
    "shoes": (0.28, 0.22, 0.1),
}


def item(shape: str, object_id: str = "thing") -> SceneObject:
    return SceneObject(object_id, shape, shape, SIZES[shape], 1.0, True, True)


def turns_around(mesh: trimesh.Trimesh, places: np.ndarray) -> np.ndarray:
    """Return how often the surface winds around places: 1 inside, 0 outside."""
    a, b, c = np.moveaxis(mesh.triangles[None] - places[:, None, None], 2, 0)
    lengths = [np.linalg.norm(edge, axis=2) for edge in (a, b, c)]
    volume = (a * np.cross(b, c)).sum(axis=2)
    below = (
        np.prod(lengths, axis=0)
        + (a * b).sum(axis=2) * lengths[2]
        + (b * c).sum(axis=2) * lengths[0]
        + (c * a).sum(axis=2) * lengths[1]
    )
    return np.arctan2(volume, below).sum(axis=1) / (2 * np.pi)


@pytest.mark.parametrize("shape", SIZES)
def test_the_mass_centre_is_that_of_the_solid(shape: str) -> None:
    cloud = object_cloud(item(shape), 0.01)
    truth = object_shape(shape, SIZES[shape]).mesh.center_mass
    assert np.abs(cloud.mass_centre - truth).max() < 0.025 * max(SIZES[shape])


@pytest.mark.parametrize("shape", SIZES)
def test_points_lie_on_the_surface_and_normals_point_out(shape: str) -> None:
    cloud = object_cloud(item(shape), 0.01)
    mesh = object_shape(shape, SIZES[shape]).mesh
    assert 0.8 * FEWEST < len(cloud.points) < 1.2 * MOST
    assert (np.abs(cloud.points) <= np.array(SIZES[shape]) / 2 + 1e-6).all()
    assert np.linalg.norm(cloud.normals, axis=1) == pytest.approx(1)
    outside, inside = (
        turns_around(mesh, cloud.points[::10] + step * cloud.normals[::10])
        for step in (1e-4, -1e-4)
    )
    assert (outside < 0.5).mean() > 0.95
    assert (inside > 0.5).mean() > 0.95


def test_clouds_are_the_same_every_time_and_named_after_their_object() -> None:
    one, other = (
        object_cloud(item("mug", "mug1"), 0.01),
        object_cloud(item("mug"), 0.01),
    )
    assert one.object_id == "mug1"
    np.testing.assert_array_equal(one.points, other.points)
    assert one != other


def test_a_wider_spacing_takes_fewer_points() -> None:
    fine, coarse = (len(object_cloud(item("box"), s).points) for s in (0.02, 0.03))
    assert fine > 1.5 * coarse


def test_the_mass_centre_of_an_open_shell_is_that_of_its_hull() -> None:
    box = trimesh.creation.box((0.3, 0.2, 0.1)).apply_translation((0, 0, 0))
    box.visual.face_colors = [90, 90, 90, 255]
    cloud = sample_cloud(np.random.default_rng(1), [box], 0.01)
    points, normals = cloud.points.astype(float), cloud.normals.astype(float)
    is_kept = normals[:, 2] < 0.5  # A tray without its lid.
    centre = mass_centre_of(points[is_kept], normals[is_kept])
    assert np.abs(centre).max() < 0.005

"""Meshes of a layout are where it says, and near walls do not hide the room."""

import numpy as np
import pytest

from placing import rigid
from placing.dressing import WALLS, meshes_of, object_meshes
from placing.pictures.cameras import Camera
from placing.pictures.rooms import anchor_of, cut_away, room_camera, seen_furniture
from placing.scene import Arrangement, Furniture, Layout, Placement, SceneObject
from placing.shapes.objects import object_shape

SIZE = (160, 120)


def furniture(name, kind, size_m, position_m, yaw_deg):
    pose = rigid.from_yaw(np.deg2rad(yaw_deg), position_m)
    return Furniture(name, kind, size_m, pose)


@pytest.fixture(scope="module")
def layout():
    """A room whose cabinet stands at the wall y = 0 and whose picture hangs there."""
    return Layout(
        scene="office1",
        kind="office",
        outline_m=np.array([[0, 0], [4, 0], [4, 3], [0, 3.0]]),
        height_m=2.5,
        openings=(),
        furniture=(
            furniture("cabinet1", "cabinet", (0.4, 1.2, 1.8), (2.0, 0.2, 0.0), 90),
            furniture("picture1", "picture", (0.03, 0.6, 0.4), (3.2, 0.015, 1.4), 90),
        ),
        objects=(
            SceneObject("book1", "book", "book", (0.24, 0.17, 0.03), 0.5, True, True),
        ),
        arrangements=(),
    )


def test_furniture_stands_where_the_layout_says(layout):
    low, high = meshes_of(layout)["cabinet1"].bounds
    np.testing.assert_allclose(low, [1.4, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(high, [2.6, 0.4, 1.8], atol=1e-6)


@pytest.mark.parametrize(
    ("stance", "extent"),
    [("upright", (0.24, 0.17, 0.03)), ("edge", (0.17, 0.03, 0.24))],
)
def test_object_is_turned_by_its_stance_about_its_centre(layout, stance, extent):
    orientation = np.array(rigid.STANCES[stance])
    placement = Placement("book1", "floor", np.array([1.0, 1.0, 0.5]), orientation)
    placed = object_meshes(layout, Arrangement("labeller1", "tidy", (placement,)))
    low, high = placed["book1"].bounds
    np.testing.assert_allclose((low + high) / 2, [1.0, 1.0, 0.5], atol=1e-6)
    assert high - low == pytest.approx(extent)


def test_room_is_seen_from_the_side_that_its_furniture_faces(layout):
    camera = room_camera(layout, SIZE)
    assert camera.eye[1] > 3.0
    assert seen_furniture(layout, camera) == ["cabinet1", "picture1"]


def test_all_of_the_room_is_in_the_picture(layout):
    camera = room_camera(layout, SIZE)
    walls = cut_away(meshes_of(layout)[WALLS], layout.outline_m, np.array(camera.eye))
    used = walls.vertices[np.unique(walls.faces)]
    pixels = camera.project(used, SIZE)
    assert (pixels >= 0).all()
    assert (pixels <= SIZE).all()


def test_near_walls_are_left_out_and_far_ones_stay(layout):
    eye = np.array([6.0, 1.5, 5.0])
    walls = cut_away(meshes_of(layout)[WALLS], layout.outline_m, eye)
    centres = walls.triangles_center[walls.triangles[:, :, 2].min(axis=1) > 0.05]
    assert (centres[:, 0] < 4.0 + 1e-6).all()
    for at in ([-0.05, 1.5], [2.0, -0.05], [2.0, 3.05]):  # every other wall
        assert np.linalg.norm(centres[:, :2] - at, axis=1).min() < 2.1
    assert walls.bounds[1, 2] == pytest.approx(2.5)


def test_picture_on_a_wall_that_is_left_out_is_left_out_too(layout):
    behind = Camera((2.0, -4.0, 5.0), (2.0, 1.5, 0.0))
    assert seen_furniture(layout, behind) == ["cabinet1"]


def test_anchor_of_a_label_is_on_the_mesh():
    mesh = object_shape("mug", (0.08, 0.11, 0.1)).mesh
    corners = np.concatenate([mesh.vertices, mesh.triangles_center])
    assert np.linalg.norm(corners - anchor_of(mesh), axis=1).min() < 1e-12

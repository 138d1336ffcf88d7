"""Pictures show the right silhouette, light from the right side, and do not vary."""

import numpy as np
import pytest
import shapely
import trimesh
from PIL import Image

from placing.pictures.cameras import Camera, corners_of, framing
from placing.pictures.labels import labelled, sheet
from placing.pictures.renderer import Light, render, write_picture
from placing.pictures.shading import smooth_normals

SIZE = (160, 120)
BLACK = (0, 0, 0)
CAMERA = Camera((3.0, 1.5, 2.0), (0.0, 0.0, 0.0), 30.0)


def cube(side=1.0):
    box = trimesh.creation.box((side, side, side))
    colours = np.tile([200, 60, 40, 255], (12, 1))
    return trimesh.Trimesh(box.vertices, box.faces, face_colors=colours, process=False)


def silhouette(points, camera):
    """Return which pixels have their centre in the hull of the projected points."""
    hull = shapely.MultiPoint(camera.project(points, SIZE)).convex_hull
    u, v = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    return shapely.contains_xy(hull, u, v)


def test_cube_covers_the_hull_of_its_projected_corners():
    picture = render([cube()], CAMERA, SIZE, Light(background=BLACK))
    covered = picture.any(axis=2)
    expected = silhouette(cube().vertices, CAMERA)
    assert 2000 < expected.sum() < 12000
    # Only pixels that the outline crosses may differ.
    edge = shapely.MultiPoint(CAMERA.project(cube().vertices, SIZE)).convex_hull.length
    assert (covered != expected).sum() < edge


def test_projection_agrees_with_the_rays():
    points = np.array([[0.3, -0.2, 0.4], [-0.5, 0.1, 0.0], [0.0, 0.6, -0.3]])
    pixels = CAMERA.project(points, SIZE)
    rays = CAMERA.rays(pixels.astype(np.float32), SIZE)
    towards = points - CAMERA.eye
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    np.testing.assert_allclose(rays, towards, atol=1e-5)


def test_up_is_up_and_left_is_left():
    camera = Camera((4.0, 0.0, 0.5), (0.0, 0.0, 0.5))
    pixels = camera.project(np.array([[0, 0, 1.0], [0, 0, 0], [0, -0.5, 0.5]]), SIZE)
    assert pixels[0, 1] < pixels[1, 1]
    assert pixels[2, 0] < SIZE[0] / 2  # seen from +x, -y is to the left


def test_same_bytes_twice():
    first, second = (render([cube()], CAMERA, SIZE) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_outlines_are_smooth():
    picture = render([cube()], CAMERA, SIZE, Light(background=BLACK))
    reds = np.unique(picture[..., 0])
    flat = render([cube()], CAMERA, SIZE, Light(background=(255, 255, 255)))
    is_mixed = (picture[..., 1] != flat[..., 1]) & picture.any(axis=2)
    assert is_mixed.sum() > 50
    assert len(reds) > 10


def test_top_of_a_cube_is_brighter_than_a_side_in_the_shade():
    light = Light(sun=(0.0, 1.0, 1.0))  # from behind: the sides in view are in shade
    camera = Camera((4.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    picture = render([cube()], camera, SIZE, light).astype(float)
    (top, side) = camera.project(np.array([[0, 0, 0.5], [0.5, 0, 0.0]]), SIZE).astype(
        int
    )
    assert picture[top[1], top[0], 0] > 1.3 * picture[side[1], side[0], 0]


def test_shadow_falls_on_the_ground_away_from_the_sun():
    light = Light(sun=(1.0, 0.0, 1.0), ground_m=-0.5)
    camera = Camera((6.0, 0.0, 3.0), (0.0, 0.0, -0.5), 40.0)
    picture = render([cube()], camera, SIZE, light)
    # The sun is on the camera's right, +y, at 45 degrees.
    spots = camera.project(np.array([[0, -1.0, -0.5], [0, 1.0, -0.5]]), SIZE).astype(
        int
    )
    shaded, bright = (picture[v, u].astype(int) for u, v in spots)
    assert tuple(bright) == light.background
    assert (shaded < bright - 20).all()


def test_round_things_are_shaded_round_and_cubes_are_not():
    ball = trimesh.creation.icosphere(3)
    radial = ball.triangles / np.linalg.norm(ball.triangles, axis=2, keepdims=True)
    assert np.abs(smooth_normals(ball) - radial).max() < 0.03
    box = cube()
    flat = np.repeat(box.face_normals[:, None], 3, axis=1)
    np.testing.assert_allclose(smooth_normals(box), flat, atol=1e-12)


@pytest.mark.parametrize("azimuth", [0.0, 35.0, 200.0])
@pytest.mark.parametrize("elevation", [10.0, 60.0])
def test_framing_just_sees_every_corner(azimuth, elevation):
    corners = corners_of(np.array([1.0, -2.0, 0.0]), np.array([3.0, 0.0, 0.4]))
    camera = framing(corners, azimuth, elevation, SIZE, margin=0.0)
    pixels = camera.project(corners, SIZE)
    assert (pixels > -1e-6).all()
    assert (pixels < np.array(SIZE) + 1e-6).all()
    gaps = np.abs(np.concatenate([pixels.min(0), np.array(SIZE) - pixels.max(0)]))
    assert np.sort(gaps)[1] < 1e-6  # it touches two opposite sides of the picture


def test_labels_do_not_cover_one_another():
    blank = np.full((120, 300, 3), 255, np.uint8)
    alone = [labelled(blank, {"chair1": np.array([u, 60.0])}) for u in (150.0, 156.0)]
    both = labelled(
        blank, {"chair1": np.array([150.0, 60.0]), "chair2": np.array([156.0, 60.0])}
    )
    ink = [(picture < 255).any(axis=2).sum() for picture in (*alone, both)]
    assert ink[2] > 0.9 * (ink[0] + ink[1])


def test_label_outside_the_picture_is_left_out():
    blank = np.full((60, 80, 3), 255, np.uint8)
    assert (labelled(blank, {"far": np.array([-5.0, 20.0])}) == blank).all()
    assert (labelled(blank, {}) == blank).all()


def test_sheet_has_a_place_for_each_tile():
    red = np.zeros((30, 40, 3), np.uint8) + np.array([250, 0, 0], np.uint8)
    page = sheet({name: red for name in "abcde"}, columns=3, tile=(40, 30))
    is_red = (page == (250, 0, 0)).all(axis=2)
    assert is_red.sum() == 5 * 30 * 40
    assert sheet({}, columns=3, tile=(40, 30)).ndim == 3


def test_picture_is_written_as_it_is(tmp_path):
    picture = render([cube()], CAMERA, SIZE)
    write_picture(picture, tmp_path / "new" / "cube.png")
    assert (np.asarray(Image.open(tmp_path / "new" / "cube.png")) == picture).all()

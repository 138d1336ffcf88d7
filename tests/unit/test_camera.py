"""What a depth camera sees of simple walls and of a small room."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from placing.areas.finder import AreaConfig, find_areas
from placing.camera import (
    CameraConfig,
    Surfaces,
    View,
    depth_image,
    look,
    noise_m,
    rays_of,
    scan_depth,
)
from placing.clouds.cloud import CloudConfig, preprocess
from placing.clouds.ply import Cloud, read_ply, write_ply
from placing.clouds.raycaster import Raycaster
from placing.dressing import meshes_of
from placing.errors import BadInput
from placing.layouts import softness_of
from placing.rigid import from_yaw
from placing.rooms.file import read_yaml
from placing.scene import Furniture, Layout

SETTINGS = read_yaml(Path(__file__).parents[2] / "config" / "config.yaml")
LISTS = {name: tuple(SETTINGS["camera"][name]) for name in ("size", "range_m")}
CONFIG = CameraConfig(**SETTINGS["camera"] | LISTS | {"tilts_deg": (15.0, 45.0)})
SMALL = replace(CONFIG, size=(80, 60), lateral_px=0.1, max_viewpoints=4, voxel_m=0.02)
AHEAD = View(np.zeros(3), np.array([[0, -1.0, 0], [0, 0, -1.0], [1.0, 0, 0]]))
WHITE, BLACK, STEEL = (236, 234, 229), (42, 43, 46), (176, 181, 186)


def wall(
    at_m: float, color: tuple = WHITE, width_m: float = 9.0, turn_deg: float = 0.0
) -> trimesh.Trimesh:
    mesh = trimesh.creation.box((0.1, width_m, 9.0))
    mesh.apply_translation((0.05, 0, 0))
    turn = trimesh.transformations.rotation_matrix(np.radians(turn_deg), (0, 0, 1))
    mesh.apply_transform(turn).apply_translation((at_m, 0, 0))
    mesh.visual.face_colors = [*color, 255]
    return mesh


def image(*meshes: trimesh.Trimesh, config: CameraConfig = CONFIG) -> np.ndarray:
    surfaces = Surfaces(meshes, [0.0] * len(meshes), config.shiny_share)
    return depth_image(np.random.default_rng(3), surfaces, AHEAD, config)[0]


def room(*furniture: tuple) -> Layout:
    """Return a room of 3 m by 3 m with furniture of (kind, size, place)."""
    pieces = [
        Furniture(f"{kind}{k}", kind, size, from_yaw(0.0, (*place, 0.0)))
        for k, (kind, size, place) in enumerate(furniture)
    ]
    outline = np.array([[0, 0], [3, 0], [3, 3], [0, 3.0]])
    return Layout("small", "office", outline, 2.4, (), tuple(pieces), (), ())


COUCH = ("couch", (0.85, 1.6, 0.8), (0.5, 1.5))
TABLE = ("table", (0.7, 0.9, 0.75), (2.2, 2.4))


def scanned(layout: Layout, config: CameraConfig = SMALL, seed: int = 5) -> Cloud:
    meshes, soft = meshes_of(layout), softness_of(layout)
    rng = np.random.default_rng(seed)
    return scan_depth(
        rng, layout, list(meshes.values()), [soft[name] for name in meshes], config
    )


@pytest.mark.parametrize("distance", [0.8, 1.5, 3.0, 3.9])
def test_noise_grows_with_depth_as_its_formula_says(distance: float) -> None:
    depth = image(wall(distance))
    seen = depth[depth > 0]
    axial = 0.0012 + 0.0019 * (distance - 0.4) ** 2
    rounding = 0.00285 * distance**2 / np.sqrt(12)
    assert len(seen) > 0.7 * depth.size
    assert seen.std() == pytest.approx(np.hypot(axial, rounding), rel=0.05)
    assert seen.mean() == pytest.approx(distance, abs=0.1 * rounding + 1e-3)


def test_depths_are_whole_steps_of_the_disparity() -> None:
    depth = image(wall(2.9))
    steps = 1 / (depth[depth > 0] * CONFIG.step_per_m)
    assert np.abs(steps - np.round(steps)).max() < 1e-6
    assert 3 < len(np.unique(np.round(steps))) < 30


def test_nothing_is_seen_behind_what_is_in_front() -> None:
    depth = image(wall(1.2), wall(2.4, width_m=3.0))
    seen = depth[depth > 0]
    assert seen.max() < 1.2 + 5 * noise_m(np.array(1.2), CONFIG) + 0.00285 * 1.2**2


def test_black_and_shiny_walls_are_holes_from_where_white_is_seen() -> None:
    share = {
        name: (image(wall(3.0, color)) > 0).mean()
        for name, color in (("white", WHITE), ("black", BLACK), ("steel", STEEL))
    }
    assert share["white"] > 0.99
    assert share["black"] < 0.02
    assert share["steel"] < 0.5
    assert (image(wall(1.2, BLACK)) > 0).mean() > 0.7


def test_what_is_too_near_too_far_or_seen_too_flat_is_a_hole() -> None:
    assert not image(wall(0.4)).any()
    assert not image(wall(5.2)).any()
    assert not image(wall(1.5, turn_deg=87.0))[:, 150:170].any()
    assert image(wall(1.5, turn_deg=60.0)).any()


def test_the_projector_leaves_a_shadow_on_one_side_of_what_is_in_front() -> None:
    config = replace(CONFIG, edge_loss=0.0, lateral_px=0.0, signal_spread=0.0)
    post = trimesh.creation.box((0.05, 0.4, 9.0))
    post.apply_translation((1.0, 0, 0))
    post.visual.face_colors = [*WHITE, 255]
    row = image(wall(2.0), post, config=config)[120]
    focal_px = 160 / np.tan(np.radians(57.0) / 2)
    columns = np.flatnonzero(row == 0)
    shadow = focal_px * 0.075 * (1 / 0.975 - 1 / 2.0)
    assert len(columns) == pytest.approx(shadow, abs=2)
    assert columns.min() > 160 + 0.19 / 1.0 * focal_px  # To the right of the post.


def test_pixels_beside_an_edge_are_lost_and_a_steep_plane_is_none() -> None:
    config = replace(CONFIG, baseline_m=0.0, lateral_px=0.0, edge_loss=1.0)
    post = trimesh.creation.box((0.05, 0.4, 9.0))
    post.apply_translation((1.0, 0, 0))
    post.visual.face_colors = [*WHITE, 255]
    lost = np.flatnonzero(image(wall(2.0), post, config=config)[120] == 0)
    assert len(lost) == 4  # One pixel on each side of both edges.
    steep = wall(2.0, turn_deg=65.0)
    spared = replace(config, edge_loss=0.0)
    assert np.array_equal(image(steep, config=config), image(steep, config=spared))


def test_points_lie_on_the_surfaces_within_noise_and_pose_errors() -> None:
    layout = room(COUCH, TABLE)
    meshes = list(meshes_of(layout).values())
    surfaces = Surfaces(meshes, [0.0] * len(meshes), CONFIG.shiny_share)
    axes = np.array([[0, -1.0, 0], [-0.6, 0, -0.8], [0.8, 0, -0.6]])
    view = View(np.array([1.2, 1.2, 1.5]), axes)
    seen = look(np.random.default_rng(1), surfaces, view, CONFIG)
    depth = (seen.points - view.eye) @ view.axes[2]
    off = Raycaster(meshes).distance(seen.points)
    lateral = depth / rays_of(CONFIG).shape[1] * CONFIG.lateral_px * 1.1
    turned = depth * np.radians(CONFIG.pose_error_deg)
    sigma = noise_m(depth, CONFIG) + lateral + turned + CONFIG.pose_error_m
    bound = 3 * sigma + CONFIG.step_per_m * depth**2
    assert len(seen.points) > 10_000
    assert (off < bound).mean() > 0.999
    assert off.mean() > 0.001


def test_a_scan_is_the_same_for_the_same_stream_and_has_so_many_points(
    tmp_path: Path,
) -> None:
    config = replace(SMALL, n_points=5000)
    first, again = (scanned(room(TABLE), config) for _ in range(2))
    write_ply(tmp_path / "a.ply", first)
    write_ply(tmp_path / "b.ply", again)
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()
    assert 3000 < len(first) <= 5000
    other = scanned(room(TABLE), config, seed=6)
    assert not np.array_equal(first.points[:100], other.points[:100])


def test_the_area_of_a_couch_is_soft_and_that_of_a_table_hard(tmp_path: Path) -> None:
    cloud = scanned(room(COUCH, TABLE))
    floor = cloud.points[:, 2] < 0.02
    assert (cloud.normals[floor, 2] > 0.9).mean() > 0.9  # They face the camera.
    settings = SETTINGS["cloud"] | {"voxel_m": 0.03, "up": (0.0, 0.0, 1.0)}
    write_ply(tmp_path / "a.ply", preprocess(cloud, CloudConfig(**settings)))
    areas = find_areas(
        read_ply(tmp_path / "a.ply"),
        AreaConfig(**SETTINGS["areas"] | {"cell_m": 0.035}),
    )
    floor, *rest = areas
    seat = [a.softness for a in rest if abs(a.height_m - 0.44) < 0.02]
    top = [a.softness for a in rest if abs(a.height_m - 0.75) < 0.02]
    assert floor.softness == pytest.approx(0.0, abs=0.05)
    assert seat
    assert np.allclose(seat, 0.8, atol=0.05)
    assert top
    assert np.allclose(top, 0.0, atol=0.01)


def test_a_scene_without_a_place_to_stand_is_one_clear_line() -> None:
    layout = room(("table", (2.9, 2.9, 0.75), (1.5, 1.5)))
    with pytest.raises(BadInput) as error:
        scanned(layout)
    assert str(error.value).startswith("scene small: field furniture leaves no place")
    assert "expected" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_scene_in_which_nothing_is_seen_is_one_clear_line() -> None:
    with pytest.raises(BadInput, match="scene small: field points is 0"):
        scanned(room(), replace(SMALL, range_m=(0.01, 0.02)))

"""A strip shows what the robot does with one object, from where it can be seen."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import trimesh
from certified import CAN, CONFIG, certificate, settings

from placing import rigid
from placing.dressing import WALLS
from placing.errors import UnknownName
from placing.pictures.cameras import Camera
from placing.pictures.renderer import hidden
from placing.pictures.robot import part_meshes, posed
from placing.pictures.strip import (
    Stage,
    close_camera,
    draw_strip,
    moments,
    moved_farthest,
    points_on,
)
from placing.robot.film import PlaybackConfig, film
from placing.robot.model import link_poses, load_robot
from placing.scene import Furniture, Layout

PLAYBACK = PlaybackConfig(**CONFIG["playback"])
SIZE = (60, 80)


@cache
def robot():
    return load_robot(settings())


@cache
def stage():
    """Return a can that is carried in a room, and a second one that is handed over."""
    first = certificate()
    later = replace(first, object_id="can2", T_world_start=None)
    later = replace(later, segments=first.segments[2:])
    outline = np.array([[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]])
    table = Furniture("t1", "table", (0.4, 0.4, 0.78), rigid.from_yaw(0, (0.75, 0, 0)))
    items = (CAN, replace(CAN, object_id="can2"))
    layout = Layout("pillars", "office", outline, 2.5, (), (table,), items, ())
    return Stage(layout, robot(), film([first, later], robot(), PLAYBACK))


def test_moments_are_in_order_and_each_shows_its_phase():
    seen = stage().film
    shown = moments(seen, "can1")
    frames = [moment.frame for moment in shown]
    assert frames == sorted(frames)
    names = ["start", "pick can1", "carry", "lower", "let go", "end"]
    assert [moment.caption for moment in shown] == names
    held = [seen.held[frame] >= 0 for frame in frames]
    assert held == [False, True, True, True, False, False]
    assert [moment.is_whole for moment in shown] == [True] + [False] * 4 + [True]


def test_what_is_handed_over_is_not_picked():
    names = [moment.caption for moment in moments(stage().film, "can2")]
    assert names == ["start", "carry", "lower", "let go", "end"]


def test_an_object_that_nobody_moves_has_no_strip():
    with pytest.raises(UnknownName, match="can1, can2"):
        moments(stage().film, "can3")


def test_the_object_moved_farthest_is_the_one_with_the_longest_way():
    seen = stage().film
    for k, name in enumerate(seen.objects):
        poses = seen.T_world_objects.copy()
        poses[-1, k, 4] += 9
        assert moved_farthest(replace(seen, T_world_objects=poses)) == name


def test_parts_stand_where_the_links_of_the_robot_do():
    frame = len(stage().film.q) // 2
    drawn = trimesh.util.concatenate(stage().robot(frame))
    poses = link_poses(robot().tree, stage().film.q[frame])
    corners = [
        hull.points_m @ T[:3, :3].T + T[:3, 3]
        for hull in robot().hulls
        for T in [poses[robot().links.index(hull.link)]]
    ]
    every = np.concatenate(corners)
    bounds = np.stack([every.min(axis=0), every.max(axis=0)])
    np.testing.assert_allclose(drawn.bounds, bounds, atol=0.06)  # wheels are but seen


def test_a_posed_part_is_the_part_moved():
    parts = {"a": trimesh.creation.box((1, 2, 3))}
    T = rigid.homogeneous(rigid.from_yaw(0.3, (1, 2, 3)))
    (moved,) = posed(parts, {"a": T})
    expected = parts["a"].vertices @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(moved.vertices, expected)


def test_the_robot_has_wheels_and_wrists_as_its_description_shows_them():
    parts = part_meshes(robot())
    assert parts["base_footprint"].bounds[0, 2] < 0.02  # wheels reach the floor
    assert len(parts["r_wrist_roll_link"].faces) > 100


def test_what_stands_between_hides():
    wall = trimesh.creation.box((0.1, 4, 4))
    points = np.array([[-1.0, 0, 0], [-1.0, 1, 0], [2.0, 0, 0]])
    eyes = np.array([[3.0, 0, 0], [-3.0, 0, 0]])
    np.testing.assert_allclose(hidden([wall], points, eyes), [2 / 3, 1 / 3])


def test_the_camera_sees_the_object_behind_no_furniture():
    shown = moments(stage().film, "can1")[3]
    body, things = stage().robot(shown.frame), stage().objects(shown.frame)
    moved = [*body, *things.values()]
    camera = close_camera(stage(), body, things["can1"], moved, SIZE)
    solid = [mesh for name, mesh in stage().room.items() if name != WALLS]
    share = hidden([*solid, *body], points_on([things["can1"]]), np.array([camera.eye]))
    assert share[0] < 0.7  # fingers hide a part
    u, v = camera.project(things["can1"].bounds.mean(axis=0)[None], SIZE)[0]
    assert 0 < u < SIZE[0]
    assert 0 < v < SIZE[1]
    assert isinstance(camera, Camera)


def test_a_strip_is_the_same_in_every_run():
    shown = moments(stage().film, "can1")[:2]
    strips = [draw_strip(stage(), shown, "can1", SIZE, "a title") for _ in range(2)]
    np.testing.assert_array_equal(*strips)
    assert strips[0].shape[1] > 2.4 * SIZE[0]
    assert len(np.unique(strips[0].reshape(-1, 3), axis=0)) > 50

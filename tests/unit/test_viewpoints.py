"""Where viewpoints stand, compared with a search through dense points."""

import numpy as np
import pytest

from placing import rigid
from placing.clouds.cloud import sample_cloud
from placing.clouds.raycaster import Raycaster
from placing.dressing import meshes_of
from placing.scene import Furniture, Layout
from placing.viewpoints import Standing, find_viewpoints

STANDING = Standing(eye_m=1.5, free_m=0.3, spacing_m=1.2, n_most=20)
OUTLINE = np.array([[0, 0], [4, 0], [4, 3], [2, 3], [2, 5], [0, 5.0]])
PIECES = (
    ("fridge", (0.7, 0.7, 1.8), (3.4, 0.6)),
    ("table", (0.9, 0.9, 0.75), (1.0, 1.0)),
    ("wall_cabinet", (0.35, 0.8, 0.6), (1.0, 4.7)),
    ("floor_lamp", (0.4, 0.4, 1.6), (0.5, 3.0)),
)


def layout() -> Layout:
    pieces = tuple(
        Furniture(kind, kind, size, rigid.from_yaw(0.0, (*place, 0.0)))
        for kind, size, place in PIECES
    )
    return Layout("l", "office", OUTLINE, 2.4, (), pieces, (), ())


def caster() -> Raycaster:
    return Raycaster(list(meshes_of(layout()).values()))


def test_no_point_is_near_the_vertical_below_a_viewpoint() -> None:
    meshes = list(meshes_of(layout()).values())
    cloud = sample_cloud(np.random.default_rng(1), meshes, 0.02)
    points = cloud.points[cloud.points[:, 2] > 0.1]
    for eye in find_viewpoints(layout(), caster(), STANDING):
        low = np.clip(points[:, 2], 0.3, eye[2])
        gap = np.linalg.norm(
            points - np.column_stack([*np.tile(eye[:2, None], len(low)), low]), axis=1
        )
        assert gap.min() > 0.25
        assert eye[2] == 1.5


def test_viewpoints_are_apart_and_cover_the_room() -> None:
    eyes = find_viewpoints(layout(), caster(), STANDING)
    gap = np.linalg.norm(eyes[:, None] - eyes[None], axis=2)
    assert gap[~np.eye(len(eyes), dtype=bool)].min() > STANDING.spacing_m
    for place in ((0.5, 2.2), (2.2, 0.5), (3.5, 2.5), (1.5, 3.8)):
        assert np.hypot(*(eyes[:, :2] - place).T).min() < STANDING.spacing_m + 0.3


def test_viewpoints_are_never_more_than_asked_and_the_same_every_time() -> None:
    few = find_viewpoints(layout(), caster(), STANDING._replace(n_most=3))
    again = find_viewpoints(layout(), caster(), STANDING)
    assert len(few) == 3
    assert np.array_equal(few, again[:3])


@pytest.mark.parametrize("where", [(3.4, 0.6), (1.0, 1.0), (1.0, 4.7), (3.0, 4.0)])
def test_nobody_stands_in_on_or_under_furniture_or_outside(where: tuple) -> None:
    eyes = find_viewpoints(layout(), caster(), STANDING._replace(spacing_m=0.3))
    assert np.hypot(*(eyes[:, :2] - where).T).min() > 0.3

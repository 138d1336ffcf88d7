"""A short strip of pictures of a robot that places an object: what it does in turn.

The first and the last picture show the whole scene, those between what the robot does,
from where least stands before it.

Shapes: t frames, n objects, r points that are to be seen.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont
from trimesh import Trimesh

from placing import rigid, seeds
from placing.dressing import WALLS, Meshes, meshes_of
from placing.errors import unknown
from placing.object_meshes import object_mesh
from placing.pictures.cameras import Camera, corners_of, framing
from placing.pictures.labels import INK, LINE, PAPER
from placing.pictures.renderer import Picture, hidden, render
from placing.pictures.robot import part_meshes, posed
from placing.pictures.rooms import room_camera, seen_meshes
from placing.robot.film import Film
from placing.robot.model import RobotModel
from placing.robot.posing import link_poses_over
from placing.scene import Layout

Array = NDArray[np.float64]

HEADINGS_DEG = tuple(range(15, 375, 30))
ELEVATIONS_DEG = (28.0, 42.0)
"""From where what the robot does can be seen."""
FOV_DEG, MARGIN = 30.0, 0.03
AROUND_M = 0.35
"""What is seen around the object that is moved,"""
BELOW_M = 0.5
"""and below it: the base says little."""
N_SEEN = 150
"""Points of robot and object that are looked for from each camera."""
OBJECT_WEIGHT = 3.0
"""How much seeing the object counts against seeing the robot."""
WIDER = 1.4
"""Width of pictures of the whole scene over that of the others."""
GAP, TEXT_PX = 10, 24


@dataclass(frozen=True)
class Moment:
    """One picture of a strip."""

    caption: str
    frame: int
    is_whole: bool
    """Whether the whole scene is shown."""


@dataclass(frozen=True)
class Stage:
    """What a film is played in."""

    layout: Layout
    model: RobotModel
    film: Film

    @cached_property
    def room(self) -> Meshes:
        """Walls and furniture by name."""
        return meshes_of(self.layout)

    @cached_property
    def parts(self) -> Meshes:
        """What the robot looks like."""
        return part_meshes(self.model)

    def robot(self, frame: int) -> list[Trimesh]:
        """Return the robot as it stands in a frame."""
        one = np.s_[frame : frame + 1]
        q, opening = self.film.q[one], self.film.opening_m[one]
        poses = link_poses_over(self.model, q, opening)
        return posed(self.parts, {link: T[0] for link, T in poses.items()})

    def objects(self, frame: int) -> Meshes:
        """Return the objects as they are in a frame, by id."""
        items = {item.object_id: item for item in self.layout.objects}
        found = {}
        poses = zip(self.film.objects, self.film.T_world_objects[frame], strict=True)
        for name, T in poses:
            if np.isfinite(T).all():
                item = items[name]
                mesh = object_mesh(item.shape, item.size_m).copy()
                found[name] = mesh.apply_transform(rigid.homogeneous(T))
        return found


def moments(film: Film, object_id: str) -> tuple[Moment, ...]:
    """Return what a strip shows of the way of one object, in order of time."""
    if object_id not in film.objects:
        raise unknown("object of the film", object_id, list(film.objects))
    number = film.objects.index(object_id)
    held = np.flatnonzero(film.held == number)
    phases = np.array(film.phase)
    last, end = int(held[-1]), len(film.time_s) - 1

    def during(name: str, otherwise: int) -> NDArray[np.int64]:
        """Return the frames of a phase, which may be too short to have one."""
        found = np.flatnonzero((film.moving == number) & (phases == f"put {name}"))
        return found if len(found) else np.array([otherwise])

    drive, lower = during("drive", last), during("lower", last)
    retreat = during("retreat", min(last + 1, end))
    found = [Moment("start", 0, True)]
    if np.isfinite(film.T_world_objects[held[0] - 1, number]).all() and held[0] > 0:
        found.append(Moment(f"pick {object_id}", int(held[0]), False))
    return (
        *found,
        Moment("carry", int(drive[len(drive) * 3 // 5]), False),
        Moment("lower", int(lower[0]), False),
        Moment("let go", int(retreat[-1]), False),
        Moment("end", end, True),
    )


def moved_farthest(film: Film) -> str:
    """Return the object whose end is farthest from where it is first seen."""
    away = []
    for poses in np.moveaxis(film.T_world_objects[..., 4:], 1, 0):
        there = poses[np.isfinite(poses[:, 0])]
        away.append(np.linalg.norm(there[-1] - there[0]) if len(there) else 0.0)
    return film.objects[int(np.argmax(away))]


def draw_strip(
    stage: Stage,
    shown: Sequence[Moment],
    object_id: str,
    size: tuple[int, int],
    title: str,
) -> Picture:
    """Return pictures of some moments of a film side by side.

    `size` is of those from near; those of the whole scene are `WIDER`.
    """
    wide = (round(WIDER * size[0]), size[1])
    whole, tiles = room_camera(stage.layout, wide), []
    for moment in shown:
        robot, objects = stage.robot(moment.frame), stage.objects(moment.frame)
        moved = [*robot, *objects.values()]
        camera, shape = whole, wide
        if not moment.is_whole:
            held, shape = objects[object_id], size
            camera = close_camera(stage, robot, held, moved, size)
        room = seen_meshes(stage.layout, camera, stage.room)
        tiles.append(render([*room, *moved], camera, shape))
    starts = [stage.film.time_s[moment.frame] for moment in shown]
    captions = [f"{m.caption}, {t:.0f} s" for m, t in zip(shown, starts, strict=True)]
    return side_by_side(tiles, captions, title)


def close_camera(
    stage: Stage,
    robot: Sequence[Trimesh],
    held: Trimesh,
    moved: Sequence[Trimesh],
    size: tuple[int, int],
) -> Camera:
    """Return the camera that sees robot and object, least hidden by what is there."""
    low = np.min([mesh.bounds[0] for mesh in robot], axis=0)
    high = np.max([mesh.bounds[1] for mesh in robot], axis=0)
    middle = held.bounds.mean(axis=0)
    low, high = np.minimum(low, middle - AROUND_M), np.maximum(high, middle + AROUND_M)
    low[2] = max(middle[2] - BELOW_M, 0.0)
    corners = corners_of(low, high)
    cameras = [
        framing(corners, heading, elevation, size, FOV_DEG, MARGIN)
        for heading in HEADINGS_DEG
        for elevation in ELEVATIONS_DEG
    ]
    # Walls do not count: those towards a camera are left out.
    solid = [mesh for name, mesh in stage.room.items() if name != WALLS]
    eyes = np.array([camera.eye for camera in cameras])
    unseen = OBJECT_WEIGHT * hidden([*solid, *moved], points_on([held]), eyes)
    unseen += hidden([*solid, *moved], points_on(robot), eyes)
    return cameras[int(np.argmin(unseen))]


def points_on(meshes: Sequence[Trimesh]) -> Array:
    """Return corners of meshes drawn at random, the same in every run, shape (r, 3)."""
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    rng = seeds.generator(0, "strip")
    return vertices[rng.integers(len(vertices), size=N_SEEN)]


def side_by_side(
    tiles: Sequence[Picture], captions: Sequence[str], title: str
) -> Picture:
    """Return tiles in a row below a title, with numbered captions below."""
    height = tiles[0].shape[0]
    head, foot = round(2.2 * TEXT_PX), round(1.8 * TEXT_PX)
    lefts = np.cumsum([GAP, *[tile.shape[1] + GAP for tile in tiles]]).tolist()
    image = Image.new("RGB", (lefts[-1], head + height + foot), PAPER)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(TEXT_PX)
    large = ImageFont.load_default(1.2 * TEXT_PX)
    draw.text((GAP, head / 2), title, fill=INK, font=large, anchor="lm")
    for n, (tile, caption) in enumerate(zip(tiles, captions, strict=True)):
        left, width = lefts[n], tile.shape[1]
        image.paste(Image.fromarray(tile), (left, head))
        draw.rectangle((left, head, left + width - 1, head + height - 1), outline=LINE)
        at = (left + width / 2, head + height + foot / 2)
        draw.text(at, f"{n + 1}  {caption}", fill=INK, font=font, anchor="mm")
    return np.asarray(image)

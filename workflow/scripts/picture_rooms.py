"""Draw pictures of rooms and of their labelled arrangements, and sheets of them all."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm
from trimesh import Trimesh

from command import run
from placing.dressing import WALLS, meshes_of, object_meshes
from placing.pictures.cameras import Camera
from placing.pictures.labels import labelled, sheet
from placing.pictures.renderer import Picture, render, write_picture
from placing.pictures.rooms import anchor_of, cut_away, room_camera, seen_furniture
from placing.rooms.reader import layout_reader
from placing.scene import Layout

COLUMNS, TILE = 4, (480, 360)


def main(
    rooms: Path,
    scenes: tuple[str, ...],
    schema: Path,
    catalogue: Path,
    pictures: Path,
    sheet_rooms: Path,
    sheet_arrangements: Path,
    size: tuple[int, int] = (880, 660),
) -> None:
    """Draw pictures of rooms and of their labelled arrangements, and sheets of both.

    Args:
        rooms: Directory of room files.
        scenes: Rooms to draw.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        pictures: Directory whose `rooms` and `arrangements` are written.
        sheet_rooms: PNG to write with all rooms.
        sheet_arrangements: PNG to write with all arrangements.
        size: Width and height of a picture.
    """
    read = layout_reader(rooms, schema, catalogue)
    empty, filled = {}, {}
    for scene in tqdm(scenes, unit="room", disable=None):
        layout = read(scene)
        drawn = pictures_of(layout, size)
        empty[layout.scene] = drawn.pop(layout.scene)
        filled |= drawn
    for folder, tiles in (("rooms", empty), ("arrangements", filled)):
        for name, picture in tiles.items():
            write_picture(picture, pictures / folder / f"{name}.png")
    write_picture(sheet(empty, COLUMNS, TILE), sheet_rooms)
    write_picture(sheet(filled, COLUMNS, TILE), sheet_arrangements)


def pictures_of(layout: Layout, size: tuple[int, int]) -> dict[str, Picture]:
    """Return the labelled pictures of a room and its arrangements, by name."""
    camera, meshes = room_camera(layout, size), meshes_of(layout)
    walls = cut_away(meshes.pop(WALLS), layout.outline_m, np.array(camera.eye))
    furniture = {name: meshes[name] for name in seen_furniture(layout, camera)}
    room = [walls, *furniture.values()]
    pictures = {layout.scene: picture_of(room, furniture, camera, size)}
    for arrangement in layout.arrangements:
        objects = object_meshes(layout, arrangement)
        picture = picture_of([*room, *objects.values()], objects, camera, size)
        pictures[f"{layout.scene}_{arrangement.name}"] = picture
    return pictures


def picture_of(
    meshes: Sequence[Trimesh],
    named: dict[str, Trimesh],
    camera: Camera,
    size: tuple[int, int],
) -> Picture:
    """Return a picture of meshes, some of which have their names beside them."""
    anchors = np.array([anchor_of(mesh) for mesh in named.values()]).reshape(-1, 3)
    points = dict(zip(named, camera.project(anchors, size), strict=True))
    return labelled(render(meshes, camera, size), points)


if __name__ == "__main__":
    run(main)

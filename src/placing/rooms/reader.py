"""The data set `rooms`: rooms and labelled arrangements written by people.

Reads a file of the format that `room.schema.yaml` describes into a `Layout`; what the
schema cannot say is checked before anything is made of it.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from placing import rigid
from placing.errors import BadInput, PlacingError, unknown
from placing.rooms.arrangements import read_arrangements
from placing.rooms.catalogue import read_catalogue
from placing.rooms.checks import (
    check_furniture,
    check_names,
    check_openings,
    check_outline,
)
from placing.rooms.file import read_room_file, read_yaml
from placing.scene import Furniture, Layout, Opening, SceneObject


def layout_reader(
    folder: Path, schema: Path, catalogue: Path
) -> Callable[[str], Layout]:
    """Return the function from the name of a room of `folder` to its layout."""
    known = {path.stem: path for path in folder.glob("*.yaml")}
    objects, rules = read_catalogue(catalogue), read_yaml(schema)

    def read(scene: str) -> Layout:
        if scene not in known:
            raise unknown(f"scene of {folder}", scene, list(known))
        return read_layout(known[scene], objects, rules)

    return read


def read_layout(
    path: Path, catalogue: dict[str, SceneObject], schema: dict[str, Any]
) -> Layout:
    """Return the layout of a room file that matches `schema` and makes sense."""
    content = read_room_file(path, schema)
    try:
        if content["scene"] != path.stem:
            raise BadInput(f"scene is {content['scene']!r}, expected {path.stem!r}")
        layout = read_walls_and_furniture(content, catalogue)
        arrangements = read_arrangements(content["arrangements"], layout)
    except PlacingError as error:
        raise BadInput(f"{path}: {error}") from error
    return replace(layout, arrangements=arrangements)


def read_walls_and_furniture(
    content: dict[str, Any], catalogue: dict[str, SceneObject]
) -> Layout:
    """Return what a room file says without its arrangements, checked."""
    furniture = tuple(read_furniture(entry) for entry in content["furniture"])
    check_names(furniture, content["objects"], catalogue)
    layout = Layout(
        scene=content["scene"],
        kind=content["kind"],
        outline_m=np.array(content["outline_m"], float),
        height_m=float(content["height_m"]),
        openings=tuple(Opening(**entry) for entry in content["openings"]),
        furniture=furniture,
        objects=tuple(catalogue[name] for name in content["objects"]),
        arrangements=(),
    )
    check_outline(layout.outline_m)
    check_openings(layout)
    check_furniture(layout)
    return layout


def read_furniture(entry: dict[str, Any]) -> Furniture:
    """Return one piece of furniture, on the ground unless its position has a z."""
    x, y, z = (*entry["position_m"], 0.0)[:3]
    depth, width, height = entry["size_m"]
    yaw = np.deg2rad(entry["yaw_deg"])
    return Furniture(
        furniture_id=entry["id"],
        kind=entry["kind"],
        size_m=(float(depth), float(width), float(height)),
        T_world_furniture=rigid.from_yaw(yaw, (x, y, z)),
    )

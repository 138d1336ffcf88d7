"""Rooms of professional designers (AI2-THOR) as layouts with one labelled answer."""

from dataclasses import replace

import numpy as np

from placing.errors import unknown
from placing.scene import (
    Arrangement,
    Layout,
)
from placing.thor.data import ThorData, kind_of
from placing.thor.dress import dress
from placing.thor.items import Item, read_item
from placing.thor.objects import hold, name_objects, place, to_object
from placing.thor.types import ThorType
from placing.thor.walls import HEIGHT_M, MARGIN_M, outline_of, windows


def read_layout(data: ThorData, scene: str, types: dict[str, ThorType]) -> Layout:
    """Return walls, furniture, objects and the designers' answer of a scene."""
    if scene not in data.scenes:
        raise unknown("scene", scene, list(data.scenes))
    items = read_items(data, scene, types)
    kept = [item for item in items if fate(item, types) == "kept"]
    pieces = dress(*as_furniture(items, types), hold(kept))
    named = name_objects(kept)
    outline = outline_of(items, kind_of(scene))
    placements = [place(name, item, pieces, named) for name, item in named.items()]
    height = max(HEIGHT_M, *(item.top + MARGIN_M for item in items))
    return Layout(
        scene=scene,
        kind=kind_of(scene),
        outline_m=outline,
        height_m=float(height),
        openings=windows(items, outline),
        furniture=tuple(furniture for _, furniture in pieces),
        objects=tuple(to_object(name, item, types) for name, item in named.items()),
        arrangements=(Arrangement("designer", "as built", tuple(placements)),),
    )


def read_items(data: ThorData, scene: str, types: dict[str, ThorType]) -> list[Item]:
    """Return the things of a scene with the floor at z = 0."""
    items = [read_item(thing, data.asset_size) for thing in data.scenes[scene]]
    for item in items:
        if item.type not in types:
            raise unknown("type of thing", item.type, list(types))
    # SOURCE: the upper side of each floor's box is the level on which things stand;
    # plans without a floor have it at 0.
    level = next((item.top for item in items if item.type == "Floor"), 0.0)
    down = np.array([0.0, 0.0, level])
    return [replace(item, centre=item.centre - down) for item in items]


def fate(item: Item, types: dict[str, ThorType]) -> str:
    """Return `kept` for an object that is placed, else why it is not."""
    if types[item.type].role != "object":
        return types[item.type].role
    parents = {name.split("|")[0] for name in item.below}
    if item.type == "HousePlant" and item.bottom < 0.05:
        return "furniture"
    if "Drawer" in parents:
        return "shut in a drawer"
    if "Cabinet" in parents and item.bottom < 0.8:
        return "shut in a cabinet below a worktop"
    if not parents and item.bottom > 0.05:
        return "hangs or leans"
    return "kept"


def as_furniture(
    items: list[Item], types: dict[str, ThorType]
) -> tuple[list[Item], dict[str, ThorType]]:
    """Return the things to dress; plants on the floor have a type of their own."""
    plant = ThorType("furniture", "plant", "", False)
    dressed = [
        replace(item, type="Plant") if is_floor_plant(item, types) else item
        for item in items
        if types[item.type].role in ("furniture", "part") or is_floor_plant(item, types)
    ]
    return dressed, {**types, "Plant": plant}


def is_floor_plant(item: Item, types: dict[str, ThorType]) -> bool:
    """Return whether a plant is so large that it stands on the floor."""
    return item.type == "HousePlant" and fate(item, types) == "furniture"

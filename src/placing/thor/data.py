"""The rooms of designers as the data file holds them: things with boxes.

SOURCE: `ai2thor-object-metadata.json` of procthor 0.0.1.dev2 lists the objects of 120
rooms of iTHOR and 75 of RoboTHOR in the order of their names. The file names no room;
the order was checked against the rooms that `asset-database.json` beside it gives for
each asset, and agrees in all rooms that are used.
"""

import hashlib
import json
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.errors import BadInput
from placing.thor.items import asset_key, is_straight, to_world, to_yaw, turn_size, xyz

Array = NDArray[np.float64]

FILE = "procthor/databases/ai2thor-object-metadata.json"
SHA256 = "5bb9020b50b0f398e5460519d61347dfe115119dfcc3b136b02d1116bb13416a"
# Rooms of each list of the file: name of the first room, kind.
ITHOR = {
    "kitchens": (1, "kitchen"),
    "living_rooms": (201, "livingroom"),
    "bedrooms": (301, "bedroom"),
}


@dataclass(frozen=True)
class ThorData:
    """Every scene of the file."""

    scenes: dict[str, list[dict[str, Any]]]
    asset_size: dict[str, Array]
    """(3,) depth, width, height [m] of an asset by its key."""


def find_data() -> Path:
    """Return the path of the data file in the installed package."""
    try:
        found = [f for f in files("procthor") or () if str(f) == FILE]
    except PackageNotFoundError:
        found = []
    if not found:
        raise BadInput(f"{FILE}: not installed; expected package procthor 0.0.1.dev2")
    return Path(str(found[0].locate()))


def read_data(path: Path) -> ThorData:
    """Return the scenes of the data file by name."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}; expected the rooms") from None
    found = hashlib.sha256(content).hexdigest()
    if found != SHA256:
        raise BadInput(f"{path}: sha256 is {found}; expected {SHA256}")
    scenes = name_scenes(json.loads(content))
    return ThorData(scenes, measure_assets(scenes))


def name_scenes(groups: dict[str, list]) -> dict[str, list[dict[str, Any]]]:
    """Return the scenes by the names that their order in the file gives."""
    scenes = {}
    for group, (first, _) in ITHOR.items():
        for i, things in enumerate(groups[group]):
            scenes[f"FloorPlan{first + i}"] = things
    plans = [f"Train{i}" for i in range(1, 13)] + [f"Val{i}" for i in range(1, 4)]
    for i, things in enumerate(groups["robothor"]):
        scenes[f"FloorPlan_{plans[i // 5]}_{i % 5 + 1}"] = things
    return scenes


def kind_of(scene: str) -> str:
    """Return kitchen, livingroom, bedroom or apartment."""
    if "_" in scene:
        return "apartment"
    number = int(scene.removeprefix("FloorPlan"))
    return max((first, kind) for first, kind in ITHOR.values() if first <= number)[1]


def measure_assets(scenes: dict[str, list[dict[str, Any]]]) -> dict[str, Array]:
    """Return the depth, width and height of each asset by its key, (3,) [m].

    Upright boxes are exact for things along the axes. An armchair without a name of its
    asset can be turned inside its own frame, which its box and its heading both hide:
    of all that are equally high the smallest box is the nearest to the truth.
    """
    sizes: dict[str, Array] = {}
    for thing in (thing for things in scenes.values() for thing in things):
        key, yaw = asset_key(thing), to_yaw(xyz(thing["rotation"]))
        size = to_world(xyz(thing["axisAlignedBoundingBox"]["size"]))
        size = turn_size(size, yaw, None)
        if thing["assetId"]:
            if is_straight(yaw):
                sizes.setdefault(key, size)
        elif key and np.prod(size[:2]) < np.prod(sizes.get(key, size + 1)[:2]):
            sizes[key] = size
    return sizes

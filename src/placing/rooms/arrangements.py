"""Labelled arrangements of a room file: what carries an object says how high it is.

A file says where an object is seen from above and what it is on. A carrier is a piece
of furniture, the floor or another object, and has one level per height at which it has
supports, counted from below; an object stands on the highest one below its position
unless told otherwise.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from shapely import MultiPoint, Point, Polygon
from shapely.geometry.base import BaseGeometry

from placing import rigid
from placing.dressing import standing_shape
from placing.errors import BadInput, UnknownName, unknown
from placing.rooms.checks import check_listed
from placing.scene import (
    Arrangement,
    Array,
    Furniture,
    Layout,
    Placement,
    SceneObject,
)

REACH_M = 0.001
"""Guards comparisons of lengths that people type in millimetres."""


@dataclass(frozen=True)
class Level:
    """What a carrier offers at one height, in the world."""

    patches_m: tuple[BaseGeometry, ...]
    height_m: float
    clearance_m: float

    def holds(self, at: Point) -> bool:
        """Return whether a point seen from above is on a patch."""
        return any(patch.buffer(REACH_M).covers(at) for patch in self.patches_m)


def levels_of(piece: Furniture) -> tuple[Level, ...]:
    """Return the levels of a piece of furniture from below."""
    try:
        supports = standing_shape(piece).supports
    except UnknownName as error:
        raise BadInput(f"furniture[{piece.furniture_id}].kind: {error}") from error
    heights = sorted({round(support.height_m, 3) for support in supports})
    levels = []
    for height in heights:
        same = [s for s in supports if round(s.height_m, 3) == height]
        patches = tuple(Polygon(s.polygon_m) for s in same)
        top = max(s.height_m for s in same)
        levels.append(Level(patches, top, max(s.clearance_m for s in same)))
    return tuple(levels)


def read_arrangements(
    entries: list[dict[str, Any]], layout: Layout
) -> tuple[Arrangement, ...]:
    """Return the arrangements that the entries of a room file describe."""
    names = [entry["labeller"] for entry in entries]
    if len(set(names)) < len(names):
        raise BadInput(f"arrangements are by {names}, expected labellers that differ")
    floor = Level((Polygon(layout.outline_m),), 0.0, np.inf)
    carriers = {piece.furniture_id: levels_of(piece) for piece in layout.furniture}
    return tuple(
        read_arrangement(entry, layout, {"floor": (floor,), **carriers})
        for entry in entries
    )


def read_arrangement(
    entry: dict[str, Any], layout: Layout, carriers: dict[str, tuple[Level, ...]]
) -> Arrangement:
    """Return one arrangement, carriers placed before what they carry."""
    field, placements = f"arrangements[{entry['labeller']}]", entry["placements"]
    objects = {item.object_id: item for item in layout.objects}
    check_listed(field, placements, list(objects))
    waiting, placed = list(objects), {}
    while waiting:
        ready = [name for name in waiting if placements[name]["on"] not in waiting]
        if not ready:
            raise BadInput(
                f"{field}.placements: {waiting} carry each other in a circle"
            )
        for name in ready:
            label = f"{field}.placements.{name}"
            placed[name] = place(label, placements[name], objects[name], carriers)
            carriers[name] = (top_of(placed[name], objects[name]),)
        waiting = [name for name in waiting if name not in ready]
    found = tuple(placed[name] for name in objects)
    return Arrangement(entry["labeller"], entry["habit"], found)


def place(
    label: str,
    entry: dict[str, Any],
    item: SceneObject,
    carriers: dict[str, tuple[Level, ...]],
) -> Placement:
    """Return the placement of an object at rest on its level."""
    at = Point(entry["position_m"])
    if not carriers["floor"][0].patches_m[0].covers(at):
        raise BadInput(
            f"{label}.position_m is {entry['position_m']}, expected it inside the room"
        )
    level = level_below(label, entry, carriers)
    stance = rigid.STANCES[entry.get("stance", "upright")]
    height = standing_size(item, np.array(stance))[2]
    if height > level.clearance_m + REACH_M:
        raise BadInput(
            f"{label} is {height:.3f} m high, expected at most the "
            f"{level.clearance_m:.3f} m that are free above {entry['on']} there"
        )
    yaw = rigid.yaw_quaternion(np.deg2rad(entry["yaw_deg"]))
    location = np.array([at.x, at.y, level.height_m + height / 2])
    orientation = rigid.multiply(yaw, np.array(stance))
    return Placement(item.object_id, entry["on"], location, orientation)


def level_below(
    label: str, entry: dict[str, Any], carriers: dict[str, tuple[Level, ...]]
) -> Level:
    """Return the level that an entry names, else the highest below its position."""
    carrier, at = entry["on"], Point(entry["position_m"])
    if carrier not in carriers:
        raise BadInput(f"{label}.on: {unknown('carrier', carrier, list(carriers))}")
    levels = carriers[carrier]
    number = entry.get("level")
    if number is not None and number > len(levels):
        raise BadInput(
            f"{label}.level is {number}, expected one of the {len(levels)} levels "
            f"of {carrier}"
        )
    asked = levels if number is None else levels[number - 1 : number]
    below = [level for level in asked if level.holds(at)]
    if not below:
        where = f" at level {number}" if number else ""
        raise BadInput(
            f"{label}.position_m is {entry['position_m']}, "
            f"expected it above what {carrier} offers{where}"
        )
    return below[-1]


def standing_size(item: SceneObject, orientation: Array) -> Array:
    """Return the box of an object turned by a stance, shape (3,) [m]."""
    return np.abs(rigid.matrix(orientation)) @ np.array(item.size_m)


def top_of(placement: Placement, item: SceneObject) -> Level:
    """Return the top of a placed object as a level that carries others."""
    half_height = np.abs(rigid.matrix(placement.orientation)[2]) @ item.size_m / 2
    corners = np.array(list(np.ndindex(2, 2, 2))) - 0.5
    outline = rigid.apply(placement.T_world_object, corners * item.size_m)[:, :2]
    patch = MultiPoint(outline).convex_hull
    return Level((patch,), placement.location[2] + half_height, np.inf)

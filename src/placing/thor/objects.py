"""Objects of a designer's room, and where its designers put them."""

from collections.abc import Iterable

import numpy as np

from placing.rigid import from_yaw, wrap, yaw_of
from placing.scene import Placement, SceneObject
from placing.thor.dress import Piece
from placing.thor.items import Item
from placing.thor.types import ThorType

# ASSUME: an object may reach this far over the edge of what it stands on.
MARGIN_M = 0.05
MOVABLE = frozenset(
    [
        "book",
        "clean_tool",
        "mouse",
        "pen",
        "dishware",
        "pan",
        "cushion",
        "utensil",
        "food",
        "shoe",
        "remote",
    ]
)
"""Categories that the robot can carry (Table 1 of the paper)."""


def hold(kept: list[Item]) -> dict[str, list[Item]]:
    """Return the objects on or in each thing; those on another object are not on it."""
    held: dict[str, list[Item]] = {}
    for item in kept:
        if carrier(item, kept) is None:
            for name in item.below:
                held.setdefault(name, []).append(item)
    return held


def carrier(item: Item, kept: Iterable[Item]) -> Item | None:
    """Return the object on which an object stands, if it does."""
    for other in kept:
        # The source names plates and pots as carriers, but no pile of books.
        is_pile = abs(other.top - item.bottom) < 0.01 and other.covers(item)
        if other.name in item.below or (is_pile and other is not item):
            return other
    return None


def name_objects(kept: list[Item]) -> dict[str, Item]:
    """Return the objects by an id of their type and number."""
    counts: dict[str, int] = {}
    named = {}
    for item in sorted(kept, key=lambda item: (item.type, item.name)):
        counts[item.type] = counts.get(item.type, 0) + 1
        named[f"{item.type.lower()}{counts[item.type]}"] = item
    return named


def to_object(name: str, item: Item, types: dict[str, ThorType]) -> SceneObject:
    """Return the object whatever its pose."""
    kind = types[item.type]
    depth, width, height = (float(max(size, 0.002)) for size in item.size)
    return SceneObject(
        object_id=name,
        category=kind.category,
        shape=kind.shape,
        size_m=(depth, width, height),
        mass_kg=item.mass_kg if item.mass_kg > 0 else 1.0,
        has_front=kind.has_front,
        is_movable=kind.category in MOVABLE,
    )


def place(
    name: str, item: Item, pieces: list[Piece], named: dict[str, Item]
) -> Placement:
    """Return where the designers put an object."""
    pose = from_yaw(float(wrap(np.array(item.yaw))), tuple(item.centre))
    return Placement(name, below(item, pieces, named), pose[4:], pose[:4])


def below(item: Item, pieces: list[Piece], named: dict[str, Item]) -> str:
    """Return the id of the object or furniture on which an object rests."""
    on = carrier(item, named.values())
    if on is not None:
        return next(name for name, other in named.items() if other is on)
    poses = np.array([f.T_world_furniture for _, f in pieces]).reshape(-1, 7)
    sizes = np.array([f.size_m for _, f in pieces]).reshape(-1, 3)
    yaw, aside = yaw_of(poses[:, :4]), item.centre[:2] - poses[:, 4:6]
    c, s = np.cos(yaw), np.sin(yaw)
    along, across = aside.T
    local = np.stack([c * along + s * across, c * across - s * along], axis=1)
    is_above = np.all(np.abs(local) <= sizes[:, :2] / 2 + MARGIN_M, axis=1)
    gaps = np.abs(poses[:, 6] + sizes[:, 2] - item.bottom).round(3)
    best = [(abs(item.bottom), False, "floor")]
    for i in np.flatnonzero(is_above):
        owner, furniture = pieces[i]
        best.append((gaps[i], owner not in item.below, furniture.furniture_id))
    return min(best)[2]

"""Furniture for a designer's room: shapes whose boards are where its objects rest."""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from placing.rigid import from_yaw
from placing.scene import Furniture
from placing.thor.counters import DEPTHS_M, WIDEST_M, counter_strips
from placing.thor.items import Item
from placing.thor.pieces import (
    BOARD_M,
    Built,
    board_of,
    boards,
    case,
    group_heights,
    local_box,
    whole_box,
)
from placing.thor.seats import SEAT_KINDS, seat
from placing.thor.strips import Strip, area_of, side_strips
from placing.thor.types import ThorType

Array = NDArray[np.float64]

DESK_M, THIN_M = 0.76, 0.1
OPEN_KINDS = ("desk", "table")
"""Kinds on legs, where a board fits below the top."""
STORAGE_KINDS = ("dresser", "tv_stand", "bookcase", "fridge", "cabinet")
"""Closed kinds, which become an open case where something stands inside."""

Piece = tuple[str, Furniture]
"""Name of the thing that a piece dresses, and the piece."""


def dress(
    items: list[Item], types: dict[str, ThorType], held: dict[str, list[Item]]
) -> list[Piece]:
    """Return the furniture of a scene; `held` are the objects on and in each thing."""
    middle = np.mean([item.centre[:2] for item in items], axis=0)
    strips = counter_strips(items, held, middle)
    hosts = [i for i in items if types[i.type].shape in OPEN_KINDS + STORAGE_KINDS]
    hosts = [host for host in hosts if types[host.type].role == "furniture"]
    inner = {host.name: list[Item]() for host in hosts}
    shapes: list[tuple[str, str, list[Built]]] = []
    for item in items:
        if item.type == "Shelf":
            host = next((h for h in hosts if is_inside(item, h)), None)
            if host is None:
                shapes.append((item.name, "shelf", [board_of(item, held)]))
            else:
                inner[host.name].append(item)
        elif item.type == "Cabinet" and not any(is_inside(item, h) for h in hosts):
            shapes.append((item.name, "cabinet", cabinet(item, held, strips)))
    for item in items:
        kind = types[item.type].shape
        if kind in SEAT_KINDS:
            built = seat(item, kind, held.get(item.name, []))
            shapes.append((item.name, item.type.lower(), built))
        elif types[item.type].role == "furniture":
            levels = levels_of(item, inner.get(item.name, []), held)
            on = [thing.centre[:2] for thing in held.get(item.name, [])]
            built = dress_one(item, kind, levels, np.array(on).reshape(-1, 2))
            shapes.append((item.name, item.type.lower(), built))
    shapes += [(name, strip.kind, [from_strip(strip)]) for name, strip in strips]
    return [*numbered(shapes)]


def numbered(shapes: Iterable[tuple[str, str, list[Built]]]) -> Iterator[Piece]:
    """Yield the pieces with ids that number what they dress within the scene."""
    counts: dict[str, int] = {}
    for owner, word, pieces in shapes:
        counts[word] = counts.get(word, 0) + bool(pieces)
        for i, (kind, size, pose) in enumerate(pieces):
            part = f"_part{i + 1}" if len(pieces) > 1 else ""
            name = f"{word}{counts[word]}{part}"
            yield owner, Furniture(name, kind, size, pose)


def is_inside(part: Item, host: Item) -> bool:
    """Return whether the middle of `part` is in the box of `host`."""
    return host.bottom - 0.05 < part.centre[2] < host.top + 0.05 and host.covers(part)


def levels_of(
    item: Item, shelves: list[Item], held: dict[str, list[Item]]
) -> list[float]:
    """Return the heights on which objects rest, and those of empty shelves [m]."""
    things = [thing for i in [item, *shelves] for thing in held.get(i.name, [])]
    # What is lower stands on the floor below.
    levels = group_heights([thing.bottom for thing in things if thing.bottom > 0.05])
    for shelf in shelves:
        # A board needs room below the next one; shelves reach down to their board.
        if all(abs(shelf.bottom - level) > 0.06 for level in levels):
            levels.append(shelf.bottom)
    return sorted(levels)


def dress_one(item: Item, kind: str, levels: list[float], points: Array) -> list[Built]:
    """Return the shapes of one thing as (kind, size, pose)."""
    top = top_of(item, kind, levels)
    inner = [level for level in levels if abs(level - top) > 0.03]
    if kind in OPEN_KINDS:
        return [*table_top(item, kind, top, points), *boards(item, inner)]
    if kind in STORAGE_KINDS and (inner or kind == "bookcase"):
        return case(item, [item.bottom + 0.03, *inner], top)
    return [whole_box(item, kind, top, item.yaw)]


def table_top(item: Item, kind: str, top: float, points: Array) -> list[Built]:
    """Return a table or desk up to its top; a wide desk is an L round its sitter."""
    if top - item.bottom < THIN_M:
        size = item.size[:2]
        return [local_box(item, "box", (0, 0), size, top - BOARD_M, top)]
    whole = local_box(item, kind, (0, 0), item.size[:2], item.bottom, top)
    if kind != "desk" or min(item.size[:2]) < WIDEST_M:
        return [whole]
    half = item.size[:2] / 2
    box = Strip(-half, half, 0.0, top, kind)
    corners = [side_strips(box, (0, side), d) for d in DEPTHS_M for side in (1, 3)]
    on = item.local(points)
    fits = [
        strips
        for strips in corners
        if np.any([strip.holds(on, 0.0) for strip in strips], axis=0).all()
    ]
    if not fits:
        return [whole]
    return [
        local_box(item, "table", (s.low + s.high) / 2, s.high - s.low, 0, top)
        for s in min(fits, key=area_of)
    ]


def top_of(item: Item, kind: str, levels: list[float]) -> float:
    """Return the height of the top on which objects rest, above all drawers [m]."""
    if any(abs(level - item.top) < 0.03 for level in levels):
        return max(level for level in levels if abs(level - item.top) < 0.03)
    if kind == "desk" and item.top > 1.0:
        # ASSUME: a desk above 1 m carries shelves; its top is at the usual height.
        return min(
            [level for level in levels if 0.5 < level < 1.1],
            key=lambda level: abs(level - DESK_M),
            default=DESK_M,
        )
    if kind in OPEN_KINDS and levels and levels[-1] > 0.6 * item.top:
        return levels[-1]
    return item.top


def cabinet(
    item: Item, held: dict[str, list[Item]], strips: list[tuple[str, Strip]]
) -> list[Built]:
    """Return a cabinet: nothing below a worktop, open where it holds something."""
    below = [s for _, s in strips if s.holds(item.centre[None, :2], 0.05)[0]]
    if any(item.bottom < strip.height for strip in below):
        return []
    levels = group_heights([i.bottom for i in held.get(item.name, [])])
    if levels:
        return case(item, levels, item.top)
    return [whole_box(item, "cabinet", item.top, item.yaw)]


def from_strip(strip: Strip) -> Built:
    """Return the shape that fills a strip from the floor to its height."""
    extent = strip.high - strip.low
    depth, width = extent if abs(np.cos(strip.yaw)) > 0.5 else extent[::-1]
    kind = "box" if min(depth, width) < 0.3 else strip.kind
    pose = from_yaw(strip.yaw, (*(strip.low + strip.high) / 2, 0.0))
    return kind, (float(depth), float(width), float(strip.height)), pose

"""Shapes put into the box of a thing: whole, in part, as boards, as an open case."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from placing.rigid import from_yaw
from placing.thor.items import Item

Array = NDArray[np.float64]
Built = tuple[str, tuple[float, float, float], Array]
"""Kind, size [m] and pose (7,) of a shape."""

BOARD_M = 0.02
# The free space above a board may be told narrower than the board.
NARROWEST_M = 0.12
# Things within this height of each other stand on one board.
LEVEL_M = 0.025


def group_heights(heights: list[float]) -> list[float]:
    """Return the lowest height of each group that one board carries [m]."""
    levels: list[float] = []
    for height in sorted(heights):
        if not levels or height > levels[-1] + LEVEL_M:
            levels.append(height)
    return levels


def whole_box(item: Item, kind: str, top: float, yaw: float) -> Built:
    """Return one shape that fills the box of a thing up to `top`."""
    bottom = 0.0 if item.bottom < 0.12 else item.bottom
    size = (float(item.size[0]), float(item.size[1]), float(top - bottom))
    return kind, size, from_yaw(yaw, (*item.centre[:2], bottom))


def local_box(
    item: Item,
    kind: str,
    at: Iterable[float],
    size_xy: Iterable[float],
    low: float,
    high: float,
) -> Built:
    """Return a shape at a point of the frame of `item`, between two heights."""
    low = 0.0 if low < 0.12 and kind != "box" else low
    c, s = np.cos(item.yaw), np.sin(item.yaw)
    xy = item.centre[:2] + np.array([[c, -s], [s, c]]) @ np.array([*at], float)
    depth, width = map(float, size_xy)
    return kind, (depth, width, float(high - low)), from_yaw(item.yaw, (*xy, low))


def boards(item: Item, levels: list[float]) -> list[Built]:
    """Return boards of the footprint of `item` below the levels."""
    return [
        local_box(item, "box", (0, 0), item.size[:2] - BOARD_M, level - BOARD_M, level)
        for level in levels
    ]


def case(item: Item, levels: list[float], top: float) -> list[Built]:
    """Return an open case: back, two sides, a board below each level, and a top."""
    depth, width = item.size[:2]
    low, t = max(item.bottom, 0.0), BOARD_M
    side = (width - t) / 2
    return [
        local_box(item, "box", ((t - depth) / 2, 0), (t, width), low, top),
        local_box(item, "box", (t / 2, side), (depth - t, t), low, top),
        local_box(item, "box", (t / 2, -side), (depth - t, t), low, top),
        *boards(item, [*group_heights(levels), top]),
    ]


def board_of(shelf: Item, held: dict[str, list[Item]]) -> Built:
    """Return the board at the lower side of a shelf's box.

    ASSUME: the board reaches as far as the objects on it, which the box, the free space
    above the board, does not always do.
    """
    rests = held.get(shelf.name, [])
    empty = max(shelf.bottom, BOARD_M)
    level = min(
        [item.bottom for item in rests],
        key=lambda bottom: abs(bottom - shelf.bottom),
        default=empty,
    )
    points = [shelf.local(item.centre[:2])[0] for item in rests]
    half = np.maximum(shelf.size[:2] / 2, NARROWEST_M / 2)
    low = np.min([-half, *(point - 0.03 for point in points)], axis=0)
    high = np.max([half, *(point + 0.03 for point in points)], axis=0)
    at = tuple((low + high) / 2)
    return local_box(shelf, "box", at, high - low, level - BOARD_M, level)

"""Rectangles of the floor plan, from which counters and wide desks are put together."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Sides of a box: -x, -y, +x, +y; a strip along a side faces the middle of the box.
YAWS = (0.0, np.pi / 2, np.pi, -np.pi / 2)


@dataclass(frozen=True)
class Strip:
    """A rectangle of the floor plan that a box of some height fills."""

    low: Array
    """(2,) [m]."""
    high: Array
    """(2,) [m]."""
    yaw: float
    height: float
    kind: str

    def holds(self, points: Array, margin_m: float = 0.02) -> NDArray[np.bool_]:
        """Return which points lie in the rectangle, shape (n,)."""
        is_in = (points >= self.low - margin_m) & (points <= self.high + margin_m)
        return np.all(is_in, axis=1).reshape(-1)

    def overlaps(self, other: "Strip") -> bool:
        """Return whether both rectangles have more than an edge in common."""
        return bool(
            (
                np.minimum(self.high, other.high) - np.maximum(self.low, other.low)
                > 0.005
            ).all()
        )


def side_strips(box: Strip, sides: tuple[int, ...], depth: float) -> list[Strip]:
    """Return disjoint strips along some sides of a box."""
    strips: list[Strip] = []
    for side in sides:
        axis, low, high = side % 2, box.low.copy(), box.high.copy()
        if side < 2:
            high[axis] = min(high[axis], low[axis] + depth)
        else:
            low[axis] = max(low[axis], high[axis] - depth)
        strip = replace(box, low=low, high=high, yaw=YAWS[side])
        strips += subtract_all(strip, strips)
    return strips


def area_of(strips: Iterable[Strip]) -> float:
    """Return the area of disjoint strips [m2]."""
    return float(sum(np.prod(strip.high - strip.low) for strip in strips))


def subtract_all(strip: Strip, holes: Iterable[Strip]) -> list[Strip]:
    """Return rectangles that fill the strip without the holes."""
    pieces = [strip]
    for hole in holes:
        pieces = [rest for piece in pieces for rest in subtract(piece, hole)]
    return pieces


def subtract(strip: Strip, hole: Strip) -> list[Strip]:
    """Return up to four rectangles that fill the strip without the hole."""
    if not strip.overlaps(hole):
        return [strip]
    rest, low, high = [], strip.low.copy(), strip.high.copy()
    # Cut first along the strip, so that the pieces beside the hole stay deep.
    along = 1 if abs(np.cos(strip.yaw)) > 0.5 else 0
    for axis in (along, 1 - along):
        if hole.low[axis] > low[axis]:
            end = high.copy()
            end[axis] = hole.low[axis]
            rest.append(replace(strip, low=low.copy(), high=end))
            low[axis] = hole.low[axis]
        if hole.high[axis] < high[axis]:
            start = low.copy()
            start[axis] = hole.high[axis]
            rest.append(replace(strip, low=start, high=high.copy()))
            high[axis] = hole.high[axis]
    return [piece for piece in rest if min(piece.high - piece.low) > 0.01]

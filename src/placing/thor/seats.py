"""Seats and beds whose soft part is as high as designers' objects lie on it.

ASSUME: a seat with objects on it is built of boxes: the seat, a back and two arms that
leave the objects free. Seats that hold nothing keep the shape of their kind.
"""

import numpy as np

from placing.thor.items import Item
from placing.thor.pieces import Built, local_box, whole_box

BACK_M, ARM_M = 0.2, 0.18
SEAT_KINDS = ("chair", "armchair", "couch", "bed")
# SOURCE: no seat of the file is higher than 0.62 of its chair; what is higher lies on
# the table above it.
HIGHEST_SEAT = 0.65


def seat(item: Item, kind: str, held: list[Item]) -> list[Built]:
    """Return the shapes of a seat or a bed with the objects that lie on it."""
    # The source's beds have their head in front, the shapes have it behind.
    yaw = item.yaw + np.pi if kind == "bed" else item.yaw
    rests = [
        thing
        for thing in held
        if thing.bottom > 0.1
        and (kind == "bed" or thing.bottom < HIGHEST_SEAT * item.top)
        and item.covers(thing, 0.05)
    ]
    if not rests:
        return [whole_box(item, kind, item.top, yaw)]
    level = min(thing.bottom for thing in rests)
    is_high = kind == "chair" or level > 1.2
    lap = local_box(
        item, "table" if is_high else "box", (0, 0), item.size[:2], 0, level
    )
    built = [lap]
    sign = -1.0 if kind == "bed" else 1.0
    points = np.array([item.local(thing.centre[:2])[0] for thing in rests])
    thickest = {"chair": 0.03, "bed": 0.06}.get(kind, BACK_M)
    if item.top > level + 0.08:
        built.append(
            back(item, level, sign, free(points[:, 0] * sign, 0, item, thickest))
        )
    if kind in ("armchair", "couch"):
        built += arms(item, level, free(-np.abs(points[:, 1]), 1, item, ARM_M))
    return built


def free(along: np.ndarray, axis: int, item: Item, thickest: float) -> float:
    """Return how thick a part behind all objects can be [m]."""
    room = float(along.min() + item.size[axis] / 2) - 0.05
    return float(np.clip(room, 0.02, thickest))


def back(item: Item, level: float, sign: float, thickness: float) -> Built:
    """Return the back of a seat, or the head of a bed."""
    at = sign * (thickness - item.size[0]) / 2
    size = (thickness, item.size[1])
    return local_box(item, "box", (at, 0), size, level, item.top)


def arms(item: Item, level: float, thickness: float) -> list[Built]:
    """Return the two arms of a seat, half as high above it as its back."""
    top = level + 0.4 * (item.top - level)
    at, size = (item.size[1] - thickness) / 2, (item.size[0], thickness)
    return [local_box(item, "box", (0, y), size, level, top) for y in (-at, at)]

"""Walls round a designer's room, which its source does not hold.

ASSUME: the outline is the smallest rectangle round everything in a room; a RoboTHOR
apartment is the rectangle of its outer walls, as its paintings give it, without the
partitions between. Windows become openings where they lie on that outline; doors are
not in the file.
"""

import numpy as np
from numpy.typing import NDArray

from placing.scene import Opening
from placing.thor.items import Item

Array = NDArray[np.float64]

# SOURCE: where the paintings on outer walls of all RoboTHOR plans hang.
APARTMENT_M = ((1.0, -4.91), (9.8, -1.0))
MARGIN_M = 0.05
HEIGHT_M = 2.6


def outline_of(items: list[Item], kind: str) -> Array:
    """Return the corners of the floor counter-clockwise, shape (4, 2) [m]."""
    if kind == "apartment":
        (x0, y0), (x1, y1) = APARTMENT_M
    else:
        # The floor reaches below the walls and beyond them; windows lie outside.
        inside = [i for i in items if i.type not in ("Floor", "Window", "Curtains")]
        lows = [item.centre[:2] - item.half_extent for item in inside]
        highs = [item.centre[:2] + item.half_extent for item in inside]
        x0, y0 = np.min(lows, axis=0) - MARGIN_M
        x1, y1 = np.max(highs, axis=0) + MARGIN_M
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def windows(items: list[Item], outline: Array) -> tuple[Opening, ...]:
    """Return the windows that lie within half a metre of a wall as openings."""
    found = [window(i, outline) for i in items if i.type == "Window"]
    openings: list[Opening] = []
    for opening in sorted(
        (opening for opening in found if opening is not None),
        key=lambda opening: (opening.wall, opening.offset_m),
    ):
        last = openings[-1] if openings else None
        # Panes of one window overlap; two openings in one place would be no wall.
        if (
            last is None
            or last.wall != opening.wall
            or (opening.offset_m > last.offset_m + last.width_m + MARGIN_M)
        ):
            openings.append(opening)
    return tuple(openings)


def window(item: Item, outline: Array) -> Opening | None:
    """Return the opening of a window, or None where no wall is near."""
    half, (low, high) = item.half_extent, (outline[0], outline[2])
    x, y = item.centre[:2]
    gaps = np.abs([y - low[1], high[0] - x, high[1] - y, x - low[0]])
    wall = int(np.argmin(gaps))
    along = wall % 2
    if gaps[wall] > 0.5 or half[along] < 0.15:
        return None
    length = (high - low)[along]
    start = item.centre[along] - half[along] - low[along]
    start, end = np.clip([start, start + 2 * half[along]], 0.1, length - 0.1)
    sill = max(item.bottom, 0.3)
    top = min(item.top, HEIGHT_M - 0.1)
    if end - start < 0.2 or top - sill < 0.2:
        return None
    offset = start if wall < 2 else length - end
    return Opening("window", wall, *map(float, (offset, end - start, sill, top - sill)))

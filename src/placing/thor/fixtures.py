"""Stoves and sinks of a kitchen: what cuts a hole into its worktops."""

import numpy as np
from numpy.typing import NDArray

from placing.thor.items import Item
from placing.thor.strips import YAWS, Strip

Array = NDArray[np.float64]


def stove_strips(
    items: list[Item], held: dict[str, list[Item]], middle: Array
) -> list[tuple[str, Strip]]:
    """Return one stove for all burners that are close to each other."""
    groups: list[list[Item]] = []
    for burner in (item for item in items if item.type == "StoveBurner"):
        near = [
            group
            for group in groups
            if any(np.abs(burner.centre - other.centre).max() < 0.6 for other in group)
        ]
        groups = [group for group in groups if group not in near]
        groups.append([burner, *(item for group in near for item in group)])
    return [(group[0].name, stove_of(group, held, middle)) for group in groups if group]


def stove_of(burners: list[Item], held: dict[str, list[Item]], middle: Array) -> Strip:
    """Return the stove below some burners, as high as what rests on them."""
    low = np.min([b.centre[:2] - b.half_extent for b in burners], axis=0) - 0.05
    high = np.max([b.centre[:2] + b.half_extent for b in burners], axis=0) + 0.05
    rests = [item.bottom for b in burners for item in held.get(b.name, [])]
    height = min(rests) if rests else max(b.top for b in burners)
    centre = (low + high) / 2
    # The nearest wall is behind the stove: the side that is farthest off the middle.
    side = int(np.argmax(np.abs(centre - middle)))
    yaw = YAWS[side if centre[side] < middle[side] else side + 2]
    return Strip(low, high, yaw, height, "stove")


def sink_strips(
    items: list[Item], held: dict[str, list[Item]]
) -> list[tuple[str, Strip]]:
    """Return the bottom of each basin as a low box in a hole of the worktop."""
    strips = []
    for sink in (item for item in items if item.type == "Sink"):
        for basin in items:
            if basin.type != "SinkBasin" or not sink.covers(basin, 0.05):
                continue
            rests = [
                item
                for item in held.get(basin.name, [])
                if item.bottom < sink.top - 0.05 and basin.covers(item, 0.1)
            ]
            height = min([item.bottom for item in rests], default=basin.bottom)
            corners = [item.centre[:2] for item in rests]
            low = np.min([basin.centre[:2] - basin.half_extent, *corners], axis=0)
            high = np.max([basin.centre[:2] + basin.half_extent, *corners], axis=0)
            strips.append((sink.name, Strip(low, high, 0.0, height, "box")))
    return strips


def sink_rims(
    items: list[Item], held: dict[str, list[Item]], middle: Array
) -> list[tuple[str, Strip]]:
    """Return the rim of each sink, which is its own worktop where none is around it."""
    rims = []
    for sink in (item for item in items if item.type == "Sink"):
        near = [i.bottom for i in held.get(sink.name, []) if i.bottom > sink.top - 0.05]
        height = min(near, default=sink.top)
        rims.append((sink.name, rectangle_of(sink, height, middle, "counter")))
    return rims


def rectangle_of(item: Item, height: float, middle: Array, kind: str) -> Strip:
    """Return the strip below a box, whose front faces the middle of the room."""
    half, centre = item.half_extent, item.centre[:2]
    across = int(half[1] < half[0])
    is_low = centre[across] < middle[across]
    yaw = YAWS[across if is_low else across + 2]
    return Strip(centre - half, centre + half, yaw, height, kind)

"""Kitchen counters: the source gives one upright box for a worktop of any outline."""

from itertools import product

import numpy as np
from numpy.typing import NDArray

from placing.thor.fixtures import rectangle_of, sink_rims, sink_strips, stove_strips
from placing.thor.items import Item
from placing.thor.strips import Strip, area_of, side_strips, subtract_all

Array = NDArray[np.float64]

# ASSUME: a worktop wider than this on both sides is an L, a U or a ring of strips.
WIDEST_M = 1.25
DEPTHS_M = (0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9)
OUTLINES = [
    tuple(i for i in range(4) if is_used[i])
    for is_used in product((False, True), repeat=4)
    if any(is_used[i] and is_used[(i + 1) % 4] for i in range(4))
]
"""Sides that connected outlines use: four Ls, four Us and the ring."""
# SOURCE: the median of the 428 objects on worktops rests 18 mm below their box.
SUNK_M = 0.018


def counter_strips(
    items: list[Item], held: dict[str, list[Item]], middle: Array
) -> list[tuple[str, Strip]]:
    """Return the name of the thing behind each strip, and the strip."""
    tops = [
        (item.name, strip)
        for item in items
        if item.type == "CounterTop"
        for strip in worktop_strips(item, items, held.get(item.name, []), middle)
    ]
    stoves = stove_strips(items, held, middle)
    sinks = sink_strips(items, held)
    for name, rim in sink_rims(items, held, middle):
        if not any(strip.overlaps(rim) for _, strip in tops):
            tops.append((name, rim))
    holes = stoves + sinks
    rest = [
        (name, piece)
        for name, strip in tops
        for piece in subtract_all(strip, [hole for _, hole in holes])
    ]
    return rest + holes


def worktop_strips(
    top: Item, items: list[Item], held: list[Item], middle: Array
) -> list[Strip]:
    """Return the outline that best fits what tells where the worktop is.

    ASSUME: objects on the worktop, cabinets and drawers below, sinks and burners lie on
    it; a box that is too wide for one strip is the smallest L, U or ring that reaches
    all sides of the box and holds them.
    """
    height = worktop_height(top, held)
    box = rectangle_of(top, height, middle, "counter")
    if min(box.high - box.low) <= WIDEST_M:
        return [box]
    others = [i for i in items if i.type == "CounterTop" and area(i) < area(top)]
    told = [
        item
        for item in items
        if item.type in ("Cabinet", "Drawer", "Sink", "StoveBurner")
        and item.bottom < height
        and top.covers(item)
        and not any(other.covers(item) for other in others)
    ]
    places = np.array([item.centre[:2] for item in told]).reshape(-1, 2)
    # Appliances stand on worktops as objects do.
    on = [*held, *(item for item in items if top.name in item.below)]
    objects = np.array([item.centre[:2] for item in on]).reshape(-1, 2)
    outlines = [side_strips(box, s, depth) for depth, s in product(DEPTHS_M, OUTLINES)]
    return min(
        [*outlines, [box]],
        key=lambda strips: misfit(strips, objects, places),
    )


def misfit(strips: list[Strip], objects: Array, places: Array) -> float:
    """Return the area of an outline plus what it leaves out [m2].

    An object left out would lose its support, so it weighs more than any worktop.
    """
    n_objects, n_places = (
        np.sum(~np.any([strip.holds(points) for strip in strips], axis=0))
        for points in (objects, places)
    )
    return area_of(strips) + 100 * n_objects + 0.6 * n_places


def area(item: Item) -> float:
    """Return the area of the footprint of a thing [m2]."""
    return float(item.size[0] * item.size[1])


def worktop_height(top: Item, held: list[Item]) -> float:
    """Return the height on which most things rest [m]."""
    bottoms = [item.bottom for item in held]
    near = [b for b in bottoms if abs(b - top.top + SUNK_M) < 0.03]
    return min(near) if near else top.top - SUNK_M

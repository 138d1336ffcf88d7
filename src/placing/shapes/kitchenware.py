"""Shapes of what lies and stands beside the stove."""

from itertools import pairwise

import numpy as np

from placing.shapes.solids import (
    Points,
    Solid,
    arc,
    ball,
    box,
    cylinder,
    extruded,
    hull,
    profiled,
    slab,
    tube,
    union,
)

WOOD = "#b98552"
BLACK = "#2b2d31"
STEEL = "#c3c8cc"


def knife_block(d: float, w: float, h: float) -> Solid:
    """Return a leaning wooden block with the handles of five knives in it."""
    low, high = (0.22, 0.42), (-0.28, 0.80)  # the slope that the knives stand in
    side = [(-0.5, 0), (0.14, 0), low, high, (-0.5, 0.5)]
    body = profiled([(x * d, z * h) for x, z in side], w, WOOD)
    tilt = np.degrees(np.arctan2(0.38 * h, 0.5 * d))
    slots = [(0.78, -0.28), (0.78, 0.0), (0.78, 0.28), (0.32, -0.2), (0.32, 0.2)]
    knives = [
        _knife((0.16 + 0.2 * s) * h)
        .turned(y=tilt)
        .at((0.22 - 0.5 * s) * d, y * w, (0.42 + 0.38 * s) * h)
        for s, y in slots
    ]
    return union([body, *knives])


def _knife(length: float) -> Solid:
    """Return what shows of a knife in its block: bolster and riveted handle."""
    bolster = box(0.020, 0.012, 0.25 * length, STEEL).at(z=-0.1 * length)
    grip = slab(0.026, 0.016, 0.85 * length, 0.006, BLACK).at(z=0.12 * length)
    rivets = [
        cylinder(0.003, 0.018, "#d9dde0", n=10).turned(x=90).at(y=0.009, z=k * length)
        for k in (0.3, 0.55, 0.8)
    ]
    return union([bolster, grip, *rivets])


def spatula(d: float, w: float, h: float) -> Solid:
    """Return a slotted spatula that lies on its blade and on the end of its handle."""
    length = 0.32 * d
    blade = slab(length, w, 0.12 * h, 0.012, BLACK)
    slots = [
        slab(0.62 * length, 0.07 * w, 1.0, 0.002, BLACK).at(y=k * w, z=-0.5)
        for k in (-0.25, 0, 0.25)
    ]
    blade = (blade - union(slots)).at(x=length / 2 - d / 2)
    r = 0.16 * h
    path = [(-0.2 * d, 0, r), (-0.14 * d, 0, 0.7 * h), (0.05 * d, 0, h - r)]
    path += [(0.2 * d, 0, 0.75 * h), (0.4 * d, 0, 0.42 * h)]
    stem = tube(path, r, STEEL, 12)
    grip = hull(
        [
            slab(0.02, 0.22 * w, 0.5 * h, 0.005, "#c8553d").at(x=0.17 * d, z=0.45 * h),
            slab(0.03, 0.3 * w, 0.5 * h, 0.01, "#c8553d").at(x=0.5 * d - 0.015),
        ],
        "#c8553d",
    )
    return union([blade, stem, grip])


def ladle(d: float, w: float, h: float) -> Solid:
    """Return a soup ladle that lies on its bowl and on the end of its handle."""
    r, depth = w / 2, 0.75 * h
    bowl = ball(1, STEEL, 32).scaled(r, r, depth) - box(3 * w, 3 * w, h, STEEL).at(
        z=depth
    )
    inside = ball(1, "#a9afb4", 32).scaled(r - 0.003, r - 0.003, depth - 0.003)
    flat = box(w, w, h, STEEL).at(z=0.03 * h - h)  # A flat spot lets it lie still.
    bowl = (bowl - inside.at(z=0.003) - flat).at(x=r - d / 2)
    start = -d / 2 + 1.9 * r
    path = [(start, 0, 0.72 * depth), (start + 0.12 * d, 0, h - 0.006)]
    path += [(0.1 * d, 0, 0.75 * h), (0.44 * d, 0, 0.03 * h + 0.009)]
    stem = hull_chain(path, STEEL)
    ring = arc(0.011, 0, 360, 17)
    hook = [(0.5 * d - 0.016 + x, y, 0.03 * h + 0.005) for x, y in ring]
    return union([bowl, stem, tube(hook, 0.005, STEEL, 12)])


def hull_chain(path: Points, colour: str) -> Solid:
    """Return a flat bar along a polyline, wider than thick."""
    beads = [
        slab(0.014, 0.018, 0.008, 0.004, colour).at(x, y, z - 0.004) for x, y, z in path
    ]
    return union([hull(pair, colour) for pair in pairwise(beads)])


def crate(d: float, w: float, h: float) -> Solid:
    """Return a plain box: the shape of what has no better one."""
    return extruded(
        [(-d / 2, -w / 2), (d / 2, -w / 2), (d / 2, w / 2), (-d / 2, w / 2)],
        h,
        "#c9a26b",
    )

"""The building: floor and walls of a layout, with holes for doors and windows."""

from math import inf

import numpy as np
from manifold3d import CrossSection, JoinType, Manifold

from placing.scene import Layout, Opening
from placing.shapes.colours import FLOORING, OAK, WALL, WHITE
from placing.shapes.parts import (
    Array,
    Colour,
    Interval,
    Part,
    box,
    cut,
    prism,
    rectangle,
    union,
)
from placing.shapes.shape import Shape, Support

WALL_M, FLOOR_M = 0.1, 0.1
"""Thickness of the walls and of the slab below the floor."""
SKIRTING_M, FRAME_M = 0.08, 0.04
"""Height of the skirting and width of the frame of a window."""


def walls_shape(layout: Layout) -> Shape:
    """Return floor and walls of a layout in the world, with the support `floor`.

    The walls stand outside the outline, so the room is as large as the outline says.
    Doors are holes without a leaf; windows are holes with a thin frame and no glass.
    The skirting is flush with the wall: things may touch the wall above and below.
    """
    inner = CrossSection([layout.outline_m])
    outer = inner.offset(WALL_M, JoinType.Miter, 10.0)
    holes = [_hole(layout, opening) for opening in layout.openings]
    ring = outer - inner
    skirting = cut(_slab(ring, (0.0, SKIRTING_M), WHITE), *holes)
    walls = cut(_slab(ring, (SKIRTING_M, layout.height_m), WALL), *holes)
    parts = [_slab(outer, (-FLOOR_M, 0.0), FLOORING), skirting, walls]
    for opening in layout.openings:
        if opening.kind == "window":
            parts.append(_frame(layout, opening))
    outline = np.asarray(layout.outline_m, float)
    return Shape(union(parts), (Support("floor", outline, 0.0, inf, 0.0),))


def _slab(section: CrossSection, z: Interval, colour: Colour) -> Part:
    """Return the section extruded from z[0] to z[1]."""
    return Part(Manifold.extrude(section, z[1] - z[0]).translate((0, 0, z[0])), colour)


def opening_outline(layout: Layout, opening: Opening, grow_m: float = 0.0) -> Array:
    """Return the footprint of an opening in its wall, shape (4, 2) [m].

    `grow_m` widens it across the wall on both sides.
    """
    start, along, outwards = wall_axes(layout.outline_m, opening.wall)
    near = start + opening.offset_m * along
    corners = rectangle((0.0, opening.width_m), (-WALL_M - grow_m, grow_m))
    return near + corners[:, :1] * along - corners[:, 1:] * outwards


def wall_axes(outline_m: Array, wall: int) -> tuple[Array, Array, Array]:
    """Return first corner, direction and outward normal of a wall, each shape (2,)."""
    start = np.asarray(outline_m[wall], float)
    along = np.asarray(outline_m[(wall + 1) % len(outline_m)], float) - start
    along = along / np.linalg.norm(along)
    # The outline is counter-clockwise: outside is to the right of each wall.
    return start, along, np.array([along[1], -along[0]])


def _hole(layout: Layout, opening: Opening) -> Part:
    """Return the solid that an opening takes out of its wall."""
    low, high = opening.sill_m, opening.sill_m + opening.height_m
    # The hole of a door starts at the floor, without a film left by rounding.
    low = low if low > 0 else -FLOOR_M / 2
    return prism(opening_outline(layout, opening, 0.05), (low, high), WALL)


def _frame(layout: Layout, opening: Opening) -> Part:
    """Return the frame of a window with one upright bar, in the middle of the wall."""
    width, low = opening.width_m, opening.sill_m
    high = low + opening.height_m
    depth = (-0.7 * WALL_M, -0.3 * WALL_M)
    outer = box((0.0, width), depth, (low, high), WHITE)
    lights = max(1, round(width / 0.8))
    step = (width - FRAME_M) / lights
    panes = [
        box(
            (FRAME_M + i * step, (i + 1) * step),
            (-1.0, 1.0),
            (low + FRAME_M, high - FRAME_M),
            OAK,
        )
        for i in range(lights)
    ]
    start, along, _ = wall_axes(layout.outline_m, opening.wall)
    turn_deg = float(np.degrees(np.arctan2(along[1], along[0])))
    near_x, near_y = (start + opening.offset_m * along).tolist()
    turned = cut(outer, *panes).solid.rotate((0.0, 0.0, turn_deg))
    return Part(turned.translate((near_x, near_y, 0.0)), WHITE)

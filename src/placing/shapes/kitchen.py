"""Kitchen furniture that carries a worktop: counters, sink, stove, island."""

from math import inf

import numpy as np

from placing.shapes.colours import (
    BLACK,
    DARK_STEEL,
    GLASS,
    GREY,
    NAVY,
    OAK,
    SAGE,
    STEEL,
    STONE,
    WHITE,
)
from placing.shapes.joinery import (
    BOARD_M,
    HANDLE_M,
    Size,
    extent,
    fronts,
    shrink,
    top_patch,
)
from placing.shapes.parts import (
    Colour,
    Part,
    assemble,
    box,
    cut,
    cylinder,
    patch,
    rod,
)
from placing.shapes.shape import Shape, Support

WORKTOP_M = 0.04
SINK_BACK_M, SINK_FRONT_M = 0.095, 0.07
"""Worktop left behind and before the basin, too narrow for things to stand on."""
TAP_M = 0.28
"""How far the tap rises above the worktop."""


def counter(size_m: Size) -> Shape:
    """Return a counter: drawers above doors, a worktop, a recessed plinth."""
    return assemble([*_base(size_m, SAGE), _worktop(size_m)], top_patch(size_m))


def _worktop(size_m: Size) -> Part:
    """Return the slab on top of a counter."""
    x, y, z = extent(size_m)
    return box(x, y, (z[1] - _thickness(size_m), z[1]), STONE)


def _thickness(size_m: Size) -> float:
    """Return how thick the worktop is [m]."""
    return min(WORKTOP_M, 0.2 * size_m[2])


def _base(size_m: Size, colour: Colour, drawers: float = 0.22) -> list[Part]:
    """Return the cabinets below a worktop, solid inside."""
    x, y, z = extent(size_m)
    plinth = min(0.1, 0.12 * z[1])
    top = z[1] - _thickness(size_m)
    split = top - drawers * (top - plinth)
    n = max(1, round(size_m[1] / 0.5))
    parts = [
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, (plinth, top), colour),
        box((x[0], x[1] - 0.09), y, (0.0, plinth), BLACK),
        *fronts(x[1], y, (plinth, split), (n, 1), colour),
    ]
    if drawers:
        parts += fronts(x[1], y, (split, top), (n, 1), colour, is_drawer=True)
    return parts


def sink_counter(size_m: Size) -> Shape:
    """Return a counter with a hollow steel basin, and a tap behind the basin.

    The box is that of the counter: the tap rises 0.28 m above it. The support `top` is
    the worktop left, right and before the basin; the strip behind it holds the tap.
    """
    x, y, z = extent(size_m)
    basin_x, basin_y = _basin(size_m)
    depth = min(0.19, 0.4 * z[1])
    floor = z[1] - depth
    wall = 0.012
    opening = box(basin_x, basin_y, (floor, z[1] + 1), STEEL)
    outer_x, outer_y = shrink(basin_x, -wall), shrink(basin_y, -wall)
    room = box(outer_x, outer_y, (floor - wall, z[1] + 1), STEEL)
    solid, *panels = _base(size_m, SAGE, drawers=0)
    steel = cut(box(outer_x, outer_y, (floor - wall, z[1]), STEEL), opening)
    parts = [cut(solid, room), *panels, cut(_worktop(size_m), room), steel]
    parts += _tap((x[0] + 0.05, sum(basin_y) / 2), basin_x[0] + 0.12, z[1])
    left, right = basin_y[1], basin_y[0]
    # The worktop without basin and tap is a U that is open to the back.
    outline = np.array(
        [
            (x[0], y[0]),
            (x[1], y[0]),
            (x[1], y[1]),
            (x[0], y[1]),
            (x[0], left + wall),
            (basin_x[1] + wall, left + wall),
            (basin_x[1] + wall, right - wall),
            (x[0], right - wall),
        ]
    )
    top = Support("top", outline, z[1], inf, 0.0)
    tap_free = depth + TAP_M - 0.05
    basin = patch("basin", basin_x, basin_y, floor, tap_free)
    return assemble(parts, [top, *basin])


def _basin(size_m: Size) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the intervals of the basin along x and y."""
    x, _, _ = extent(size_m)
    back = x[0] + min(SINK_BACK_M, 0.25 * size_m[0])
    front = min(x[1] - min(SINK_FRONT_M, 0.2 * size_m[0]), back + 0.5)
    half = min(0.3, 0.5 * size_m[1] - 0.05)
    # A wide counter has its basin beside the middle, with a place to drain.
    middle = -0.15 * size_m[1] if size_m[1] > 1.2 else 0.0
    return (back, front), (middle - half, middle + half)


def _tap(foot: tuple[float, float], reach: float, top: float) -> list[Part]:
    """Return a tap that bends from its foot on the worktop to above the basin."""
    x, y = foot
    peak, end = top + TAP_M - 0.01, reach - 0.008
    return [
        cylinder(foot, 0.024, (top - 0.01, top + 0.03), STEEL, n=16),
        rod((x, y, top), (x, y, peak), 0.011, STEEL),
        rod((x - 0.006, y, peak), (reach, y, peak), 0.01, STEEL),
        rod((end, y, peak + 0.008), (end, y, peak - 0.04), 0.01, STEEL),
        rod((x, y, top + 0.02), (x, y + 0.07, top + 0.05), 0.007, STEEL),
    ]


def stove(size_m: Size) -> Shape:
    """Return an oven with a flat glass hob; the hob's rings lie flush in the glass."""
    x, y, z = extent(size_m)
    hob = z[1] - min(0.02, 0.1 * z[1])
    face = x[1] - 0.045
    panel = hob - min(0.11, 0.15 * z[1])
    rings = _rings(size_m, (hob, z[1]))
    parts = [
        cut(box(x, y, (hob, z[1]), GLASS), *rings),
        *rings,
        box((x[0], face), y, (0.0, hob), WHITE),
    ]
    door_y, door_z = shrink(y, 0.01), (0.16 * z[1], panel - 0.01)
    parts.append(box((face, face + 0.02), door_y, door_z, DARK_STEEL))
    edge = 0.2 * (door_z[1] - door_z[0])
    window = shrink(door_y, 0.15 * size_m[1]), shrink(door_z, edge)
    parts.append(box((face + 0.01, face + 0.022), *window, GLASS))
    grip = (door_z[1] - 0.05, door_z[1] - 0.03)
    parts.append(box((face + 0.02, x[1]), shrink(door_y, 0.06), grip, STEEL))
    level = (panel + hob) / 2
    for at in np.linspace(*shrink(y, 0.15 * size_m[1]), 5):
        knob = (face, at, level), (x[1] - 0.015, at, level)
        parts.append(rod(*knob, min(0.02, 0.2 * (hob - panel)), BLACK, n=12))
    return assemble(parts, top_patch(size_m))


def _rings(size_m: Size, z: tuple[float, float]) -> list[Part]:
    """Return the four discs that show where the hob heats."""
    depth, width, _ = size_m
    radius = 0.17 * min(depth, width)
    return [
        cylinder((i * depth, j * width), radius * k, z, GREY)
        for i, j, k in ((0.22, 0.23, 1), (0.22, -0.23, 0.8), (-0.22, 0.23, 0.8))
    ] + [cylinder((-0.22 * depth, -0.23 * width), radius, z, GREY)]


def island(size_m: Size) -> Shape:
    """Return a kitchen island whose worktop juts out to the front, for stools."""
    x, y, z = extent(size_m)
    top = z[1] - _thickness(size_m)
    jut = min(0.3, 0.3 * size_m[0])
    sides, plinth = shrink(y, 0.02), min(0.08, 0.1 * z[1])
    inner = shrink(sides, 0.04)
    parts = [
        box(x, y, (top, z[1]), OAK),
        box((x[0] + 0.02, x[1] - jut), sides, (plinth, top), NAVY),
        box((x[0] + 0.06, x[1] - jut - 0.04), inner, (0.0, plinth), BLACK),
    ]
    for side in ((sides[0], sides[0] + 0.04), (sides[1] - 0.04, sides[1])):
        parts.append(box((x[0] + 0.02, x[1] - 0.02), side, (0.0, top), NAVY))
    return assemble(parts, top_patch(size_m))

"""Desks and tables: a top on legs, and what stands between the legs."""

from math import inf

import numpy as np

from placing.shapes.colours import (
    BIRCH,
    BLACK,
    DARK_STEEL,
    OAK,
    PINE,
    WALNUT,
    WHITE,
)
from placing.shapes.joinery import (
    BOARD_M,
    HANDLE_M,
    Size,
    extent,
    fronts,
    legs,
    shrink,
    top_patch,
)
from placing.shapes.parts import (
    Array,
    Colour,
    Interval,
    Part,
    assemble,
    box,
    cylinder,
    ellipse,
    patch,
    prism,
    quarter_turn,
)
from placing.shapes.shape import Shape, Support


def desk(size_m: Size) -> Shape:
    """Return a desk: steel frames, a screen at the back, drawers at the right.

    The sitter is in front, at +x. Desks narrower than 1.3 m have no drawers.
    """
    x, y, z = extent(size_m)
    under = (0.0, z[1] - min(0.03, 0.2 * z[1]))
    parts = [box(x, y, (under[1], z[1]), OAK)]
    foot, beam = 0.05, min(0.04, 0.2 * under[1])
    for side in (shrink(y, 0.03)[0], shrink(y, 0.03)[1] - foot):
        along = (side, side + foot)
        parts += [
            box(shrink(x, 0.03), along, (0.0, beam), DARK_STEEL),
            box(shrink(x, 0.03), along, (under[1] - beam, under[1]), DARK_STEEL),
            box((x[0] + 0.03, x[0] + 0.08), along, under, DARK_STEEL),
            box((x[1] - 0.08, x[1] - 0.03), along, under, DARK_STEEL),
        ]
    screen = (max(0.3, 0.45 * under[1]), under[1])
    parts.append(box((x[0] + 0.04, x[0] + 0.06), shrink(y, 0.08), screen, OAK))
    if size_m[1] >= 1.3 and size_m[0] >= 0.45:
        drawers = (y[0] + 0.1, y[0] + 0.48)
        front = min(x[1] - 0.02, x[0] + 0.06 + 0.6)
        body = (x[0] + 0.06, front - 0.042)
        parts.append(box(body, drawers, (0.08, under[1]), WHITE))
        parts += fronts(front, drawers, (0.08, under[1]), (1, 3), WHITE, is_drawer=True)
    return assemble(parts, top_patch(size_m))


def corner_desk(size_m: Size) -> Shape:
    """Return an L-shaped desk whose free quadrant, with the sitter, is at +x, +y.

    One wing runs along the back edge (-x) over the whole width, the other along the
    right edge (-y) over the whole depth; they meet in the corner at -x, -y.
    """
    x, y, z = extent(size_m)
    wing = min(0.75, 0.55 * min(size_m[:2]))
    chamfer = min(0.25, 0.3 * (min(size_m[:2]) - wing))
    outline = l_outline(x, y, wing, chamfer)
    under = z[1] - min(0.03, 0.2 * z[1])
    parts = [prism(outline, (under, z[1]), BIRCH)]
    inset = 0.03
    along_back = (x[0] + inset, x[0] + wing - inset)
    along_right = (y[0] + inset, y[0] + wing - inset)
    parts += legs(along_back, along_right, (0.0, under), 0.06, BLACK)
    end = (y[1] - inset - 0.06, y[1] - inset)
    parts += [
        box(along_back, end, (0.0, 0.04), BLACK),
        box((x[0] + wing / 2 - 0.03, x[0] + wing / 2 + 0.03), end, (0.0, under), BLACK),
    ]
    front = (x[1] - inset - 0.4, x[1] - inset)
    if size_m[0] - wing > 0.6:
        drawers = _turned_block(front, along_right, (0.0, under))
        parts += drawers
    else:
        parts += legs(front, along_right, (0.0, under), 0.06, BLACK)
    return assemble(parts, [Support("top", outline, z[1], inf, 0.0)])


def _turned_block(x: Interval, y: Interval, z: Interval) -> list[Part]:
    """Return a block of three drawers that open towards +y."""
    # A quarter turn about z maps the front +x to +y and the left +y to -x.
    left = (-x[1], -x[0])
    parts = [box((y[0], y[1] - BOARD_M - HANDLE_M), left, z, WHITE)]
    parts += fronts(y[1], left, z, (1, 3), WHITE, is_drawer=True)
    return [quarter_turn(part) for part in parts]


def l_outline(x: Interval, y: Interval, wing: float, chamfer: float = 0.0) -> Array:
    """Return the outline of an L with its free quadrant at +x, +y, shape (v, 2) [m]."""
    inner_x, inner_y = x[0] + wing, y[0] + wing
    corners = [(x[0], y[1]), (x[0], y[0]), (x[1], y[0]), (x[1], inner_y)]
    if chamfer > 0:
        corners.append((inner_x + chamfer, inner_y))
    return np.array([*corners, (inner_x, inner_y + chamfer), (inner_x, y[1])])


def table(size_m: Size) -> Shape:
    """Return a table with an apron and four legs that taper to the floor."""
    parts = _board_on_legs(size_m, OAK, 0.07)
    x, y, z = extent(size_m)
    apron = (z[1] - 0.03 - min(0.09, 0.2 * z[1]), z[1] - 0.02)
    low_x, low_y = shrink(x, 0.05), shrink(y, 0.05)
    for side in ((low_x[0], low_x[0] + 0.022), (low_x[1] - 0.022, low_x[1])):
        parts.append(box(side, low_y, apron, OAK))
    for side in ((low_y[0], low_y[0] + 0.022), (low_y[1] - 0.022, low_y[1])):
        parts.append(box(low_x, side, apron, OAK))
    return assemble(parts, top_patch(size_m))


def _board_on_legs(
    size_m: Size, colour: Colour, side: float, inset: float = 0.04
) -> list[Part]:
    """Return a board as large as the size on four legs."""
    x, y, z = extent(size_m)
    under = z[1] - min(0.03, 0.3 * z[1])
    parts = [box(x, y, (under, z[1]), colour)]
    return parts + legs(
        shrink(x, inset), shrink(y, inset), (0, under), side, colour, 0.6
    )


def round_table(size_m: Size) -> Shape:
    """Return a round table, elliptic where depth and width differ, on one column."""
    depth, width, height = size_m
    under = height - min(0.03, 0.2 * height)
    outline = ellipse((depth / 2, width / 2), 40)
    column = min(0.05, 0.1 * min(depth, width))
    foot = 0.5 * min(depth, width, 1.2 * height)
    parts = [
        prism(outline, (under, height), WALNUT),
        cylinder((0, 0), column, (0.02, under), DARK_STEEL),
        # The foot slopes, so that nothing can stand on it.
        cylinder((0, 0), 0.8 * foot, (0.0, 0.015), DARK_STEEL, n=32),
        cylinder((0, 0), 0.8 * foot, (0.015, 0.06), DARK_STEEL, taper=0.1, n=32),
        cylinder((0, 0), column * 3, (under - 0.03, under), DARK_STEEL),
    ]
    return assemble(parts, [Support("top", outline, height, inf, 0.0)])


def coffee_table(size_m: Size) -> Shape:
    """Return a coffee table; higher than 0.3 m it has a board under its top."""
    return _table_with_shelf(size_m, WALNUT, 0.05, 0.32)


def side_table(size_m: Size) -> Shape:
    """Return a side table with a board near the floor."""
    return _table_with_shelf(size_m, PINE, 0.035, 0.25)


def _table_with_shelf(size_m: Size, colour: Colour, leg: float, at: float) -> Shape:
    """Return a table with a board at the share `at` of its height."""
    x, y, z = extent(size_m)
    parts = _board_on_legs(size_m, colour, leg, inset=0.0)
    supports = top_patch(size_m)
    under, shelf = z[1] - min(0.03, 0.3 * z[1]), at * z[1]
    if z[1] >= 0.3 and min(size_m[:2]) > 4 * leg:
        inner_x, inner_y = shrink(x, leg), shrink(y, leg)
        parts.append(box(shrink(x, 0.012), inner_y, (shelf - 0.02, shelf), colour))
        supports += patch("shelf1", inner_x, inner_y, shelf, under - shelf)
    return assemble(parts, supports)


def bench(size_m: Size) -> Shape:
    """Return a wooden bench with two trestles and a rail between them."""
    x, y, z = extent(size_m)
    under = z[1] - min(0.04, 0.3 * z[1])
    parts = [box(x, y, (under, z[1]), PINE)]
    stand = min(0.12, 0.2 * size_m[1])
    for side in (
        (y[0] + stand, y[0] + stand + 0.05),
        (y[1] - stand - 0.05, y[1] - stand),
    ):
        parts.append(box(shrink(x, 0.02), side, (0.0, under), PINE))
    rail = (0.3 * under, 0.3 * under + 0.08)
    parts.append(box((-0.02, 0.02), shrink(y, stand), rail, PINE))
    return assemble(parts, patch("seat", x, y, z[1]))

"""Storage with drawers: sideboards, dressers, drawer units, nightstands."""

from placing.shapes.colours import BIRCH, BLACK, CREAM, OAK, STEEL, WALNUT, WHITE
from placing.shapes.joinery import (
    BOARD_M,
    HANDLE_M,
    Size,
    case,
    extent,
    fronts,
    legs,
    shelving,
    shrink,
    top_patch,
)
from placing.shapes.parts import Part, assemble, box, cut, patch
from placing.shapes.shape import Shape


def sideboard(size_m: Size) -> Shape:
    """Return a sideboard on legs: a row of drawers above a row of doors."""
    x, y, z = extent(size_m)
    foot = min(0.14, 0.25 * z[1])
    board = min(0.025, 0.2 * z[1])
    body_z = (foot, z[1] - board)
    split = body_z[1] - 0.3 * (body_z[1] - body_z[0])
    n = max(1, round(size_m[1] / 0.5))
    parts = [
        box(x, y, (body_z[1], z[1]), WALNUT),
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, body_z, WALNUT),
        *legs(shrink(x, 0.04), shrink(y, 0.06), (0.0, foot), 0.05, BLACK, 0.6),
        *fronts(x[1], y, (foot, split), (n, 1), WALNUT, STEEL),
        *fronts(x[1], y, (split, body_z[1]), (n, 1), CREAM, STEEL, is_drawer=True),
    ]
    return assemble(parts, top_patch(size_m))


def dresser(size_m: Size) -> Shape:
    """Return a chest of closed drawers, about 0.22 m high and 0.6 m wide each."""
    x, y, z = extent(size_m)
    board, plinth = min(0.025, 0.2 * z[1]), min(0.06, 0.1 * z[1])
    body_z = (plinth, z[1] - board)
    counts = max(1, round(size_m[1] / 0.6)), max(1, round(size_m[2] / 0.22))
    parts = [
        box(x, y, (body_z[1], z[1]), BIRCH),
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, body_z, BIRCH),
        box((x[0], x[1] - 0.07), shrink(y, 0.01), (0.0, plinth), BLACK),
        *fronts(x[1], y, body_z, counts, BIRCH, BLACK, is_drawer=True),
    ]
    return assemble(parts, top_patch(size_m))


def drawer_unit(size_m: Size) -> Shape:
    """Return a chest of drawers whose top drawer is pulled open and hollow.

    The box is that of the closed unit; the open drawer stands out of its front by 0.6
    of its depth. The support `drawer` is the floor of the drawer in front of the box.
    """
    x, y, z = extent(size_m)
    board, plinth = min(0.02, 0.2 * z[1]), min(0.05, 0.1 * z[1])
    rows = max(1, round((z[1] - plinth) / 0.19))
    row = (z[1] - board - plinth) / rows
    drawer_z = (z[1] - board - row + 0.004, z[1] - board - 0.008)
    parts = [
        box(x, y, (z[1] - board, z[1]), WHITE),
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, (plinth, z[1] - board), WHITE),
        box((x[0], x[1] - 0.06), shrink(y, 0.01), (0.0, plinth), BLACK),
    ]
    if rows > 1:
        below = (plinth, z[1] - board - row)
        parts += fronts(x[1], y, below, (1, rows - 1), WHITE, is_drawer=True)
    # The closed drawer's front would end at the handles; it moves out by `pull`.
    pull, wall = 0.6 * size_m[0], 0.014
    back = x[1] - HANDLE_M - BOARD_M
    tray = (back - 0.01, back + pull)
    inner_y = shrink(y, 0.012 + wall)
    floor = drawer_z[0] + 0.012
    body = box(tray, shrink(y, 0.012), (drawer_z[0], drawer_z[1] - 0.02), OAK)
    hollow = box((back - 1.0, back + pull + 1.0), inner_y, (floor, z[1] + 1), OAK)
    parts.append(cut(body, hollow))
    parts += fronts(
        back + pull + BOARD_M + HANDLE_M, y, drawer_z, (1, 1), WHITE, is_drawer=True
    )
    held = patch("drawer", (x[1], back + pull), inner_y, floor)
    return assemble(parts, top_patch(size_m) + held)


def nightstand(size_m: Size) -> Shape:
    """Return a nightstand: an open shelf above one drawer, on short legs."""
    x, y, z = extent(size_m)
    foot = min(0.1, 0.2 * z[1])
    split = foot + 0.45 * (z[1] - foot)
    body, hollow = case(x, y, (split, z[1]), BOARD_M, OAK)
    parts: list[Part] = [
        body,
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, (foot, split), OAK),
        *legs(shrink(x, 0.02), shrink(y, 0.02), (0.0, foot), 0.04, OAK, 0.6),
        *fronts(x[1], y, (foot, split), (1, 1), WHITE, is_drawer=True),
    ]
    boards, supports = shelving(hollow, [hollow[1]], 9.9, BOARD_M, OAK)
    return assemble(parts + boards, supports + top_patch(size_m))

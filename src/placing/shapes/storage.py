"""Open and closed storage without drawers: bookcases, shelves, cabinets, racks."""

from math import inf

from placing.shapes.colours import (
    BIRCH,
    BLACK,
    CREAM,
    DARK_STEEL,
    OAK,
    SAGE,
    STEEL,
    WALNUT,
    WHITE,
)
from placing.shapes.joinery import (
    BOARD_M,
    HANDLE_M,
    Size,
    bays,
    case,
    extent,
    fronts,
    legs,
    shelving,
    shrink,
    top_patch,
)
from placing.shapes.parts import assemble, box, hull, patch
from placing.shapes.shape import Shape, Support


def bookcase(size_m: Size) -> Shape:
    """Return a bookcase: open boards about 0.33 m apart, partitions every 1.3 m."""
    x, y, z = extent(size_m)
    plinth = min(0.06, 0.1 * z[1])
    body, hollow = case(x, y, (plinth, z[1]), BOARD_M, OAK)
    columns = bays(hollow[1], 1.3, BOARD_M)
    boards, supports = shelving(hollow, columns, 0.33, BOARD_M, OAK)
    base = box((x[0], x[1] - 0.02), shrink(y, 0.004), (0.0, plinth), WALNUT)
    return assemble([body, base, *boards], supports + top_patch(size_m))


def open_shelf(size_m: Size) -> Shape:
    """Return wall boards on two rails, about 0.32 m apart; a low one is one board.

    The boards of a shelf of several carry from their upper sides; the rails end at
    the top of the box and the highest board is open above.
    """
    x, y, z = extent(size_m)
    n = round(z[1] / 0.32)
    if n < 2:
        return _single_board(size_m)
    step, board = z[1] / n, 0.025
    tops = [i * step + board for i in range(n)]
    parts = [box(x, y, (top - board, top), OAK) for top in tops]
    supports: list[Support] = []
    rail = 0.012
    for i, top in enumerate(tops):
        free = step - board if i < n - 1 else inf
        supports += patch(f"shelf{i + 1}", (x[0] + rail, x[1]), y, top, free)
    aside = min(0.15, 0.2 * size_m[1])
    for at in (y[0] + aside, y[1] - aside):
        parts.append(box((x[0], x[0] + rail), (at - 0.012, at + 0.012), z, BLACK))
    return assemble(parts, supports)


def _single_board(size_m: Size) -> Shape:
    """Return one wall board at the top of the box on slanted brackets."""
    x, y, z = extent(size_m)
    under = z[1] - min(0.03, z[1])
    parts = [box(x, y, (under, z[1]), OAK)]
    aside = min(0.15, 0.2 * size_m[1])
    for at in (y[0] + aside, y[1] - aside) if under > 0.005 else ():
        corners = [(x[0], 0.0), (x[0], under), (x[0] + 0.7 * size_m[0], under)]
        sides = (at - 0.01, at + 0.01)
        parts.append(hull([(cx, cy, cz) for cx, cz in corners for cy in sides], BLACK))
    return assemble(parts, patch("shelf1", x, y, z[1]))


def cabinet(size_m: Size) -> Shape:
    """Return a closed cabinet: doors about 0.5 m wide on a plinth, solid inside."""
    return _closed(size_m, 0.5, CREAM)


def _closed(size_m: Size, door: float, colour: tuple[int, int, int]) -> Shape:
    """Return a closed block with doors in front and a board on top."""
    x, y, z = extent(size_m)
    board, plinth = min(0.025, 0.2 * z[1]), min(0.07, 0.1 * z[1])
    body_z = (plinth, z[1] - board)
    parts = [
        box((x[0], x[1] - HANDLE_M - BOARD_M), y, body_z, colour),
        box((x[0], x[1] - 0.07), shrink(y, 0.01), (0.0, plinth), BLACK),
        box(x, y, (body_z[1], z[1]), OAK),
    ]
    n = max(1, round(size_m[1] / door))
    parts += fronts(x[1], y, body_z, (n, 1), colour)
    return assemble(parts, top_patch(size_m))


def wall_cabinet(size_m: Size) -> Shape:
    """Return a hanging cabinet with shelves inside and its doors open.

    The box is that of the closed cabinet, doors included. Each door stands out to the
    front at a right angle, by half a column's width, and stays within the width.
    """
    x, y, z = extent(size_m)
    door = min(0.018, 0.3 * size_m[0])
    shell = (x[0], x[1] - door)
    body, hollow = case(shell, y, z, door, WHITE)
    columns = bays(hollow[1], 1.0, 2 * door)
    boards, supports = shelving(hollow, columns, 0.3, door, WHITE)
    parts = [body, *boards]
    for column in columns:
        reach = (column[1] - column[0] + 2 * door) / 2
        for hinge in ((column[0] - door, column[0]), (column[1], column[1] + door)):
            leaf = (shell[1], shell[1] + reach)
            parts.append(box(leaf, shrink(hinge, 0.001), z, SAGE))
    return assemble(parts, supports + patch("top", shell, y, z[1]))


def shoe_rack(size_m: Size) -> Shape:
    """Return an open rack with boards about 0.2 m apart, the highest at the top."""
    x, y, z = extent(size_m)
    board, bar = min(0.016, 0.2 * z[1]), min(0.025, 0.1 * min(size_m[:2]))
    low = min(0.06, 0.2 * z[1])
    n = max(2, 1 + round((z[1] - low) / 0.2)) if z[1] > 0.25 else 1
    step = (z[1] - low - board) / max(1, n - 1)
    tops = [z[1] - i * step for i in range(n)][::-1]
    parts = legs(x, y, (0.0, z[1] - board), bar, DARK_STEEL)
    parts += [box(x, y, (top - board, top), BIRCH) for top in tops]
    supports: list[Support] = []
    for i, top in enumerate(tops):
        is_top = i == n - 1
        sides = (x, y) if is_top else (shrink(x, bar), shrink(y, bar))
        free = inf if is_top else step - board
        supports += patch(f"shelf{i + 1}", *sides, top, free)
    return assemble(parts, supports)


def tv_stand(size_m: Size) -> Shape:
    """Return a low stand: an open shelf in the middle, closed doors beside it."""
    x, y, z = extent(size_m)
    foot = min(0.08, 0.2 * z[1])
    body, hollow = case(x, y, (foot, z[1]), BOARD_M, WALNUT)
    parts = [body, *legs(shrink(x, 0.03), shrink(y, 0.05), (0, foot), 0.05, BLACK, 0.6)]
    closed = min(0.45, 0.28 * size_m[1]) if size_m[1] >= 1.2 else 0.0
    middle = shrink(hollow[1], closed)
    for side in ((hollow[1][0], middle[0]), (middle[1], hollow[1][1])):
        if closed:
            inner = (hollow[0][0], x[1] - BOARD_M - HANDLE_M)
            parts.append(box(inner, side, hollow[2], WALNUT))
            parts += fronts(x[1], side, hollow[2], (1, 1), CREAM, STEEL)
    boards, supports = shelving(
        (hollow[0], middle, hollow[2]), bays(middle, 1.3, BOARD_M), 0.3, BOARD_M, WALNUT
    )
    return assemble(parts + boards, supports + top_patch(size_m))

"""What many pieces of furniture share: legs, fronts with handles, cases and boards."""

from itertools import pairwise
from math import inf

from placing.shapes.colours import DARK_STEEL
from placing.shapes.parts import Colour, Interval, Part, box, cut, hull, patch
from placing.shapes.shape import Support

Size = tuple[float, float, float]
BOARD_M = 0.02
"""Thickness of the boards that furniture is made of."""
HANDLE_M = 0.022
"""How far a handle stands out of its front."""


def extent(size_m: Size) -> tuple[Interval, Interval, Interval]:
    """Return the intervals that a box of this size covers along x, y and z."""
    depth, width, height = size_m
    return (-depth / 2, depth / 2), (-width / 2, width / 2), (0.0, height)


def shrink(interval: Interval, low: float, high: float | None = None) -> Interval:
    """Return the interval shortened by `low` below and `high` above."""
    return interval[0] + low, interval[1] - (low if high is None else high)


def legs(
    x: Interval, y: Interval, z: Interval, side: float, colour: Colour, foot: float = 1
) -> list[Part]:
    """Return four square legs in the corners; `foot` scales their lower ends."""
    if z[1] <= z[0]:
        return []
    side = min(side, (x[1] - x[0]) / 2, (y[1] - y[0]) / 2)
    parts = []
    for ex, sx in ((x[0], 1), (x[1], -1)):
        for ey, sy in ((y[0], 1), (y[1], -1)):
            points = [
                (ex + sx * i * k, ey + sy * j * k, level)
                for level, k in ((z[0], side * foot), (z[1], side))
                for i in (0, 1)
                for j in (0, 1)
            ]
            parts.append(hull(points, colour))
    return parts


def fronts(
    x_front: float,
    y: Interval,
    z: Interval,
    counts: tuple[int, int],
    colour: Colour,
    handle: Colour = DARK_STEEL,
    is_drawer: bool = False,
) -> list[Part]:
    """Return a grid of fronts, columns by rows, whose handles end at `x_front`.

    The fronts are as thick as a board: what they close ends at `x_front` minus the
    handle and the board. Doors have upright handles at the side where they open.
    """
    columns, rows = counts
    step_y, step_z = (y[1] - y[0]) / columns, (z[1] - z[0]) / rows
    face = (x_front - HANDLE_M - BOARD_M, x_front - HANDLE_M)
    parts = []
    for i in range(columns):
        for j in range(rows):
            cell_y = (y[0] + i * step_y + 0.002, y[0] + (i + 1) * step_y - 0.002)
            cell_z = (z[0] + j * step_z + 0.002, z[0] + (j + 1) * step_z - 0.002)
            parts.append(box(face, cell_y, cell_z, colour))
            grip = (
                _drawer_grip(cell_y, cell_z)
                if is_drawer
                else _door_grip(cell_y, cell_z, opens_left=i % 2 == 0)
            )
            parts.append(box((face[1], x_front), *grip, handle))
    return parts


def _drawer_grip(y: Interval, z: Interval) -> tuple[Interval, Interval]:
    """Return where the lying handle of a drawer is, along y and z."""
    half = min(0.08, 0.25 * (y[1] - y[0]))
    middle, level = (y[0] + y[1]) / 2, z[0] + 0.7 * (z[1] - z[0])
    return (middle - half, middle + half), (level - 0.006, level + 0.006)


def _door_grip(y: Interval, z: Interval, opens_left: bool) -> tuple[Interval, Interval]:
    """Return where the upright handle of a door is, along y and z."""
    aside = min(0.04, 0.2 * (y[1] - y[0]))
    at = y[1] - aside if opens_left else y[0] + aside
    half = min(0.08, 0.25 * (z[1] - z[0]))
    # A low door is opened at its top, a tall one at the height of a hand.
    level = min(z[1] - half - 0.05, 1.05) if z[0] < 1.0 else z[0] + half + 0.05
    level = min(max(level, z[0] + half), z[1] - half)
    return (at - 0.006, at + 0.006), (level - half, level + half)


def case(
    x: Interval, y: Interval, z: Interval, board: float, colour: Colour
) -> tuple[Part, tuple[Interval, Interval, Interval]]:
    """Return a box that is open to the front, and the intervals of its hollow."""
    hollow = (x[0] + board, x[1]), shrink(y, board), shrink(z, board)
    if any(high - low <= 0 for low, high in hollow):
        return box(x, y, z, colour), hollow
    opening = box((hollow[0][0], x[1] + 1), hollow[1], hollow[2], colour)
    return cut(box(x, y, z, colour), opening), hollow


def bays(y: Interval, longest: float, board: float) -> list[Interval]:
    """Return the intervals between upright partitions, none longer than `longest`."""
    width = y[1] - y[0]
    n = 1 + int((width + board) / (longest + board + 1e-9))
    each = (width - (n - 1) * board) / n
    starts = [y[0] + i * (each + board) for i in range(n)]
    return [(start, start + each) for start in starts]


def shelving(
    hollow: tuple[Interval, Interval, Interval],
    columns: list[Interval],
    gap: float,
    board: float,
    colour: Colour,
    setback: float = 0.0,
) -> tuple[list[Part], list[Support]]:
    """Return the partitions and boards of a hollow, and the supports on them.

    Boards are about `gap` apart; the lowest support is the bottom of the hollow.
    Supports are `shelf1`, `shelf2`, ... from below, and `shelf1_2` is the second
    column from the right where there are several.
    """
    x, y, z = hollow
    n = max(1, round((z[1] - z[0] + board) / (gap + board)))
    free = (z[1] - z[0] - (n - 1) * board) / n
    floors = [z[0] + i * (free + board) for i in range(n)]
    parts = [
        box(x, (left[1], right[0]), z, colour) for left, right in pairwise(columns)
    ]
    inner = (x[0], x[1] - setback)
    parts += [box(inner, y, (f - board, f), colour) for f in floors[1:]]
    supports = []
    for i, floor in enumerate(floors):
        for j, column in enumerate(columns):
            name = f"shelf{i + 1}" + (f"_{j + 1}" if len(columns) > 1 else "")
            depth = x if i == 0 else inner
            supports += patch(name, depth, column, floor, free)
    return parts, supports


def top_patch(size_m: Size) -> list[Support]:
    """Return the whole top of a box of this size as a support."""
    x, y, z = extent(size_m)
    return patch("top", x, y, z[1], inf)

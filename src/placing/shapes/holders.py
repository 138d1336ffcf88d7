"""What holds one kind of thing: rails for stemmed glasses, hooks, pen holders."""

from math import inf

import numpy as np

from placing.shapes.colours import BLACK, DARK_STEEL, OAK, STEEL, WALNUT
from placing.shapes.joinery import BOARD_M, Size, extent, shrink, top_patch
from placing.shapes.parts import (
    Array,
    Interval,
    Part,
    assemble,
    box,
    cut,
    patch,
)
from placing.shapes.shape import Shape

SLOT_M, PITCH_M = 0.026, 0.11
"""Free width between two rails of a stemware holder, and from slot to slot."""
LIP_M = 0.006
"""Thickness of the lips of the rails."""
HOOK_M, HOOK_PITCH_M = 0.008, 0.07
"""Thickness of a hook, and from one hook to the next."""


def stemware_holder(size_m: Size) -> Shape:
    """Return a board on two sides with rails below, under which glasses hang.

    The slots between the rails run along x and are open to the front; the foot of a
    glass rests on the lips at both sides of a slot, see `slots_of` and `rails_height`.
    The lips carry no support of their own: they are narrower than any object stands on.
    """
    x, y, z = extent(size_m)
    board = min(BOARD_M, 0.1 * z[1])
    rails = rails_height(z[1])
    parts = [
        box(x, y, (z[1] - board, z[1]), WALNUT),
        box(x, (y[0], y[0] + board), z, WALNUT),
        box(x, (y[1] - board, y[1]), z, WALNUT),
    ]
    ends = [y[0] + board - 0.001, *_edges(size_m[1]), y[1] - board + 0.001]
    for low, high in zip(ends[::2], ends[1::2], strict=True):
        if high <= low:
            continue
        middle = (low + high) / 2
        lip = box(x, (low, high), (rails - LIP_M, rails), STEEL)
        web = (middle - 0.004, middle + 0.004)
        parts += [lip, box(x, web, (rails - LIP_M, z[1] - board + 0.001), STEEL)]
    return assemble(parts, top_patch(size_m))


def rails_height(height_m: float) -> float:
    """Return how high the lips of a stemware holder are [m]."""
    return height_m - min(BOARD_M, 0.1 * height_m) - min(0.03, 0.15 * height_m)


def slots_of(width_m: float) -> Array:
    """Return the middles of the slots of a stemware holder along y, shape (n,) [m]."""
    n = max(1, int((width_m - 0.08) / PITCH_M))
    return PITCH_M * (np.arange(n, dtype=np.float64) - (n - 1) / 2)


def _edges(width_m: float) -> list[float]:
    """Return where the slots begin and end along y, in order."""
    return [at + side for at in slots_of(width_m) for side in (-SLOT_M / 2, SLOT_M / 2)]


def hooks(size_m: Size) -> Shape:
    """Return a rail at the wall with hooks that stand out of it and turn up.

    Mugs and ladles hang on one hook or lie across several; the hooks end at the front
    of the box and the rail fills its height, see `hooks_height`.
    """
    x, y, z = extent(size_m)
    back = min(0.015, 0.3 * size_m[0])
    arm = hooks_height(z[1])
    parts = [box((x[0], x[0] + back), y, z, OAK)]
    n = max(2, 1 + int((size_m[1] - 2 * HOOK_M) / HOOK_PITCH_M))
    for at in np.linspace(y[0] + HOOK_M, y[1] - HOOK_M, n):
        wide = (at - HOOK_M / 2, at + HOOK_M / 2)
        out = (x[0] + back - 0.001, x[1])
        tip = (x[1] - HOOK_M, x[1])
        parts.append(box(out, wide, (arm - HOOK_M, arm), BLACK))
        parts.append(box(tip, wide, (arm - HOOK_M, arm + 0.02), BLACK))
    return assemble(parts)


def hooks_height(height_m: float) -> float:
    """Return how high the arms of hooks are [m]."""
    return 0.4 * height_m


def pen_holder(size_m: Size) -> Shape:
    """Return a square cup with a cross inside: pens stand in its four cells."""
    x, y, z = extent(size_m)
    wall, floor = min(0.003, 0.05 * min(size_m[:2])), min(0.004, 0.1 * z[1])
    inner = (shrink(x, wall), shrink(y, wall))
    hollow = box(*inner, (floor, z[1] + 1), DARK_STEEL)
    parts = [cut(box(x, y, z, DARK_STEEL), hollow), *_cross(inner, (floor, z[1]))]
    return assemble(parts, patch("cup", *inner, floor, inf))


def _cross(inner: tuple[Interval, Interval], z: Interval) -> list[Part]:
    """Return two thin upright walls across a hollow."""
    thin, level = (-0.001, 0.001), (z[0] - 0.001, z[1] - 0.002)
    return [
        box(shrink(inner[0], -0.001), thin, level, STEEL),
        box(thin, shrink(inner[1], -0.001), level, STEEL),
    ]

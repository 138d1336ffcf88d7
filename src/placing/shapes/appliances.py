"""Kitchen appliances and the dish rack."""

from math import inf

import numpy as np

from placing.shapes.colours import BLACK, DARK_STEEL, GLASS, GREY, STEEL, WHITE
from placing.shapes.joinery import Size, case, extent, shelving, shrink, top_patch
from placing.shapes.parts import (
    Array,
    Interval,
    Part,
    assemble,
    box,
    cushion,
    cut,
    cylinder,
    patch,
)
from placing.shapes.shape import Shape

DOOR_M = 0.05
"""How thick the wall and the door of a fridge are."""
WIRE_M, SLOT_M = 0.004, 0.04
"""Thickness of the wires of a dish rack, and from one wire to the next."""


def fridge(size_m: Size) -> Shape:
    """Return a fridge with shelves behind its open door, and a closed freezer below.

    The box is that of the closed fridge, door included. The open door is hinged at the
    right (-y) and stands out to the front by the width of the fridge, within the width.
    A fridge lower than 1.2 m has no freezer.
    """
    x, y, z = extent(size_m)
    foot = min(0.04, 0.05 * z[1])
    freezer = foot + (0.33 * (z[1] - foot) if z[1] >= 1.2 else 0.0)
    shell = (x[0], x[1] - DOOR_M)
    body, hollow = case(shell, y, (freezer, z[1]), DOOR_M, WHITE)
    boards, supports = shelving(hollow, [hollow[1]], 0.28, 0.012, GREY, setback=0.03)
    parts = [body, *boards, box((x[0], x[1] - 0.08), shrink(y, 0.02), (0, foot), BLACK)]
    if freezer > foot:
        door = (foot, freezer - 0.006)
        parts.append(box(shell, y, (foot, freezer), WHITE))
        parts.append(box((shell[1], x[1] - 0.01), y, door, WHITE))
        grip = (door[1] - 0.06, door[1] - 0.04)
        parts.append(box((x[1] - 0.02, x[1]), shrink(y, 0.1), grip, DARK_STEEL))
    else:
        parts.append(box((shell[1], x[1]), y, (foot, freezer + 0.01), WHITE))
    parts += _open_door(shell[1], y, (freezer + 0.002, z[1]))
    return assemble(parts, supports + patch("top", shell, y, z[1]))


def _open_door(hinge_x: float, y: Interval, z: Interval) -> list[Part]:
    """Return the open door with its handle and narrow bins for bottles."""
    leaf = (hinge_x, hinge_x + y[1] - y[0])
    inner = y[0] + DOOR_M - 0.01
    parts = [box(leaf, (y[0], inner), z, WHITE)]
    bins = (leaf[0] + 0.06, leaf[1] - 0.04)
    for share in (0.12, 0.4, 0.68):
        level = z[0] + share * (z[1] - z[0])
        outer = box(bins, (inner - 0.005, inner + 0.085), (level, level + 0.07), STEEL)
        room = shrink(bins, 0.006), (inner, inner + 0.079)
        parts.append(cut(outer, box(*room, (level + 0.008, level + 1), STEEL)))
    return parts


def microwave(size_m: Size) -> Shape:
    """Return a closed microwave: a dark window, a handle and a panel of buttons.

    Seen from the front the panel is at the right, +y; the support is the top of the
    body without its door.
    """
    x, y, z = extent(size_m)
    foot = min(0.012, 0.1 * z[1])
    face = x[1] - min(0.03, 0.2 * size_m[0])
    split = y[1] - 0.26 * size_m[1]
    pane = shrink((y[0], split), 0.05 * size_m[1], 0.07 * size_m[1])
    panel = shrink((split, y[1]), 0.05 * size_m[1], 0.03 * size_m[1])
    high, shown = (foot + 0.12 * z[1], 0.86 * z[1]), (0.68 * z[1], 0.86 * z[1])
    parts = [
        box((x[0], face), y, (foot, z[1]), STEEL),
        box(shrink(x, 0.03, 0.06), shrink(y, 0.02), (0.0, foot), BLACK),
        box((face, face + 0.012), y, shrink((foot, z[1]), 0.004), DARK_STEEL),
        box((face, face + 0.014), pane, high, GLASS),
        box((face, face + 0.014), panel, shown, GLASS),
        box((face, x[1]), (split - 0.015, split), high, STEEL),
        *_keys(face, panel, z[1]),
    ]
    return assemble(parts, patch("top", (x[0], face), y, z[1]))


def _keys(face: float, y: Interval, height: float) -> list[Part]:
    """Return nine buttons in a square."""
    step, parts = (y[1] - y[0]) / 3, []
    for i in range(3):
        for j in range(3):
            across = shrink((y[0] + i * step, y[0] + (i + 1) * step), 0.1 * step)
            level = (0.2 + 0.14 * j) * height
            key = (level, level + 0.09 * height)
            parts.append(box((face, face + 0.015), across, key, GREY))
    return parts


def toaster(size_m: Size) -> Shape:
    """Return a toaster with two slots along its width; nothing stands on it."""
    x, y, _ = extent(size_m)
    depth, width, height = size_m
    foot = min(0.012, 0.1 * height)
    lever = min(0.02, 0.1 * width)
    long = (y[0] + lever, y[1])
    body = cushion(x, long, (foot, height), STEEL, 0.03)
    along, floor = shrink(long, 0.13 * width), (0.35 * height, 2 * height)
    slots = [
        box((at - 0.09 * depth, at + 0.09 * depth), along, floor, BLACK)
        for at in (-0.17 * depth, 0.17 * depth)
    ]
    below = (0.0, foot + 0.02)
    parts = [
        cut(body, *slots),
        box(shrink(x, 0.12 * depth), shrink(long, 0.06 * width), below, BLACK),
        box((-0.02, 0.02), (y[0], y[0] + 0.06), (0.62 * height, 0.7 * height), BLACK),
    ]
    return assemble(parts)


def coffee_machine(size_m: Size) -> Shape:
    """Return a coffee machine: a tray for a cup under an overhanging head."""
    x, y, _ = extent(size_m)
    depth, width, height = size_m
    column = (x[0], x[0] + 0.45 * depth)
    tray, head = 0.1 * height, 0.62 * height
    spout, panel = (x[0] + 0.72 * depth, 0.0), (0.75 * height, 0.9 * height)
    parts = [
        box(x, y, (0.0, tray), BLACK),
        box(column, y, (tray, head), DARK_STEEL),
        box(x, y, (head, height), STEEL),
        cylinder(spout, 0.12 * width, (head - 0.06 * height, head), BLACK, n=16),
        box((x[1] - 0.004, x[1]), shrink(y, 0.2 * width), panel, BLACK),
    ]
    cup = patch("tray", (column[1], x[1]), y, tray, 0.56 * height - tray)
    return assemble(parts, cup + top_patch(size_m))


def dish_rack(size_m: Size) -> Shape:
    """Return a dish rack: a rimmed tray whose left half has slots for plates.

    Wire hoops stand across the width in planes of constant y; a plate on edge with the
    yaw of the rack stands between two of them, see `slot_centres`. The one support is
    the whole floor of the tray, out of which the thin hoops rise.
    """
    x, y, z = extent(size_m)
    floor, rim = 0.015, min(0.05, 0.6 * z[1])
    wall = 0.006
    hollow = box(shrink(x, wall), shrink(y, wall), (floor, z[1] + 1), GREY)
    parts = [cut(box(x, y, (0.0, rim), GREY), hollow)]
    across = min(0.1, 0.36 * size_m[0])
    for at in hoops(size_m[1]):
        wire = (at - WIRE_M / 2, at + WIRE_M / 2)
        bar = (z[1] - WIRE_M, z[1])
        parts.append(box((-across, across), wire, bar, STEEL))
        for post in ((-across, -across + WIRE_M), (across - WIRE_M, across)):
            parts.append(box(post, wire, (floor - 0.002, z[1] - 0.001), STEEL))
    tray = patch("tray", shrink(x, wall), shrink(y, wall), floor, inf)
    return assemble(parts, tray)


def hoops(width_m: float) -> Array:
    """Return where the wire hoops of a rack stand along y, shape (n,) [m]."""
    high = width_m / 2 - 0.03
    n = max(2, 1 + int(0.5 * width_m / SLOT_M))
    return high - SLOT_M * np.arange(n, dtype=np.float64)[::-1]


def slot_centres(width_m: float) -> Array:
    """Return the middles of the slots of a rack along y, shape (n - 1,) [m]."""
    at = hoops(width_m)
    return (at[:-1] + at[1:]) / 2

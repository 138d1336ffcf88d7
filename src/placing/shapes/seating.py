"""Hard and padded seats for one: chairs and stools."""

from math import inf

import numpy as np

from placing.shapes.colours import BLACK, DARK_STEEL, OAK, SLATE, TEAL, WALNUT
from placing.shapes.joinery import Size, extent, legs, shrink
from placing.shapes.parts import (
    Colour,
    Part,
    assemble,
    box,
    cushion,
    cylinder,
    ellipse,
    hull,
    patch,
    rod,
)
from placing.shapes.shape import Shape, Support

Point = tuple[float, float, float]

PADDED = 0.5
"""Softness of a padded seat."""


def seat_height(height_m: float) -> float:
    """Return how high the seat of a chair of this height is [m]."""
    return min(0.46, 0.55 * height_m)


def chair(size_m: Size) -> Shape:
    """Return a wooden chair: four legs, a flat seat, a back of two posts and slats."""
    x, y, z = extent(size_m)
    seat = seat_height(z[1])
    board = min(0.03, 0.2 * seat)
    post = min(0.04, 0.15 * min(size_m[:2]))
    parts = [
        box((x[0] + 0.002, x[1]), y, (seat - board, seat), OAK),
        *legs(shrink(x, 0.01), shrink(y, 0.01), (0.0, seat - board), post, OAK, 0.65),
        box(shrink(x, 0.02), shrink(y, 0.02), (seat - 0.08, seat - 0.02), OAK),
    ]
    for side in ((y[0], y[0] + post), (y[1] - post, y[1])):
        parts.append(box((x[0], x[0] + 0.03), side, (seat - board, z[1]), OAK))
    rise = z[1] - seat
    for low, high in ((0.35, 0.55), (0.72, 1.0)):
        slat = (seat + low * rise, seat + high * rise)
        parts.append(box((x[0] + 0.006, x[0] + 0.024), y, slat, OAK))
    return assemble(parts, patch("seat", (x[0] + 0.03, x[1]), y, seat))


def office_chair(size_m: Size) -> Shape:
    """Return a swivel chair: five-star foot, padded seat, curved back, armrests."""
    x, y, z = extent(size_m)
    seat = min(0.48, 0.52 * z[1])
    pad = min(0.08, 0.3 * seat)
    arm = min(0.05, 0.12 * size_m[1])
    inner, back = shrink(y, arm + 0.015), x[0] + min(0.09, 0.2 * size_m[0])
    parts = [
        *_star_foot(0.47 * min(size_m[:2]), seat - pad),
        cushion((back - 0.05, x[1]), inner, (seat - pad, seat), SLATE, 0.02),
        cushion((x[0], back), shrink(inner, 0.01), (seat + 0.1, z[1]), SLATE, 0.03),
        box((back - 0.06, back - 0.03), (-0.04, 0.04), (seat - pad, seat + 0.2), BLACK),
    ]
    top = min(seat + 0.22, z[1])
    reach = (back + 0.06, min(back + 0.34, x[1]))
    for side, root in (((y[0], y[0] + arm), inner[0]), ((y[1] - arm, y[1]), inner[1])):
        post = (sum(reach) / 2 - 0.025, sum(reach) / 2 + 0.025)
        middle = (sum(side) / 2 - 0.012, sum(side) / 2 + 0.012)
        bridge = min(middle[0], root - 0.02), max(middle[1], root + 0.02)
        parts += [
            cushion(reach, side, (top - 0.03, top), BLACK, 0.01),
            box(post, middle, (seat - pad, top - 0.015), BLACK),
            box(post, bridge, (seat - pad + 0.005, seat - pad + 0.03), BLACK),
        ]
    flat = shrink((back, x[1]), 0.0, 0.02), shrink(inner, 0.02)
    return assemble(parts, patch("seat", *flat, seat, inf, PADDED))


def _star_foot(radius: float, top: float) -> list[Part]:
    """Return the foot of a swivel chair with its column and five castors."""
    parts: list[Part] = [
        cylinder((0, 0), 0.03, (0.06, top), DARK_STEEL, n=16),
        cylinder((0, 0), 0.05, (0.055, 0.11), BLACK, taper=0.6, n=16),
        box((-0.1, 0.1), (-0.08, 0.08), (top - 0.025, top + 0.005), BLACK),
    ]
    for angle in np.pi + 2 * np.pi * np.arange(5) / 5:
        c, s = np.cos(angle) * (radius - 0.03), np.sin(angle) * (radius - 0.03)
        parts.append(rod((0, 0, 0.085), (c, s, 0.07), 0.025, BLACK, 0.014, n=8))
        wheel = (c - 0.012 * s / radius, s + 0.012 * c / radius, 0.028)
        end = (c + 0.012 * s / radius, s - 0.012 * c / radius, 0.028)
        parts.append(rod(wheel, end, 0.028, BLACK, n=12))
    return parts


def stool(size_m: Size) -> Shape:
    """Return a round wooden stool on three or four splayed legs."""
    depth, width, height = size_m
    board = min(0.035, 0.2 * height)
    outline = (depth / 2, width / 2)
    parts = [cylinder((0, 0), outline, (height - board, height), WALNUT, n=32)]
    parts += _splayed(size_m, height - board / 2, 0.02)
    return assemble(parts, _round_seat(outline, height, 0.0))


def bar_stool(size_m: Size) -> Shape:
    """Return a high round stool with a padded seat and a ring of rungs."""
    depth, width, height = size_m
    pad = min(0.06, 0.2 * height)
    outline, edge = (depth / 2, width / 2), 0.012
    flat = (depth / 2 - edge, width / 2 - edge)
    rounded = np.concatenate(
        [
            np.column_stack([ellipse(radius, 32), np.full(32, level)])
            for radius, level in (
                (flat, height),
                (outline, height - edge),
                (outline, height - pad),
            )
        ]
    )
    parts = [hull(rounded, TEAL), *_splayed(size_m, height - pad / 2, 0.016, BLACK)]
    level, reach = 0.32 * height, 0.78
    for i in range(4):
        a, b = np.pi / 4 + np.pi / 2 * np.array([i, i + 1])
        ends = _at(size_m, a, level, reach), _at(size_m, b, level, reach)
        parts.append(rod(*ends, 0.01, BLACK))
    return assemble(parts, _round_seat(flat, height, PADDED))


def _round_seat(
    radius: tuple[float, float], height: float, soft: float
) -> list[Support]:
    """Return the flat top of a round seat as a support."""
    return [Support("seat", ellipse(radius, 32), height, inf, soft)]


def _at(size_m: Size, angle: float, level: float, reach: float) -> Point:
    """Return the point of an ellipse inside the footprint at a level."""
    depth, width, _ = size_m
    x, y = np.cos(angle) * depth / 2, np.sin(angle) * width / 2
    return float(x * reach), float(y * reach), level


def _splayed(
    size_m: Size, top: float, radius: float, colour: Colour = WALNUT
) -> list[Part]:
    """Return four round legs that spread towards the floor and stand flat on it."""
    ring = np.column_stack([ellipse(radius, 10), np.zeros(10)])  # (10, 3)
    parts = []
    for angle in np.pi / 4 + np.pi / 2 * np.arange(4):
        foot, head = _at(size_m, angle, 0.0, 0.88), _at(size_m, angle, top, 0.62)
        parts.append(hull(np.concatenate([ring + foot, ring + head]), colour))
    return parts

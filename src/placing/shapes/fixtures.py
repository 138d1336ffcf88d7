"""What stands or hangs beside the furniture: lamp, plant, picture, boards, boxes."""

from math import inf

import numpy as np

from placing.shapes.colours import (
    BLACK,
    CREAM,
    DARK_STEEL,
    GREY,
    LEAF,
    LINEN,
    NAVY,
    OAK,
    SAND,
    SOIL,
    TERRACOTTA,
    WHITE,
)
from placing.shapes.joinery import Size, extent, shrink, top_patch
from placing.shapes.parts import (
    Part,
    assemble,
    box,
    cut,
    cylinder,
    ellipse,
    hull,
    patch,
    prism,
    rod,
    union,
)
from placing.shapes.shape import Shape


def plain_box(size_m: Size) -> Shape:
    """Return a plain closed box, for what has no shape of its own."""
    return assemble([box(*extent(size_m), SAND)], top_patch(size_m))


def window_sill(size_m: Size) -> Shape:
    """Return the board below a window."""
    return assemble([box(*extent(size_m), WHITE)], top_patch(size_m))


def floor_lamp(size_m: Size) -> Shape:
    """Return a floor lamp: a foot, a pole and an open shade as wide as the box."""
    depth, width, height = size_m
    low = height - min(0.3, 0.3 * height)
    outer, radius = (depth / 2, width / 2), min(depth, width) / 2
    inner = (depth / 2 - 0.006, width / 2 - 0.006)
    shade = cut(
        prism(ellipse(outer, 32), (low, height), LINEN, taper=0.75),
        prism(ellipse(inner, 32), (low - 1e-4, height + 1e-4), LINEN, taper=0.75),
    )
    hub = low + 0.6 * (height - low)
    parts = [
        shade,
        # The foot slopes, so that nothing can stand on it.
        cylinder((0, 0), 0.75 * radius, (0.0, 0.012), BLACK),
        cylinder((0, 0), 0.75 * radius, (0.012, 0.035), BLACK, taper=0.1),
        cylinder((0, 0), 0.012, (0.01, hub), BLACK, n=12),
        cylinder((0, 0), 0.03, (hub, hub + 0.07), CREAM, taper=0.5, n=12),
    ]
    # Thin spokes carry the shade.
    reach = 0.82 * depth / 2
    parts.append(box((-reach, reach), (-0.004, 0.004), (hub - 0.008, hub), BLACK))
    return assemble(parts)


def plant(size_m: Size) -> Shape:
    """Return a potted plant whose leaves just fill the box; nothing stands on it."""
    depth, width, height = size_m
    radius, pot = 0.3 * min(depth, width), min(0.35 * height, 0.35)
    parts = [
        cylinder((0, 0), radius * 0.75, (0.0, pot), TERRACOTTA, taper=1 / 0.75, n=20),
        cylinder((0, 0), 0.9 * radius, (pot - 0.01, pot + 0.04), SOIL, taper=0.1, n=20),
    ]
    # The golden angle spreads the leaves evenly without a pattern.
    for i in range(14):
        angle, level = 2.39996 * i, (i + 1) / 14
        parts += _leaf(angle, pot, height, level, (depth / 2, width / 2))
    mesh = union(parts)
    low, high = mesh.bounds
    mesh.vertices = (mesh.vertices - low) / (high - low) * size_m
    mesh.vertices -= [depth / 2, width / 2, 0.0]
    return Shape(mesh, ())


def _leaf(
    angle: float, pot: float, height: float, level: float, reach: tuple[float, float]
) -> list[Part]:
    """Return a stem and a leaf that leaves it slantwise; high leaves stand steeper."""
    aside = np.array([np.cos(angle), np.sin(angle)]) * reach
    rise = height - pot
    stem_end = np.append(0.3 * (1.2 - level) * aside, pot + level * 0.55 * rise)
    tip = np.append((1.15 - 0.75 * level) * aside, pot + (0.3 + 0.7 * level) * rise)
    along = tip - stem_end
    across = np.array([-np.sin(angle), np.cos(angle), 0.0])
    across *= 0.2 * np.linalg.norm(along)
    normal = np.cross(across, along)
    normal *= 0.006 / np.linalg.norm(normal)
    middle = stem_end + 0.55 * along
    ring = [stem_end, middle + across, tip, middle - across]
    points = [p + s * normal for p in ring for s in (-1, 1)] + [middle - 2.5 * normal]
    root = (0.0, 0.0, pot - 0.01)
    end_x, end_y, end_z = (stem_end + 0.05 * along).tolist()
    stem = rod(root, (end_x, end_y, end_z), 0.007, LEAF, n=6)
    return [stem, hull(points, LEAF)]


def picture(size_m: Size) -> Shape:
    """Return a framed picture that hangs: its canvas lies behind the frame's face."""
    x, y, z = extent(size_m)
    edge = min(0.04, 0.15 * min(size_m[1:]))
    inner_y, inner_z = shrink(y, edge), shrink(z, edge)
    behind = x[0] + 0.6 * size_m[0]
    hollow = box((behind, x[1] + 1), inner_y, inner_z, OAK)
    horizon = inner_z[0] + 0.4 * (inner_z[1] - inner_z[0])
    canvas = (behind - 0.2 * size_m[0], behind + 0.1 * size_m[0])
    parts = [
        cut(box(x, y, z, OAK), hollow),
        box(canvas, inner_y, (inner_z[0], horizon), NAVY),
        box(canvas, inner_y, (horizon, inner_z[1]), CREAM),
    ]
    return assemble(parts, top_patch(size_m))


def whiteboard(size_m: Size) -> Shape:
    """Return a whiteboard that hangs, with a narrow ledge for pens at its foot."""
    x, y, z = extent(size_m)
    panel = x[0] + min(0.025, 0.5 * size_m[0])
    edge = min(0.02, 0.1 * min(size_m[1:]))
    parts = [
        box((x[0], panel), y, z, GREY),
        box((x[0], panel + 0.002), shrink(y, edge), shrink(z, edge), WHITE),
        box((x[0], x[1]), shrink(y, 0.15 * size_m[1]), (0.0, 0.012), DARK_STEEL),
    ]
    ledge = patch(
        "ledge", (panel + 0.002, x[1]), shrink(y, 0.15 * size_m[1]), 0.012, inf
    )
    return assemble(parts, ledge)

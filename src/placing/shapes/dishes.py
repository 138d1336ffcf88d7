"""Shapes of plates, cups and pans: walls turned about the vertical, and handles."""

from placing.shapes.solids import (
    Points,
    Solid,
    arc,
    box,
    cylinder,
    extruded,
    hull,
    inlaid,
    revolved,
    slab,
    tube,
    union,
)

PORCELAIN = "#f3efe6"
STEEL = "#c3c8cc"
BLACK = "#2b2d31"


def plate(d: float, w: float, h: float) -> Solid:
    """Return a dinner plate with a foot, a flat well and a blue line on its rim."""
    below = [(0, 0.18), (0.50, 0.18), (0.50, 0), (0.58, 0), (0.60, 0.2), (0.72, 0.36)]
    above = [(1, 0.78), (1, 1), (0.70, 0.58), (0.60, 0.42), (0, 0.40)]
    body = revolved(below + above, PORCELAIN, 64)
    line = revolved([(0.88, 0), (0.95, 0), (0.95, 1), (0.88, 1)], "#5b84a8", 64)
    return inlaid(body, line, "#5b84a8").scaled(d / 2, w / 2, h)


def bowl(d: float, w: float, h: float) -> Solid:
    """Return a hollow bowl on a foot ring, glazed in another colour inside."""
    r, t = d / 2, 0.045 * d
    outer = [(0, 0), (0.48 * r, 0), (0.46 * r, 0.08 * h), (0.72 * r, 0.28 * h)]
    outer += [(0.92 * r, 0.6 * h), (r, h), (0, h)]
    inner = [(0, 0.14 * h), (0.44 * r, 0.16 * h), (0.66 * r, 0.34 * h)]
    inner += [(0.92 * r - t, 0.64 * h), (r - t, h), (r - t, 1.1 * h), (0, 1.1 * h)]
    body = revolved(outer, "#d98c4a", 56) - revolved(inner, PORCELAIN, 56)
    return body.scaled(y=w / d)


def handle(reach: float, height: float, radius: float, colour: str) -> Solid:
    """Return a D-shaped handle in the y-z plane whose ends are at y = 0."""
    curve = arc(1, -90, 90, 11)
    path = [(0, reach * y, height * (0.5 + 0.5 * z)) for y, z in curve]
    return tube(path, radius, colour, 12)


def mug(d: float, w: float, h: float) -> Solid:
    """Return a hollow mug whose handle points to the right hand of its user, +y."""
    r, t = d / 2, 0.055 * d
    body = revolved(
        [(0, 0), (0.9 * r, 0), (r, 0.06 * h), (r, h), (0, h)], "#3f7f8c", 48
    )
    reach = w - d - 0.055 * d
    grip = handle(reach, 0.62 * h, 0.055 * d, "#3f7f8c").at(y=r - t / 2, z=0.19 * h)
    hollow = cylinder(r - t, h, PORCELAIN, n=48).at(z=0.06 * h)
    return (body + grip - hollow).at(y=r - w / 2)


def cup(d: float, w: float, h: float) -> Solid:
    """Return a tea cup, half full, on its saucer."""
    r, r_cup, t = d / 2, 0.30 * d, 0.02 * d
    saucer = revolved(
        [
            (0, 0),
            (0.55 * r, 0),
            (0.7 * r, 0.07 * h),
            (r, 0.20 * h),
            (r, 0.24 * h),
            (0.66 * r, 0.15 * h),
            (0, 0.10 * h),
        ],
        PORCELAIN,
        56,
    ).scaled(y=w / d)
    outer = [(0, 0), (0.5, 0), (0.55, 0.1), (0.82, 0.35), (0.96, 0.7), (1, 1), (0, 1)]
    body = revolved(_stretched(outer, r_cup, 0.9 * h), PORCELAIN, 48)
    inner = [(0, 0.1), (0.5, 0.12), (0.78, 0.38), (0.92, 0.7), (0.94, 1.1), (0, 1.1)]
    hollow = revolved(_stretched(inner, r_cup, 0.9 * h), "#fbf8f0", 48)
    grip = handle(0.24 * d, 0.4 * h, t, PORCELAIN).at(y=0.85 * r_cup, z=0.3 * h)
    tea = cylinder(r_cup, 0.5 * h, "#8a4b1f", n=48)
    tea = tea.at(z=0.15 * h) ^ hollow.scaled(1.02, 1.02)
    return saucer + (body + grip - hollow + tea).at(z=0.1 * h)


def _stretched(profile: Points, radius: float, height: float) -> Points:
    """Return a profile of unit radius and height in metres."""
    return [(r * radius, z * height) for r, z in profile]


def frying_pan(d: float, w: float, h: float) -> Solid:
    """Return a frying pan whose long handle rises towards the right hand, +y."""
    r, depth, t = d / 2, 0.6 * h, 0.02 * d
    outer = [(0, 0), (0.78 * r, 0), (r, depth), (0, depth)]
    inner = [(0, t), (0.77 * r, t), (r - t, depth), (r - t, h), (0, h)]
    body = revolved(outer, "#34373c", 56) - revolved(inner, "#4a4e55", 56)
    end = w - r
    neck = hull(
        [
            box(0.11 * d, 0.01, 0.012, STEEL).at(y=0.95 * r, z=0.62 * depth),
            box(0.09 * d, 0.01, 0.014, STEEL).at(y=1.3 * r, z=0.8 * depth),
        ],
        STEEL,
    )
    grip = hull(
        [
            slab(0.085 * d, 0.02, 0.018, 0.008, BLACK).at(y=1.3 * r, z=0.75 * depth),
            slab(0.11 * d, 0.03, 0.02, 0.01, BLACK).at(y=end - 0.015, z=h - 0.02),
        ],
        BLACK,
    )
    return (body + neck + grip).at(y=r - w / 2)


def saucepan(d: float, w: float, h: float) -> Solid:
    """Return a saucepan under its lid, with a handle towards the right hand, +y."""
    r, wall = d / 2, 0.72 * h
    body = cylinder(r * 0.97, wall, STEEL, n=56)
    bottom = cylinder(r, 0.05 * h, "#9aa0a6", n=56).at(z=0.02 * h)
    edge = cylinder(r, 0.04 * h, "#dfe3e6", n=56).at(z=wall)
    dome = revolved(
        [
            (0, 0),
            (0.96 * r, 0),
            (0.8 * r, 0.05 * h),
            (0.45 * r, 0.1 * h),
            (0, 0.11 * h),
        ],
        "#b5bbc0",
        56,
    ).at(z=wall + 0.04 * h)
    stem = cylinder(0.08 * r, 0.09 * h, BLACK).at(z=wall + 0.12 * h)
    knob = revolved(
        _stretched([(0, 0), (1, 0.2), (1, 0.7), (0.7, 1), (0, 1)], 1, 1), BLACK
    )
    top = wall + 0.19 * h
    knob = knob.scaled(0.2 * r, 0.2 * r, h - top).at(z=top)
    bar = extruded(
        [(-0.06 * d, 0), (0.06 * d, 0), (0.05 * d, 1), (-0.05 * d, 1)], 1, BLACK
    )
    bar = bar.scaled(y=w - d + 0.02 * d, z=0.13 * h).at(y=0.48 * d, z=0.52 * h)
    return union([body, bottom, edge, dome, stem, knob, bar]).at(y=r - w / 2)

"""Shapes of shoes; a pair is one object and toes point to +x."""

from placing.shapes.solids import (
    Solid,
    box,
    cylinder,
    ellipsoid,
    hull,
    inlaid,
    tube,
    union,
)

LEFT_RIGHT = (1, -1)


def shoe(d: float, w: float, h: float) -> Solid:
    """Return the left one of a pair of sneakers."""
    return _sneaker(d, w, h)


def shoes(d: float, w: float, h: float) -> Solid:
    """Return a pair of sneakers side by side."""
    one = _sneaker(d, 0.45 * w, h)
    return union([one.scaled(y=s).at(y=s * 0.275 * w) for s in LEFT_RIGHT])


def boots(d: float, w: float, h: float) -> Solid:
    """Return a pair of ankle boots side by side."""
    one = _boot(d, 0.45 * w, h)
    return union([one.scaled(y=s).at(y=s * 0.275 * w) for s in LEFT_RIGHT])


def _sole(d: float, w: float, h: float, colour: str) -> Solid:
    """Return a foot-shaped sole of the given height."""
    ball_, heel = w / 2, 0.38 * w
    return hull(
        [
            cylinder(heel, h, colour).at(x=heel - d / 2),
            cylinder(ball_, h, colour).at(x=0.16 * d),
            cylinder(0.36 * w, h, colour).at(d / 2 - 0.36 * w, -0.04 * w),
        ],
        colour,
    )


def _sneaker(d: float, w: float, h: float) -> Solid:
    """Return the left shoe of a pair of sneakers."""
    fabric, dark, white = "#3b6ea5", "#22344a", "#f2f1ec"
    toe = ellipsoid(0.44 * d, 0.9 * w, 0.8 * h, fabric, 32)
    toe = toe.at(0.26 * d, -0.02 * w, -0.2 * h)
    low = cylinder(0.5, 0.1 * h, fabric).scaled(0.46 * d, 0.74 * w).at(x=-0.25 * d)
    collar = cylinder(0.5, 0.02 * h, fabric).scaled(0.38 * d, 0.6 * w).turned(y=-12)
    collar = collar.at(x=-0.27 * d, z=0.76 * h)
    tongue = hull([collar.at(x=0.02 * d), toe.scaled(0.8, 0.8, 0.8)], fabric)
    upper = union([hull([toe, low], fabric), hull([low, collar], fabric), tongue])
    upper = upper ^ box(2 * d, 2 * w, h, fabric)
    lace = box(0.03 * d, 0.5 * w, h, white).at(z=0.25 * h)
    stripe = box(0.035 * d, 2 * w, 0.4 * h, white).turned(y=-25)
    marks = [lace.at(x=x * d) for x in (-0.04, 0.03, 0.1)]
    upper = inlaid(upper, union([*marks, stripe.at(x=-0.12 * d, z=0.06 * h)]), white)
    mouth = cylinder(0.5, h, dark).scaled(0.30 * d, 0.46 * w).turned(y=-12)
    upper = upper - mouth.at(x=-0.22 * d, z=0.3 * h)
    return _sole(d, w, 0.2 * h, white) + upper.at(z=0.12 * h)


def _boot(d: float, w: float, h: float) -> Solid:
    """Return the left boot of a pair."""
    leather, dark = "#8a5431", "#3b2617"
    sole = _sole(d, w, 0.07 * h, dark)
    heel_block = _sole(d, w, 0.1 * h, dark) ^ box(0.34 * d, 2 * w, h, dark).at(
        x=-0.36 * d
    )
    toe = ellipsoid(0.46 * d, 0.88 * w, 0.6 * h, leather).at(
        0.24 * d, -0.02 * w, -0.2 * h
    )
    ankle = ellipsoid(0.46 * d, 0.74 * w, 0.9 * h, leather).at(-0.24 * d, 0, -0.25 * h)
    foot = hull([toe, ankle], leather) ^ box(2 * d, 2 * w, h, leather)
    shaft = cylinder(0.5, 0.72 * h, leather, top=0.5).scaled(0.44 * d, 0.7 * w)
    shaft = shaft.at(-0.25 * d, 0, 0.28 * h)
    cuff = cylinder(0.5, 0.09 * h, "#c9a06a").scaled(0.47 * d, 0.76 * w)
    hollow = (
        cylinder(0.5, h, dark).scaled(0.36 * d, 0.56 * w).at(-0.25 * d, 0, 0.35 * h)
    )
    laces = [
        tube([(0.0, -0.2 * w, z * h), (0.0, 0.2 * w, z * h)], 0.016 * d, "#e3c98f", 10)
        for z in (0.42, 0.54, 0.66, 0.78)
    ]
    laces = [lace.at(x=-0.045 * d) for lace in laces]
    cuff = cuff.at(-0.25 * d, 0, 0.91 * h)
    return union([sole, heel_block, foot.at(z=0.06 * h), shaft, cuff, *laces]) - hollow

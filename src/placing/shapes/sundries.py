"""Shapes of small things of a household that have no family."""

from placing.shapes.solids import (
    Solid,
    cylinder,
    ellipsoid,
    hull,
    inlaid,
    slab,
    union,
)


def hand_torch(d: float, w: float, h: float) -> Solid:
    """Return an electric torch that lies on its flat sides, its light towards +x."""
    dark, rim = "#2b2f36", "#c8322c"
    # Eight-sided all along, as many are: a round one would roll away.
    tube = cylinder(h / 2, 1.0, dark, n=8).turned(z=22.5).turned(y=90)
    grip = tube.scaled(0.9 * d, 0.74).at(x=-0.48 * d)
    head = tube.scaled(0.24 * d).at(x=0.26 * d)
    collar = inlaid(grip, tube.scaled(0.05 * d, 2, 2).at(x=0.1 * d), rim)
    glass = cylinder(0.4 * h, 0.02 * d, dark, n=24).turned(y=90).at(x=0.485 * d)
    key = slab(0.09 * d, 0.2 * w, 0.08 * h, 0.003, rim).at(x=-0.05 * d, z=0.45 * h)
    tail = tube.scaled(0.06 * d, 0.8, 1).at(x=-d / 2)
    parts = [collar, inlaid(head, glass, "#f6efc9"), tail, key]
    return union(parts).scaled(y=w / h)


def tissue_box(d: float, w: float, h: float) -> Solid:
    """Return a box of tissues along y, the next one drawn out of its slot."""
    wall = 0.8 * h
    body = slab(d, w, wall, 0.003, "#7fb6c9")
    band = slab(2 * d, 2 * w, 0.2 * h, 0.003, "#eef5f4").at(z=0.28 * h)
    body = inlaid(body, band, "#eef5f4")
    slot = slab(0.28 * d, 0.6 * w, h, 0.1 * d, "#31505c").at(z=0.72 * h)
    white = "#fdfdfb"
    tuft = hull(
        [
            ellipsoid(0.12 * d, 0.34 * w, 0.1 * h, white).at(z=0.7 * h),
            ellipsoid(0.3 * d, 0.26 * w, 0.06 * h, white).at(z=0.94 * h),
        ],
        white,
    )
    return (body - slot) + tuft

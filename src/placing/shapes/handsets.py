"""Shapes with keys that one holds in the hand."""

from placing.shapes.solids import (
    Solid,
    box,
    cylinder,
    extruded,
    pebble,
    slab,
    union,
)

DARK = "#26282c"
BLUE = "#3b6ea5"


def remote(d: float, w: float, h: float) -> Solid:
    """Return a remote control that lies with its keys up, pointing to -x."""
    body = pebble(d, w, 0.85 * h, 0.3 * h, DARK)
    keys = [
        slab(0.05 * d, 0.2 * w, 0.3 * h, 0.002, "#8d9299").at(
            (-0.14 + 0.11 * i) * d, (j - 1) * 0.28 * w, 0.7 * h
        )
        for i in range(4)
        for j in range(3)
    ]
    power = cylinder(0.09 * w, 0.3 * h, "#d9483b").at(-0.41 * d, -0.25 * w, 0.7 * h)
    ring = cylinder(0.3 * w, 0.25 * h, "#5f646b").at(x=-0.28 * d, z=0.7 * h)
    centre = cylinder(0.13 * w, 0.3 * h, "#b9bdc3").at(x=-0.28 * d, z=0.7 * h)
    bar = slab(0.1 * d, 0.16 * w, 0.3 * h, 0.002, BLUE).at(x=0.38 * d, z=0.7 * h)
    bars = [bar.at(y=-0.2 * w), bar.at(y=0.2 * w)]
    return union([body, *keys, power, ring, centre, *bars])


def phone(d: float, w: float, h: float) -> Solid:
    """Return a mobile phone that lies with its screen up."""
    body = slab(d, w, 0.85 * h, 0.12 * w, "#3a3d43")
    glass = slab(0.96 * d, 0.92 * w, 0.06 * h, 0.1 * w, "#0f1c2e").at(z=0.85 * h)
    icons = [
        slab(0.15 * w, 0.15 * w, 0.09 * h, 0.03 * w, colour).at(
            (0.11 * i - 0.30) * d, (j - 1.5) * 0.21 * w, 0.85 * h
        )
        for i in range(4)
        for j, colour in enumerate(("#4fa3d9", "#e8b04a", "#6cbf84", "#d9605a"))
    ]
    dock = slab(0.12 * d, 0.8 * w, 0.08 * h, 0.04 * w, "#35527a")
    return union([body, glass, dock.at(x=0.37 * d, z=0.85 * h), *icons])


def desk_phone(d: float, w: float, h: float) -> Solid:
    """Return an office telephone: sloping body, keys, display and a handset."""
    side = [(-d / 2, 0), (d / 2, 0), (d / 2, 0.22 * h), (-d / 2, 0.68 * h)]
    body = extruded(side, w, "#4a4d53").turned(x=90).at(y=w / 2)
    tilt = 24.7 * (0.46 * h / d) / 0.46 * 2.0
    keys = [
        slab(0.085 * d, 0.12 * w, 0.12 * h, 0.004, "#e6e8ea").at(
            (0.02 + 0.125 * i) * d, (0.04 + 0.16 * j) * w
        )
        for i in range(4)
        for j in range(3)
    ]
    display = box(0.2 * d, 0.46 * w, 0.1 * h, "#a9c7a0").at(-0.3 * d, 0.2 * w)
    face = union([*keys, display]).turned(y=tilt).at(z=0.40 * h)
    end = pebble(0.2 * d, 0.25 * w, 0.42 * h, 0.09 * h, DARK)
    ends = [end.at(x=-0.36 * d), end.at(x=0.36 * d)]
    bridge = pebble(0.86 * d, 0.19 * w, 0.22 * h, 0.09 * h, DARK).at(z=0.26 * h)
    handset = union([*ends, bridge]).turned(y=tilt).at(y=-0.32 * w, z=0.43 * h)
    return union([body, face, handset])

"""Shapes with a screen that faces the user, who is at +x."""

from placing.shapes.keyboards import key_rows
from placing.shapes.solids import Solid, box, cylinder, hull, slab, tube, union

DARK = "#26282c"
SILVER = "#c9ccd1"
GLASS = "#15191f"
BLUE = "#3b6ea5"


def screen(width: float, height: float, picture: bool, bezel: float) -> Solid:
    """Return a thin panel in the y-z plane that faces +x, its lower edge at z = 0."""
    thick = 0.012
    frame = slab(height, width, thick, 0.006, DARK).turned(y=90).at(z=height / 2)
    frame = frame.at(x=-thick)
    glass = (width - 2 * bezel, height - 2 * bezel)
    lit = box(0.002, *glass, BLUE if picture else GLASS).at(x=0.0, z=bezel)
    if not picture:
        return union([frame, lit])
    bar = box(0.0026, glass[0], 0.07 * glass[1], "#24476b").at(z=bezel)
    window = box(0.0030, 0.52 * glass[0], 0.58 * glass[1], "#f1f3f5")
    window = window.at(y=-0.14 * glass[0], z=bezel + 0.24 * glass[1])
    lines = [
        box(0.0036, 0.42 * glass[0] * k, 0.03 * glass[1], "#8c98a4").at(
            y=-0.14 * glass[0] - 0.21 * glass[0] * (1 - k),
            z=bezel + (0.70 - 0.08 * i) * glass[1],
        )
        for i, k in enumerate((1, 0.8, 0.95, 0.6, 0.9))
    ]
    card = box(0.0030, 0.2 * glass[0], 0.3 * glass[1], "#e8b04a")
    card = card.at(y=0.3 * glass[0], z=bezel + 0.45 * glass[1])
    return union([frame, lit, bar, window, card, *lines])


def laptop(d: float, w: float, h: float) -> Solid:
    """Return a laptop whose screen leans back 20 degrees, open at 110."""
    base_h, sin, cos = 0.075 * h, 0.342, 0.940
    length = (h - base_h) / cos
    depth = d - length * sin - 0.012 * cos
    base = slab(depth, w, base_h, 0.01, SILVER)
    pad = box(0.30 * depth, 0.34 * w, 0.001, "#b4b8be").at(x=0.3 * depth, z=base_h)
    well = box(0.46 * depth, 0.86 * w, 0.001, "#b4b8be").at(x=-0.16 * depth, z=base_h)
    keys = key_rows(0.44 * depth, 0.84 * w, 0.0035, (12, 12, 11, 10))
    keys = keys.at(x=-0.16 * depth, z=base_h - 0.0005)
    lid = screen(w, length, True, 0.035 * w).turned(y=-20).at(x=-depth / 2, z=base_h)
    hinge = cylinder(0.5 * base_h, 0.6 * w, DARK).turned(x=90)
    hinge = hinge.at(-depth / 2, 0.3 * w, 0.8 * base_h)
    return union([base, pad, well, keys, hinge, lid])


def monitor(d: float, w: float, h: float) -> Solid:
    """Return a monitor on its stand, its screen facing +x."""
    foot = slab(d, 0.42 * w, 0.012, 0.02, "#4a4d53")
    height = 0.76 * h
    neck = hull(
        [
            box(0.03, 0.10, 0.01, "#4a4d53").at(x=-0.22 * d, z=0.008),
            box(0.025, 0.075, 0.01, "#4a4d53").at(x=-0.14 * d, z=h - 0.55 * height),
        ],
        "#4a4d53",
    )
    back = hull(
        [
            box(0.004, 0.8 * w, 0.72 * height, DARK).at(x=0.0, z=0.14 * height),
            box(0.004, 0.4 * w, 0.4 * height, DARK).at(x=-0.17 * d, z=0.3 * height),
        ],
        "#3a3d42",
    )
    panel = screen(w, height, True, 0.014)
    head = union([back.at(x=-0.01), panel]).at(x=0.04 * d, z=h - height)
    return union([foot, neck, head])


def tv(d: float, w: float, h: float) -> Solid:
    """Return a flat television on two splayed feet, its screen facing +x."""
    height = 0.91 * h
    panel = screen(w, height, False, 0.012)
    back = box(0.03, 0.6 * w, 0.5 * height, DARK).at(x=-0.02, z=0.08 * height)
    glow = box(0.0032, 0.02, 0.003, "#d9483b").at(z=0.004)
    head = union([panel, back, glow]).at(z=h - height)
    feet = []
    for y in (-0.32 * w, 0.32 * w):
        path = [
            (-d / 2 + 0.01, y, 0.01),
            (-0.008, y, 0.13 * h),
            (d / 2 - 0.01, y, 0.01),
        ]
        feet.append(tube(path, 0.01, "#55585e", 12))
        feet.append(box(d, 0.02, 0.006, "#55585e").at(y=y))
    return union([head, *feet])

"""Shapes of electronics; a screen or a row of keys faces the user, who is at +x."""

from placing.shapes.solids import (
    Solid,
    box,
    cylinder,
    ellipsoid,
    extruded,
    hull,
    inlaid,
    pebble,
    slab,
    tube,
    union,
)

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


def key_rows(depth: float, width: float, height: float, counts: tuple) -> Solid:
    """Return rows of keys, the space bar nearest to the user, standing on z = 0."""
    rows = len(counts) + 1
    pitch, keys = depth / rows, []
    for row, count in enumerate(counts):
        step = width / count
        x = -depth / 2 + (row + 0.5) * pitch
        keys += [
            box(0.8 * pitch, 0.84 * step, height, "#3a3d43").at(
                x, -width / 2 + (k + 0.5) * step
            )
            for k in range(count)
        ]
    x = depth / 2 - pitch / 2
    for y, share in ((0, 0.42), (-0.365, 0.27), (0.365, 0.27)):
        keys.append(box(0.8 * pitch, share * width, height, "#3a3d43").at(x, y * width))
    return union(keys)


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


def keyboard(d: float, w: float, h: float) -> Solid:
    """Return a keyboard that slopes towards its user, with a number pad if wide."""
    side = [(-d / 2, 0), (d / 2, 0), (d / 2, 0.45 * h), (-d / 2, 0.75 * h)]
    body = extruded(side, w, "#dfe1e4").turned(x=90).at(y=w / 2)
    slope = 2.0 * 0.3 * h / d
    letters = w * (0.74 if w > 0.38 else 0.94)
    keys = key_rows(0.86 * d, letters, 0.6 * h, (15, 14, 13, 13, 12))
    keys = keys.at(y=-w / 2 + letters / 2 + 0.03 * w)
    blocks = [keys]
    if w > 0.38:
        blocks.append(_numbers(0.86 * d, 0.17 * w, 0.6 * h).at(y=0.395 * w))
    tilt = slope / 2 * 57.3
    return body + union(blocks).turned(y=tilt).at(z=0.36 * h)


def _numbers(depth: float, width: float, height: float) -> Solid:
    """Return the 4 x 5 keys of a block of numbers."""
    x, y = depth / 6, width / 4
    return union(
        [
            box(0.8 * x, 0.84 * y, height, "#4d5158").at((i - 1.5) * x, (j - 1.5) * y)
            for i in range(5)
            for j in range(4)
        ]
    )


def mouse(d: float, w: float, h: float) -> Solid:
    """Return a mouse whose palm end is at +x, with two buttons and a wheel."""
    grey, dark = "#8d939b", "#3a3d43"
    palm = ellipsoid(0.9 * d, w, 2 * h, grey, 40).at(x=0.05 * d, z=-h)
    nose = ellipsoid(0.5 * d, 0.86 * w, 1.1 * h, grey, 40).at(x=-0.25 * d, z=-0.55 * h)
    body = hull([palm, nose], grey) ^ box(2 * d, 2 * w, 2 * h, grey)
    front = box(0.8 * d, 2 * w, 2 * h, dark).at(x=-0.25 * d, z=0.25 * h)
    body = inlaid(body, front, dark)
    split = box(0.7 * d, 0.02 * d, 2 * h, "#c9ccd1").at(x=-0.2 * d, z=0.3 * h)
    wheel = cylinder(0.085 * d, 0.08 * d, "#e0653c", n=24).turned(x=90)
    return inlaid(body, split, "#c9ccd1") + wheel.at(
        x=-0.22 * d, y=0.045 * d, z=0.66 * h
    )


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

"""Shapes of books, pens and lamps."""

import numpy as np

from placing.shapes.solids import (
    Solid,
    box,
    cylinder,
    inlaid,
    profiled,
    revolved,
    slab,
    tube,
    union,
)

PAPER = "#f4eeda"
COVERS = ("#9c2f2f", "#27567b", "#3d7a4f", "#c9892b", "#5d4a7d", "#2f7f83")
PENCILS = ("#e2b33c", "#c8483b", "#3b7dbd", "#4a9a5b")


def book(d: float, w: float, h: float) -> Solid:
    """Return a hardback that lies flat; its spine is the -y side, its head is at -x.

    The colour of the cover follows from the size, so that books differ.
    """
    cover = COVERS[round(1000 * (d + w + h)) % len(COVERS)]
    t = min(0.003, 0.12 * h)
    pages = box(d - 0.010, w - 0.012, h - 2 * t, PAPER).at(y=-0.003, z=t)
    board = box(d, w, t, cover)
    spine = box(d, 0.006, h, cover).at(y=0.003 - w / 2)
    bands = [
        box(0.012 * d, 0.0064, h, "#e7cf8f").at(x * d, 0.003 - w / 2)
        for x in (-0.4, -0.34, 0.4)
    ]
    title = box(0.16 * d, 0.66 * w, t, PAPER).at(-0.2 * d, 0.02 * w, h - t / 2)
    name = box(0.04 * d, 0.4 * w, t, PAPER).at(0.32 * d, 0.02 * w, h - t / 2)
    covers = [inlaid(board.at(z=h - t), title + name, "#f0e3bd"), board, spine]
    return union([*bands, *covers, pages])


def pen(d: float, w: float, h: float) -> Solid:
    """Return a ball pen that lies along x with its clip up."""
    r = w / 2
    body = cylinder(r, 0.62 * d, "#2457a6", n=12).turned(z=15).at(z=0.1 * d)
    cap = cylinder(r, 0.28 * d, "#1c3f78", n=12).turned(z=15).at(z=0.72 * d)
    tip = cylinder(0.25 * r, 0.10 * d, "#d5d8db", top=r, n=12)
    clip = box(h - w + r, 0.3 * w, 0.24 * d, "#d5d8db").at(
        x=-(h - w + r) / 2, z=0.74 * d
    )
    knob = cylinder(0.5 * r, 0.02 * d, "#d5d8db", n=12).at(z=d * 0.98)
    upright = union([body, cap, tip, clip, knob])
    return upright.turned(y=90)


def pencil_cup(d: float, w: float, h: float) -> Solid:
    """Return a cup that holds four pencils and a pair of scissors."""
    r, wall = d / 2, 0.52 * h
    shell = cylinder(r, wall, "#50545c", top=r, n=40)
    hollow = cylinder(0.9 * r, wall, "#33363b", n=40).at(z=0.05 * h)
    leans = [(9, 6), (-8, 9), (5, -11), (-9, -7)]
    pencils = [
        pencil(0.9 * h, colour)
        .turned(x, y)
        .at(-0.04 * d * y / 3, 0.04 * d * x / 3, 0.04 * h)
        for (x, y), colour in zip(leans, PENCILS, strict=True)
    ]
    return union([shell.scaled(y=w / d) - hollow.scaled(y=w / d), *pencils])


def pencil(length: float, colour: str) -> Solid:
    """Return an upright hexagonal pencil, its point up."""
    r = 0.0042
    stick = cylinder(r, 0.86 * length, colour, n=6)
    wood = cylinder(r, 0.11 * length, "#e3c08f", top=0.3 * r, n=12).at(z=0.86 * length)
    lead = cylinder(0.32 * r, 0.04 * length, "#2b2d31", top=0.05 * r, n=12)
    return union([stick, wood, lead.at(z=0.96 * length)])


def desk_light(d: float, w: float, h: float) -> Solid:
    """Return a lamp with a jointed arm whose shade hangs towards +x over the desk."""
    r, r_shade = w / 2, 0.42 * w
    foot = revolved(
        [(0, 0), (r, 0), (r, 0.03 * h), (0.3 * r, 0.06 * h), (0, 0.06 * h)], "#3d4046"
    )
    x0, x1 = r - d / 2, d / 2 - r_shade
    joints = [
        (x0, 0, 0.05 * h),
        (x0 - 0.10 * d, 0, 0.55 * h),
        (x1 - 0.04 * d, 0, 0.94 * h),
    ]
    arm = tube(joints, 0.007, "#b9bdc3", 12)
    pivot = cylinder(0.016, 0.03, "#3d4046", n=20).turned(x=90).at(y=0.015)
    shade = revolved(
        [
            (0.93, 0),
            (1, 0),
            (0.42, 0.72),
            (0.36, 1),
            (0, 1),
            (0, 0.9),
            (0.32, 0.9),
            (0.36, 0.7),
        ],
        "#c8553d",
    ).scaled(r_shade, r_shade, 0.27 * h)
    bulb = cylinder(0.45 * r_shade, 0.14 * h, "#fff3c4", top=0.2 * r_shade).at(
        z=0.05 * h
    )
    head = union([shade, bulb]).at(x=x1, z=0.73 * h)
    return union([foot, arm, pivot.at(*joints[1]), pivot.at(*joints[0]), head])


def table_lamp(d: float, w: float, h: float) -> Solid:
    """Return a ceramic lamp under a linen shade that is open above and below."""
    r, low = d / 2, 0.52 * h
    profile = [(0, 0), (0.5, 0), (0.5, 0.04), (0.36, 0.07), (0.52, 0.2), (0.56, 0.32)]
    profile += [(0.4, 0.5), (0.14, 0.62), (0.14, 0.7), (0, 0.7)]
    foot = revolved(profile, "#4d7f8a").scaled(r, r, 0.75 * h)
    pole = cylinder(0.05 * r, 0.5 * h, "#b08d4c").at(z=0.4 * h)
    shade = revolved([(0.95, 0), (1, 0), (0.66, 1), (0.61, 1)], "#f1dfb6", 48)
    spokes = box(1.26 * r, 0.006, 0.006, "#b08d4c") + box(
        0.006, 1.26 * r, 0.006, "#b08d4c"
    )
    bulb = revolved([(0, 0), (0.10, 0), (0.2, 0.5), (0.12, 0.9), (0, 1)], "#fffbe6")
    parts = [foot, pole, shade.scaled(r, r, h - low).at(z=low), spokes.at(z=0.88 * h)]
    return union([*parts, bulb.scaled(r, r, 0.2 * h).at(z=0.6 * h)]).scaled(y=w / d)


def picture_frame(d: float, w: float, h: float) -> Solid:
    """Return a framed photograph that leans back on its strut, facing +x."""
    lean = 14.0
    length = 0.985 * h / 0.970
    frame = (
        slab(length, w, 0.014, 0.003, "#8a5a33").turned(y=90).at(x=-0.014, z=length / 2)
    )
    mat = box(0.002, 0.84 * w, 0.86 * length, "#f6f2e8").at(z=0.07 * length)
    sky = box(0.003, 0.62 * w, 0.64 * length, "#8fbbd9").at(z=0.18 * length)
    ridge = [(-0.31, 0), (0.31, 0), (0.31, 0.2), (0.12, 0.42), (-0.08, 0.2)]
    hills = profiled([*ridge, (-0.31, 0.3)], 0.004, "#4f8a5b")
    hills = hills.scaled(w, 1, length).turned(z=90)
    panel = union([frame, mat, sky, hills.at(z=0.18 * length)])
    panel = panel.turned(y=-lean).at(x=d / 2, z=0.014 * np.sin(np.radians(lean)))
    top = d / 2 - 0.66 * h * np.tan(np.radians(lean)) - 0.008  # inside the frame
    side = [(-d / 2, 0), (0.01 - d / 2, 0), (top, 0.66 * h), (top - 0.01, 0.66 * h)]
    strut = profiled(side, 0.22 * w, "#5b3a20")
    return union([panel, strut])

"""Shapes of cleaning things, cushions, bins and ornaments."""

import numpy as np
from manifold3d import Manifold
from numpy.typing import NDArray

from placing.shapes.solids import (
    Solid,
    arc,
    ball,
    box,
    cylinder,
    ellipsoid,
    hull,
    inlaid,
    painted,
    pebble,
    profiled,
    revolved,
    slab,
    tube,
    union,
)

IVORY = "#e9dcc3"
FABRICS = ("#b5533c", "#5c7f92", "#8a9a5b", "#c9a14a", "#7b5b7d")


def broom(d: float, w: float, h: float) -> Solid:
    """Return a broom that stands upright on its wide bristles.

    Its brush carries most of the mass, so it rests when it is put down straight.
    """
    # ASSUME: a broom stands rather than leans, because a shape knows no wall.
    brush, head = 0.09 * h, 0.035 * h
    bristles = hull(
        [
            box(d, w, 0.005, "#d8b35a"),
            box(0.6 * d, 0.88 * w, 0.005, "#d8b35a").at(z=brush),
        ],
        "#d8b35a",
    )
    cuts = [
        box(2 * d, 0.012 * w, 0.72 * brush, "#b8923f").at(y=k * w / 9, z=-0.01)
        for k in range(-4, 5)
    ]
    for cut in cuts:
        bristles = bristles - cut
    block = pebble(0.72 * d, 0.94 * w, head, 0.3 * head, "#2f6f77").at(z=brush)
    socket = cylinder(0.022, 0.05 * h, "#2f6f77", top=0.015).at(z=brush + 0.7 * head)
    pole = cylinder(0.0115, h - brush - head, "#c79a63", n=20).at(z=brush + head)
    grip = cylinder(0.014, 0.12 * h, "#2f6f77", n=20).at(z=0.88 * h)
    return union([bristles, block, socket, pole, grip])


def dustpan(d: float, w: float, h: float) -> Solid:
    """Return a dustpan that lies with its lip at -x and its handle at +x."""
    pan, t = 0.60 * d, 0.004
    side = [(0, 0), (0.92 * pan, 0), (pan, 0.75 * h), (0.55 * pan, 0.5 * h)]
    body = profiled([*side, (0, 0.04 * h)], w, "#2f8088").at(x=-d / 2)
    inside = [(-1.0, t), (0.91 * pan - t, t), (pan - t, 0.8 * h), (-1.0, h)]
    body = body - profiled(inside, w - 2 * t, "#4fa0a8").at(x=-d / 2)
    rise, end = (0.97 * pan - d / 2, 0, 0.6 * h), (d / 2 - 0.011, 0, 0.8 * h)
    path = [rise, (0.2 * d, 0, h - 0.011), end]
    handle = tube(path, 0.011, "#2f8088", 16).scaled(y=1.4)
    ribs = [
        box(0.8 * pan, 0.006, 0.006, "#2f8088").at(-d / 2 + 0.5 * pan, y * w)
        for y in (-0.25, 0, 0.25)
    ]
    return union([body, handle, *ribs])


def spray_bottle(d: float, w: float, h: float) -> Solid:
    """Return a bottle of cleaner whose nozzle points to +x."""
    r = w / 2
    profile = [
        (0, 0),
        (0.94, 0),
        (1, 0.04),
        (1, 0.5),
        (0.88, 0.68),
        (0.42, 0.85),
        (0.36, 1),
        (0, 1),
    ]
    body = revolved(profile, "#4fa3c9").scaled(r, r, 0.7 * h)
    label = revolved([(0, 0.12), (1.015, 0.12), (1.015, 0.46), (0, 0.46)], "#f5f5f2")
    label = label.scaled(r, r, 0.7 * h)
    collar = cylinder(0.42 * r, 0.08 * h, "#f2f2ee").at(z=0.69 * h)
    side = [(-0.62, 0.86), (-0.45, 0.98), (0.45, 1), (0.62, 0.95), (0.62, 0.88)]
    side += [(0.1, 0.86), (0.1, 0.76), (-0.25, 0.76)]
    head = profiled(side, 0.5 * w, "#e9662c").scaled(0.62 * d, 1, h)
    nozzle = (
        cylinder(0.16 * w, 0.12 * d, "#f2f2ee").turned(y=90).at(x=0.37 * d, z=0.915 * h)
    )
    trigger = profiled(
        [(0.14, 0.87), (0.26, 0.87), (0.34, 0.72), (0.28, 0.71)], 0.26 * w, "#f2f2ee"
    )
    parts = union([head, nozzle, trigger.scaled(d, 1, h)])
    return union([label, body, collar, parts]).at(x=r - d / 2)


def cushion(d: float, w: float, h: float) -> Solid:
    """Return a plump cushion with drawn-in sides, in the colour that its size gives."""
    colour = FABRICS[round(100 * (d + w + h)) % len(FABRICS)]
    body = Manifold.cube((2, 2, 2), True).refine(16).warp_batch(_plump)
    return painted(body, colour).scaled(d / 2, w / 2, h / 2)


def _plump(cube: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points of the cube [-1, 1] moved to a cushion with a flat underside."""
    x, y, z = np.asarray(cube).T
    x, y = np.sin(np.pi / 2 * x), np.sin(np.pi / 2 * y)  # finer at the seams
    dome = np.clip((1 - x**2) * (1 - y**2), 0, 1) ** 0.5
    corner = np.clip((1 - x**8) * (1 - y**8), 0, 1) ** 0.5
    thick = 0.04 + 0.96 * (0.8 * dome + 0.2 * corner)
    z = np.maximum(z * thick, -0.86)
    return np.column_stack([x * (0.9 + 0.1 * y**4), y * (0.9 + 0.1 * x**4), z])


def vase(d: float, w: float, h: float) -> Solid:
    """Return a hollow vase with a narrow neck and a wide lip."""
    outer = [(0, 0), (0.5, 0), (0.62, 0.06), (0.9, 0.24), (1, 0.4), (0.9, 0.58)]
    outer += [(0.52, 0.76), (0.42, 0.86), (0.5, 0.95), (0.6, 1), (0, 1)]
    inner = [(0, 0.06), (0.45, 0.06), (0.8, 0.26), (0.9, 0.4), (0.8, 0.57)]
    inner += [(0.42, 0.75), (0.32, 0.86), (0.42, 0.96), (0.55, 1.01), (0, 1.01)]
    body = revolved(outer, "#7d9aa5", 56) - revolved(inner, "#2f3a3f", 56)
    band = revolved([(0, 0.34), (1.1, 0.34), (1.1, 0.46), (0, 0.46)], IVORY, 56)
    core = revolved([(0, 0.3), (0.93, 0.3), (0.93, 0.5), (0, 0.5)], IVORY, 56)
    return inlaid(body, band - core, IVORY).scaled(d / 2, w / 2, h)


def figurine(d: float, w: float, h: float) -> Solid:
    """Return a sitting porcelain cat that looks to +x, on a small base."""
    white, ink = "#f1ece2", "#2b2d31"
    base = slab(d, 0.9 * w, 0.06 * h, 0.012, "#8a5a33")
    body = ellipsoid(0.72 * d, 0.62 * w, 0.66 * h, white).at(x=-0.08 * d, z=0.02 * h)
    chest = ellipsoid(0.42 * d, 0.42 * w, 0.6 * h, white).at(x=0.1 * d, z=0.05 * h)
    head = ellipsoid(0.46 * d, 0.48 * w, 0.34 * h, white).at(x=0.08 * d, z=0.58 * h)
    parts = [body, chest, head]
    for side in (-1, 1):
        ear = cylinder(0.1 * w, 0.17 * h, white, top=0.01 * w, n=12)
        parts.append(ear.at(0.06 * d, side * 0.14 * w, 0.83 * h))
        parts.append(ball(0.03 * w, ink, 12).at(0.28 * d, side * 0.09 * w, 0.75 * h))
        paw = ellipsoid(0.26 * d, 0.18 * w, 0.1 * h, white)
        parts.append(paw.at(0.3 * d, side * 0.13 * w, 0.05 * h))
        thigh = ellipsoid(0.5 * d, 0.28 * w, 0.3 * h, "#e3b07a")
        parts.append(thigh.at(-0.08 * d, side * 0.24 * w, 0.04 * h))
    nose = ball(0.022 * w, "#d98a86", 12).at(0.3 * d, 0, 0.69 * h)
    curl = [
        (x - 0.1 * d, y + 0.12 * w, 0.1 * h) for x, y in 0.34 * d * arc(1, 60, 220, 9)
    ]
    return union([base, *parts, nose, tube(curl, 0.035 * w, "#e3b07a", 12)])


def trash_bin(d: float, w: float, h: float) -> Solid:
    """Return an open waste-paper basket with slots in its wall and a rim."""
    r, t = d / 2, 0.02 * d
    shell = cylinder(0.78 * r, h, "#5b6168", top=0.97 * r, n=48)
    shell = shell - cylinder(0.78 * r - t, h, "#494e54", top=0.97 * r - t, n=48).at(
        z=0.02 * h
    )
    bars = [
        box(2 * d, 0.022 * d, 0.5 * h, "#6d747c").at(z=0.28 * h).turned(z=180 / 14 * k)
        for k in range(14)
    ]
    keep = cylinder(0.6 * r, 3 * h, "#494e54").at(z=-h)
    shell = shell - (union(bars) - keep)
    rim = revolved([(0.93, 0), (1, 0), (1, 1), (0.93, 1)], "#3f444a", 48)
    return (shell + rim.scaled(r, r, 0.05 * h).at(z=0.95 * h)).scaled(y=w / d)


def pedal_bin(d: float, w: float, h: float) -> Solid:
    """Return a closed steel bin with a domed lid and its pedal at +x."""
    r, steel = w / 2, "#c3c8cc"
    back = r - d / 2
    foot = cylinder(r, 0.06 * h, "#2b2d31").at(x=back)
    body = cylinder(0.95 * r, 0.78 * h, steel, n=48).at(x=back, z=0.05 * h)
    ring = cylinder(r, 0.04 * h, "#2b2d31", n=48).at(x=back, z=0.82 * h)
    dome = revolved(
        [(0, 0), (0.96, 0), (0.9, 0.4), (0.66, 0.78), (0.3, 0.97), (0, 1)],
        "#b4babf",
        48,
    )
    dome = dome.scaled(r, r, 0.14 * h).at(x=back, z=0.86 * h)
    pedal = slab(0.25 * d, 0.3 * w, 0.03 * h, 0.008, "#2b2d31").at(
        x=0.375 * d, z=0.015 * h
    )
    return union([foot, body, ring, dome, pedal])

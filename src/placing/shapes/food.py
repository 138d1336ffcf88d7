"""Shapes of food, loose and in packs."""

from placing.shapes.solids import (
    Solid,
    ball,
    box,
    cylinder,
    ellipsoid,
    hull,
    inlaid,
    profiled,
    revolved,
    slab,
    tube,
    union,
)

METAL = "#d5d9dc"


def fruit_bowl(d: float, w: float, h: float) -> Solid:
    """Return a wooden bowl heaped with apples, oranges, a pear and bananas."""
    r, rim = d / 2, 0.52 * h
    outer = [(0, 0), (0.5, 0), (0.8, 0.45), (1, 1), (0, 1)]
    inner = [(0, 0.12), (0.46, 0.12), (0.75, 0.5), (0.95, 1.01), (0, 1.01)]
    bowl = revolved(outer, "#9a6a3c", 48) - revolved(inner, "#b98552", 48)
    bowl = bowl.scaled(r, w / 2, rim)
    f = 0.135 * d
    heap = [(-0.24, 0.02, "#c23b30"), (-0.06, -0.24, "#e58a2b")]
    heap += [(0.16, 0.22, "#8fb545"), (-0.12, 0.24, "#e58a2b"), (0.22, -0.1, "#c23b30")]
    fruits = [fruit(f, colour).at(x * d, y * w, 0.24 * h) for x, y, colour in heap]
    pear = revolved(
        [(0, 0), (0.7, 0.1), (0.9, 0.4), (0.5, 0.8), (0.3, 1), (0, 1.05)], "#c7c04a", 24
    )
    pear = pear.scaled(0.9 * f, 0.9 * f, 1.9 * f).at(-0.02 * d, 0.0, 0.42 * h)
    curve = [
        (0.04, -0.34, 0.62),
        (0.14, -0.2, 0.76),
        (0.18, 0.0, 0.84),
        (0.14, 0.2, 0.80),
    ]
    bananas = [
        tube(
            [((x + k) * d, y * w, (z - 0.4 * k) * h) for x, y, z in curve],
            0.058 * d,
            "#efd052",
            16,
        )
        for k in (0.0, 0.1)
    ]
    return union([bowl, *fruits, pear, *bananas])


def fruit(radius: float, colour: str) -> Solid:
    """Return a round fruit with its stalk."""
    stalk = cylinder(0.08 * radius, 0.5 * radius, "#5b3a20", n=8).at(z=1.8 * radius)
    return ball(radius, colour, 24) + stalk


def bread(d: float, w: float, h: float) -> Solid:
    """Return a loaf along y, scored on top, one end of it cut open."""
    crust, crumb = "#c1813f", "#f0ddb0"
    low = slab(0.86 * d, w, 0.5 * h, 0.03, crust)
    top = hull(
        [
            ellipsoid(d, 0.3 * w, 0.66 * h, crust).at(y=k * w, z=0.34 * h)
            for k in (-0.35, 0.35)
        ],
        crust,
    )
    loaf = hull([low, low.scaled(0.96).at(z=0.02 * h)], crust) + top
    cut = box(2 * d, 0.1 * w, 2 * h, crumb).at(y=0.5 * w, z=-h / 2)
    scores = [
        box(0.7 * d, 0.03 * w, 0.14 * h, "#e8c88d").turned(z=28).at(y=k * w, z=0.95 * h)
        for k in (-0.26, -0.06, 0.14, 0.33)
    ]
    return loaf - cut - union(scores)


def cereal_box(d: float, w: float, h: float) -> Solid:
    """Return a cereal box whose printed front faces +x."""
    red, front = "#d9542b", d / 2 - 0.0008
    facts = box(0.8 * d, 2 * w, 0.5 * h, "#f5f2ea").at(z=0.2 * h)
    inner = box(2 * d, w - 0.002, h, red)
    body = inlaid(box(d, w, h, red), facts - inner, "#f5f2ea")
    body = inlaid(
        body, box(d, 0.9 * w, 0.24 * h, red).at(0.9 * d, z=0.66 * h), "#f7d64a"
    )
    disc = (
        cylinder(0.34 * w, 0.0016, "#f5f2ea", n=40).turned(y=90).at(front, z=0.33 * h)
    )
    bowl = disc - box(1, w, h, red).at(z=0.34 * h)
    places = [(k, 0.355) for k in range(6)] + [(k + 0.5, 0.39) for k in range(5)]
    flakes = [
        cylinder(0.055 * w, 0.0016, "#e0a03a", n=14)
        .turned(y=90)
        .at(front, (k - 2.5) * 0.1 * w, z * h)
        for k, z in places
    ]
    return union([body.scaled((d - 0.0016) / d), *flakes, bowl])


def soda_can(d: float, w: float, h: float) -> Solid:
    """Return a closed drinks can with a wave around it and its tab."""
    profile = [(0, 0.012), (0.7, 0.012), (0.76, 0), (0.82, 0), (0.99, 0.06)]
    profile += [(1, 0.08), (1, 0.9), (0.84, 0.965), (0.86, 0.98), (0.84, 1)]
    profile += [(0.8, 1), (0.78, 0.97), (0, 0.97)]
    body = revolved(profile, "#c8322c", 48).scaled(d / 2, w / 2, h)
    metal = box(2 * d, 2 * w, h, METAL)
    body = inlaid(body, metal.at(z=0.905 * h) + metal.at(z=-0.935 * h), METAL)
    wave = box(2 * d, 2 * w, 0.16 * h, "#f4f4f2").turned(x=24, y=10).at(z=0.41 * h)
    tab = slab(0.42 * d, 0.22 * d, 0.018 * h, 0.1 * d, "#a9afb4")
    return inlaid(body, wave, "#f4f4f2") + tab.at(x=0.08 * d, z=0.965 * h)


def milk_carton(d: float, w: float, h: float) -> Solid:
    """Return a gable-top carton with a screw cap on the slope that faces +x."""
    wall, ridge, seam, blue = 0.72 * h, 0.90 * h, 0.04 * d, "#3b7dbd"
    roof = [(-d / 2, 0), (d / 2, 0), (seam, ridge - wall), (-seam, ridge - wall)]
    gable = profiled(roof, w, blue).at(z=wall)
    fin = box(2 * seam, w, h - ridge, blue).at(z=ridge)
    cap = cylinder(0.2 * d, 0.05 * h, "#d9483b", n=24).turned(y=42)
    body = inlaid(box(d, w, wall, "#f6f6f2"), box(d, w, 0.26 * wall, blue), blue)
    body = inlaid(body, box(d, w, 0.03 * wall, blue).at(z=0.29 * wall), "#8fc1e8")
    splash = (
        cylinder(0.3 * w, 0.1, blue, n=32).turned(y=90).at(x=0.4 * d, z=0.66 * wall)
    )
    body = inlaid(body, splash, "#8fc1e8")
    return union([body, gable, fin, cap.at(0.22 * d, 0, wall + 0.08 * h)])


def bottle(d: float, w: float, h: float) -> Solid:
    """Return a corked bottle of green glass with a label."""
    profile = [(0, 0), (1, 0), (1, 0.58), (0.85, 0.66), (0.38, 0.76), (0.36, 0.95)]
    body = revolved([*profile, (0, 0.95)], "#2f5d43").scaled(d / 2, w / 2, h)
    body = inlaid(body, box(d, w, 0.26 * h, "#efe6cf").at(z=0.2 * h), "#efe6cf")
    return body + cylinder(0.16 * d, 0.07 * h, "#7b2f35").at(z=0.93 * h)

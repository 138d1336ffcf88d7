"""Shapes of what one types and points with; the user is at +x."""

from placing.shapes.solids import (
    Solid,
    box,
    cylinder,
    ellipsoid,
    extruded,
    hull,
    inlaid,
    union,
)


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

"""Shapes of glasses on a stem: a foot, a thin stem and a bowl, turned about z."""

from placing.shapes.solids import Solid, revolved

GLASS = "#cfe3ea"


def wine_glass(d: float, w: float, h: float) -> Solid:
    """Return a wine glass: an egg-shaped hollow bowl on a stem and a round foot."""
    foot = [(0, 0), (0.4 * d, 0), (0.4 * d, 0.004), (0.05 * d, 0.02)]
    outer = [(0.05 * d, 0.45 * h), (0.3 * d, 0.5 * h), (0.5 * d, 0.7 * h)]
    inner = [(0.42 * d, h), (0.4 * d, h), (0.47 * d, 0.7 * h), (0.28 * d, 0.53 * h)]
    return revolved([*foot, *outer, *inner, (0, 0.5 * h)], GLASS).scaled(y=w / d)


def martini_glass(d: float, w: float, h: float) -> Solid:
    """Return a martini glass: a conical hollow bowl on a stem and a round foot."""
    foot = [(0, 0), (0.36 * d, 0), (0.36 * d, 0.004)]
    stem = [(0.035 * d, 0.018), (0.035 * d, 0.55 * h)]
    bowl = [(0.5 * d, h), (0.475 * d, h), (0, 0.6 * h)]
    return revolved([*foot, *stem, *bowl], GLASS).scaled(y=w / d)

"""Whether the objects of a designer's room rest on something that a scan can find."""

from dataclasses import dataclass

import numpy as np
from shapely import Point, Polygon, distance

from placing.scene import Layout, Placement

Patch = tuple[Polygon, float]
"""Outline in the world and height [m] of something to stand on."""

HIGHEST_M = 0.03
# ASSUME: an object may reach this far below a patch, which is as flat as its scan.
DEEPEST_M = 0.015
ASIDE_M = 0.02
"""How far outside the outline of a patch the middle of an object may lie."""


@dataclass(frozen=True)
class SupportCheck:
    """What is below one object of a scene."""

    object_id: str
    category: str
    below: str
    """What the layout says is below."""
    gap_m: float
    """From the nearest patch up to the object; NaN where no patch is near."""
    is_supported: bool
    reason: str


def check_layout(layout: Layout, patches: list[Patch]) -> list[SupportCheck]:
    """Return what is below each object of the designers' arrangement."""
    objects = {item.object_id: item for item in layout.objects}
    placed = {p.object_id: p for p in layout.arrangements[0].placements}
    checks = []
    for name, placement in placed.items():
        if placement.area in placed:
            # A stack moves with its lowest object, which is checked on its own.
            gap, reason = 0.0, "stands on an object"
        else:
            bottom = placement.location[2] - objects[name].size_m[2] / 2
            gap, reason = find_gap(placement, bottom, patches)
        is_supported = reason in ("", "stands on an object")
        category = objects[name].category
        checks.append(
            SupportCheck(name, category, placement.area, gap, is_supported, reason)
        )
    return checks


def find_gap(
    placement: Placement, bottom: float, patches: list[Patch]
) -> tuple[float, str]:
    """Return the gap to the nearest patch [m] and why it is no support, if so."""
    middle = Point(placement.location[:2])
    gaps = np.array([bottom - height for _, height in patches])
    is_near = distance([polygon for polygon, _ in patches], middle) <= ASIDE_M
    fits = is_near & (gaps >= -DEEPEST_M) & (gaps <= HIGHEST_M)
    if fits.any():
        return float(gaps[fits][np.argmin(np.abs(gaps[fits]))]), ""
    is_level = (gaps >= -DEEPEST_M) & (gaps <= HIGHEST_M)
    if is_level.any():
        aside = distance([p for p, _ in np.array(patches, object)[is_level]], middle)
        if aside.min() < 0.3:
            return np.nan, f"{aside.min():.2f} m beside a patch of its height"
    if not is_near.any():
        return np.nan, "nothing below"
    gap = float(gaps[is_near][np.argmin(np.abs(gaps[is_near]))])
    return gap, "hovers above" if gap > 0 else "inside or below"

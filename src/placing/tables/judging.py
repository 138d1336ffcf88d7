"""The judge of Table 2: whether each object stands in a semantically correct place.

It is no part of the model: it looks at the true furniture of a layout and at a table
that people wrote, never at features, areas found in a cloud or labelled arrangements.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from shapely import Point, Polygon
from shapely.geometry.base import BaseGeometry

from placing.dressing import standing_shape
from placing.errors import unknown
from placing.rooms.arrangements import top_of
from placing.rooms.checks import footprint
from placing.scene import Layout, Placement, SceneObject, extents, resting_point
from placing.tables.correct_places import FLOOR, HUNG, NOTHING, CorrectPlaces, PlaceRow

# ASSUME: a placement in a noisy scan is at most so far off what it stands on.
NEAR_HEIGHT_M, NEAR_SIDEWAYS_M = 0.06, 0.05
LOWER_M = 1e-6
"""Guards the comparison of heights: what carries an object begins below it."""


@dataclass(frozen=True)
class Judged:
    """What the judge says of one object."""

    object_id: str
    category: str
    support: str
    """Kind of surface below it, or `nothing`."""
    room: str
    is_correct: bool
    row: PlaceRow
    """The row of the table that decided."""


@dataclass(frozen=True)
class Surface:
    """What can be below an object."""

    support: str
    outline: BaseGeometry
    height_m: float


@dataclass(frozen=True)
class Holder:
    """A piece of furniture in which things hang."""

    support: str
    outline: BaseGeometry
    low_m: float
    high_m: float


def judge(
    layout: Layout, placements: Iterable[Placement], table: CorrectPlaces
) -> list[Judged]:
    """Return the judgement of each object; who is not placed stands on nothing."""
    supports = supports_of(layout, placements, table)
    judged = []
    for item in layout.objects:
        support = supports.get(item.object_id, NOTHING)
        row = table.decision(item.category, support, layout.kind)
        what = item.object_id, item.category, support, layout.kind
        judged.append(Judged(*what, row.is_correct, row))
    return judged


def supports_of(
    layout: Layout, placements: Iterable[Placement], table: CorrectPlaces
) -> dict[str, str]:
    """Return the kind of surface below each placed object, below its stack if any."""
    items = {item.object_id: item for item in layout.objects}
    surfaces, holders = _surfaces(layout, table), _holders(layout, table)
    found: dict[str, str] = {}
    tops: list[tuple[float, Surface]] = []
    placed = [(_item(p, items), p) for p in placements]
    # From below, so that what carries an object is judged before it.
    for item, placement in sorted(placed, key=lambda e: resting_point(*e)[2]):
        bottom_m = float(resting_point(item, placement)[2])
        below = [top for low_m, top in tops if low_m < bottom_m - LOWER_M]
        at = Point(placement.location[:2])
        support = _below(at, bottom_m, surfaces, below)
        if support == NOTHING:
            support = _holder_of(item, placement, holders)
        found[item.object_id] = support
        top = top_of(placement, item)
        tops.append((bottom_m, Surface(support, top.patches_m[0], top.height_m)))
    return found


def _item(placement: Placement, items: dict[str, SceneObject]) -> SceneObject:
    """Return the object of a placement."""
    if placement.object_id not in items:
        raise unknown("object", placement.object_id, list(items))
    return items[placement.object_id]


def _surfaces(layout: Layout, table: CorrectPlaces) -> list[Surface]:
    """Return floor and true placing areas of all furniture."""
    ground = table.support(FLOOR, FLOOR, 0.0)
    surfaces = [Surface(ground, Polygon(layout.outline_m), 0.0)]
    for piece in layout.furniture:
        for patch in standing_shape(piece).supports:
            support = table.support(piece.kind, patch.name, patch.height_m)
            outline = Polygon(patch.polygon_m)
            surfaces.append(Surface(support, outline, patch.height_m))
    return surfaces


def _holders(layout: Layout, table: CorrectPlaces) -> list[Holder]:
    """Return the furniture in which things hang."""
    hung = {rule.furniture for rule in table.rules if rule.patch == HUNG}
    holders = []
    for piece in layout.furniture:
        if piece.kind in hung:
            low = float(piece.T_world_furniture[6])
            support = table.support(piece.kind, HUNG, low)
            outline = footprint(piece.size_m, piece.T_world_furniture)
            holders.append(Holder(support, outline, low, low + piece.size_m[2]))
    return holders


def _below(
    at: Point, bottom_m: float, surfaces: list[Surface], tops: list[Surface]
) -> str:
    """Return the kind of surface near the bottom of an object."""
    near = [s for s in surfaces if abs(s.height_m - bottom_m) <= NEAR_HEIGHT_M]
    carriers = [s for s in tops if abs(s.height_m - bottom_m) <= NEAR_HEIGHT_M]
    # Of surfaces one above the other the highest carries, as the tray of a dish rack
    # does on a counter: nothing reaches through it to the lower one.
    over = [s for s in [*near, *carriers] if s.outline.covers(at)]
    if over:
        return max(over, key=lambda s: s.height_m).support
    gaps_m = [(s.outline.distance(at), i) for i, s in enumerate(near)]
    gap_m, i = min(gaps_m, default=(float("inf"), 0))
    return near[i].support if gap_m <= NEAR_SIDEWAYS_M else NOTHING


def _holder_of(item: SceneObject, placement: Placement, holders: list[Holder]) -> str:
    """Return the holder in which an object hangs, or `nothing`."""
    half_m = extents(item, placement)[2] / 2
    low_m, high_m = placement.location[2] - half_m, placement.location[2] + half_m
    at = Point(placement.location[:2])
    for holder in holders:
        is_level = low_m < holder.high_m and holder.low_m < high_m
        if is_level and holder.outline.distance(at) <= NEAR_SIDEWAYS_M:
            return holder.support
    return NOTHING

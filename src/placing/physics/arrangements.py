"""Whether labelled arrangements are possible: inside, supported, apart and at rest."""

from collections.abc import Mapping
from dataclasses import dataclass

from shapely import MultiPoint, Polygon

from placing import rigid
from placing.dressing import WALLS
from placing.physics.bodies import Body, Piece
from placing.physics.cutting import fixed_of
from placing.physics.settling import SettleConfig, Settled, settle, unrest
from placing.rigid import Array
from placing.scene import Arrangement, Layout, Placement

TOLERANCE_M = 0.001
"""Guards the comparison of an outline with what touches it."""
FLOOR_M = 0.01
"""What is carried by walls below this height is carried by the floor."""


@dataclass(frozen=True)
class PlacementCheck:
    """What was found about one labelled placement."""

    scene: str
    labeller: str
    object: str
    is_inside: bool
    """Whether it lies within the walls, above the floor and below the ceiling."""
    support: str
    """What carries it in the end, names joined by `+`."""
    penetration_m: float
    """Deepest overlap with anything else."""
    moved_m: float
    tilted_deg: float
    stays: bool
    """Whether nothing is wrong with it."""
    reason: str
    """What is wrong with it; empty if it stays."""


def check_arrangements(
    layout: Layout, bodies: Mapping[str, Body], config: SettleConfig
) -> list[PlacementCheck]:
    """Return what is found about each placement of each arrangement of a room."""
    fixed = fixed_of(layout, config.margin_m)
    return [
        check
        for arrangement in layout.arrangements
        for check in check_arrangement(layout, arrangement, fixed, bodies, config)
    ]


def check_arrangement(
    layout: Layout,
    arrangement: Arrangement,
    fixed: Mapping[str, tuple[Piece, ...]],
    bodies: Mapping[str, Body],
    config: SettleConfig,
) -> list[PlacementCheck]:
    """Return what is found about each placement when all settle together."""
    poses = {p.object_id: p.T_world_object for p in arrangement.placements}
    placed = {name: (bodies[name], T) for name, T in poses.items()}
    settled = settle(fixed, placed, config)
    checks = []
    for placement in arrangement.placements:
        name = placement.object_id
        corners_m = rigid.apply(poses[name], bodies[name].corners_m)
        inside, end = is_inside(layout, corners_m), settled[name]
        support = supports_of(end, corners_m)
        reason = reason_of(placement, inside, support, end, config)
        checks.append(
            PlacementCheck(
                scene=layout.scene,
                labeller=arrangement.name,
                object=name,
                is_inside=inside,
                support="+".join(support),
                penetration_m=round(end.penetration_m, 4),
                moved_m=round(end.moved_m, 4),
                tilted_deg=round(end.tilted_deg, 2),
                stays=not reason,
                reason=reason,
            )
        )
    return checks


def is_inside(layout: Layout, corners_m: Array) -> bool:
    """Return whether all corners lie within the walls, the floor and the ceiling."""
    room = Polygon(layout.outline_m).buffer(TOLERANCE_M, join_style="mitre")
    low, high = corners_m[:, 2].min(), corners_m[:, 2].max()
    is_between = low >= -TOLERANCE_M and high <= layout.height_m + TOLERANCE_M
    return bool(is_between and room.covers(MultiPoint(corners_m[:, :2])))


def supports_of(settled: Settled, corners_m: Array) -> tuple[str, ...]:
    """Return the names of what carries an object, the floor by its own name."""
    is_low = corners_m[:, 2].min() < FLOOR_M
    return tuple(
        "floor" if name == WALLS and is_low else name for name in settled.supports
    )


def reason_of(
    placement: Placement,
    inside: bool,
    support: tuple[str, ...],
    settled: Settled,
    config: SettleConfig,
) -> str:
    """Return what is wrong with a placement, the cause before what follows from it."""
    if not inside:
        return "outside the room"
    if reason := unrest(settled, config):
        return reason
    if placement.area not in support:
        carrier = " and ".join(support) or "nothing"
        return f"not supported by {placement.area} but by {carrier}"
    return ""


# ASSUME: what the paper's Figure 3 shows of each kind of room, in categories.
NEEDED = {
    "kitchen": ("dishware", "food", "pan", "utensil"),
    "livingroom": ("book", "cushion", "decoration", "remote", "tv"),
    "office": ("book", "pen", "trash_bin"),
}
"""Categories that a room of each kind must hold an object of."""


def lacks(layout: Layout) -> list[str]:
    """Return a line for each category that a room of its kind needs and has not."""
    held = {item.category for item in layout.objects}
    return [
        f"{layout.scene}: no object of category {name}, as every {layout.kind} needs"
        for name in NEEDED.get(layout.kind, ())
        if name not in held
    ]


def complaints_about(layout: Layout, config: SettleConfig) -> list[str]:
    """Return a line for each rule that the arrangements of a room as a whole break."""
    least, most = config.min_arrangements, config.max_arrangements
    complaints = []
    if not least <= len(layout.arrangements) <= most:
        complaints.append(
            f"{layout.scene}: has {len(layout.arrangements)} arrangements, "
            f"expected {least} to {most}"
        )
    listed = {item.object_id for item in layout.objects}
    for arrangement in layout.arrangements:
        missing = listed - {p.object_id for p in arrangement.placements}
        complaints += [
            f"{layout.scene} {arrangement.name} {name}: not placed"
            for name in sorted(missing)
        ]
    return complaints

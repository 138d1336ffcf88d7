"""Whether an arrangement chosen from a scan holds among the true furniture.

An independent test of the joint placement: it sees the meshes that the scan was made
of, which no stage before it does.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from placing import rigid
from placing.physics.arrangements import is_inside, supports_of
from placing.physics.bodies import Body, Piece
from placing.physics.settling import SettleConfig, settle, unrest
from placing.scene import Layout, Placement


@dataclass(frozen=True)
class JointCheck:
    """What became of one object when all settled together."""

    object: str
    penetration_m: float
    moved_m: float
    tilted_deg: float
    support: str
    """What carries it in the end, names joined by `+`."""
    stays: bool
    reason: str
    """Why it does not stay; empty if it does."""


def check_joint(
    layout: Layout,
    placements: Sequence[Placement],
    fixed: Mapping[str, tuple[Piece, ...]],
    bodies: Mapping[str, Body],
    config: SettleConfig,
    reach_m: float,
) -> list[JointCheck]:
    """Return what becomes of each object when all are put down and let go together."""
    poses = {p.object_id: p.T_world_object for p in placements}
    placed = {name: (bodies[name], T) for name, T in poses.items()}
    checks = []
    for name, end in settle(fixed, placed, config, reach_m).items():
        corners_m = rigid.apply(poses[name], bodies[name].corners_m)
        reason = unrest(end, config)
        # A lamp may reach into the niche of a window; walls hold what they would cut.
        if not is_inside(layout, corners_m.mean(0, keepdims=True)):
            reason = "outside the room"
        checks.append(
            JointCheck(
                object=name,
                penetration_m=round(end.penetration_m, 4),
                moved_m=round(end.moved_m, 4),
                tilted_deg=round(end.tilted_deg, 2),
                support="+".join(supports_of(end, corners_m)),
                stays=not reason,
                reason=reason,
            )
        )
    return checks

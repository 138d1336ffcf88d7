"""Judge a certificate in a world of its own, without the planner.

The robot walks every path again, among the true furniture and the objects that stood
there, at a finer step than it was planned with: its joints keep their limits, nothing
touches what it may not, no part of the motion jumps, the object ends where it was to
end, and it stays there when it is let go.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from placing import rigid
from placing.physics.bodies import Body
from placing.physics.settling import SettleConfig
from placing.physics.simulator import add_fixed, new_world
from placing.robot.certificates import Certificate
from placing.robot.letting_go import Fixed, let_go, moved
from placing.robot.puppet import Puppet
from placing.robot.replay_config import ReplayConfig
from placing.robot.settings import RobotSettings
from placing.robot.walking import Failed, Walk


@dataclass(frozen=True)
class Verdict:
    """What was found about a certificate."""

    n_looks: int
    end_error_m: float
    """How far from its place it is let go, the height that it drops included."""
    end_error_deg: float
    moved_m: float
    """How far from its place it comes to rest."""
    tilted_deg: float
    reason: str
    """Where it fails and why; empty if it holds."""


def judge(
    walk: Walk,
    fixed: Fixed,
    bodies: Mapping[str, Body],
    settling: SettleConfig,
    reach_m: float,
) -> Verdict:
    """Return what is found about a certificate: walked, then let go at its end."""
    nothing = np.nan, np.nan, np.nan, np.nan
    try:
        end = walk.to_end()
    except Failed as failed:
        return Verdict(walk.n_looks, *nothing, str(failed))
    finally:
        walk.clear()
    certificate = walk.certificate
    error = rigid.difference(end, certificate.T_world_object)
    still = {
        other: tuple(moved(piece, bodies[other], T) for piece in bodies[other].pieces)
        for other, T in certificate.standing.items()
    }
    body = bodies[certificate.object_id]
    planned = certificate.T_world_object
    rest = let_go({**fixed, **still}, (body, end), planned, settling, reach_m)
    reason = unrest(*rest, settling)
    return Verdict(walk.n_looks, *error, rest[0], rest[2], reason)


def unrest(
    went_m: float,
    sank_m: float,
    turned_deg: float,
    speed_m_s: float,
    settling: SettleConfig,
) -> str:
    """Return why an object did not stay that was let go; empty if it stayed."""
    if max(went_m, abs(sank_m)) > settling.max_moved_m:
        return f"let go: comes to rest {went_m * 1e3:.0f} mm from its place"
    if turned_deg > settling.max_tilted_deg:
        return f"let go: comes to rest {turned_deg:.0f} deg from its place"
    if speed_m_s > settling.max_speed_m_s:
        return f"let go: still moves at {speed_m_s:.2f} m/s"
    return ""


def judge_all(
    certificates: Sequence[Certificate],
    settings: RobotSettings,
    fixed: Fixed,
    bodies: Mapping[str, Body],
    config: ReplayConfig,
    settling: SettleConfig,
    reach_m: float,
) -> list[Verdict]:
    """Return what is found about certificates of one scene, one after the other."""
    rates = settling.step_rate_hz, settling.friction, settling.margin_m
    with new_world(*rates) as world:
        for name, pieces in fixed.items():
            for piece in pieces:
                add_fixed(world, name, piece)
        puppet = Puppet(world.client, settings, is_fixed=False)
        return [
            judge(
                Walk(world, puppet, certificate, bodies, config),
                fixed,
                bodies,
                settling,
                reach_m,
            )
            for certificate in certificates
        ]

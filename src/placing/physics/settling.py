"""Whether objects stay where an arrangement puts them, by rigid-body simulation.

All bodies of an arrangement settle together, among furniture that does not move, in a
world made for this one trial. Soft furniture is rigid here, so that a cushion rests on
a seat and does not sink in.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.simulator import (
    World,
    add_body,
    add_fixed,
    deepest_overlap,
    motion,
    new_world,
    supports_of,
)
from placing.rigid import Array

LOOK_S = 0.0625
"""Simulated time from one look to the next, at what may have come to rest."""
RESTING_M_S, RESTING_M, RESTING_DEG = 0.005, 0.001, 0.3
"""What moves and turns less between three looks has come to rest."""
NO_AIMS: Mapping[str, Array] = MappingProxyType({})


@dataclass(frozen=True)
class SettleConfig:
    """What a trial is, and what an object may do in it; values: config/config.yaml."""

    duration_s: float
    """Simulated time."""
    step_rate_hz: float
    """Steps of the simulator in a second."""
    friction: float
    """Coefficient of Coulomb friction of a pair of bodies."""
    margin_m: float
    """Shell around convex pieces; they are shrunk by as much."""
    near_m: float
    """Furniture farther than this beside or above all objects is left out."""
    max_penetration_m: float
    """Deepest overlap before the first step."""
    max_moved_m: float
    """Farthest way of the centre of an object."""
    max_tilted_deg: float
    """Largest rotation about any axis."""
    max_drop_m: float
    """An object that sinks more than this fell."""
    max_speed_m_s: float
    """An object that is faster in the end did not come to rest."""
    min_arrangements: int
    """Fewest labelled arrangements of a room."""
    max_arrangements: int


@dataclass(frozen=True)
class Settled:
    """What one object did in a trial."""

    penetration_m: float
    """Deepest overlap with anything else before the first step."""
    penetrated: str
    """Name of what it overlaps with most; empty where it does not."""
    moved_m: float
    dropped_m: float
    tilted_deg: float
    speed_m_s: float
    supports: tuple[str, ...]
    """Names of what carries it in the end."""


def settle(
    fixed: Mapping[str, tuple[Piece, ...]],
    bodies: Mapping[str, tuple[Body, Array]],
    config: SettleConfig,
    reach_m: float = 0.0,
    aims: Mapping[str, Array] = NO_AIMS,
    until: str = "",
) -> dict[str, Settled]:
    """Return what each body does when it is let go at its pose `T_world_body`.

    `fixed` holds furniture in the frame of the world; poses are those of the meshes
    the bodies come from. The lowest first, bodies are put down before: moved up or down
    by at most `reach_m` until they touch. Motion is measured from there, or from where
    `aims` says that a body is to be. The trial is over when the body called `until` has
    come to rest, or else after its whole time.
    """
    with new_world(config.step_rate_hz, config.friction, config.margin_m) as world:
        for name, piece in near_pieces(fixed, bodies, config.near_m):
            add_fixed(world, name, piece)
        starts = {
            add_body(world, name, body, T_world_body): (body, T_world_body)
            for name, (body, T_world_body) in bodies.items()
        }
        if reach_m > 0:
            starts = put_down(world, starts, reach_m)
        pybullet.performCollisionDetection(world.client)
        overlaps = {i: deepest_overlap(world, i) for i in starts}
        watched = {i: start for i, start in starts.items() if world.names[i] == until}
        _let_pass(world, watched, config)
        return {
            world.names[i]: Settled(
                *overlaps[i],
                *motion(world, i, body, aims.get(world.names[i], T)),
                supports_of(world, i),
            )
            for i, (body, T) in starts.items()
        }


def _let_pass(
    world: World, watched: Mapping[int, tuple[Body, Array]], config: SettleConfig
) -> None:
    """Let the time of a trial pass, until the one body rests that may be watched."""
    looks: list[tuple[float, float, float, float]] = []
    n_look = round(LOOK_S * config.step_rate_hz)
    for n in range(1, round(config.duration_s * config.step_rate_hz) + 1):
        pybullet.stepSimulation(world.client)
        if n % n_look == 0:
            looks += [motion(world, i, *start) for i, start in watched.items()]
            if rests(looks[-3:]):
                return


def rests(looks: list[tuple[float, float, float, float]]) -> bool:
    """Return whether three looks in a row found an object at one place."""
    if len(looks) < 3:
        return False
    moved, _, turned, speed = np.array(looks).T
    return bool(
        speed[1:].max() < RESTING_M_S
        and np.ptp(moved) < RESTING_M
        and np.ptp(turned) < RESTING_DEG
    )


def near_pieces(
    fixed: Mapping[str, tuple[Piece, ...]],
    bodies: Mapping[str, tuple[Body, Array]],
    near_m: float,
) -> list[tuple[str, Piece]]:
    """Return the fixed pieces whose bounds come near those of a body or lie below."""
    points = [rigid.apply(T, body.corners_m) for body, T in bodies.values()]
    low = np.array([p.min(0) for p in points]) - near_m  # (n, 3)
    low[:, 2] = -np.inf
    high = np.array([p.max(0) for p in points]) + near_m
    return [
        (name, piece)
        for name, pieces in fixed.items()
        for piece in pieces
        if np.any(
            np.all(piece.vertices_m.max(0) >= low, axis=1)
            & np.all(piece.vertices_m.min(0) <= high, axis=1)
        )
    ]


def unrest(settled: Settled, config: SettleConfig) -> str:
    """Return why an object does not count as staying put; empty if it does."""
    if settled.penetration_m > config.max_penetration_m:
        return (
            f"penetrates {settled.penetrated} by {settled.penetration_m * 1e3:.0f} mm"
        )
    if settled.dropped_m > config.max_drop_m:
        return f"fell {settled.dropped_m * 1e3:.0f} mm"
    if settled.tilted_deg > config.max_tilted_deg:
        return f"tilted {settled.tilted_deg:.0f} deg"
    if settled.moved_m > config.max_moved_m:
        return f"moved {settled.moved_m * 1e3:.0f} mm"
    if settled.speed_m_s > config.max_speed_m_s:
        return f"still moves at {settled.speed_m_s:.2f} m/s"
    return ""

"""One object let go in a world of its own, watched only until its fate is clear.

The outcome is that of `settling.settle` over its whole time: an object that went too
far does not come back, and one that has come to rest stays there.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import pybullet

from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.settling import LOOK_S, SettleConfig, near_pieces, rests
from placing.physics.simulator import (
    add_body,
    add_fixed,
    deepest_overlap,
    motion,
    new_world,
)
from placing.rigid import Array


@dataclass(frozen=True)
class Watched:
    """What an object did, as far as it was watched."""

    penetration_m: float
    """Deepest overlap before the first step; who overlaps too much is not watched."""
    moved_m: float
    dropped_m: float
    tilted_deg: float
    speed_m_s: float
    stays: bool


def watch(
    fixed: Mapping[str, tuple[Piece, ...]],
    body: Body,
    T_world_body: Array,
    config: SettleConfig,
    reach_m: float,
) -> Watched:
    """Return what a body does that is put down and let go among furniture.

    It is moved up or down by at most `reach_m` before, until it touches.
    """
    with new_world(config.step_rate_hz, config.friction, config.margin_m) as world:
        for name, piece in near_pieces(
            fixed, {"body": (body, T_world_body)}, config.near_m
        ):
            add_fixed(world, name, piece)
        i = add_body(world, "body", body, T_world_body)
        if reach_m > 0:
            _, T_world_body = put_down(world, {i: (body, T_world_body)}, reach_m)[i]
        pybullet.performCollisionDetection(world.client)
        overlap_m = deepest_overlap(world, i)[0]
        if overlap_m > config.max_penetration_m:
            return Watched(overlap_m, 0.0, 0.0, 0.0, 0.0, False)
        looks: list[tuple[float, float, float, float]] = []
        for _ in range(round(config.duration_s / LOOK_S)):
            for _ in range(round(LOOK_S * config.step_rate_hz)):
                pybullet.stepSimulation(world.client)
            looks.append(motion(world, i, body, T_world_body))
            if went_too_far(looks[-1], config) or rests(looks[-3:]):
                break
    is_slow = looks[-1][3] <= config.max_speed_m_s
    is_fine = is_slow and not went_too_far(looks[-1], config)
    return Watched(overlap_m, *looks[-1], stays=is_fine)


def went_too_far(look: tuple[float, float, float, float], config: SettleConfig) -> bool:
    """Return whether an object went, sank or turned more than one that stays may."""
    return (
        look[0] > config.max_moved_m
        or look[1] > config.max_drop_m
        or look[2] > config.max_tilted_deg
    )

"""Where an object comes to rest that a robot lets go."""

from collections.abc import Mapping

import pybullet

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.settling import SettleConfig, near_pieces
from placing.physics.simulator import (
    add_body,
    add_fixed,
    deepest_overlap,
    motion,
    new_world,
)
from placing.rigid import Array

Fixed = Mapping[str, tuple[Piece, ...]]


def let_go(
    fixed: Fixed,
    placed: tuple[Body, Array],
    T_world_planned: Array,
    settling: SettleConfig,
    reach_m: float,
) -> tuple[float, float, float, float]:
    """Return how far from a pose a body comes to rest, as `simulator.motion` does.

    Where it overlaps with what carries it, it is lifted by at most `reach_m` before.
    """
    body, T = placed
    config = settling.step_rate_hz, settling.friction, settling.margin_m
    with new_world(*config) as world:
        for name, piece in near_pieces(fixed, {"": placed}, settling.near_m):
            add_fixed(world, name, piece)
        number = add_body(world, "", body, T)
        pybullet.performCollisionDetection(physicsClientId=world.client)
        if deepest_overlap(world, number)[0] > settling.max_penetration_m:
            put_down(world, {number: (body, T)}, reach_m)
        for _ in range(round(settling.duration_s * settling.step_rate_hz)):
            pybullet.stepSimulation(physicsClientId=world.client)
        return motion(world, number, body, T_world_planned)


def moved(piece: Piece, body: Body, T_world_body: Array) -> Piece:
    """Return a piece of a body in the world, where it stands still."""
    corners = rigid.apply(T_world_body, piece.vertices_m + body.mass_centre_m)
    return Piece(corners, piece.faces, piece.is_convex)

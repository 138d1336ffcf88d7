"""Worlds of the rigid-body simulator: made, filled and read.

Each trial has a world of its own: worlds that are used again give other results.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.rigid import Array

GRAVITY_M_S2 = 9.81
MAX_STEEPNESS = 0.5
"""Least z of the normal of a contact that carries: 60 degrees from level."""


@dataclass(frozen=True)
class World:
    """A client of the simulator and the names of what is in it."""

    client: int
    folder: Path
    """Private: the simulator reads compound shapes from files."""
    friction: float
    """Coefficient of Coulomb friction of a pair of bodies."""
    margin_m: float
    """Shell around convex pieces."""
    names: dict[int, str]
    """Of each body of the simulator."""


class Overlap(NamedTuple):
    """A point where two bodies overlap."""

    depth_m: float
    at_m: tuple[float, float, float]
    """In the world, on the other body."""
    normal: tuple[float, float, float]
    """From the other body."""


@contextmanager
def new_world(step_rate_hz: float, friction: float, margin_m: float) -> Iterator[World]:
    """Yield an empty world with gravity that is gone afterwards."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        with TemporaryDirectory(prefix="settling") as folder:
            pybullet.setGravity(0, 0, -GRAVITY_M_S2, physicsClientId=client)
            pybullet.setPhysicsEngineParameter(
                fixedTimeStep=1 / step_rate_hz,
                numSolverIterations=100,
                deterministicOverlappingPairs=1,
                enableFileCaching=0,
                physicsClientId=client,
            )
            yield World(client, Path(folder), friction, margin_m, {})
    finally:
        pybullet.disconnect(client)


def add_fixed(world: World, name: str, piece: Piece) -> int:
    """Return the number of a piece that does not move and is put into the world."""
    options = {}
    if not piece.is_convex:
        options = {
            "indices": piece.faces.ravel().tolist(),
            "flags": pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
        }
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_MESH,
        vertices=piece.vertices_m.tolist(),
        physicsClientId=world.client,
        **options,
    )
    i = pybullet.createMultiBody(0, shape, physicsClientId=world.client)
    pybullet.changeDynamics(
        i,
        -1,
        # The simulator multiplies the coefficients of the two bodies of a contact.
        lateralFriction=np.sqrt(world.friction),
        collisionMargin=world.margin_m if piece.is_convex else 0.0,
        physicsClientId=world.client,
    )
    world.names[i] = name
    return i


def add_body(world: World, name: str, body: Body, T_world_body: Array) -> int:
    """Return the number of a body that is put into the world at a pose."""
    w, x, y, z = T_world_body[:4]
    # The simulator keeps read files by name, so each body has a file of its own.
    path = world.folder / f"body{len(world.names)}.obj"
    path.write_text(wavefront(body.pieces))
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_MESH, fileName=str(path), physicsClientId=world.client
    )
    i = pybullet.createMultiBody(
        body.mass_kg,
        shape,
        basePosition=rigid.apply(T_world_body, body.mass_centre_m[None])[0],
        baseOrientation=(x, y, z, w),
        physicsClientId=world.client,
    )
    pybullet.changeDynamics(
        i,
        -1,
        lateralFriction=np.sqrt(world.friction),
        # ASSUME: what is round does not roll off by itself on a real table top.
        rollingFriction=0.001,
        spinningFriction=0.001,
        collisionMargin=world.margin_m,
        localInertiaDiagonal=body.inertia_kg_m2,
        physicsClientId=world.client,
    )
    world.names[i] = name
    return i


def wavefront(pieces: tuple[Piece, ...]) -> str:
    """Return the text of an OBJ file with an object per piece."""
    lines, n_before = [], 1
    for number, piece in enumerate(pieces):
        lines.append(f"o piece{number}")
        lines += [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in piece.vertices_m]
        lines += [f"f {a} {b} {c}" for a, b, c in piece.faces + n_before]
        n_before += len(piece.vertices_m)
    return "\n".join(lines) + "\n"


def near_pairs(world: World, i: int) -> list[tuple[int, int, int]]:
    """Return what may overlap with a body, sorted: its link, other body, link of that.

    Bodies are as the last collision detection found them; filtered pairs are left out.
    """
    # A contact of an earlier pose follows a body that is put elsewhere, and one with a
    # triangle takes the place of a deeper one with the next: how deep a contact is says
    # nothing, but no pair overlaps without one.
    return sorted({(c[3], c[2], c[4]) for c in contacts_of(world, i)})


def overlaps(world: World, i: int, pair: tuple[int, int, int]) -> list[Overlap]:
    """Return where a body overlaps with one of what is near it, asked anew."""
    link, other, other_link = pair
    points = pybullet.getClosestPoints(
        i, other, 0.0, link, other_link, physicsClientId=world.client
    )
    return [Overlap(-p[8], p[6], p[7]) for p in points]


def deepest_overlap(world: World, i: int) -> tuple[float, str]:
    """Return the deepest overlap of a body and the name of what it overlaps with."""
    depths = [
        (overlap.depth_m, pair[1])
        for pair in near_pairs(world, i)
        for overlap in overlaps(world, i, pair)
    ]
    depth, other = max(depths, default=(0.0, -1))
    return (depth, world.names[other]) if depth > 0 else (0.0, "")


def supports_of(world: World, i: int) -> tuple[str, ...]:
    """Return the sorted names of what carries a body."""
    contacts = contacts_of(world, i)
    carrying = [c for c in contacts if c[7][2] > MAX_STEEPNESS and c[9] > 0]
    return tuple(sorted({world.names[contact[2]] for contact in carrying}))


def contacts_of(world: World, i: int) -> tuple[tuple, ...]:
    """Return the contacts of a body: other body 2, normal 7, distance 8, force 9."""
    return pybullet.getContactPoints(bodyA=i, physicsClientId=world.client)


def motion(
    world: World, i: int, body: Body, T_world_start: Array
) -> tuple[float, float, float, float]:
    """Return how far a body went [m], sank [m], turned [deg] and its speed [m/s]."""
    position, (x, y, z, w) = pybullet.getBasePositionAndOrientation(i, world.client)
    velocity, _ = pybullet.getBaseVelocity(i, world.client)
    T_world_end = np.array([w, x, y, z, *position])
    T_world_end[4:] = rigid.apply(T_world_end, -body.mass_centre_m[None])[0]
    way_m, turned_deg = rigid.difference(T_world_end, T_world_start)
    sunk_m = float(T_world_start[6] - T_world_end[6])
    return way_m, sunk_m, turned_deg, float(np.linalg.norm(velocity))

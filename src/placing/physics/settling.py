"""Whether objects stay where an arrangement puts them, by rigid-body simulation.

All bodies of an arrangement settle together, among furniture that does not move, in a
world made for this one trial: worlds that are used again give other results. Soft
furniture is rigid here, so that a cushion rests on a seat and does not sink in.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.rigid import Array

GRAVITY_M_S2 = 9.81
MAX_STEEPNESS = 0.5
"""Least z of the normal of a contact that carries: 60 degrees from level."""


@dataclass(frozen=True)
class SettleConfig:
    """What a trial is, and what an object may do in it without being refused."""

    duration_s: float = 1.5
    """Simulated time."""
    time_step_s: float = 1 / 240
    friction: float = 0.7
    """Coefficient of Coulomb friction of a pair of bodies."""
    margin_m: float = 0.001
    """Shell around convex pieces; they are shrunk by as much."""
    near_m: float = 0.1
    """Furniture farther than this beside or above all objects is left out."""
    max_penetration_m: float = 0.003
    """Deepest overlap before the first step."""
    max_moved_m: float = 0.02
    """Farthest way of the centre of an object."""
    max_tilted_deg: float = 10.0
    """Largest rotation about any axis: a plate in a rack leans against its wire."""
    max_drop_m: float = 0.05
    """An object that sinks more than this fell."""
    max_speed_m_s: float = 0.05
    """An object that is faster in the end did not come to rest."""
    min_arrangements: int = 3
    """Fewest labelled arrangements of a room."""
    max_arrangements: int = 5


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


@dataclass(frozen=True)
class World:
    """A client of the simulator and the names of what is in it."""

    client: int
    folder: Path
    """Private: the simulator reads compound shapes from files."""
    names: dict[int, str]
    """Of each body of the simulator."""


def settle(
    fixed: Mapping[str, tuple[Piece, ...]],
    bodies: Mapping[str, tuple[Body, Array]],
    config: SettleConfig,
) -> dict[str, Settled]:
    """Return what each body does when it is let go at its pose `T_world_body`.

    `fixed` holds furniture in the frame of the world; poses are those of the meshes
    the bodies come from.
    """
    with new_world(config) as world:
        for name, piece in near_pieces(fixed, bodies, config.near_m):
            add_fixed(world, name, piece, config)
        starts = {
            add_body(world, name, body, T_world_body, config): (body, T_world_body)
            for name, (body, T_world_body) in bodies.items()
        }
        pybullet.performCollisionDetection(world.client)
        overlaps = {i: deepest_overlap(world, i) for i in starts}
        for _ in range(round(config.duration_s / config.time_step_s)):
            pybullet.stepSimulation(world.client)
        return {
            world.names[i]: Settled(
                *overlaps[i], *motion(world, i, body, T), supports_of(world, i)
            )
            for i, (body, T) in starts.items()
        }


@contextmanager
def new_world(config: SettleConfig) -> Iterator[World]:
    """Yield an empty world with gravity that is gone afterwards."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        with TemporaryDirectory(prefix="settling") as folder:
            pybullet.setGravity(0, 0, -GRAVITY_M_S2, physicsClientId=client)
            pybullet.setPhysicsEngineParameter(
                fixedTimeStep=config.time_step_s,
                numSolverIterations=100,
                deterministicOverlappingPairs=1,
                enableFileCaching=0,
                physicsClientId=client,
            )
            yield World(client, Path(folder), {})
    finally:
        pybullet.disconnect(client)


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


def add_fixed(world: World, name: str, piece: Piece, config: SettleConfig) -> None:
    """Put a piece that does not move into the world."""
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
        lateralFriction=np.sqrt(config.friction),
        collisionMargin=config.margin_m if piece.is_convex else 0.0,
        physicsClientId=world.client,
    )
    world.names[i] = name


def add_body(
    world: World, name: str, body: Body, T_world_body: Array, config: SettleConfig
) -> int:
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
        lateralFriction=np.sqrt(config.friction),
        # ASSUME: what is round does not roll off by itself on a real table top.
        rollingFriction=0.001,
        spinningFriction=0.001,
        collisionMargin=config.margin_m,
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


def deepest_overlap(world: World, i: int) -> tuple[float, str]:
    """Return the deepest overlap of a body and the name of what it overlaps with."""
    depths = [(-contact[8], contact[2]) for contact in contacts_of(world, i)]
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
    way = T_world_end[4:] - T_world_start[4:]
    cosine = min(1.0, abs(T_world_end[:4] @ T_world_start[:4]))
    turned_deg = np.rad2deg(2 * np.arccos(cosine))
    distances = np.linalg.norm(way), -way[2], turned_deg, np.linalg.norm(velocity)
    return tuple(float(value) for value in distances)  # type: ignore[return-value]

"""Questions to sample: a made-up full scene, or the poses of a real one.

Objects are drawn around people who stand at a few spots, one kind of object at a time,
so that their potentials agree on few poses, as in a furnished room.

Shapes: n objects, q poses, p placements.
"""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.people import dpmm
from placing.people.human import HumanPoses, headings, prior_of
from placing.people.potential import Theta, log_psi_human
from placing.people.valid_poses import neighbours_first

Array = NDArray[np.float64]

N_SUMMED = 64
"""Placements that the row of an unplaced object adds up; only its shape matters."""
OBJECTS_PER_SPOT = 4


@dataclass(frozen=True)
class Question:
    """Objects with their potentials; the last object is the one to place."""

    thetas: tuple[Theta, ...]
    """(n,) how people use each object."""
    objects: Array
    """(n, 4) x, y, z and yaw."""
    poses: Array
    """(q, 5) x, y, z, cosine and sine of the yaw."""
    prior: Array
    """(q,) P0."""
    placements: Array
    """(p, 4) where the last object may be: x, y, z and yaw."""
    rows: NDArray[np.float32]
    """(n, q) potential of each object; of the last one, summed over placements."""


def full_scene(n_objects: int = 17, n_poses: int = 80_000, seed: int = 0) -> Question:
    """Return a question about a made-up room with about `n_poses` poses."""
    kind, yaw = np.arange(3), headings(8)
    side = np.arange(round((n_poses / len(kind) / len(yaw)) ** 0.5)) * 0.1
    grid = np.stack(np.meshgrid(kind, yaw, side, side, indexing="ij"), -1)
    kind, yaw, x, y = grid.reshape(-1, 4).astype(float).T
    location = np.column_stack([x, y, np.zeros(len(x))])
    kind = kind.astype(np.uint8)
    order = neighbours_first(kind, location, yaw)
    kind, location, yaw = kind[order], location[order], yaw[order]
    poses = HumanPoses(kind, location, yaw, prior_of(kind))
    free = np.stack(np.meshgrid(side, side, [0.75], yaw[:1], indexing="ij"), -1)
    places = free.reshape(-1, 4)[:, :3]
    return ask(np.random.default_rng(seed), poses, places, n_objects)


def ask(rng: Generator, poses: HumanPoses, places: Array, n_objects: int) -> Question:
    """Return a question about objects on `places` (p, 3) near people of a scene."""
    references = poses.references()
    spots = rng.choice(
        len(references), -(-n_objects // OBJECTS_PER_SPOT), p=poses.prior
    )
    thetas = tuple(_theta(rng) for _ in range(n_objects))
    yaw = np.tile(headings(8), len(places))
    placements = np.column_stack([np.repeat(places, 8, axis=0), yaw])  # (p, 4)
    objects = np.empty((n_objects, 4))
    for i, theta in enumerate(thetas):
        person = references[spots[i % len(spots)]][None]
        weight = np.exp(_log_psi(theta, placements, person)[:, 0].astype(float))
        objects[i] = rng.choice(placements, p=weight / weight.sum())
    rows = [
        _log_psi(t, o[None], references) for t, o in zip(thetas, objects, strict=True)
    ]
    rows = dpmm.weight_rows(np.concatenate(rows))
    summed = rng.choice(placements, min(N_SUMMED, len(placements)), replace=False)
    rows[-1] = dpmm.scale_row(_sum_psi(thetas[-1], summed, references))
    return Question(thetas, objects, references, poses.prior, placements, rows)


def _theta(rng: Generator) -> Theta:
    """Return how people use a made-up object: within reach and in front of them."""
    distance, height = np.log(rng.uniform(0.3, 1.2)), rng.uniform(-0.6, 0.1)
    bearing, heading = rng.normal(0, 0.5), np.pi + rng.normal(0, 0.5)
    return Theta(distance, 0.4, bearing, 3.0, height, 0.2, heading, 2.0)


def _log_psi(theta: Theta, objects: Array, poses: Array) -> NDArray[np.float32]:
    """Return log Psi_human of objects that have a front, shape (n, q)."""
    return log_psi_human(theta, objects, np.ones(len(objects), np.bool_), poses)


def _sum_psi(theta: Theta, placements: Array, poses: Array) -> Array:
    """Return the sum of Psi_human over placements, shape (q,)."""
    blocks = [np.exp(_log_psi(theta, p[None], poses)[0]) for p in placements]
    return np.sum(blocks, axis=0, dtype=float)

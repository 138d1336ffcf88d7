"""Meshes of people and of densities, to be drawn into the picture of a room.

Shapes: k people, p places.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import matplotlib as mpl
import numpy as np
import trimesh
from numpy.typing import NDArray

from placing.people import skeleton
from placing.pictures.shading import joined

Array = NDArray[np.float64]
Colour = tuple[int, int, int]

# SOURCE: Paul Tol, "Colour schemes", bright, which colour-blind people tell apart too.
KIND_COLOURS: dict[str, Colour] = {
    "sitting_upright": (68, 119, 170),
    "sitting_reclined": (102, 204, 238),
    "sitting_forward": (34, 136, 51),
    "reaching": (170, 51, 119),
    "standing": (238, 102, 119),
    "leaning_forward": (204, 187, 68),
}
N_SIDES = 16
"""Of a limb; more do not look rounder."""
HEAT = "turbo"
"""Colour map of densities."""
COLD = 0.03
"""Places below this share of the highest density are not drawn."""
LIFT_M = 0.004
"""Heat lies so much above the area, to not flicker with it."""


@dataclass(frozen=True)
class Person:
    """One human pose."""

    kind: str
    location: Array
    """(3,) of the pose's origin [m]."""
    yaw: float
    n_objects: int = 0
    """Objects that it explains; 0 where that is unknown."""

    def joints(self) -> Array:
        """Return the joints in the world, shape (15, 3) [m]."""
        location, yaw = self.location[None], np.array([self.yaw])
        return skeleton.place(self.kind, location, yaw)[0]


def body(person: Person, thickness: float = 1.0, detail: int = 2) -> trimesh.Trimesh:
    """Return the body of a person as capsules in the colour of the kind.

    Joints are balls of 20 * 4**detail triangles.
    """
    joints, radii = person.joints(), thickness * skeleton.RADIUS_M
    balls = [ball(at, r, detail) for at, r in zip(joints, radii, strict=True)]
    limbs = [limb(joints[a], joints[b], radii[a], radii[b]) for a, b in skeleton.BONES]
    return painted(joined([*balls, *limbs]), KIND_COLOURS[person.kind])


def ball(centre: Array, radius: float, detail: int) -> trimesh.Trimesh:
    """Return a ball of 20 * 4**detail triangles."""
    unit = _unit_ball(detail)
    return trimesh.Trimesh(centre + radius * unit.vertices, unit.faces, process=False)


@cache
def _unit_ball(detail: int) -> trimesh.Trimesh:
    """Return a ball of radius 1 around the origin."""
    return trimesh.creation.icosphere(detail, 1.0)


def limb(start: Array, end: Array, start_m: float, end_m: float) -> trimesh.Trimesh:
    """Return a round limb between two points, open at its ends."""
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    aside = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    aside /= np.linalg.norm(aside)
    turn = 2 * np.pi * np.arange(N_SIDES) / N_SIDES
    ring = np.outer(np.cos(turn), aside) + np.outer(
        np.sin(turn), np.cross(along, aside)
    )
    vertices = np.concatenate([start + start_m * ring, end + end_m * ring])
    here = np.arange(N_SIDES)
    then = (here + 1) % N_SIDES
    lower = np.column_stack([here, then, then + N_SIDES])
    upper = np.column_stack([here, then + N_SIDES, here + N_SIDES])
    return trimesh.Trimesh(vertices, np.concatenate([lower, upper]), process=False)


def heat(places: Array, density: Array, spacing_m: float) -> trimesh.Trimesh:
    """Return a tile per place, coloured by its density; cold places have none.

    `places` (p, 3) on a lattice of `spacing_m`, `density` (p,).
    """
    relative = density / max(float(density.max(initial=0)), 1e-300)
    warm = np.flatnonzero(relative > COLD)
    half = spacing_m / 2
    corners = half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    vertices = places[warm][:, None] + corners + [0, 0, LIFT_M]  # (p, 4, 3)
    first = 4 * np.arange(len(warm))[:, None]
    halves = np.array([[0, 1, 2], [0, 2, 3]])
    faces = np.concatenate([first + half for half in halves])
    colours = np.tile(mpl.colormaps[HEAT](relative[warm], bytes=True), (2, 1))
    return trimesh.Trimesh(
        vertices.reshape(-1, 3), faces, face_colors=colours, process=False
    )


def painted(mesh: trimesh.Trimesh, colour: Sequence[int]) -> trimesh.Trimesh:
    """Return the mesh in one colour."""
    colours = np.tile(np.array([*colour, 255], np.uint8), (len(mesh.faces), 1))
    return trimesh.Trimesh(
        mesh.vertices, mesh.faces, face_colors=colours, process=False
    )

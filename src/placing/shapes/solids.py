"""Coloured solids and how to join them: what object shapes are built from.

Every primitive stands on z = 0 and is centred in x and y. Booleans are those of
manifold3d, so a union has no inner walls and is watertight; each face keeps the colour
of the primitive that it comes from, and a cut shows the colour of the cutter.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import trimesh
from manifold3d import CrossSection, FillRule, JoinType, Manifold, Mesh64, OpType
from numpy.typing import NDArray

Points = Sequence[tuple[float, ...]] | NDArray[np.float64]
SEGMENTS = 40
"""Corners of a full circle: enough for a smooth outline at the size of a picture."""


@dataclass(frozen=True)
class Solid:
    """A closed solid whose faces are coloured by the primitive they come from."""

    manifold: Manifold
    colours: dict[int, str] = field(default_factory=dict)
    """Colour `#rrggbb` of each primitive, by its number in the manifold."""

    def at(self, x: float = 0, y: float = 0, z: float = 0) -> "Solid":
        """Return the solid moved by (x, y, z) [m]."""
        return Solid(self.manifold.translate((x, y, z)), self.colours)

    def turned(self, x: float = 0, y: float = 0, z: float = 0) -> "Solid":
        """Return the solid turned about x, then y, then z, in degrees."""
        return Solid(self.manifold.rotate((x, y, z)), self.colours)

    def scaled(self, x: float = 1, y: float = 1, z: float = 1) -> "Solid":
        """Return the solid stretched along the axes."""
        return Solid(self.manifold.scale((x, y, z)), self.colours)

    def __add__(self, other: "Solid") -> "Solid":
        """Return the union of both."""
        return union([self, other])

    def __sub__(self, other: "Solid") -> "Solid":
        """Return what is left when `other` is cut away."""
        return Solid(self.manifold - other.manifold, self.colours | other.colours)

    def __xor__(self, other: "Solid") -> "Solid":
        """Return what both have in common."""
        return Solid(self.manifold ^ other.manifold, self.colours | other.colours)


def painted(manifold: Manifold, colour: str) -> Solid:
    """Return the manifold as a solid of one colour."""
    original = manifold.as_original()
    return Solid(original, {original.original_id(): colour})


def inlaid(body: Solid, where: Solid, colour: str) -> Solid:
    """Return the body with the part of its surface inside `where` in another colour."""
    inside = painted((body ^ where).manifold, colour)
    return (body - where) + inside


def union(solids: Sequence[Solid]) -> Solid:
    """Return the union of many solids."""
    colours = {number: c for solid in solids for number, c in solid.colours.items()}
    manifolds = [solid.manifold for solid in solids]
    return Solid(Manifold.batch_boolean(manifolds, OpType.Add), colours)


def hull(solids: Sequence[Solid], colour: str) -> Solid:
    """Return the convex hull of many solids in one colour."""
    return painted(Manifold.batch_hull([solid.manifold for solid in solids]), colour)


def box(x: float, y: float, z: float, colour: str) -> Solid:
    """Return a box of the given size [m]."""
    cube = Manifold.cube((x, y, z), True).translate((0, 0, z / 2))
    return painted(cube, colour)


def slab(x: float, y: float, z: float, radius: float, colour: str) -> Solid:
    """Return a box whose upright edges are rounded by `radius` [m]."""
    inner = CrossSection.square((x - 2 * radius, y - 2 * radius), True)
    outline = inner.offset(radius, JoinType.Round, 2.0, SEGMENTS // 2)
    return painted(Manifold.extrude(outline, z), colour)


def pebble(x: float, y: float, z: float, radius: float, colour: str) -> Solid:
    """Return a box all of whose edges are rounded by `radius` [m]."""
    ball_ = Manifold.sphere(radius, 16)
    corners = [
        ball_.translate((a * (x / 2 - radius), b * (y / 2 - radius), c))
        for a in (-1, 1)
        for b in (-1, 1)
        for c in (radius, z - radius)
    ]
    return painted(Manifold.batch_hull(corners), colour)


def cylinder(
    radius: float, height: float, colour: str, top: float = -1, n: int = SEGMENTS
) -> Solid:
    """Return an upright cylinder, or a cone with the radius `top` above [m]."""
    return painted(Manifold.cylinder(height, radius, top, n), colour)


def ball(radius: float, colour: str, n: int = 24) -> Solid:
    """Return a sphere that stands on z = 0 [m]."""
    return painted(Manifold.sphere(radius, n).translate((0, 0, radius)), colour)


def ellipsoid(x: float, y: float, z: float, colour: str, n: int = 24) -> Solid:
    """Return an ellipsoid of the given size that stands on z = 0 [m]."""
    unit = Manifold.sphere(0.5, n).scale((x, y, z)).translate((0, 0, z / 2))
    return painted(unit, colour)


def extruded(outline: Points, height: float, colour: str) -> Solid:
    """Return the prism over an outline in x and y [m]."""
    section = CrossSection([np.asarray(outline, float)], FillRule.NonZero)
    return painted(Manifold.extrude(section, height), colour)


def profiled(outline: Points, width: float, colour: str) -> Solid:
    """Return the prism of an outline in x and z, centred along y [m]."""
    prism = extruded(outline, width, colour)
    return prism.turned(x=90).at(y=width / 2)


def revolved(profile: Points, colour: str, n: int = SEGMENTS) -> Solid:
    """Return the solid of a closed outline in (radius, z) turned about z [m]."""
    section = CrossSection([np.asarray(profile, float)], FillRule.NonZero)
    return painted(section.revolve(n), colour)


def tube(path: Points, radius: float, colour: str, n: int = 12) -> Solid:
    """Return a round bar along a polyline in space [m]."""
    ball_ = Manifold.sphere(radius, n)
    beads = [ball_.translate((float(x), float(y), float(z))) for x, y, z in path]
    links = [Manifold.batch_hull(pair) for pair in pairwise(beads)]
    return painted(Manifold.batch_boolean(links, OpType.Add), colour)


def arc(
    radius: float, start_deg: float, stop_deg: float, n: int = 12
) -> NDArray[np.float64]:
    """Return points on a circle about the origin, shape (n, 2) [m]."""
    angle = np.radians(np.linspace(start_deg, stop_deg, n))
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def mesh_of(solid: Solid, size_m: Sequence[float]) -> trimesh.Trimesh:
    """Return the solid as a mesh stretched to `size_m` and centred on its box."""
    source = solid.manifold.to_mesh64()
    vertices = np.asarray(source.vert_properties, float)[:, :3]
    faces = np.asarray(source.tri_verts, np.int64).reshape(-1, 3)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    vertices = (vertices - (low + high) / 2) / (high - low) * np.asarray(size_m)
    colours = face_colours(solid, source, len(faces))
    return trimesh.Trimesh(vertices, faces, face_colors=colours, process=False)


def face_colours(solid: Solid, source: Mesh64, n_faces: int) -> NDArray[np.uint8]:
    """Return the colour of each face, shape (n_faces, 4)."""
    colours = np.full((n_faces, 4), 255, np.uint8)
    starts = np.asarray(source.run_index) // 3
    numbers = source.run_original_id
    for number, start, stop in zip(numbers, starts[:-1], starts[1:], strict=True):
        colours[start:stop, :3] = rgb(solid.colours[number])
    return colours


def rgb(colour: str) -> tuple[int, ...]:
    """Return `#rrggbb` as three numbers of 0 to 255."""
    return tuple(bytes.fromhex(colour.removeprefix("#")))

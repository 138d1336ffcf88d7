"""Coloured solids that furniture is built of, and their union into one closed mesh.

Intervals (low, high) along x, y and z say where a part is, in metres in the frame of
the furniture. A part whose interval is empty vanishes: a piece of furniture that is
too small for a detail is built without it.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf

import numpy as np
import trimesh
from manifold3d import CrossSection, Manifold, OpType
from numpy.typing import NDArray

from placing.shapes.shape import Shape, Support

Interval = tuple[float, float]
Colour = tuple[int, int, int]
Array = NDArray[np.float64]

# ASSUME: nothing stands on a patch narrower than this, so it is no support.
NARROWEST_M = 0.1


@dataclass(frozen=True)
class Part:
    """A solid of one colour."""

    solid: Manifold
    colour: Colour


def box(x: Interval, y: Interval, z: Interval, colour: Colour) -> Part:
    """Return a box."""
    low, high = np.array([x, y, z]).T
    if np.any(high - low <= 0):
        return Part(Manifold(), colour)
    return Part(Manifold.cube(high - low).translate(low), colour)


def cushion(
    x: Interval, y: Interval, z: Interval, colour: Colour, radius: float = 0.03
) -> Part:
    """Return a box with rounded edges and flat faces."""
    low, high = np.array([x, y, z]).T
    if np.any(high - low <= 0):
        return Part(Manifold(), colour)
    radius = min(radius, 0.4 * float(np.min(high - low)))
    arc = np.linspace(0, np.pi / 2, 4)
    # One eighth of a sphere in every corner; the hull joins them.
    eighth = np.array([[i, j] for i in arc for j in arc])
    ball = np.stack(
        [
            np.sin(eighth[:, 0]) * np.cos(eighth[:, 1]),
            np.sin(eighth[:, 0]) * np.sin(eighth[:, 1]),
            np.cos(eighth[:, 0]),
        ],
        axis=1,
    )  # (16, 3)
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    centres = (low + high) / 2 + signs * ((high - low) / 2 - radius)  # (8, 3)
    points = centres[:, None] + radius * signs[:, None] * ball
    return Part(Manifold.hull_points(points.reshape(-1, 3)), colour)


def prism(polygon_m: Array, z: Interval, colour: Colour, taper: float = 1.0) -> Part:
    """Return an upright prism; its top is its bottom scaled by `taper` about z."""
    if z[1] <= z[0]:
        return Part(Manifold(), colour)
    section = CrossSection([np.asarray(polygon_m, float)])
    solid = Manifold.extrude(section, z[1] - z[0], scale_top=(taper, taper))
    return Part(solid.translate((0.0, 0.0, z[0])), colour)


def hull(points_m: Array | list, colour: Colour) -> Part:
    """Return the convex hull of points, which may be slanted."""
    return Part(Manifold.hull_points(np.asarray(points_m, float)), colour)


def cylinder(
    centre: tuple[float, float],
    radius: float | tuple[float, float],
    z: Interval,
    colour: Colour,
    taper: float = 1.0,
    n: int = 24,
) -> Part:
    """Return an upright cylinder, or a cone where the top is scaled by `taper`."""
    part = prism(ellipse(radius, n), z, colour, taper)
    return Part(part.solid.translate((*centre, 0.0)), colour)


def rod(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    radius: float,
    colour: Colour,
    end_radius: float | None = None,
    n: int = 10,
) -> Part:
    """Return a round rod between two points, which need not be upright."""
    a, b = np.array(start, float), np.array(end, float)
    axis = (b - a) / np.linalg.norm(b - a)
    # Any direction that is not along the axis spans the cross-section with it.
    aside = np.cross(axis, [0.0, 0.0, 1.0] if abs(axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    aside /= np.linalg.norm(aside)
    ring = ellipse(1.0, n) @ np.stack([aside, np.cross(axis, aside)])  # (n, 3)
    last = radius if end_radius is None else end_radius
    return hull(np.concatenate([a + radius * ring, b + last * ring]), colour)


def cut(part: Part, *tools: Part) -> Part:
    """Return the part without what the tools take away."""
    solids = [part.solid, *(tool.solid for tool in tools)]
    return Part(Manifold.batch_boolean(solids, OpType.Subtract), part.colour)


def quarter_turn(part: Part) -> Part:
    """Return the part turned by a right angle about z: its front +x becomes +y."""
    return Part(part.solid.rotate((0.0, 0.0, 90.0)), part.colour)


def rectangle(x: Interval, y: Interval) -> Array:
    """Return the corners of a rectangle counter-clockwise, shape (4, 2) [m]."""
    return np.array([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], float)


def ellipse(radius: float | tuple[float, float], n: int = 24) -> Array:
    """Return the corners of a round polygon counter-clockwise, shape (n, 2) [m]."""
    angle = 2 * np.pi * np.arange(n) / n
    unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return unit * np.asarray(radius, np.float64)


def patch(
    name: str,
    x: Interval,
    y: Interval,
    height: float,
    clearance: float = inf,
    softness: float = 0.0,
) -> list[Support]:
    """Return a rectangular support, or none where it is too narrow or too low."""
    if min(x[1] - x[0], y[1] - y[0], clearance) < NARROWEST_M:
        return []
    return [Support(name, rectangle(x, y), height, clearance, softness)]


def assemble(parts: Iterable[Part], supports: Iterable[Support] = ()) -> Shape:
    """Return the union of the parts as one closed mesh; supports from below."""
    ordered = sorted(supports, key=lambda support: support.height_m)
    return Shape(union(parts), tuple(ordered))


def union(parts: Iterable[Part]) -> trimesh.Trimesh:
    """Return the union of the parts as one closed mesh with the parts' colours."""
    solids, colour_of = [], {}
    for part in parts:
        if part.solid.is_empty():
            continue
        is_original = part.solid.original_id() >= 0
        solids.append(part.solid if is_original else part.solid.as_original())
        colour_of[solids[-1].original_id()] = (*part.colour, 255)
    joined = Manifold.batch_boolean(solids, OpType.Add).to_mesh64()
    n_faces = np.diff(np.asarray(joined.run_index)) // 3
    colours = np.array([colour_of[run] for run in joined.run_original_id], np.uint8)
    return trimesh.Trimesh(
        vertices=np.array(joined.vert_properties[:, :3]),
        faces=np.array(joined.tri_verts, np.int64),
        face_colors=np.repeat(colours, n_faces, axis=0),
        process=False,
    )

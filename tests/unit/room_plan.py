"""Whether a room can be lived in: what a designer checks on the floor plan.

Each check returns one line per fault. Furniture counts with its mesh, so that an open
drawer takes its room and a chair may reach under a table.
"""

from dataclasses import dataclass
from itertools import combinations

import manifold3d
import numpy as np
import shapely
import trimesh
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from placing import rigid
from placing.dressing import standing_shape
from placing.rooms.checks import footprint
from placing.scene import Array, Furniture, Layout, Opening
from placing.shapes.building import wall_axes

HANGING = ("open_shelf", "picture", "wall_cabinet", "whiteboard", "window_sill")
SEATS = ("armchair", "bar_stool", "bed", "bench", "chair", "corner_couch", "couch")
SEATS += ("office_chair", "stool")
LOOKED_AT = ("floor_lamp", "plant")
"""Furniture that nobody has to get to."""

WALKWAY_M = 0.6
"""Width of the narrowest walkway."""
ARM_M = 0.15
"""How far from the edge of a walkway furniture may be and still be reached."""
SEAT_GAP_M = 0.4
"""How far from a table a seat may stand and still belong to it."""
DOORWAY_M = 0.8
"""Depth of the floor behind a door that stays free."""
CRUMB_M3 = 2e-5
"""Guards the comparison of meshes that touch: the volume of a sugar cube or two."""


@dataclass(frozen=True)
class Solid:
    """A piece of furniture as it stands in the world."""

    piece: Furniture
    mesh: trimesh.Trimesh
    outline: BaseGeometry
    """What it covers seen from above [m]."""


def solid_of(piece: Furniture) -> Solid:
    """Return a piece of furniture as a mesh in the world."""
    mesh = standing_shape(piece).mesh
    return Solid(piece, mesh, outline_of(mesh))


def outline_of(mesh: trimesh.Trimesh) -> BaseGeometry:
    """Return what a closed mesh covers seen from above, holes filled [m]."""
    vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    solid = manifold3d.Manifold(manifold3d.Mesh(vertices, faces))
    rings = solid.project().to_polygons()
    return shapely.union_all([Polygon(ring) for ring in rings if len(ring) > 2])


def faults(layout: Layout) -> list[str]:
    """Return what a designer would not accept in a room, one line each."""
    solids = [solid_of(p) for p in layout.furniture if p.kind != "rug"]
    return [
        *overlaps(solids),
        *blocked_doors(layout, solids),
        *unreached(layout, solids),
        *unsupported(layout, solids),
    ]


def overlaps(solids: list[Solid]) -> list[str]:
    """Return the pairs of furniture that reach into each other."""
    found = []
    for a, b in combinations(solids, 2):
        low = np.maximum(a.mesh.bounds[0], b.mesh.bounds[0])
        high = np.minimum(a.mesh.bounds[1], b.mesh.bounds[1])
        if (high - low).min() < 1e-3 or not a.outline.intersects(b.outline):
            continue
        volume = trimesh.boolean.intersection([a.mesh, b.mesh]).volume
        if volume > CRUMB_M3:
            names = f"{a.piece.furniture_id} and {b.piece.furniture_id}"
            found.append(f"{names} share {1e3 * volume:.2f} litres")
    return found


def door_line(layout: Layout, door: Opening) -> LineString:
    """Return the threshold of a door on the floor [m]."""
    start, along, _ = wall_axes(layout.outline_m, door.wall)
    near = start + along * door.offset_m
    return LineString([near, near + along * door.width_m])


def blocked_doors(layout: Layout, solids: list[Solid]) -> list[str]:
    """Return the furniture that stands behind a door."""
    found = []
    for door in layout.openings:
        if door.kind != "door":
            continue
        line = door_line(layout, door)
        # The left side of a wall is the inside, as corners go counter-clockwise.
        way = line.buffer(DOORWAY_M, cap_style="flat", single_sided=True)
        for solid in solids:
            if solid.outline.intersection(way).area > 1e-3:
                found.append(f"{solid.piece.furniture_id} blocks a door")
    return found


def walkway(layout: Layout, solids: list[Solid]) -> BaseGeometry:
    """Return where the middle of a person can walk who came in by a door."""
    # Open doors and drawers do not count: whoever walks there closes them.
    standing = [
        s.outline.intersection(footprint(s.piece.size_m, s.piece.T_world_furniture))
        for s in solids
        if s.piece.kind not in HANGING
    ]
    free = Polygon(layout.outline_m).difference(shapely.union_all(standing))
    middle = free.buffer(-WALKWAY_M / 2 + 1e-3)
    doors = [door_line(layout, o) for o in layout.openings if o.kind == "door"]
    parts = shapely.get_parts(middle)
    entry = shapely.union_all(doors).buffer(WALKWAY_M / 2 + 0.02)
    entered = [part for part in parts if part.intersects(entry)]
    return max(entered, key=lambda part: part.area, default=Polygon())


def unreached(layout: Layout, solids: list[Solid]) -> list[str]:
    """Return the furniture that no walkway leads to, itself or by its seats."""
    middle = walkway(layout, solids)
    reach = WALKWAY_M / 2 + ARM_M
    ground = [s for s in solids if s.piece.kind not in (*HANGING, *LOOKED_AT)]
    ground = [s for s in ground if s.piece.T_world_furniture[6] < 0.05]
    is_near = {s.piece.furniture_id: middle.distance(s.outline) < reach for s in ground}
    found = []
    for solid in ground:
        name = solid.piece.furniture_id
        seats = [
            s.piece.furniture_id
            for s in ground
            if s.piece.kind in SEATS and s.outline.distance(solid.outline) < SEAT_GAP_M
        ]
        if not any(is_near[s] for s in [name, *seats]):
            found.append(f"{name} is out of reach of the walkway")
    return found


def unsupported(layout: Layout, solids: list[Solid]) -> list[str]:
    """Return the furniture above the floor that neither hangs nor stands on another."""
    room, found = Polygon(layout.outline_m), []
    for solid in solids:
        piece, z = solid.piece, solid.piece.T_world_furniture[6]
        if piece.kind in HANGING:
            back = rigid.apply(piece.T_world_furniture, back_of(piece))[:, :2]
            gaps = [room.exterior.distance(shapely.Point(p)) for p in back]
            if max(gaps) > 0.05:
                found.append(f"{piece.furniture_id} hangs {max(gaps):.2f} m off a wall")
        elif z > 0 and not any(carries(other, solid) for other in layout.furniture):
            found.append(f"{piece.furniture_id} stands on nothing at {z:.2f} m")
    return found


def back_of(piece: Furniture) -> Array:
    """Return the two lower corners of a piece's back in its frame, shape (2, 3) [m]."""
    depth, width, _ = piece.size_m
    return np.array([[-depth / 2, -width / 2, 0], [-depth / 2, width / 2, 0]])


def carries(below: Furniture, solid: Solid) -> bool:
    """Return whether a piece has a support under the whole of another."""
    bottom_m = solid.piece.T_world_furniture[6]
    for support in standing_shape(below).supports:
        patch = Polygon(support.polygon_m).buffer(0.01)
        is_level = abs(support.height_m - bottom_m) < 2e-3
        if is_level and patch.covers(solid.outline):
            return True
    return False

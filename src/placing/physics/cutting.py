"""Meshes cut into what a rigid-body simulator takes.

What can move is cut into few convex parts; what stays may have hollow pieces.
"""

from collections.abc import Iterable
from functools import lru_cache

import numpy as np
import trimesh

from placing.dressing import meshes_of
from placing.object_meshes import object_mesh
from placing.physics.bodies import Body, Piece, Solids, shrunk_hull
from placing.physics.convex_parts import convex_parts, hull_volume
from placing.scene import Layout, SceneObject

CONVEX_SHARE = 0.98
"""A piece that fills this share of its hull counts as convex."""
N_BODIES = 256
"""Bodies that are kept; those of a scene are fewer."""


def solids_of(
    layout: Layout, objects: Iterable[SceneObject], margin_m: float
) -> Solids:
    """Return the furniture of a layout and what can be moved of some objects."""
    movable = [item for item in objects if item.is_movable]
    return Solids(fixed_of(layout, margin_m), bodies_of(movable, margin_m))


def bodies_of(objects: Iterable[SceneObject], margin_m: float) -> dict[str, Body]:
    """Return the bodies of objects by id; the slow part, so worth doing once."""
    return {
        item.object_id: _body(item.shape, item.size_m, item.mass_kg, margin_m)
        for item in objects
    }


@lru_cache(maxsize=N_BODIES)
def _body(
    shape: str, size_m: tuple[float, float, float], mass_kg: float, margin_m: float
) -> Body:
    """Return the body of an object; the scenes of a fold share most of theirs."""
    return body_of(object_mesh(shape, size_m), mass_kg, margin_m)


def fixed_of(layout: Layout, margin_m: float) -> dict[str, tuple[Piece, ...]]:
    """Return walls and furniture in the world, by the id of the furniture."""
    meshes = meshes_of(layout).items()
    return {name: fixed_pieces(mesh, margin_m) for name, mesh in meshes}


def fixed_pieces(mesh: trimesh.Trimesh, margin_m: float) -> tuple[Piece, ...]:
    """Return the pieces of a mesh that stays where it is: hollow ones as triangles."""
    return tuple(
        shrunk_hull(piece.vertices, margin_m)
        if is_convex(piece)
        else Piece(np.asarray(piece.vertices), np.asarray(piece.faces), False)
        for piece in pieces_of(mesh)
    )


def body_of(mesh: trimesh.Trimesh, mass_kg: float, margin_m: float) -> Body:
    """Return the body of a mesh, cut into convex parts where it is far from convex."""
    whole = mesh if mesh.is_volume else mesh.convex_hull
    centre = np.asarray(whole.center_mass)
    inertia = np.diag(whole.moment_inertia) * mass_kg / whole.volume
    parts = convex_parts(whole)
    pieces = tuple(shrunk_hull(corners - centre, margin_m) for corners in parts)
    return Body(pieces, mass_kg, centre, inertia)


def pieces_of(mesh: trimesh.Trimesh) -> list[trimesh.Trimesh]:
    """Return the connected pieces of a mesh."""
    return list(mesh.split(only_watertight=False))


def is_convex(mesh: trimesh.Trimesh) -> bool:
    """Return whether a mesh is closed and fills its convex hull."""
    if not mesh.is_watertight:
        return False
    return bool(abs(mesh.volume) >= CONVEX_SHARE * hull_volume(mesh.vertices))

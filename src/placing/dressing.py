"""The shapes of a layout in the world: walls, furniture and placed objects."""

from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
import trimesh

from placing import rigid
from placing.scene import Arrangement, Furniture, Layout
from placing.shapes.building import walls_shape
from placing.shapes.furniture import furniture_shape
from placing.shapes.objects import object_shape
from placing.shapes.shape import Shape

Meshes = dict[str, trimesh.Trimesh]

WALLS = "walls"
"""Name of the mesh of floor and walls; furniture goes by its id."""


def meshes_of(layout: Layout) -> Meshes:
    """Return walls and furniture in the world, by name."""
    meshes = {WALLS: walls_shape(layout).mesh}
    for item in layout.furniture:
        meshes[item.furniture_id] = standing_shape(item).mesh
    return meshes


def standing_shape(item: Furniture) -> Shape:
    """Return mesh and supports of a piece of furniture in the world."""
    shape, T = _shape_of(item.kind, item.size_m), item.T_world_furniture
    mesh = shape.mesh.copy().apply_transform(rigid.homogeneous(T))
    supports = []
    for support in shape.supports:
        flat = np.insert(support.polygon_m, 2, support.height_m, axis=1)  # (v, 3)
        world = rigid.apply(T, flat)
        height_m = float(world[0, 2])
        supports.append(replace(support, polygon_m=world[:, :2], height_m=height_m))
    return Shape(mesh, tuple(supports))


@lru_cache(maxsize=1024)
def _shape_of(kind: str, size_m: tuple[float, float, float]) -> Shape:
    """Return the shape of furniture, made once for all pieces that are alike."""
    return furniture_shape(kind, size_m)


@cache
def _object_shape(shape: str, size_m: tuple[float, float, float]) -> Shape:
    """Return the shape of an object, made once for all arrangements."""
    return object_shape(shape, size_m)


def object_meshes(layout: Layout, arrangement: Arrangement) -> Meshes:
    """Return the objects of an arrangement in the world, by object id."""
    objects = {item.object_id: item for item in layout.objects}
    meshes = {}
    for placement in arrangement.placements:
        item = objects[placement.object_id]
        mesh = _object_shape(item.shape, item.size_m).mesh.copy()
        mesh.apply_transform(rigid.homogeneous(placement.T_world_object))
        meshes[placement.object_id] = mesh
    return meshes

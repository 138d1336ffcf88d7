"""The meshes of a layout in the world: walls, furniture and placed objects."""

import numpy as np
import trimesh

from placing import rigid
from placing.scene import Arrangement, Layout
from placing.shapes.building import walls_shape
from placing.shapes.furniture import furniture_shape
from placing.shapes.objects import object_shape

Meshes = dict[str, trimesh.Trimesh]

WALLS = "walls"
"""Name of the mesh of floor and walls; furniture goes by its id."""


def meshes_of(layout: Layout) -> Meshes:
    """Return walls and furniture in the world, by name."""
    meshes = {WALLS: walls_shape(layout).mesh}
    for item in layout.furniture:
        mesh = furniture_shape(item.kind, item.size_m).mesh.copy()
        mesh.apply_transform(rigid.homogeneous(item.T_world_furniture))
        meshes[item.furniture_id] = mesh
    return meshes


def object_meshes(layout: Layout, arrangement: Arrangement) -> Meshes:
    """Return the objects of an arrangement in the world, by object id."""
    objects = {item.object_id: item for item in layout.objects}
    meshes = {}
    for placement in arrangement.placements:
        item = objects[placement.object_id]
        mesh = object_shape(item.shape, item.size_m).mesh
        T_world_object = np.concatenate([placement.orientation, placement.location])
        mesh.apply_transform(rigid.homogeneous(T_world_object))
        meshes[placement.object_id] = mesh
    return meshes

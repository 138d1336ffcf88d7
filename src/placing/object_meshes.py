"""Meshes of objects of any size."""

import trimesh

from placing.errors import BadInput
from placing.shapes.objects import object_shape


def object_mesh(shape: str, size_m: tuple[float, float, float]) -> trimesh.Trimesh:
    """Return a mesh that fills the box of `size_m` about the origin.

    Raises `UnknownName` for a shape that is not known.
    """
    try:
        return object_shape(shape, size_m).mesh
    except BadInput:
        # ASSUME: what designers made smaller than the shape of its category has parts
        # (an egg as bread, a butter knife as spatula) is a block.
        return trimesh.creation.box(size_m)

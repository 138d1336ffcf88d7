"""The registry of object shapes: a name and a size give a coloured mesh.

Object shapes are centred on their bounding box and fill it. Their +x side faces the
user: screens look there, keyboards slope down to there, toes of shoes point there.
"""

from collections.abc import Callable

import numpy as np

from placing.errors import BadInput, unknown
from placing.shapes import (
    dishes,
    food,
    footwear,
    handsets,
    household,
    keyboards,
    kitchenware,
    officeware,
    screens,
    stemware,
    sundries,
)
from placing.shapes.shape import Shape, Support
from placing.shapes.solids import Solid, mesh_of

OBJECTS: dict[str, Callable[[float, float, float], Solid]] = {
    "book": officeware.book,
    "boots": footwear.boots,
    "bottle": food.bottle,
    "bowl": dishes.bowl,
    "box": kitchenware.crate,
    "bread": food.bread,
    "broom": household.broom,
    "cereal_box": food.cereal_box,
    "cup": dishes.cup,
    "cushion": household.cushion,
    "desk_light": officeware.desk_light,
    "desk_phone": handsets.desk_phone,
    "dustpan": household.dustpan,
    "figurine": household.figurine,
    "fruit_bowl": food.fruit_bowl,
    "frying_pan": dishes.frying_pan,
    "hand_torch": sundries.hand_torch,
    "keyboard": keyboards.keyboard,
    "knife_block": kitchenware.knife_block,
    "ladle": kitchenware.ladle,
    "laptop": screens.laptop,
    "martini_glass": stemware.martini_glass,
    "milk_carton": food.milk_carton,
    "monitor": screens.monitor,
    "mouse": keyboards.mouse,
    "mug": dishes.mug,
    "pedal_bin": household.pedal_bin,
    "pen": officeware.pen,
    "pencil_cup": officeware.pencil_cup,
    "phone": handsets.phone,
    "picture_frame": officeware.picture_frame,
    "plate": dishes.plate,
    "remote": handsets.remote,
    "saucepan": dishes.saucepan,
    "shoe": footwear.shoe,
    "shoes": footwear.shoes,
    "soda_can": food.soda_can,
    "spatula": kitchenware.spatula,
    "spray_bottle": household.spray_bottle,
    "table_lamp": officeware.table_lamp,
    "tissue_box": sundries.tissue_box,
    "trash_bin": household.trash_bin,
    "tv": screens.tv,
    "vase": household.vase,
    "wine_glass": stemware.wine_glass,
}
"""Object shapes by name; each is a function of depth, width and height [m]."""

FLAT_TOPS = ("book", "box")
"""Shapes on whose top other things can be stacked."""


def object_shape(shape: str, size_m: tuple[float, float, float]) -> Shape:
    """Return an object shape that fills the box of `size_m` about the origin."""
    if shape not in OBJECTS:
        raise unknown("object shape", shape, list(OBJECTS))
    solid = OBJECTS[shape](*size_m)
    if solid.manifold.is_empty():
        raise BadInput(
            f"object shape {shape!r}: size_m is {list(size_m)}; expected a size in "
            "which all parts of the shape have room"
        )
    mesh = mesh_of(solid, size_m)
    return Shape(mesh, (_top(size_m),) if shape in FLAT_TOPS else ())


def _top(size_m: tuple[float, float, float]) -> Support:
    """Return the whole top of the box as a support."""
    x, y, z = np.asarray(size_m) / 2
    corners = np.array([(-x, -y), (x, -y), (x, y), (-x, y)])
    return Support("top", corners, float(z), float("inf"), softness=0.0)

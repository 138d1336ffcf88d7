"""All furniture shapes by kind: the front door to the files of each family."""

from collections.abc import Callable

import numpy as np

from placing.errors import BadInput, unknown
from placing.shapes import (
    appliances,
    drawers,
    fixtures,
    holders,
    kitchen,
    seating,
    soft,
    storage,
    tables,
)
from placing.shapes.joinery import Size
from placing.shapes.shape import Shape

FURNITURE: dict[str, Callable[[Size], Shape]] = {
    "desk": tables.desk,
    "corner_desk": tables.corner_desk,
    "table": tables.table,
    "round_table": tables.round_table,
    "coffee_table": tables.coffee_table,
    "side_table": tables.side_table,
    "bench": tables.bench,
    "counter": kitchen.counter,
    "sink_counter": kitchen.sink_counter,
    "stove": kitchen.stove,
    "island": kitchen.island,
    "wall_cabinet": storage.wall_cabinet,
    "open_shelf": storage.open_shelf,
    "bookcase": storage.bookcase,
    "cabinet": storage.cabinet,
    "shoe_rack": storage.shoe_rack,
    "tv_stand": storage.tv_stand,
    "sideboard": drawers.sideboard,
    "dresser": drawers.dresser,
    "drawer_unit": drawers.drawer_unit,
    "nightstand": drawers.nightstand,
    "fridge": appliances.fridge,
    "dish_rack": appliances.dish_rack,
    "stemware_holder": holders.stemware_holder,
    "hooks": holders.hooks,
    "pen_holder": holders.pen_holder,
    "microwave": appliances.microwave,
    "toaster": appliances.toaster,
    "coffee_machine": appliances.coffee_machine,
    "chair": seating.chair,
    "office_chair": seating.office_chair,
    "stool": seating.stool,
    "bar_stool": seating.bar_stool,
    "armchair": soft.armchair,
    "couch": soft.couch,
    "corner_couch": soft.corner_couch,
    "bed": soft.bed,
    "rug": soft.rug,
    "floor_lamp": fixtures.floor_lamp,
    "plant": fixtures.plant,
    "picture": fixtures.picture,
    "window_sill": fixtures.window_sill,
    "whiteboard": fixtures.whiteboard,
    "box": fixtures.plain_box,
}
"""Function of each kind. Every mesh fills its box, and only these leave it: `fridge`,
`wall_cabinet` (open doors) and `drawer_unit` (open drawer) to the front, +x, and
`sink_counter` (tap) upwards."""


def furniture_shape(kind: str, size_m: Size) -> Shape:
    """Return the shape of a kind of furniture at a size (depth, width, height) [m]."""
    if kind not in FURNITURE:
        raise unknown("furniture kind", kind, list(FURNITURE))
    if np.shape(size_m) != (3,) or not np.all(np.isfinite(size_m)) or min(size_m) <= 0:
        expected = "expected three lengths above 0 m"
        raise BadInput(f"furniture {kind}: size_m is {size_m}; {expected}")
    depth, width, height = size_m
    return FURNITURE[kind]((float(depth), float(width), float(height)))

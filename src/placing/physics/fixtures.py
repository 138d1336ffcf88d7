"""Furniture on which placements are tried, each piece alone on a floor.

Kinds are the placing areas of the group's earlier papers: table, shelf, drawer, fridge,
dish rack, stemware holder, hooks, pen holder, couch, and the floor.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np
import trimesh

from placing import rigid
from placing.dressing import standing_shape
from placing.scene import Furniture, PlacingArea
from placing.shapes.appliances import slot_centres
from placing.shapes.holders import hooks_height, rails_height, slots_of
from placing.shapes.joinery import Size, extent
from placing.shapes.parts import rectangle
from placing.shapes.shape import Shape, Support

FLOOR = "floor"
"""Name of the floor among the meshes of a fixture."""
AROUND_M = 0.5
"""How far the floor reaches beyond the furniture on it."""

Place = tuple[float, float, float]
Pieces = tuple[tuple[str, Size, Place], ...]
"""Kind, size and place of pieces of furniture; objects are placed on the first."""

COUNTER = ("box", (0.6, 0.8, 0.9), (0, 0, 0))
DESK = ("box", (0.5, 0.7, 0.74), (0, 0, 0))
"""What small holders stand on."""

# ASSUME: three sizes of each kind as furniture shops sell them; what hangs on a wall
# does so here at its usual height; small holders stand on a counter or a desk.
INSTANCES: dict[str, tuple[Pieces, ...]] = {
    "table": (
        (("table", (0.8, 1.2, 0.75), (0, 0, 0)),),
        (("round_table", (0.9, 0.9, 0.72), (0, 0, 0)),),
        (("coffee_table", (0.55, 0.9, 0.42), (0, 0, 0)),),
    ),
    "shelf": (
        (("bookcase", (0.3, 0.9, 1.3), (0, 0, 0)),),
        (("open_shelf", (0.26, 1.0, 0.7), (0, 0, 0.9)),),
        (("bookcase", (0.4, 1.2, 0.8), (0, 0, 0)),),
    ),
    "drawer": (
        (("drawer_unit", (0.5, 0.45, 0.6), (0, 0, 0)),),
        (("drawer_unit", (0.6, 0.8, 0.9), (0, 0, 0)),),
        (("drawer_unit", (0.45, 0.6, 0.45), (0, 0, 0)),),
    ),
    "fridge": (
        (("fridge", (0.65, 0.6, 1.75), (0, 0, 0)),),
        (("fridge", (0.6, 0.55, 0.85), (0, 0, 0)),),
        (("fridge", (0.7, 0.75, 1.9), (0, 0, 0)),),
    ),
    "dish_rack": (
        (("dish_rack", (0.35, 0.5, 0.16), (0, 0, 0.9)), COUNTER),
        (("dish_rack", (0.3, 0.4, 0.14), (0, 0, 0.9)), COUNTER),
        (("dish_rack", (0.34, 0.42, 0.22), (0, 0, 0)),),
    ),
    "stemware_holder": (
        (("stemware_holder", (0.3, 0.5, 0.4), (0, 0, 0)),),
        (("stemware_holder", (0.26, 0.75, 0.5), (0, 0, 0)),),
        (("stemware_holder", (0.34, 0.36, 0.34), (0, 0, 0)),),
    ),
    "hooks": (
        (("hooks", (0.09, 0.6, 0.12), (0, 0, 1.2)),),
        (("hooks", (0.13, 0.8, 0.12), (0, 0, 1.4)),),
        (("hooks", (0.07, 0.45, 0.1), (0, 0, 1.0)),),
    ),
    "pen_holder": (
        (("pen_holder", (0.08, 0.08, 0.1), (0, 0, 0.74)), DESK),
        (("pen_holder", (0.07, 0.12, 0.11), (0, 0, 0.74)), DESK),
        (("pen_holder", (0.16, 0.16, 0.18), (0, 0, 0)),),
    ),
    "couch": (
        (("couch", (0.9, 1.9, 0.8), (0, 0, 0)),),
        (("couch", (0.8, 1.4, 0.75), (0, 0, 0)),),
        (("armchair", (0.85, 0.85, 0.85), (0, 0, 0)),),
    ),
    "floor": (
        (),
        (("box", (0.12, 1.4, 1.6), (-0.4, 0, 0)),),
        (("cabinet", (0.4, 0.9, 1.0), (-0.5, 0, 0)),),
    ),
}
KINDS = tuple(INSTANCES)


@dataclass(frozen=True)
class Fixture:
    """A piece of furniture on a floor, with the areas where placements are tried."""

    kind: str
    instance: int
    yaw_rad: float
    """How the furniture is turned about the vertical through the origin."""
    meshes: dict[str, trimesh.Trimesh]
    """In the world: the floor, and the pieces by their number."""
    areas: tuple[PlacingArea, ...]
    slots_m: tuple[float, ...]
    """Where its slots are along its y axis; none where it has none."""

    @property
    def name(self) -> str:
        """Kind and number."""
        return f"{self.kind}{self.instance}"


def fixture_of(kind: str, instance: int, yaw_rad: float) -> Fixture:
    """Return one of the pieces of a kind, turned about the vertical."""
    pieces = INSTANCES[kind][instance]
    standing = [
        Furniture(f"piece{i}", name, size, _turned(yaw_rad, place))
        for i, (name, size, place) in enumerate(pieces)
    ]
    shapes = {item.furniture_id: standing_shape(item) for item in standing}
    meshes = {name: shape.mesh for name, shape in shapes.items()}
    supports = _floor_support(yaw_rad) if kind == FLOOR else _held(standing[0], shapes)
    areas = tuple(
        PlacingArea(s.name, s.polygon_m, s.height_m, s.clearance_m, kind == FLOOR, None)
        for s in supports
    )
    meshes[FLOOR] = _floor(meshes)
    slots_m = _slots(standing[0]) if standing else ()
    return Fixture(kind, instance, yaw_rad, meshes, areas, slots_m)


def _turned(yaw_rad: float, place: Place) -> rigid.Array:
    """Return the pose of a piece whose place is turned with it, shape (7,)."""
    turn = rigid.from_yaw(yaw_rad, (0.0, 0.0, 0.0))
    return rigid.compose(turn, rigid.from_yaw(0.0, place))


def _floor(meshes: dict[str, trimesh.Trimesh]) -> trimesh.Trimesh:
    """Return a slab below all meshes, at least 1.6 m wide."""
    corners = np.concatenate(
        [[[-0.3, -0.3], [0.3, 0.3]], *(mesh.bounds[:, :2] for mesh in meshes.values())]
    )
    low, high = corners.min(0) - AROUND_M, corners.max(0) + AROUND_M
    size, middle = (*(high - low), 0.1), (*(low + high) / 2, -0.05)
    slab = trimesh.creation.box(size)
    slab.apply_translation(middle)
    grey = np.full((len(slab.faces), 4), 128, np.uint8)
    return trimesh.Trimesh(slab.vertices, slab.faces, face_colors=grey, process=False)


def _floor_support(yaw_rad: float) -> tuple[Support, ...]:
    """Return the floor in front of what stands at its back."""
    corners = np.insert(rectangle((-0.3, 0.5), (-0.5, 0.5)), 2, 0.0, axis=1)  # (4, 3)
    world = rigid.apply(rigid.from_yaw(yaw_rad, (0.0, 0.0, 0.0)), corners)
    return (Support(FLOOR, world[:, :2], 0.0, inf, 0.0),)


def _slots(item: Furniture) -> tuple[float, ...]:
    """Return where a holder has slots along its y axis [m]."""
    width = item.size_m[1]
    slots = {
        "dish_rack": slot_centres,
        "stemware_holder": slots_of,
        "pen_holder": lambda width: np.array([-width / 4, width / 4]),
    }
    return tuple(slots[item.kind](width).tolist()) if item.kind in slots else ()


def _held(item: Furniture, shapes: dict[str, Shape]) -> tuple[Support, ...]:
    """Return the supports of a piece and the levels at which it holds things."""
    known = shapes[item.furniture_id].supports
    if item.kind not in HELD:
        return tuple(s for s in known if item.kind not in INSIDE or s.name != "top")
    x, y, height = HELD[item.kind](item.size_m)
    corners = np.insert(rectangle(x, y), 2, height, axis=1)  # (4, 3)
    world = rigid.apply(item.T_world_furniture, corners)
    return (Support("held", world[:, :2], float(world[0, 2]), inf, 0.0),)


INSIDE = ("drawer_unit", "fridge")
"""Kinds whose tops are tables like any other and are not tried."""


def _rails(size_m: Size) -> tuple:
    """Return where glasses hang in a stemware holder: along x, along y, and level."""
    slots = slots_of(size_m[1])
    return (
        extent(size_m)[0],
        (slots[0] - 0.04, slots[-1] + 0.04),
        rails_height(size_m[2]),
    )


def _arms(size_m: Size) -> tuple:
    """Return where things hang on hooks: along x, along y, and level."""
    x, y, z = extent(size_m)
    return (x[0] + 0.015, x[1]), y, hooks_height(z[1])


def _cup(size_m: Size) -> tuple:
    """Return where pens stand in a pen holder: along x, along y, and level."""
    return *extent(size_m)[:2], 0.004


HELD: dict[str, Callable[[Size], tuple]] = {
    "stemware_holder": _rails,
    "hooks": _arms,
    "pen_holder": _cup,
}
"""Where things are held that stand on no support: it would be too narrow."""

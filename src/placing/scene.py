"""What a scene is: a layout of furniture before the scan, placing areas after it.

A `Layout` is what a room file or a designer's room says: walls, furniture, objects and
labelled arrangements. A `Scene` is what every stage after the scan sees: placing areas
found in a point cloud, and the identity of the objects, but no furniture and no mesh.

Frames: world = metres, z up, floor at z = 0, right-handed. The frame of furniture has
its origin at the centre of the footprint on the ground, x towards its front (the side
its user is on), y to its left. The frame of an object has its origin at the centre of
its bounding box, with the same axes. Sizes are (depth x, width y, height z).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from shapely import Point, Polygon

from placing import rigid

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Opening:
    """A door or a window in a wall."""

    kind: str
    """`door` or `window`."""
    wall: int
    """Index of the wall, which runs from corner `wall` to the next one."""
    offset_m: float
    """From the wall's first corner to the near side of the opening."""
    width_m: float
    sill_m: float
    """Height of the lower edge; 0 for doors."""
    height_m: float
    """From the lower to the upper edge."""


@dataclass(frozen=True)
class Furniture:
    """A piece of furniture: a shape scaled to a size and put in the world."""

    furniture_id: str
    kind: str
    """Name of a furniture shape, see `placing.shapes`."""
    size_m: tuple[float, float, float]
    T_world_furniture: Array
    """(7,) wxyz + xyz."""


@dataclass(frozen=True)
class SceneObject:
    """An object to place, whatever its pose."""

    object_id: str
    category: str
    """One of the 19 categories."""
    shape: str
    """Name of an object shape, see `placing.shapes`."""
    size_m: tuple[float, float, float]
    """(3,) depth, width, height of the bounding box in the stance `upright`."""
    mass_kg: float
    has_front: bool
    """Whether its heading matters to its user."""
    is_movable: bool
    """Whether the robot can carry it (Table 1 of the paper)."""


@dataclass(frozen=True)
class Placement:
    """One object at one pose (E_j, l_i, c_i)."""

    object_id: str
    area: str
    """Placing area; in a `Layout`, the furniture or object below, or `floor`."""
    location: Array
    """(3,) centre of the object's bounding box in the world [m]."""
    orientation: Array
    """(4,) unit quaternion wxyz that turns the object's frame to the world's."""

    @property
    def T_world_object(self) -> Array:
        """Pose of the object, shape (7,)."""
        return np.concatenate([self.orientation, self.location])


@dataclass(frozen=True)
class Arrangement:
    """One answer for one scene: a placement of each object."""

    name: str
    """Who gave it, such as `labeller1`."""
    habit: str
    """What it says of its author's habits, such as `left-handed`."""
    placements: tuple[Placement, ...]


@dataclass(frozen=True)
class Layout:
    """Walls, furniture, objects and labelled arrangements of a scene."""

    scene: str
    kind: str
    """kitchen, livingroom, office, bedroom or apartment."""
    outline_m: Array
    """(c, 2) corners of the floor, counter-clockwise."""
    height_m: float
    """Height of the walls."""
    openings: tuple[Opening, ...]
    furniture: tuple[Furniture, ...]
    objects: tuple[SceneObject, ...]
    arrangements: tuple[Arrangement, ...]


@dataclass(frozen=True)
class PlacingArea:
    """A horizontal patch of the cloud on which objects can stand (E_j)."""

    area: str
    """`floor`, or `area` and a number: the cloud knows no names."""
    polygon_m: Array
    """(v, 2) corners in the world, counter-clockwise."""
    height_m: float
    clearance_m: float
    """Free height above; `inf` where nothing is above."""
    is_floor: bool
    softness: float | None
    """0 hard to 1 soft; None where unknown, as in every cloud without an expert."""


@dataclass(frozen=True)
class Scene:
    """A scene as every stage after the scan sees it."""

    scene: str
    kind: str
    areas: tuple[PlacingArea, ...]
    objects: tuple[SceneObject, ...]
    arrangements: tuple[Arrangement, ...]


def extents(item: SceneObject, placement: Placement) -> Array:
    """Return the size of the object's box along the world's axes, shape (3,) [m]."""
    return np.abs(rigid.matrix(placement.orientation)) @ np.array(item.size_m)


def standing_at(item: SceneObject, T_world_object: Array) -> Array:
    """Return centre, size and yaw of the box around an object at a pose, shape (7,)."""
    quaternion, location = T_world_object[:4], T_world_object[4:]
    return standing_box(item, Placement(item.object_id, "", location, quaternion))


def standing_box(item: SceneObject, placement: Placement) -> Array:
    """Return centre, size and yaw of the box around a placed object, shape (7,)."""
    size, yaw = extents(item, placement), 0.0
    if abs(size[2] - item.size_m[2]) < 1e-6:  # it stands upright
        size, yaw = item.size_m, float(rigid.yaw_of(placement.orientation))
    return np.array([*placement.location, *size, yaw])


def resting_point(item: SceneObject, placement: Placement) -> Array:
    """Return the point below the object's centre on which it rests, shape (3,) [m]."""
    drop = extents(item, placement)[2] / 2
    return placement.location - np.array([0.0, 0.0, drop])


NEAR_M = 0.03
"""An object rests on a placing area when it is no further than this above it."""


def with_areas(scene: Scene, areas: tuple[PlacingArea, ...]) -> Scene:
    """Return the scene with placing areas, and the area below each labelled object.

    An object that rests on no area, such as one on another object, names none.
    """
    items = {item.object_id: item for item in scene.objects}
    polygons = [Polygon(area.polygon_m) for area in areas]

    def area_below(placement: Placement) -> str:
        x, y, z = resting_point(items[placement.object_id], placement)
        below = [
            (abs(z - area.height_m), area.area)
            for area, polygon in zip(areas, polygons, strict=True)
            if abs(z - area.height_m) <= NEAR_M and polygon.covers(Point(x, y))
        ]
        return min(below)[1] if below else ""

    def on_areas(arrangement: Arrangement) -> Arrangement:
        placed = tuple(replace(p, area=area_below(p)) for p in arrangement.placements)
        return replace(arrangement, placements=placed)

    arrangements = tuple(on_areas(arrangement) for arrangement in scene.arrangements)
    return replace(scene, areas=areas, arrangements=arrangements)

"""Things of a designer's room: boxes in the world, read from the source's frame."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Item:
    """A thing of a scene in the world frame: a box that is turned about z only."""

    name: str
    """Unique in its scene; the source's `objectId`."""
    type: str
    centre: Array
    """(3,) of the box [m]."""
    size: Array
    """(3,) depth, width and height [m]."""
    yaw: float
    """Heading of the front [rad]."""
    mass_kg: float
    below: tuple[str, ...]
    """Names of what it rests on or in, as the source says."""

    @property
    def bottom(self) -> float:
        """Return the height of the lower side of the box [m]."""
        return float(self.centre[2] - self.size[2] / 2)

    @property
    def top(self) -> float:
        """Return the height of the upper side of the box [m]."""
        return float(self.centre[2] + self.size[2] / 2)

    @property
    def half_extent(self) -> Array:
        """Return half the extent along x and y of the world, shape (2,) [m]."""
        c, s = abs(np.cos(self.yaw)), abs(np.sin(self.yaw))
        return np.array([[c, s], [s, c]]) @ self.size[:2] / 2

    def local(self, xy: Array) -> Array:
        """Return points of the world in the frame of the footprint, shape (n, 2)."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return (np.atleast_2d(xy) - self.centre[:2]) @ np.array([[c, -s], [s, c]])

    def covers(self, other: "Item", margin_m: float = 0.0) -> bool:
        """Return whether the centre of `other` lies in the footprint."""
        inside = np.abs(self.local(other.centre[:2])[0]) <= self.size[:2] / 2 + margin_m
        return bool(inside.all())


def to_world(xyz: Array) -> Array:
    """Return points of the source in the world, same shape.

    The source is left-handed with y up, the world right-handed with z up: swapping y
    and z changes the handedness and leaves the room as it is, seen from above.
    """
    return np.asarray(xyz, float)[..., [0, 2, 1]]


def to_yaw(rotation_deg: Array) -> float:
    """Return the heading of the front, which is +z in the source [rad].

    The source turns clockwise seen from above, about z, then x, then y.
    """
    about_x, about_y = np.deg2rad(rotation_deg[:2])
    # Tilted beyond upright, the front points the other way.
    flip = np.pi if np.cos(about_x) < -1e-6 else 0.0
    return float(np.pi / 2 - about_y + flip)


def xyz(record: dict[str, float]) -> Array:
    """Return the three numbers of a record, shape (3,)."""
    return np.array([record["x"], record["y"], record["z"]])


def read_item(thing: dict[str, Any], asset_size: dict[str, Array]) -> Item:
    """Return the thing with its box in the world, before the floor is at z = 0."""
    yaw = to_yaw(xyz(thing["rotation"]))
    upright = thing["axisAlignedBoundingBox"]
    centre, size = to_world(xyz(upright["center"])), to_world(xyz(upright["size"]))
    oriented = thing["objectOrientedBoundingBox"]
    if oriented is not None:
        # The oriented box is turned about all axes: its corners reach below the thing.
        flat, across = fit_box(to_world(oriented["cornerPoints"]), yaw)
        centre = np.array([*flat[:2], centre[2]])
        size = np.array([*across[:2], size[2]])
    else:
        known = asset_size.get(asset_key(thing))
        if known is not None and not thing["assetId"]:
            size = known
        else:
            size = turn_size(size, yaw, known)
    return Item(
        thing["objectId"] if thing["objectId"] else thing["name"],
        thing["objectType"],
        centre,
        size,
        yaw,
        float(thing["mass"]),
        tuple(thing["parentReceptacles"] or ()),
    )


def asset_key(thing: dict[str, Any]) -> str:
    """Return what names the equals of a thing; empty where nothing does."""
    if thing["objectType"] == "ArmChair" and not thing["assetId"]:
        return f"ArmChair {thing['axisAlignedBoundingBox']['size']['y']:.2f}"
    return thing["assetId"]


def fit_box(corners: Array, yaw: float) -> tuple[Array, Array]:
    """Return centre and size of the box round the corners, turned by `yaw`, (3,)."""
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    local = corners @ turn
    low, high = local.min(0), local.max(0)
    return turn @ ((low + high) / 2), high - low


def turn_size(extent: Array, yaw: float, known: Array | None) -> Array:
    """Return depth, width, height of a thing by its extent in the world, shape (3,)."""
    c, s = abs(np.cos(yaw)), abs(np.sin(yaw))
    if is_straight(yaw):
        return extent if c > s else extent[[1, 0, 2]]
    if known is not None:
        return known
    # ASSUME: without a straight twin the footprint is shrunk evenly until it fits.
    return extent[[0, 1, 2] if c > s else [1, 0, 2]] / np.array([c + s, c + s, 1])


def is_straight(yaw: float) -> bool:
    """Return whether the heading lies along an axis of the world within 2 degrees."""
    return abs(np.sin(2 * yaw)) < np.sin(np.deg2rad(4))

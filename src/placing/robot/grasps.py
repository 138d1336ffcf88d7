"""Pre-determined grasps: how a hand takes an object (Section 3.3).

Each row of `config/grasps.csv` says how things of one shape are taken, relative to the
bounding box, so that it serves every size of that shape: what is a rim, a handle or an
edge has a width of its own, everything else is as wide as a share of the box. A row
gives `n_turns` grasps, turned about the object's upright axis.

The tool's frame: x is where the fingers point, y is how they close, the origin lies
between their tips.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placing import rigid
from placing.scene import SceneObject
from placing.sheets import Row, read_sheet

Array = rigid.Array


@dataclass(frozen=True)
class Grasp:
    """One way to hold one object."""

    name: str
    """As in the sheet, with the number of the turn."""
    T_object_tool: Array
    """(7,) where the tool is when it holds the object."""
    width_m: float
    """Distance of the fingers when they hold it."""
    release_m: float
    """How far above contact the object is let go, so that no finger is caught."""

    @property
    def T_tool_object(self) -> Array:
        """Where the object is in the hand, shape (7,)."""
        return rigid.inverse(self.T_object_tool)


@dataclass(frozen=True)
class GraspSheet:
    """The rows of `config/grasps.csv` by what they are of."""

    rows: dict[str, tuple[Row, ...]]
    """By shape or category; `any` for the rest."""

    def rows_of(self, item: SceneObject) -> tuple[Row, ...]:
        """Return the rows of its shape, else of its category, else of anything."""
        names = (item.shape, item.category, "any")
        return next((self.rows[name] for name in names if name in self.rows), ())


def read_grasps(path: Path, row_schema: dict) -> GraspSheet:
    """Read the sheet of grasps, in its order."""
    rows: dict[str, list[Row]] = {}
    for row in read_sheet(path, row_schema, ("of", "grasp")):
        rows.setdefault(row["of"], []).append(row)
    return GraspSheet({of: tuple(some) for of, some in rows.items()})


def grasps_of(
    item: SceneObject, sheet: GraspSheet, max_opening_m: float, tip_m: float
) -> tuple[Grasp, ...]:
    """Return the grasps of an object, in the sheet's order; none if it is too wide.

    The origin of the tool stays `tip_m` above the object's bottom, or at half of the
    object's height if that is less.
    """
    return tuple(
        grasp
        for row in sheet.rows_of(item)
        if _width(row, item.size_m) <= max_opening_m
        for grasp in _turned(row, item.size_m, tip_m)
    )


def _width(row: Row, size_m: Sequence[float]) -> float:
    """Return how wide what is between the fingers is [m]."""
    axis = row["width_axis"]
    box_m = size_m["xyz".index(axis)] if axis != "none" else 0.0
    return row["width_share"] * box_m + row["width_m"]


def _turned(row: Row, size_m: Sequence[float], tip_m: float) -> list[Grasp]:
    """Return the grasps of a row, one for each turn."""
    half = np.asarray(size_m) / 2
    low = -half[2] + min(tip_m, half[2])
    grasps = []
    for k in range(row["n_turns"]):
        turn = 2 * np.pi * k / row["n_turns"]
        heading = np.deg2rad(row["heading_deg"]) + turn
        at = rigid.apply(rigid.from_yaw(turn, (0, 0, 0)), _point(row))[0] * half
        at[:2] += row["in_m"] * np.array([np.cos(heading), np.sin(heading)])
        at[2] = max(at[2] - row["down_m"], low)
        pitch, roll = np.deg2rad((row["pitch_deg"], row["roll_deg"]))
        grasps.append(
            Grasp(
                name=f"{row['grasp']}{k + 1}",
                T_object_tool=np.concatenate([facing(heading, pitch, roll), at]),
                width_m=_width(row, size_m),
                release_m=row["release_m"],
            )
        )
    return grasps


def _point(row: Row) -> Array:
    """Return the point of the box that a row names, shape (1, 3), from -1 to 1."""
    return np.array([[row["x"], row["y"], row["z"]]])


def facing(heading: float, pitch: float, roll: float) -> Array:
    """Return the rotation of a hand that points down by `pitch`, shape (4,) wxyz.

    Its fingers point along `heading` on the floor, lowered by `pitch`; they close
    level where `roll` is zero. Angles in radians.
    """
    about_y, about_x = rigid.about((0, 1, 0), pitch), rigid.about((1, 0, 0), roll)
    return rigid.multiply(
        rigid.multiply(rigid.yaw_quaternion(heading), about_y), about_x
    )

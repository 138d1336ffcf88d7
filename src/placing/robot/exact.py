"""The exact check of whole motions, and of where an object ends up.

Furniture and the object that is carried are as they truly are; the other objects are
the boxes that the planner sees, which contain them.
"""

from collections.abc import Mapping

import numpy as np

from placing.physics.bodies import Body, box_body
from placing.rigid import Array, from_yaw
from placing.robot.planning import Motion
from placing.robot.truth import Truth
from placing.scene import SceneObject, standing_at

LINES = ("lower", "retreat", "approach", "lift")
"""Straight segments, in which hand and object may touch what is there."""
DENSITY_KG_M3 = 300.0
"""Of boxes; only guards against objects that push what is much lighter."""


class Exact:
    """The true furniture, boxes that stand there, and one object at a time."""

    def __init__(
        self, truth: Truth, bodies: Mapping[str, Body], margin_m: float, reach_m: float
    ) -> None:
        """Take a world of furniture alone, and the bodies of objects by id."""
        self.truth, self.bodies = truth, bodies
        self.margin_m, self.reach_m = margin_m, reach_m
        self._standing: dict[str, bytes] = {}
        self._boxes: dict[bytes, Body] = {}
        self._contacts: dict[tuple, Array] = {}

    def stand(self, boxes: Mapping[str, Array]) -> None:
        """Let these boxes stand there and nothing else."""
        wanted = {name: np.asarray(box, float).tobytes() for name, box in boxes.items()}
        for name in sorted(self._standing):
            if self._standing[name] != wanted.get(name):
                self.truth.remove(name)
                del self._standing[name]
        for name in sorted(wanted):
            if name not in self._standing:
                box = np.asarray(boxes[name], float)
                body = self._body(box[3:6])
                self.truth.put(name, body, from_yaw(box[6], tuple(box[:3])))
                self._standing[name] = wanted[name]

    def contact(
        self, item: SceneObject, T_world_object: Array, boxes: Mapping[str, Array]
    ) -> Array:
        """Return the pose at which an object touches what is below, shape (7,)."""
        name, at = item.object_id, standing_at(item, T_world_object)
        near = {other: box for other, box in boxes.items() if _is_near(box, at)}
        key = name, T_world_object.tobytes(), *(near[k].tobytes() for k in sorted(near))
        if key not in self._contacts:
            self.stand(near)
            self.truth.put(name, self.bodies[name], T_world_object)
            self._contacts[key] = self.truth.touching_pose(name, self.reach_m)
            self.truth.remove(name)
        return self._contacts[key]

    def falls(self, item: SceneObject, T_world_object: Array, release_m: float) -> bool:
        """Return whether an object does not stay that is let go above its place."""
        name = item.object_id
        self.truth.put(name, self.bodies[name], T_world_object)
        complaint = self.truth.let_go(name, release_m, self.reach_m)
        self.truth.remove(name)
        return bool(complaint)

    def complaint(self, motion: Motion, item: SceneObject) -> str:
        """Return a hit of a motion, in words; empty if there is none.

        Straight lines are looked at first: they are short and fail more often.
        """
        name = item.object_id
        self.truth.put(name, self.bodies[name], motion.T_world_object)
        try:
            for segment in sorted(motion.segments, key=lambda s: s.name not in LINES):
                is_line = segment.name in LINES
                T_tool_object = motion.T_tool_object if segment.is_holding else None
                if not segment.is_holding:
                    self.truth.put(name, self.bodies[name], motion.T_world_object)
                is_known = segment.is_holding or is_line
                self.truth.open_fingers(segment.opening_m)
                hit = self.truth.check_path(
                    segment.path, name if is_known else None, T_tool_object, is_line
                )
                if hit:
                    return f"{segment.name}: {hit}"
        finally:
            self.truth.remove(name)
        return ""

    def _body(self, size_m: Array) -> Body:
        """Return a box as a body, the same one for the same size."""
        key = size_m.tobytes()
        if key not in self._boxes:
            mass_kg = DENSITY_KG_M3 * float(np.prod(size_m))
            self._boxes[key] = box_body(size_m, mass_kg, self.margin_m)
        return self._boxes[key]


def _is_near(one: Array, other: Array) -> bool:
    """Return whether one of two boxes (7,) may be below the other."""
    away = np.hypot(*(one[:2] - other[:2]))
    return bool(away <= (np.hypot(*one[3:5]) + np.hypot(*other[3:5])) / 2)

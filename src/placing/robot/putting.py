"""Put an object somewhere, or pick it up there (Section 3.3).

The robot drives to where it can stand, raises its torso, reaches above the place with
a path of the arm, goes straight down to contact, opens the gripper, draws the hand
straight back and folds its arm. What was planned among the points of a scan is checked
among the true furniture before it counts.
"""

from collections.abc import Mapping

import numpy as np

from placing.errors import BadInput
from placing.rigid import Array
from placing.robot.blame import to_blame
from placing.robot.carrying import Carrying
from placing.robot.checker import Held, SceneChecker
from placing.robot.driving import Floor
from placing.robot.exact import Exact
from placing.robot.goals import Search, goals_of
from placing.robot.grasps import Grasp, GraspSheet, grasps_of
from placing.robot.held_shapes import carried, cells_of
from placing.robot.model import RobotModel
from placing.robot.motions import segments_of
from placing.robot.paths import Query
from placing.robot.planning import (
    FALLS,
    REJECTED,
    Motion,
    PlanningConfig,
    Refusal,
)
from placing.scene import Placement, SceneObject, standing_box
from placing.seeds import generator

Boxes = Mapping[str, Array]
"""Objects that stand there: centre, size and yaw (7,) by object id."""


OWN = ""
"""Name of the box of the object itself, which no object has."""


class Placer:
    """Plans motions of one robot in one scene, and remembers those of empty scenes."""

    def __init__(
        self,
        model: RobotModel,
        checker: SceneChecker,
        floor: Floor,
        exact: Exact,
        sheet: GraspSheet,
        config: PlanningConfig,
        seed: int,
    ) -> None:
        """Take a robot in a scene; `exact` knows its true furniture."""
        self.model, self.checker, self.floor, self.exact = model, checker, floor, exact
        self.sheet, self.config, self.seed = sheet, config, seed
        self.carrying = Carrying(checker)
        self.n_rejected = 0
        self._grasps: dict[str, tuple[tuple[Grasp, Held], ...]] = {}
        self._known: dict[tuple, Motion | Refusal] = {}

    def put(
        self,
        item: SceneObject,
        T_world_object: Array,
        boxes: Boxes,
        grasp: str = "",
        start: Array | None = None,
    ) -> Motion | Refusal:
        """Return how an object is put at a pose among what stands there.

        A `grasp` by name is the only one that is tried; the base starts at that of
        `start` (4 + a,), by default where the floor is most open.
        """
        return self._answer(True, item, T_world_object, boxes, grasp, start)

    def pick(
        self,
        item: SceneObject,
        T_world_object: Array,
        boxes: Boxes,
        grasp: str = "",
        start: Array | None = None,
    ) -> Motion | Refusal:
        """Return how an object that stands at a pose is picked up; as `put`.

        `boxes` are the other objects.
        """
        return self._answer(False, item, T_world_object, boxes, grasp, start)

    def grasps(self, item: SceneObject) -> tuple[tuple[Grasp, Held], ...]:
        """Return the grasps of an object that fit the gripper, with what is held."""
        name = item.object_id
        if name not in self._grasps:
            opening_m = self.model.settings.max_opening_m
            some = grasps_of(item, self.sheet, opening_m, self.config.tip_m)
            cells = cells_of(self.exact.bodies[name])
            self._grasps[name] = tuple(
                (g, carried(name, item.size_m, cells, g.T_tool_object)) for g in some
            )
        return self._grasps[name]

    def _answer(
        self,
        is_putting: bool,
        item: SceneObject,
        T_world_object: Array,
        boxes: Boxes,
        grasp: str,
        start: Array | None,
    ) -> Motion | Refusal:
        """Return the motion of the empty scene where it still holds, else a new one."""
        if start is not None:
            self._check_start(start)
        key = (is_putting, item.object_id, T_world_object.tobytes(), grasp)
        if start is not None:
            key = (*key, start.tobytes())
        args = is_putting, item, T_world_object
        if key not in self._known:
            self._known[key] = self._plan(*args, {}, grasp, start)
        known = self._known[key]
        if not boxes:
            return known
        if isinstance(known, Refusal):
            # What falls alone may rest on what stands there.
            if known.reason != FALLS:
                return known
        elif self._holds(known, item, boxes):
            return known
        return self._plan(*args, boxes, grasp, start)

    def _plan(
        self,
        is_putting: bool,
        item: SceneObject,
        T_world_object: Array,
        boxes: Boxes,
        grasp: str,
        start: Array | None,
    ) -> Motion | Refusal:
        """Return a motion that the exact check accepts, or why there is none."""
        self.exact.stand(boxes)
        if is_putting and boxes is not None:
            T_world_object = self.exact.contact(item, T_world_object)
        grasps = [g for g in self.grasps(item) if grasp in ("", g[0].name)]
        search = Search(
            is_putting,
            T_world_object,
            grasps,
            self._among(boxes),
            self._among({**boxes, OWN: standing_at(item, T_world_object)}),
            self.checker,
            start,
            self._query(item, T_world_object),
            self.config.n_paths,
        )
        for goal in goals_of(search, self.floor, self.carrying, self.config):
            segments = segments_of(search, goal, self.floor)
            if segments is not None:
                motion = Motion(
                    item.object_id,
                    T_world_object,
                    goal.grasp.name,
                    goal.grasp.T_tool_object,
                    segments,
                )
                if not self.exact.complaint(motion, item):
                    release_m = goal.grasp.release_m
                    args = item, T_world_object, release_m
                    if is_putting and self.exact.falls(*args):
                        search.reached(FALLS)
                        break
                    return motion
                self.n_rejected += 1
                search.reached(REJECTED)
            if search.n_paths <= 0:
                break
        return Refusal(search.reason, to_blame(search, boxes, self.config.blame_m))

    def _check_start(self, start: Array) -> None:
        """Raise `BadInput` where the robot cannot stand at its start."""
        if not self.checker.is_free(start):
            x, y, yaw = np.round(start[:3], 2).tolist()
            raise BadInput(
                f"{self.floor.scene}: start: the robot {self.model.settings.robot} at"
                f" x {x}, y {y}, yaw {yaw} is in collision; expected a free place"
            )

    def _among(self, boxes: Boxes) -> SceneChecker:
        """Return the checker with boxes beside those it knows."""
        more = [boxes[name] for name in sorted(boxes)]
        own = np.array(self.checker.boxes, float).reshape(-1, 7)
        return self.checker.with_boxes(np.vstack([own, *more]))

    def _query(self, item: SceneObject, T_world_object: Array) -> Query:
        """Return the limits of a query, with the seed of a placement."""
        where = T_world_object.tobytes().hex()
        rng = generator(self.seed, "putting", item.object_id, where)
        seed = int(rng.integers(1, 2**31))
        return Query(seed, self.config.n_checks, self.config.range_rad)

    def _holds(self, motion: Motion, item: SceneObject, boxes: Boxes) -> bool:
        """Return whether a motion of the empty scene is free among boxes as well."""
        own = {OWN: standing_at(item, motion.T_world_object)}
        without, among = self._among(boxes), self._among({**boxes, **own})
        known = dict((g.name, h) for g, h in self.grasps(item))[motion.grasp]
        for segment in motion.segments:
            is_line = segment.name in ("lower", "retreat", "approach", "lift")
            is_alone = segment.is_holding or is_line
            checker = without if is_alone else among
            what = known if segment.is_holding else None
            if not checker.is_path_free(segment.path, what, touching=is_line):
                return False
        return True


def standing_at(item: SceneObject, T_world_object: Array) -> Array:
    """Return centre, size and yaw of the box around an object at a pose, (7,)."""
    quaternion, location = T_world_object[:4], T_world_object[4:]
    return standing_box(item, Placement(item.object_id, "", location, quaternion))

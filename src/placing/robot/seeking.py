"""Seek one motion that puts an object somewhere, or picks it up there (Section 3.3).

The robot drives to where it can stand, raises its torso, reaches above the place with
a path of the arm, goes straight down to contact, opens the gripper, draws the hand
straight back and folds its arm.
"""

from collections.abc import Callable

import numpy as np

from placing.errors import BadInput
from placing.rigid import Array
from placing.robot.blame import to_blame
from placing.robot.carrying import Carrying
from placing.robot.checker import Held, SceneChecker
from placing.robot.distance_field import Mask
from placing.robot.driving import Floor
from placing.robot.errands import Boxes, Errand
from placing.robot.exact import Exact
from placing.robot.goals import goals_of
from placing.robot.grasps import Grasp, GraspSheet, grasps_of
from placing.robot.hands import Hands
from placing.robot.held_shapes import carried, cells_of
from placing.robot.motions import segments_of
from placing.robot.paths import Query
from placing.robot.planning import FALLS, TOO_WIDE, Motion, PlanningConfig, Refusal
from placing.robot.reach import standing_places
from placing.robot.search import Search
from placing.scene import SceneObject, standing_at
from placing.seeds import generator

Complaint = Callable[[Motion], str]
"""Returns why a motion is not accepted, one of `planning.REASONS`; empty if it is."""

OWN = ""
"""Name of the box of the object itself, which no object has."""


def no_complaint(motion: Motion) -> str:
    """Accept every motion that is free among the points of the scan."""
    return ""


class Seeker:
    """Seeks motions of one robot in one scene."""

    def __init__(
        self,
        checker: SceneChecker,
        floor: Floor,
        exact: Exact,
        sheet: GraspSheet,
        config: PlanningConfig,
        seed: int,
    ) -> None:
        """Take a robot in a scene; `exact` knows where objects touch what is below."""
        self.checker, self.floor, self.exact = checker, floor, exact
        self.config, self.seed = config, seed
        self._sheet, self._carrying = sheet, Carrying(checker)
        self._grasps: dict[str, dict[str, tuple[Grasp, Held]]] = {}
        self._places: dict[bytes, Array] = {}
        self._stands: dict[tuple, Mask] = {}
        self._hands = Hands(checker)

    def grasps(self, item: SceneObject) -> dict[str, tuple[Grasp, Held]]:
        """Return the grasps of an object that fit the gripper, with what is held."""
        name, opening_m = item.object_id, self.checker.model.settings.max_opening_m
        if name not in self._grasps:
            cells = cells_of(self.exact.bodies[name])
            self._grasps[name] = {
                g.name: (g, carried(name, item.size_m, cells, g.T_tool_object))
                for g in grasps_of(item, self._sheet, opening_m, self.config.tip_m)
            }
        return self._grasps[name]

    def sought(
        self, errand: Errand, complaint: Complaint = no_complaint
    ) -> Motion | Refusal:
        """Return the first motion that is accepted, or why there is none.

        Raises `BadInput` where the robot cannot stand at its start.
        """
        self._check_start(errand.start)
        grasps = self.grasps(errand.item)
        some = [grasps[name] for name in grasps if errand.grasp in ("", name)]
        if not some:
            return Refusal(TOO_WIDE, ())
        search = self._search(errand, some)
        if search.stands.any():
            motion = self._accepted(search, complaint)
            if motion is not None:
                return motion
        blamed = to_blame(search, errand.boxes, self.config.blame_m)
        return Refusal(search.reason, blamed)

    def _accepted(self, search: Search, complaint: Complaint) -> Motion | None:
        """Return the first motion that is accepted."""
        fallen_m = np.inf
        for goal in goals_of(search, self.floor, self._carrying, self.config):
            # What falls from some height falls from above it.
            if goal.grasp.release_m >= fallen_m:
                continue
            segments = segments_of(search, goal, self.floor)
            if segments is not None:
                T_tool_object, T = goal.grasp.T_tool_object, search.T_world_object
                name, grasp = goal.held.object_id, goal.grasp.name
                motion = Motion(name, T, grasp, T_tool_object, segments)
                reason = complaint(motion)
                if not reason:
                    return motion
                search.reached(reason)
                if reason == FALLS:
                    fallen_m = goal.grasp.release_m
            if search.n_paths <= 0:
                break
        return None

    def among(self, boxes: Boxes) -> SceneChecker:
        """Return the checker with boxes beside those it knows."""
        more = [boxes[name] for name in sorted(boxes)]
        own = np.array(self.checker.boxes, float).reshape(-1, 7)
        return self.checker.with_boxes(np.vstack([own, *more]))

    def among_all(
        self, boxes: Boxes, item: SceneObject, T_world_object: Array
    ) -> SceneChecker:
        """Return the checker with boxes, and that of an object where it stands."""
        return self.among({**boxes, OWN: standing_at(item, T_world_object)})

    def _search(self, errand: Errand, grasps: list[tuple[Grasp, Held]]) -> Search:
        """Return a search that has not begun, with the object where it touches."""
        item = errand.item
        bases, stands = self._standing_places(errand)
        T_world_object = errand.T_world_object
        if errand.is_putting and stands.any():
            T_world_object = self.exact.contact(item, T_world_object, errand.boxes)
        return Search(
            errand.is_putting,
            T_world_object,
            bases,
            stands,
            grasps,
            self.among(errand.boxes),
            self.among_all(errand.boxes, item, T_world_object),
            self._hands,
            errand.start,
            self.query(item, errand.T_world_object),
            self.config.n_paths,
        )

    def _standing_places(self, errand: Errand) -> tuple[Array, Mask]:
        """Return where the robot can stand to reach a point of the plan, (b, 3).

        That is where nothing else stands; at which of these it can stand now is (b,).
        """
        key = errand.T_world_object[4:6].tobytes()
        if key not in self._places:
            args = self.checker, errand.T_world_object, self.config
            self._places[key] = standing_places(self.floor, *args)
        bases, checker = self._places[key], self.among(errand.boxes)
        if (key, checker.boxes) not in self._stands:
            stands = checker.are_free(self.floor.configurations(bases))
            self._stands[key, checker.boxes] = stands
        return bases, self._stands[key, checker.boxes]

    def _check_start(self, start: Array | None) -> None:
        """Raise `BadInput` where the robot cannot stand at its start."""
        if start is not None and not self.checker.is_free(start):
            robot = self.checker.model.settings.robot
            x, y, yaw = np.round(start[:3], 2).tolist()
            raise BadInput(
                f"{self.floor.scene}: start: the robot {robot} at"
                f" x {x}, y {y}, yaw {yaw} is in collision; expected a free place"
            )

    def query(self, item: SceneObject, T_world_object: Array) -> Query:
        """Return the limits of a query, with the seed of a placement."""
        where = T_world_object.tobytes().hex()
        rng = generator(self.seed, "putting", item.object_id, where)
        seed = int(rng.integers(1, 2**31))
        return Query(seed, self.config.n_checks, self.config.range_rad)

"""The scenarios of Section 4.3: objects are fetched from a table and arranged.

Each object is picked up where it starts and put where people would have it, with one
grasp for both. Where and in which order is for `robot_arranging` to say; what waits on
the pick-up table is in the way like everything else.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray
from shapely import Point
from shapely.geometry.base import BaseGeometry

from placing.learning.learned import Choices
from placing.methods.answering import Asked
from placing.methods.scene_model import SceneModel
from placing.physics.cutting import solids_of
from placing.plans.offering import OPTION_COLUMNS, OfferingConfig, offered_rows
from placing.plans.robot_arranging import (
    Robot,
    Robotic,
    RobotPlacingConfig,
    Standing,
    Step,
    arrange,
)
from placing.plans.robot_candidates import Candidate, candidates_of, in_falling_score
from placing.plans.robot_scene import RobotConfig, placer_in
from placing.robot.certificates import Certificate, World, certificate_of
from placing.robot.errands import Answer, Boxes, Errand
from placing.robot.grasps import GraspSheet
from placing.robot.model import RobotModel
from placing.robot.paths import connect
from placing.robot.planning import NO_PATH, Motion, Refusal, Segment
from placing.robot.putting import Placer
from placing.rooms.checks import footprint
from placing.scene import Layout, SceneObject, standing_at
from placing.tasks import questions

Array = NDArray[np.float64]
Poses = Mapping[str, Array]
"""`T_world_object` (7,) by object id."""

SAME = 1e-9
"""Guards the comparison of two configurations that are the same."""
PICKUP_TABLE = "pickup_table"
"""The furniture on which objects wait."""


@dataclass(frozen=True)
class ScenarioConfig(RobotConfig):
    """Sections of the configuration that planning a scenario looks at."""

    offering: OfferingConfig
    robot_placing: RobotPlacingConfig


@dataclass(frozen=True)
class Fetching:
    """Plans to fetch objects from where they start."""

    placer: Placer
    items: Mapping[str, SceneObject]
    starts: Poses
    _known: dict[tuple[str, str], bool] = field(default_factory=dict)

    @property
    def robot(self) -> Robot:
        """What the search for an order asks."""
        placer = self.placer
        return Robot(
            partial(self._put, placer.planned), partial(self._put, placer.carried_out)
        )

    def _put(
        self,
        answer: Answer,
        item: SceneObject,
        T_world_object: Array,
        boxes: Boxes,
    ) -> Motion | Refusal:
        """Return how an object is put somewhere with a grasp that picks it up too."""
        errand = Errand(True, item, T_world_object, self.boxes_around(item, boxes))
        first = answer(errand)
        if isinstance(first, Refusal) or self._picks(item, first.grasp):
            return first
        for grasp in self.placer.seeker.grasps(item):
            if self._picks(item, grasp):
                found = answer(replace(errand, grasp=grasp))
                if isinstance(found, Motion):
                    return found
        return Refusal(NO_PATH, ())

    def on_the_way(
        self, step: Step, T_world_start: Array, others: Poses, q: Array | None
    ) -> tuple[Motion, Motion] | Refusal:
        """Return how an object is picked and put by a robot that waits at `q`.

        The grasp of the step is the first one that is tried.
        """
        item = self.items[step.candidate.object_id]
        T = step.candidate.placement(item).T_world_object
        boxes = {name: standing_at(self.items[name], p) for name, p in others.items()}
        names = [*self.placer.seeker.grasps(item)]
        names.sort(key=lambda name: name != step.motion.grasp)
        found = Refusal(NO_PATH, ())
        for back in (None, self._way_home(T_world_start, item, boxes, q)):
            for grasp in names:
                start = q if back is None else back[-1]
                errand = Errand(False, item, T_world_start, boxes, grasp, start)
                pick = self.placer.carried_out(errand)
                if isinstance(pick, Refusal):
                    continue
                end = pick.segments[-1].path[-1]
                errand = Errand(True, item, T, boxes, grasp, end)
                found = self.placer.carried_out(errand)
                if isinstance(found, Refusal):
                    continue
                put = self._joined(end, found, item, boxes)
                if put is not None:
                    return _after(back, pick), put
                found = Refusal(NO_PATH, ())
        return found

    def _joined(
        self, q: Array, put: Motion, item: SceneObject, boxes: Mapping[str, Array]
    ) -> Motion | None:
        """Return a motion that starts at `q`, the arm moved to how it carries."""
        begin = put.segments[0].path[0]
        if np.abs(begin - q).max() < SAME:
            return put
        seeker = self.placer.seeker
        _, held = seeker.grasps(item)[put.grasp]
        query = seeker.query(item, put.T_world_object)
        path = connect(seeker.among(boxes), q, begin, held, query)
        if path is None:
            return None
        first = Segment("shift", path, True, put.segments[0].opening_m)
        return replace(put, segments=(first, *put.segments))

    def _way_home(
        self,
        T_world_start: Array,
        item: SceneObject,
        boxes: Mapping[str, Array],
        q: Array | None,
    ) -> Array | None:
        """Return how the robot drives from `q` to where the floor is most open."""
        if q is None:
            return None
        seeker = self.placer.seeker
        checker = seeker.among_all(boxes, item, T_world_start)
        return seeker.floor.path(seeker.floor.start, checker, None, start=q)

    def boxes_around(
        self, item: SceneObject, placed: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Return the boxes of what is placed and of all that waits, but the object."""
        waiting = {
            name: standing_at(self.items[name], T)
            for name, T in self.starts.items()
            if name not in placed and name != item.object_id
        }
        return {**waiting, **placed}

    def _picks(self, item: SceneObject, grasp: str) -> bool:
        """Return whether a grasp picks an object up while all others wait."""
        key = item.object_id, grasp
        if key not in self._known:
            T, around = self.starts[item.object_id], self.boxes_around(item, {})
            found = self.placer.carried_out(Errand(False, item, T, around, grasp))
            self._known[key] = isinstance(found, Motion)
        return self._known[key]


def _after(back: Array | None, pick: Motion) -> Motion:
    """Return picking an object up after driving back, if that is needed."""
    if back is None:
        return pick
    opening_m = pick.segments[0].opening_m
    first = Segment("return", back, False, opening_m)
    return replace(pick, segments=(first, *pick.segments))


def off_table(
    candidates: Mapping[str, Sequence[Candidate]], table: BaseGeometry
) -> dict[str, list[Candidate]]:
    """Return the candidates that are not on, above or below the pick-up table."""
    # ASSUME: nothing is put back on the table that it was brought on.
    return {
        name: [c for c in some if not table.covers(Point(c.resting_point[:2]))]
        for name, some in candidates.items()
    }


def fetched(
    fetching: Fetching, robotic: Robotic, world: World
) -> tuple[list[Certificate], dict[str, str]]:
    """Return the certificates of an order carried out in one go, and what fails.

    The robot drives on from where it has put the last object.
    """
    poses, q, certificates, failed = dict(fetching.starts), None, [], {}
    for step in robotic.steps:
        name = step.candidate.object_id
        others = {other: pose for other, pose in poses.items() if other != name}
        motions = fetching.on_the_way(step, poses[name], others, q)
        if isinstance(motions, Refusal):
            failed[name] = motions.reason
            continue
        certificates.append(certificate_of(world, motions, others))
        poses[name] = motions[1].T_world_object
        q = motions[1].segments[-1].path[-1]
    return certificates, failed


def plan_scenario(
    asked: Asked,
    layout: Layout,
    points_m: Array,
    robot: tuple[RobotModel, GraspSheet],
    config: ScenarioConfig,
    seed: int,
) -> tuple[Robotic, list[Certificate], dict[str, str]]:
    """Return what a robot arranges, how it carries that out, and what it cannot.

    `points_m` (p, 3) is the scan of the scene.
    """
    items = {item.object_id: item for item in layout.objects}
    (start,) = layout.arrangements
    starts = {p.object_id: p.T_world_object for p in start.placements}
    scene, margin_m = asked.model.scene, config.settling.margin_m
    args = solids_of(layout, scene.objects, margin_m), *robot, config, seed
    with placer_in(scene, points_m, *args) as placer:
        fetching = Fetching(placer, items, starts)
        possible = possible_in(asked, layout, config.offering)
        distance_m = asked.model.settings.decision.min_distance_m
        standing = Standing(items, (), distance_m)
        robotic = arrange(possible, standing, fetching.robot, config.robot_placing)
        return robotic, *fetched(fetching, robotic, world_of(layout.scene))


def asked_about(model: SceneModel, stream: Callable[..., Generator]) -> Asked:
    """Return the question about all objects of a scenario, with its streams."""
    (question,) = questions(model.scene, "empty")
    # `dp` asks for no K and no omega.
    return Asked(partial(stream, model.scene.scene), model, question, Choices(1, 1.0))


def possible_in(
    asked: Asked, layout: Layout, config: OfferingConfig
) -> dict[str, list[Candidate]]:
    """Return where every object may go, best first."""
    rows = offered_rows("empty", asked, config)
    options = pd.DataFrame(rows, columns=list(OPTION_COLUMNS))
    table = next(f for f in layout.furniture if f.furniture_id == PICKUP_TABLE)
    left = off_table(
        candidates_of(options), footprint(table.size_m, table.T_world_furniture)
    )
    return {name: in_falling_score(some) for name, some in left.items()}


def world_of(scene: str) -> World:
    """Return what the certificates of a scenario were made for."""
    return World("scenarios", scene, "empty", "all", "inside")

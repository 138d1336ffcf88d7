"""A robot in a scene: what it plans with, from a scan, and what checks its plans."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from placing.physics.bodies import Solids
from placing.physics.settling import SettleConfig
from placing.plans.robot_arranging import Robot
from placing.rigid import Array
from placing.robot.checker import CheckerConfig, SceneChecker
from placing.robot.distance_field import distance_field
from placing.robot.driving import Floor
from placing.robot.errands import Answer, Boxes, Errand
from placing.robot.exact import Exact
from placing.robot.grasps import GraspSheet
from placing.robot.model import RobotModel
from placing.robot.planning import Motion, PlanningConfig, Refusal
from placing.robot.putting import Placer
from placing.robot.seeking import Seeker
from placing.robot.truth import Truth
from placing.scene import Scene, SceneObject


@dataclass(frozen=True)
class RobotConfig:
    """The sections of the configuration that a robot in a scene looks at."""

    checking: CheckerConfig
    planning: PlanningConfig
    settling: SettleConfig


def robot_of(placer: Placer) -> Robot:
    """Return what the search for an order asks, answered by a planner."""
    return Robot(partial(_put, placer.planned), partial(_put, placer.carried_out))


def _put(
    answer: Answer, item: SceneObject, T_world_object: Array, boxes: Boxes
) -> Motion | Refusal:
    """Return how an object is put somewhere."""
    return answer(Errand(True, item, T_world_object, boxes))


@contextmanager
def placer_in(
    scene: Scene,
    points: NDArray[np.floating],
    solids: Solids,
    model: RobotModel,
    sheet: GraspSheet,
    config: RobotConfig,
    seed: int,
) -> Iterator[Placer]:
    """Give a planner that sees the points (p, 3) of a scene.

    What it carries out is checked among what is really there.
    """
    checking, planning, settling = config.checking, config.planning, config.settling
    checker = SceneChecker(model, distance_field(points, checking), checking)
    floor = Floor(checker, planning, scene.scene)
    with Truth(model, solids.fixed, checking, settling) as truth:
        exact = Exact(truth, solids.bodies, settling.margin_m, planning.contact_m)
        seeker = Seeker(checker, floor, exact, sheet, planning, seed)
        yield Placer(seeker, exact)

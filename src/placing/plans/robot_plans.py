"""What a robot makes of the questions about a scene, in both modes of Table 1.

`with` is the paper's: what people would have is arranged without regard to the robot,
then filtered. `inside` chooses among all that the robot can do by the same density.
"""

from collections.abc import Iterator, Sequence

import pandas as pd

from placing.methods.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.plans.robot_arranging import (
    Robot,
    Robotic,
    RobotPlacingConfig,
    Standing,
    arrange,
)
from placing.plans.robot_candidates import (
    arranged,
    candidates_of,
    in_falling_score,
)
from placing.robot.certificates import Certificate, World, certificate_of
from placing.scene import Scene
from placing.tasks import TASKS, Question, questions

WITHOUT, WITH, INSIDE = "without", "with", "inside"
CONSTRAINTS = (WITHOUT, WITH, INSIDE)
"""How the robot is looked at; what is arranged without it is no plan."""
REFUSED = "refused"
"""The status of an object that the robot does not place."""
PLAN_COLUMNS = (
    *("dataset", "scene", "task", "question", "labels", "constraints", "object"),
    *("category", "status", "reason", "order", "option", "heading", "grasp", "area"),
    *(*LOCATION, *ORIENTATION, "n_calls"),
)
"""One row per wanted object that the robot can carry, per question and constraints."""

TRIED_COLUMNS = (
    *("dataset", "scene", "task", "question", "labels", "constraints", "object"),
    *("option", "heading", "among", "reason", "blockers", *LOCATION, *ORIENTATION),
)
"""One row per time that the robot was asked, in order; names joined by `+`."""


def asked_of_robot(scene: Scene, task: str, n_labels: int) -> list[Question]:
    """Return the questions of a task with an object that the robot can carry.

    In a filled scene those about its first `n_labels` labelled arrangements.
    """
    # ASSUME: what the robot cannot carry is brought into an empty scene later.
    labels = sorted(arrangement.name for arrangement in scene.arrangements)
    known = {"", *labels[:n_labels]}
    every = [q for q in questions(scene, task) if q.labels in known]
    return [q for q in every if any(item.is_movable for item in q.wanted)]


def plan(
    question: Question,
    scene: Scene,
    options: pd.DataFrame,
    robot: Robot,
    min_distance_m: float,
    config: RobotPlacingConfig,
) -> Iterator[tuple[str, Robotic]]:
    """Yield the constraints and what the robot makes of a question under them.

    `options` are those of the question.
    """
    items = {item.object_id: item for item in scene.objects}
    standing = Standing(items, question.given, min_distance_m)
    found = candidates_of(options)
    movable = sorted(item.object_id for item in question.wanted if item.is_movable)
    every = {name: found.get(name, []) for name in movable}
    modes = {name: arranged(c, config.n_arranged) for name, c in every.items()}
    yield WITH, arrange(modes, standing, robot, config)
    best = {name: in_falling_score(c) for name, c in every.items()}
    yield INSIDE, arrange(best, standing, robot, config)


def rows_of(
    world: World, question: Question, robotic: Robotic
) -> list[tuple[object, ...]]:
    """Return one row per wanted object that the robot can carry."""
    items = {item.object_id: item for item in question.wanted}
    named = (world.dataset, world.scene, world.task, question.name, question.labels)
    rows = []
    for order, step in enumerate(robotic.steps):
        candidate, item = step.candidate, items[step.candidate.object_id]
        placement = candidate.placement(item)
        row = (*named, world.constraints, item.object_id, item.category, PLACED, "")
        row += (order, candidate.option, candidate.heading, step.motion.grasp)
        pose = (*placement.location.tolist(), *placement.orientation.tolist())
        rows.append((*row, candidate.area, *pose, len(robotic.tried)))
    for name, reason in sorted(robotic.refused.items()):
        row = (*named, world.constraints, name, items[name].category, REFUSED, reason)
        rows.append((*row, -1, -1, -1, "", "", *[float("nan")] * 7, len(robotic.tried)))
    return rows


def tried_rows(
    world: World, question: Question, robotic: Robotic
) -> list[tuple[object, ...]]:
    """Return one row per time that the robot was asked; the reason is "" if it can."""
    items = {item.object_id: item for item in question.wanted}
    named = (world.dataset, world.scene, world.task, question.name, question.labels)
    rows = []
    for one in robotic.tried:
        candidate = one.candidate
        placement = candidate.placement(items[candidate.object_id])
        row = (*named, world.constraints, candidate.object_id, candidate.option)
        row += (candidate.heading, "+".join(one.among), one.reason)
        pose = (*placement.location.tolist(), *placement.orientation.tolist())
        rows.append((*row, "+".join(one.blockers), *pose))
    return rows


def certificates_of(world: World, robotic: Robotic) -> list[Certificate]:
    """Return the certificate of every executed placement, in order."""
    return [
        certificate_of(world, (step.motion,), step.standing) for step in robotic.steps
    ]


def plan_table(rows: Sequence[tuple[object, ...]]) -> pd.DataFrame:
    """Return what becomes of every wanted object as a table."""
    return pd.DataFrame(rows, columns=list(PLAN_COLUMNS))


def tried_table(rows: Sequence[tuple[object, ...]]) -> pd.DataFrame:
    """Return every placement that was tried as a table."""
    return pd.DataFrame(rows, columns=list(TRIED_COLUMNS))


class Planned:
    """What a robot makes of the scenes of a fold, filled scene by scene."""

    def __init__(
        self,
        dataset: str,
        options: pd.DataFrame,
        min_distance_m: float,
        config: RobotPlacingConfig,
    ) -> None:
        """Start empty; `options` are those of all scenes and tasks."""
        self.certificates: list[Certificate] = []
        self._dataset, self._min_distance_m = dataset, min_distance_m
        self._config, self._none = config, options.iloc[:0]
        self._options = dict(tuple(options.groupby(["scene", "task", "question"])))
        self._rows: list[tuple[object, ...]] = []
        self._tried: list[tuple[object, ...]] = []

    def add(self, scene: Scene, robot: Robot) -> None:
        """Let the robot answer the questions of both tasks about a scene."""
        for task in TASKS:
            self._add(scene, task, robot)

    def _add(self, scene: Scene, task: str, robot: Robot) -> None:
        """Let the robot answer the questions of a task about a scene."""
        for question in asked_of_robot(scene, task, self._config.n_labels):
            key = scene.scene, task, question.name
            options = self._options.get(key, self._none)
            args = options, robot, self._min_distance_m, self._config
            for constraints, robotic in plan(question, scene, *args):
                world = World(self._dataset, *key, constraints)
                self._rows += rows_of(world, question, robotic)
                self._tried += tried_rows(world, question, robotic)
                self.certificates += certificates_of(world, robotic)

    def plans(self) -> pd.DataFrame:
        """Return what becomes of every wanted object."""
        return plan_table(self._rows)

    def tried(self) -> pd.DataFrame:
        """Return every placement that was tried."""
        return tried_table(self._tried)

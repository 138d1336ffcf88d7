"""Where a robot puts the objects of one question, and in which order (Section 3.3).

First what it cannot put anywhere is left out, each object alone among what stands
there; then an order is sought for the others, and where there is none, objects in
conflict are left out. Whether a step is feasible is for the robot to say: as planned
while an order is sought, as checked among the true furniture for every step of an
order that was found. What that check does not accept is ruled out, and an order is
sought again.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from placing.overlap import overlaps
from placing.plans.placing_order import Verdict
from placing.plans.robot_candidates import Candidate
from placing.plans.try_place import Found, Limits, place_most
from placing.robot.planning import NO_PLACE, REJECTED, Motion, Refusal
from placing.scene import Placement, SceneObject, standing_at

Array = NDArray[np.float64]
Put = Callable[[SceneObject, Array, Mapping[str, Array]], Motion | Refusal]
"""Puts an object at a pose (7,), with the boxes (7,) of what stands there."""

NO_OPTION = "no place fits"
IN_CONFLICT = "in conflict with other objects"
LIMIT = "limit of the search"
"""Reasons for leaving out an object beside those of the robot."""


@dataclass(frozen=True)
class Robot:
    """What a robot says about putting an object somewhere."""

    plan: Put
    """Among the points of the scan."""
    carry_out: Put
    """Among the true furniture, which takes longer."""


@dataclass(frozen=True)
class RobotPlacingConfig:
    """Settings of the search; the values live in `config/config.yaml`."""

    n_arranged: int
    """Modes that are arranged without regard to the robot, and then filtered."""
    n_labels: int
    """Labelled arrangements that fill a scene, the first ones by name."""
    max_calls: int
    """How often feasibility is asked."""
    max_steps: int
    """How often one more object is given a place."""

    @property
    def limits(self) -> Limits:
        """The limits of the search."""
        return Limits(self.max_calls, self.max_steps)


@dataclass(frozen=True)
class Standing:
    """What stands in a scene when a question is asked."""

    items: Mapping[str, SceneObject]
    """All objects of the scene by id."""
    given: tuple[Placement, ...]
    min_distance_m: float
    """Between two objects of one category that are placed."""


@dataclass(frozen=True)
class Step:
    """One executed placement."""

    candidate: Candidate
    motion: Motion
    standing: dict[str, Array]
    """(7,) poses of all that stood there, by id."""


@dataclass(frozen=True)
class Tried:
    """What the robot said to one candidate."""

    candidate: Candidate
    among: tuple[str, ...]
    """Objects that it had placed before, sorted."""
    reason: str
    """Why it cannot put it; empty if it can."""
    blockers: tuple[str, ...]


@dataclass(frozen=True)
class Robotic:
    """What a robot makes of a question."""

    steps: tuple[Step, ...]
    """In the order in which they are carried out."""
    refused: dict[str, str]
    """The reason for each object that is not placed."""
    tried: tuple[Tried, ...]
    """In the order in which it was asked; what it carried out as planned once."""


def put_nowhere(
    item: SceneObject, T_world_object: Array, boxes: Mapping[str, Array]
) -> Refusal:
    """Return the answer of a robot that can stand nowhere in a scene."""
    return Refusal(NO_PLACE, ())


NOWHERE = Robot(put_nowhere, put_nowhere)
"""A robot that can stand nowhere in a scene."""


def arrange(
    possible: Mapping[str, Sequence[Candidate]],
    standing: Standing,
    robot: Robot,
    config: RobotPlacingConfig,
) -> Robotic:
    """Return what the robot places where and in which order.

    `possible` holds the candidates of every wanted object, best first.
    """
    asking = Asking(standing, robot)
    exclusive = Exclusion(standing, possible)
    while True:
        left, refused = asking.split(possible)
        worth = {name: candidates[0].log_score for name, candidates in left.items()}
        found, dropped = place_most(
            left, asking.feasible, config.limits, worth, exclusive=exclusive
        )
        steps = asking.carried_out(found.order)
        if steps is not None:
            refused |= _left_out(left, found, dropped)
            return Robotic(steps, refused, tuple(asking.tried))


def _left_out(
    left: Mapping[str, Sequence[Candidate]],
    found: Found[Candidate],
    dropped: Mapping[str, frozenset[str]],
) -> dict[str, str]:
    """Return the reason for each object that has no place in the order."""
    placed = {candidate.object_id for candidate in found.order}
    return {
        name: IN_CONFLICT if name in dropped else LIMIT
        for name in left
        if name not in placed
    }


Attempt = tuple[Candidate, frozenset[Candidate]]
"""One more placement, and those before it."""
NOTHING: frozenset[Candidate] = frozenset()
MOST_REJECTED = 3
"""A placement that the exact check does not accept so often is not tried again."""


class Asking:
    """Asks the robot, and keeps what it answers."""

    def __init__(self, standing: Standing, robot: Robot) -> None:
        """Put what is given where it stands."""
        self.tried: list[Tried] = []
        self._standing, self._robot = standing, robot
        self._given = {p.object_id: p.T_world_object for p in standing.given}
        self._alone: dict[Candidate, Motion | Refusal] = {}
        self._out_of_reach: dict[tuple[str, int], Refusal] = {}
        self._planned: dict[Attempt, Motion | Refusal] = {}
        self._ruled_out: dict[Candidate, list[frozenset[Candidate]]] = {}

    def split(
        self, possible: Mapping[str, Sequence[Candidate]]
    ) -> tuple[dict[str, list[Candidate]], dict[str, str]]:
        """Return the candidates of objects that can be put alone, else the reasons."""
        left, refused = {}, {}
        for name, candidates in possible.items():
            survivors, reason = self.survivors(candidates)
            if survivors:
                left[name] = survivors
            else:
                refused[name] = reason
        return left, refused

    def survivors(self, candidates: Sequence[Candidate]) -> tuple[list[Candidate], str]:
        """Return the candidates from the first on that the robot can put alone.

        Those after it are looked at when the search needs them. Where there is none,
        the reason is that of the best one.
        """
        for n, candidate in enumerate(candidates):
            if isinstance(self.alone(candidate), Motion):
                return list(candidates[n:]), ""
        reasons = [self.alone(c) for c in candidates]
        first = reasons[0] if reasons else None
        return [], first.reason if isinstance(first, Refusal) else NO_OPTION

    def alone(self, candidate: Candidate) -> Motion | Refusal:
        """Return how the robot puts an object among what is given, nothing else."""
        if candidate not in self._alone:
            place = candidate.object_id, candidate.option
            found = self._out_of_reach.get(place)
            found = found or self._plan(candidate, NOTHING)
            # Where the robot can stand to put an object is the same for all headings.
            if isinstance(found, Refusal) and found.reason == NO_PLACE:
                self._out_of_reach[place] = found
            self._alone[candidate] = found
        return self._alone[candidate]

    def feasible(
        self, candidate: Candidate, placed: frozenset[Candidate]
    ) -> Verdict[Candidate]:
        """Return whether the robot can put an object when others are placed."""
        found = self.alone(candidate)
        if isinstance(found, Refusal):
            return Verdict(False)
        # More objects never make a placement easier.
        for others in self._ruled_out.get(candidate, ()):
            if others <= placed:
                return Verdict(False, others)
        if placed:
            key = candidate, placed
            if key not in self._planned:
                self._planned[key] = self._plan(*key)
            found = self._planned[key]
        if isinstance(found, Motion):
            return Verdict(True)
        blockers = frozenset(c for c in placed if c.object_id in found.blockers)
        # Alone it could be put: if the robot blames nothing, all that is new is to
        # blame.
        return Verdict(False, blockers or placed)

    def carried_out(self, order: Sequence[Candidate]) -> tuple[Step, ...] | None:
        """Return the motions of an order; None if not all steps can be carried out.

        Then the step that cannot is ruled out.
        """
        steps, poses = [], dict(self._given)
        for n, candidate in enumerate(order):
            found = self._ask(self._robot.carry_out, candidate, poses)
            if isinstance(found, Refusal):
                self._rule_out(candidate, frozenset(order[:n]), found)
                return None
            steps.append(Step(candidate, found, dict(poses)))
            poses[candidate.object_id] = found.T_world_object
        return tuple(steps)

    def _rule_out(
        self, candidate: Candidate, placed: frozenset[Candidate], found: Refusal
    ) -> None:
        """Rule out a placement that cannot be carried out beside others, or at all."""
        self._note(candidate, placed, found)
        known = self._ruled_out.setdefault(candidate, [])
        known.append(placed)
        alone = found
        if placed:
            alone = self._ask(self._robot.carry_out, candidate, self._given)
            if isinstance(alone, Refusal):
                self._note(candidate, NOTHING, alone)
        if isinstance(alone, Refusal):
            self._alone[candidate] = alone
        elif len(known) >= MOST_REJECTED:
            # ASSUME: the search has to end, and other places are as good.
            self._alone[candidate] = Refusal(REJECTED, ())

    def _plan(
        self, candidate: Candidate, placed: frozenset[Candidate]
    ) -> Motion | Refusal:
        """Return how an object would be put where others would stand."""
        poses = self._given | {c.object_id: self._left_at(c) for c in placed}
        found = self._ask(self._robot.plan, candidate, poses)
        self._note(candidate, placed, found)
        return found

    def _ask(
        self, put: Put, candidate: Candidate, poses: Mapping[str, Array]
    ) -> Motion | Refusal:
        """Return what the robot says to a placement among objects at poses (7,)."""
        items = self._standing.items
        boxes = {name: standing_at(items[name], poses[name]) for name in sorted(poses)}
        item = items[candidate.object_id]
        return put(item, candidate.placement(item).T_world_object, boxes)

    def _note(
        self,
        candidate: Candidate,
        placed: frozenset[Candidate],
        found: Motion | Refusal,
    ) -> None:
        """Keep what the robot said for the record."""
        refused = found if isinstance(found, Refusal) else Refusal("", ())
        among = tuple(sorted(c.object_id for c in placed))
        self.tried.append(Tried(candidate, among, refused.reason, refused.blockers))

    def _left_at(self, candidate: Candidate) -> Array:
        """Return where the motion alone leaves an object, (7,)."""
        motion = self._alone[candidate]
        assert isinstance(motion, Motion), "what is placed can be placed alone"
        return motion.T_world_object


N_TOGETHER = 128
"""Placements compared together with all others; only speed and memory depend on it."""


class Exclusion:
    """Tells of two placements that cannot both be, without asking the robot."""

    def __init__(
        self, standing: Standing, possible: Mapping[str, Sequence[Candidate]]
    ) -> None:
        """Compare all candidates: in each other, or of one category and too near."""
        every = [c for candidates in possible.values() for c in candidates]
        self._number = {candidate: n for n, candidate in enumerate(every)}
        items = [standing.items[c.object_id] for c in every]
        boxes = np.array(
            [
                [*c.resting_point, *item.size_m, c.yaw_rad]
                for c, item in zip(every, items, strict=True)
            ]
        ).reshape(-1, 7)
        boxes[:, 2] += boxes[:, 5] / 2
        _, kind = np.unique([item.category for item in items], return_inverse=True)
        at = np.array([c.resting_point for c in every]).reshape(-1, 3)
        self._excludes = np.empty((len(every), len(every)), np.bool_)
        for first in range(0, len(every), N_TOGETHER):
            some = slice(first, first + N_TOGETHER)
            is_near = cdist(at[some], at) < standing.min_distance_m
            is_twin = is_near & (kind[some, None] == kind)
            self._excludes[some] = overlaps(boxes[some], boxes) | is_twin

    def __call__(self, one: Candidate, other: Candidate) -> bool:
        """Return whether two placements cannot both be."""
        return bool(self._excludes[self._number[one], self._number[other]])

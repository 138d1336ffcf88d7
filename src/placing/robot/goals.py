"""A search for a motion, and the goals at an object that it goes through.

Letters: k goals, a joints of the arm.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from placing import rigid
from placing.rigid import Array
from placing.robot.carrying import Carrying
from placing.robot.checker import Held, SceneChecker
from placing.robot.driving import Floor
from placing.robot.grasps import Grasp
from placing.robot.paths import Query
from placing.robot.planning import (
    GOAL_HIT,
    NO_ARM,
    NO_PATH,
    REASONS,
    TOO_WIDE,
    PlanningConfig,
)
from placing.robot.reach import (
    Goal,
    best_first,
    hands_at,
    has_hand_lines,
    straight_back,
    straight_down,
)

N_TOGETHER = 16
"""Base poses tried together at first; each time twice as many as before."""


@dataclass
class Search:
    """One search for a motion, and how far it has come."""

    is_putting: bool
    T_world_object: Array
    """(7,) where the object stands when it is not held."""
    grasps: Sequence[tuple[Grasp, Held]]
    without: SceneChecker
    """Knows what stands there but the object."""
    among: SceneChecker
    """Knows the object as well."""
    alone: SceneChecker
    """Knows only what always stands there."""
    start: Array | None
    """Where the robot waits, by default where the floor is most open."""
    query: Query
    n_paths: int
    """Paths that may still be sought."""
    reason: str = TOO_WIDE
    n_free: int = 0
    """Goals found free."""
    blocked: list[frozenset[int]] = field(default_factory=list)
    """Numbers of the boxes that each goal hits which is free without them."""

    def reached(self, reason: str) -> None:
        """Remember the reason if the search came as far as that."""
        if REASONS.index(reason) > REASONS.index(self.reason):
            self.reason = reason


def goals_of(
    search: Search,
    bases: Array,
    floor: Floor,
    carrying: Carrying,
    config: PlanningConfig,
) -> Iterator[Goal]:
    """Yield goals that are free and have free straight lines, grasp by grasp.

    `bases` (b, 3) are where the robot can stand.
    """
    search.reached(NO_ARM)
    stand = Standing(search, floor, carrying)
    for grasp, held in search.grasps:
        release_m = grasp.release_m if search.is_putting else 0.0
        T_let_go = search.T_world_object + np.array([0, 0, 0, 0, 0, 0, release_m])
        T_world_tool = rigid.compose(T_let_go, grasp.T_object_tool)
        if not is_hand_free(search, T_world_tool, held, config):
            continue
        n_left = config.n_goals
        for q in free_goals(search, bases, T_world_tool, held):
            carry = stand.carried_to(q, held)
            if carry is None:
                continue
            down = straight_down(search.without, q, held, config)
            if down is not None:
                back = straight_back(
                    search.without, search.among, q, T_world_tool, config
                )
                if back is not None:
                    yield Goal(grasp, held, carry, T_let_go, down, back)
            n_left -= 1
            if n_left == 0:
                break


def is_hand_free(
    search: Search, T_world_tool: Array, held: Held, config: PlanningConfig
) -> bool:
    """Return whether the hand alone can come down there and draw back.

    It is looked at before any arm: most places that cannot be reached are too narrow
    for the hand.
    """
    T = rigid.homogeneous(T_world_tool)
    if not search.alone.are_hands_free(T[None], held, touching=True)[0]:
        search.reached(GOAL_HIT)
        return False
    hits = search.without.hand_hits(T, held, touching=True)
    if hits:
        search.reached(GOAL_HIT)
        search.blocked.append(frozenset(hits))
        return False
    if has_hand_lines(search.without, search.among, T, held, config):
        return True
    search.reached(GOAL_HIT)
    search.n_free += not has_hand_lines(search.alone, search.alone, T, held, config)
    return False


class Standing:
    """How the torso goes up and down at the base poses of one search, remembered."""

    def __init__(self, search: Search, floor: Floor, carrying: Carrying) -> None:
        """Remember nothing yet."""
        self.search, self.floor, self.carrying = search, floor, carrying
        self._folds: dict[bytes, bool] = {}
        self._carries: dict[tuple[bytes, int], Array | None] = {}

    def carried_to(self, q: Array, held: Held) -> Array | None:
        """Return the first arm (a,) that carries an object to base and torso of `q`.

        There is none where the folded arm could not go up or down there either.
        """
        place = q[:4].tobytes()
        if place not in self._folds:
            stow = np.asarray(self.search.among.model.settings.stow)
            self._folds[place] = self._rises(self.search.among, q, stow, None)
        if not self._folds[place]:
            self.search.reached(NO_PATH)
            return None
        key = place, id(held)
        if key not in self._carries:
            arms = self.carrying.arms_for(held)
            checker = self.search.without
            free = (arm for arm in arms if self._rises(checker, q, arm, held))
            self._carries[key] = next(free, None)
            if self._carries[key] is None:
                self.search.reached(NO_PATH)
        return self._carries[key]

    def _rises(
        self, checker: SceneChecker, q: Array, arm: Array, held: Held | None
    ) -> bool:
        """Return whether the torso is free from below up to its height in `q`."""
        low = self.floor.configurations(q[:3], arm=arm)[0]
        return checker.is_edge_free(low, np.concatenate([q[:4], arm]), held)


def free_goals(
    search: Search,
    bases: Array,
    T_world_tool: Array,
    held: Held,
) -> Iterator[Array]:
    """Yield free solutions (4 + a,), some bases at a time; note what hits boxes."""
    checker, left, n = search.without, bases, N_TOGETHER
    while len(left):
        rows = hands_at(checker, left[:n], T_world_tool)
        left, n = left[n:], 2 * n
        if not len(rows):
            continue
        search.reached(GOAL_HIT)
        is_free = checker.are_free(rows, held, touching=True)
        search.n_free += int(is_free.sum())
        if len(checker.boxes) > len(search.alone.boxes) and not search.n_free:
            for row in rows[search.alone.are_free(rows, held, touching=True)]:
                hits = checker.hits(row, held, touching=True)
                search.blocked.append(frozenset(hits.boxes))
        yield from best_first(rows[is_free], checker.model.settings.carry)

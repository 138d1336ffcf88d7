"""Goals at an object: arms from which straight lines lead to it and back.

Letters: t rows of a path, a joints of the arm.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from placing import rigid
from placing.rigid import Array
from placing.robot.carrying import Carrying
from placing.robot.checker import Held
from placing.robot.driving import Floor
from placing.robot.grasps import Grasp
from placing.robot.hands import best_first
from placing.robot.planning import GOAL_HIT, NO_ARM, NO_PATH, PlanningConfig
from placing.robot.reach import has_hand_lines, straight_back, straight_down
from placing.robot.search import Search
from placing.robot.stances import Stance, Stances


@dataclass(frozen=True)
class Goal:
    """A hand at an object, and how it comes there and leaves."""

    grasp: Grasp
    held: Held
    stance: Stance
    T_world_object: Array
    """(7,) where the hand lets go of it, or takes it."""
    down: Array
    """(t, 4 + a) straight down with the object, until it is let go."""
    back: Array
    """(t, 4 + a) straight back with the empty hand."""


def goals_of(
    search: Search, floor: Floor, carrying: Carrying, config: PlanningConfig
) -> Iterator[Goal]:
    """Yield goals that are free and have free straight lines, grasp by grasp."""
    search.reached(NO_ARM)
    stances = Stances(search, floor, carrying)
    for grasp, held in search.grasps:
        release_m = grasp.release_m if search.is_putting else 0.0
        T_let_go = search.T_world_object + np.array([0, 0, 0, 0, 0, 0, release_m])
        T_world_tool = rigid.compose(T_let_go, grasp.T_object_tool)
        if not is_hand_free(search, T_world_tool, held, config):
            continue
        n_left = config.n_goals
        for q in free_goals(search, T_world_tool, held):
            stance = stances.at(q, held)
            if stance is None:
                search.reached(NO_PATH)
                continue
            down = straight_down(search.without, q, held, config)
            if down is not None:
                back = straight_back(
                    search.without, search.among, q, T_world_tool, config
                )
                if back is not None:
                    yield Goal(grasp, held, stance, T_let_go, down, back)
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


def free_goals(search: Search, T_world_tool: Array, held: Held) -> Iterator[Array]:
    """Yield free solutions (4 + a,), some bases at a time; note what hits boxes."""
    checker = search.without
    for arms in search.hands.arms(search.bases, T_world_tool, held):
        if not (arms.is_reached & search.stands).any():
            continue
        search.reached(GOAL_HIT)
        stands = search.stands[arms.base]
        rows, bases = arms.rows[stands], arms.base[stands]
        # They are free where nothing else stands.
        is_free = checker.are_clear(rows, held, touching=True)
        search.n_free += int(is_free.sum())
        if len(checker.boxes) > len(search.alone.boxes) and not search.n_free:
            for row in rows:
                hits = checker.hits(row, held, touching=True)
                search.blocked.append(frozenset(hits.boxes))
        carry = checker.model.settings.carry
        yield from best_first(rows[is_free], bases[is_free], carry)

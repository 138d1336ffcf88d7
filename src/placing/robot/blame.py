"""Which of the objects that stand there keep the robot from a placement."""

from collections.abc import Mapping

import numpy as np

from placing.rigid import Array
from placing.robot.planning import GOAL_HIT
from placing.robot.search import Search

FLOOR_M = 0.05
"""What stands lower stands on the floor, where the base drives."""


def to_blame(
    search: Search, boxes: Mapping[str, Array], near_m: float
) -> tuple[str, ...]:
    """Return names of boxes without which there might be a motion, sorted.

    Where each goal hits a box these are few boxes that together block all goals, so
    that the placement stays blocked while they stand there. Else they are all that the
    robot could meet: within `near_m`, or on the floor.
    """
    names = sorted(boxes)
    n_always = len(search.alone.boxes)
    hits = [{i - n_always for i in hit if i >= n_always} for hit in search.blocked]
    if search.reason == GOAL_HIT and not search.n_free and hits and all(hits):
        return tuple(names[i] for i in cover(hits))
    x, y = search.T_world_object[4:6]
    return tuple(
        name
        for name in names
        if np.hypot(boxes[name][0] - x, boxes[name][1] - y) <= near_m
        or boxes[name][2] - boxes[name][5] / 2 < FLOOR_M
    )


def cover(hits: list[set[int]]) -> list[int]:
    """Return few numbers, sorted, of which each set holds one: the commonest first."""
    chosen, left = [], hits
    while left:
        counts: dict[int, int] = {}
        for hit in left:
            for i in hit:
                counts[i] = counts.get(i, 0) + 1
        best = min(counts, key=lambda i: (-counts[i], i))
        chosen.append(best)
        left = [hit for hit in left if best not in hit]
    return sorted(chosen)

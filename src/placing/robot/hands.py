"""Arms that bring the hand to a place from the bases around it, remembered.

What is free where nothing else stands is found once; beside objects only that is looked
at again. Letters: b base poses, n bases at heights of the torso, k solutions, a joints
of the arm.
"""

from collections.abc import Iterator
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.distance_field import Mask
from placing.robot.inverse import solutions_at
from placing.robot.model import RobotModel

N_TOGETHER = 16
"""Base poses tried together at first; each time twice as many as before."""
MOST_KEPT = 96
"""Places of the hand that are remembered; only speed and memory depend on it."""
MIN_FACING = -0.3
"""Least cosine between where the fingers point and where the robot looks."""


class Arms(NamedTuple):
    """Arms that bring the hand to a place from some of the bases."""

    is_reached: Mask
    """From which of all bases there is one, free or not, (b,)."""
    base: NDArray[np.int64]
    """Number of the base of each that is free where nothing else stands, (k,)."""
    rows: Array
    """Those configurations, (k, 4 + a)."""


class Hands:
    """The hand at places of one scene, where nothing else stands."""

    def __init__(self, alone: SceneChecker) -> None:
        """Take the checker of the scene alone, and remember nothing yet."""
        self.alone = alone
        self._found: dict[tuple[bytes, int], list[Arms]] = {}

    def arms(self, bases: Array, T_world_tool: Array, held: Held) -> Iterator[Arms]:
        """Yield the arms from some of the bases (b, 3) after those from others.

        They are the same whenever the same tool (7,) and `held`, which has to be kept,
        are asked for again. They may touch, as when something is put down.
        """
        key = T_world_tool.tobytes(), id(held)
        found = self._found[key] = self._found.pop(key, [])  # the last of all
        if len(self._found) > MOST_KEPT:
            del self._found[next(iter(self._found))]
        first, size = 0, N_TOGETHER
        for i in count():
            if first >= len(bases):
                return
            if i == len(found):
                some = np.arange(first, min(first + size, len(bases)))
                found.append(self._some(bases, some, T_world_tool, held))
            yield found[i]
            first, size = first + size, 2 * size

    def _some(
        self, bases: Array, some: NDArray[np.int64], T_world_tool: Array, held: Held
    ) -> Arms:
        """Return the arms from the bases of some numbers."""
        which, rows = hands_at(self.alone, bases[some], T_world_tool, held)
        is_reached = np.zeros(len(bases), np.bool_)
        is_reached[some[which]] = True
        is_free = self.alone.are_free(rows, held, touching=True)
        return Arms(is_reached, some[which][is_free], rows[is_free])


def hands_at(
    checker: SceneChecker, bases: Array, T_world_tool: Array, held: Held | None = None
) -> tuple[NDArray[np.int64], Array]:
    """Return the arm's solutions at all bases (b, 3) and heights of the torso.

    They are the number of the base of each (k,), and configurations (k, 4 + a). Those
    are left out in which the hand, or what it holds, hits what base and torso carry.
    """
    model = checker.model
    pointing = rigid.matrix(T_world_tool[:4])[:2, 0]
    towards = T_world_tool[4:6] - bases[:, :2]
    # The fingers do not point back at the robot.
    facing = towards @ pointing >= MIN_FACING * np.linalg.norm(towards, axis=1)
    heights = np.asarray(model.settings.torso_heights_m)
    number = np.repeat(np.flatnonzero(facing), len(heights))
    places = np.column_stack([bases[number], np.tile(heights, int(facing.sum()))])
    is_clear = checker.are_hands_clear(places, rigid.homogeneous(T_world_tool), held)
    number, places = number[is_clear], places[is_clear]  # (n,), (n, 4)
    seen = _seen_from(places[:, :3], T_world_tool)
    which, arms = solutions_at(model, seen, places[:, 3])
    rows = np.hstack([places[which], _near_to(arms, model.settings.carry, model)])
    return number[which], rows


def _seen_from(poses: Array, T_world_tool: Array) -> Array:
    """Return the tool in the frames of base poses (n, 3), shape (n, 4, 4)."""
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    back = np.tile(np.eye(4), (len(poses), 1, 1))  # T_base_world
    back[:, 0, 0], back[:, 0, 1], back[:, 1, 0], back[:, 1, 1] = c, s, -s, c
    back[:, :2, 3] = -np.einsum("nij,nj->ni", back[:, :2, :2], poses[:, :2])
    return back @ rigid.homogeneous(T_world_tool)


def _near_to(arms: Array, other: tuple[float, ...], model: RobotModel) -> Array:
    """Return solutions (k, a) with endless joints turned to less than half a turn."""
    endless = ~np.isfinite(model.upper[4:])
    return np.where(endless, rigid.near(arms, np.asarray(other)), arms)


def best_first(rows: Array, carry: tuple[float, ...]) -> Array:
    """Return solutions nearest to the carried arm first, one of each base before more.

    Rows are (k, 4 + a), sorted into the same shape.
    """
    away = np.abs(rows[:, 4:] - np.asarray(carry)).max(1)
    order = np.argsort(away, kind="stable")
    _, base = np.unique(rows[order, :3], axis=0, return_inverse=True)
    turn = np.zeros(len(rows), int)
    seen: dict[int, int] = {}
    for i, number in enumerate(base.ravel().tolist()):
        turn[i] = seen[number] = seen.get(number, -1) + 1
    return rows[order][np.argsort(turn, kind="stable")]

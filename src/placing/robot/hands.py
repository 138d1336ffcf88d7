"""Arms that bring the hand to a place from the bases around it, remembered.

What is free where nothing else stands is found once; beside objects only that is looked
at again. Letters: b base poses, n bases at heights of the torso, k solutions, a joints
of the arm.
"""

from collections.abc import Iterator
from itertools import count
from typing import NamedTuple

import numpy as np
from numba import njit
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
        self._rises: dict[tuple[bytes, int], bool] = {}

    def rises(self, low: Array, high: Array, held: Held | None) -> bool:
        """Return whether the torso is free on its way up, from (4 + a,) to (4 + a,).

        Whoever asks for the same upper end asks for the same lower one; `held` has to
        be kept.
        """
        key = high.tobytes(), id(held)
        if key not in self._rises:
            self._rises[key] = self.alone.is_edge_free(low, high, held)
        return self._rises[key]

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
    T = rigid.homogeneous(T_world_tool)
    number, places = _facing(bases, np.array(model.settings.torso_heights_m), T)
    is_clear = checker.are_hands_clear(places, T, held)
    number, places = number[is_clear], places[is_clear]  # (n,), (n, 4)
    which, arms = solutions_at(model, places, T)
    rows = np.empty((len(which), 4 + model.n_arm))
    rows[:, :4], rows[:, 4:] = places[which], _near_to(arms, model)
    return number[which], rows


@njit(cache=True)
def _facing(
    bases: Array, heights_m: Array, T_world_tool: Array
) -> tuple[NDArray[np.int64], Array]:
    """Return numbers of the bases that the fingers do not point back at (n,).

    And these bases at all heights of the torso (n, 4), with each as often.
    """
    number = np.empty(len(bases) * len(heights_m), np.int64)
    places = np.empty((len(number), 4))
    n, (px, py) = 0, (T_world_tool[0, 0], T_world_tool[1, 0])
    for i in range(len(bases)):
        x, y = T_world_tool[0, 3] - bases[i, 0], T_world_tool[1, 3] - bases[i, 1]
        if x * px + y * py < MIN_FACING * np.hypot(x, y):
            continue
        for height_m in heights_m:
            number[n] = i
            places[n, :3], places[n, 3] = bases[i], height_m
            n += 1
    return number[:n], places[:n]


def _near_to(arms: Array, model: RobotModel) -> Array:
    """Return solutions (k, a), endless joints turned to near those of carrying."""
    endless = np.flatnonzero(~np.isfinite(model.upper[4:]))
    other = np.asarray(model.settings.carry)[endless]
    arms[:, endless] = rigid.near(arms[:, endless], other)
    return arms


def best_first(rows: Array, base: NDArray[np.int64], carry: tuple[float, ...]) -> Array:
    """Return solutions nearest to the carried arm first, one of each base before more.

    Rows are (k, 4 + a), sorted into the same shape; their bases are numbered (k,).
    """
    away = np.abs(rows[:, 4:] - np.asarray(carry)).max(1)
    order = np.argsort(away, kind="stable")
    turn, seen = np.empty(len(rows), int), dict.fromkeys(base.tolist(), 0)
    for i, number in enumerate(base[order].tolist()):
        turn[i] = seen[number]
        seen[number] += 1
    return rows[order][np.argsort(turn, kind="stable")]

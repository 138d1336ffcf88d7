"""How the robot comes to a base pose, and how its torso goes up and down there.

Both are asked before any straight line of the arm: they fail for many goals at once.
"""

from typing import NamedTuple

import numpy as np

from placing.rigid import Array
from placing.robot.carrying import Carrying
from placing.robot.checker import Held, SceneChecker
from placing.robot.distance_field import Mask
from placing.robot.driving import Floor
from placing.robot.search import Search


class Stance(NamedTuple):
    """How the robot stands at a base pose, torso raised, and comes there."""

    carry: Array
    """(a,) arm that carries the object to the base pose, or from it."""
    drive: Array
    """(t, 4 + a) way of the base, arm as in `carry` when putting, else folded."""


class Stances:
    """The stances of one search, remembered."""

    def __init__(self, search: Search, floor: Floor, carrying: Carrying) -> None:
        """Remember nothing yet."""
        self.search, self.floor, self.carrying = search, floor, carrying
        self._stow = np.asarray(search.among.model.settings.stow)
        self._folds: dict[bytes, bool] = {}
        self._drives: dict[tuple, Array | None] = {}
        self._is_lost: dict[tuple, Mask] = {}
        self._stances: dict[tuple[bytes, int], Stance | None] = {}

    def at(self, q: Array, held: Held) -> Stance | None:
        """Return how the robot stands at base and torso of `q` (4 + a,), if it can."""
        key = q[:4].tobytes(), id(held)
        if key not in self._stances:
            self._stances[key] = self._stance(q, held)
        return self._stances[key]

    def _stance(self, q: Array, held: Held) -> Stance | None:
        """Return it, with the first arm that carries an object up or down there."""
        place = q[:4].tobytes()
        if place not in self._folds:
            self._folds[place] = self._rises(self.search.among, q, self._stow, None)
        if not self._folds[place]:
            return None
        checker, arms = self.search.without, self.carrying.arms_for(held)
        free = (arm for arm in arms if self._rises(checker, q, arm, held))
        carry = next(free, None)
        if carry is None:
            return None
        if self.search.is_putting:
            drive = self._drive(checker, q, carry, held)
        else:
            drive = self._drive(self.search.among, q, self._stow, None)
        return None if drive is None else Stance(carry, drive)

    def _rises(
        self, checker: SceneChecker, q: Array, arm: Array, held: Held | None
    ) -> bool:
        """Return whether the torso is free from below up to its height in `q`."""
        low = self.floor.configurations(q[:3], arm=arm)[0]
        high = np.concatenate([q[:4], arm])
        if not self.search.hands.rises(low, high, held):
            return False
        return checker.is_path_clear(np.array([low, high]), held)

    def _drive(
        self, checker: SceneChecker, q: Array, arm: Array, held: Held | None
    ) -> Array | None:
        """Return a way of the base to that of `q`, if there is one."""
        carrying, place = (arm.tobytes(), id(held)), q[:3].tobytes()
        if (carrying, place) not in self._drives:
            floor, start = self.floor, self.search.start
            start = floor.start if start is None else start.copy()
            start[4:] = arm
            if carrying not in self._is_lost:
                self._is_lost[carrying] = np.zeros(len(floor.poses), np.bool_)
            drive = floor.path(q, checker, held, start, self._is_lost[carrying])
            self._drives[carrying, place] = drive
        return self._drives[carrying, place]

"""How the arm carries an object while the base drives.

One pose of the arm does not suit all that it carries: a broom held by its pole would
sweep the base. Of many poses in front of the body the one is taken in which hand and
object are free of the robot and nearest to it.

Letters: k poses of the arm, a joints of the arm.
"""

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.distance_field import open_field
from placing.robot.grasps import facing
from placing.robot.halton import halton
from placing.robot.inverse import arm_solutions
from placing.robot.model import RobotModel, tool_pose

N_POSES = 400
"""Tools in front of the robot that are tried for carrying."""
TOOL_LOW = (0.3, -0.45, 0.5, -1.0, 0.0, 0.0)
TOOL_HIGH = (0.65, 0.3, 1.05, 1.6, 1.57, 3.14)
"""Where they are above the floor [m], their heading, pitch and roll [rad]."""
N_TOGETHER = 24
"""Poses checked together; only speed depends on it."""
N_CHOSEN = 4
"""Arms kept for an object: above a table another one is free than on open floor."""
TILT_M = 0.1
"""Way that an object is rather held outwards than upside down."""


class Carrying:
    """The poses of the arm in which one robot may carry things."""

    def __init__(self, checker: SceneChecker) -> None:
        """Find the poses that are free of the robot itself."""
        self.model = checker.model
        self._alone = SceneChecker(self.model, open_field(), checker.config)
        arms = np.vstack([self.model.settings.carry, _arms(self.model)])
        self.arms = arms[self._are_free(arms, None)]  # (k, a)
        tools = [tool_pose(self.model, q) for q in self._at(self.arms, 0)]
        self._T_base_tool = np.array([rigid.homogeneous(T) for T in tools])
        self._chosen: dict[int, tuple[Held, Array]] = {}

    def arms_for(self, held: Held) -> Array:
        """Return arms that carry an object, nearest to the body first, (k, a).

        They are few, and none if it hits the robot in all poses.
        """
        if id(held) not in self._chosen:
            # The object is kept so that no other one gets its number.
            self._chosen[id(held)] = (held, self._free_ones(held))
        return self._chosen[id(held)][1]

    def _free_ones(self, held: Held) -> Array:
        """Return the free arm of least cost of each of some ranges of costs, (k, a)."""
        order = np.argsort(self._costs(held), kind="stable")
        chosen = []
        for first in range(0, len(order), N_TOGETHER):
            arms = self.arms[order[first : first + N_TOGETHER]]
            is_free = self._are_free(arms, held)
            if is_free.any():
                chosen.append(arms[is_free.argmax()])
            if len(chosen) == N_CHOSEN:
                break
        return np.reshape(chosen, (-1, self.model.n_arm))

    def _costs(self, held: Held) -> Array:
        """Return how far out each pose holds an object, and how tilted, (k,) [m]."""
        T = self._T_base_tool
        at = held.centre_m @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
        away = np.hypot(at[..., 0], at[..., 1]) + held.radius_m
        up = T[:, 2, :3] @ rigid.matrix(held.T_tool_object[:4])[:, 2]
        return away.max(1) + TILT_M * (1 - up)

    def _are_free(self, arms: Array, held: Held | None) -> NDArray[np.bool_]:
        """Return which arms are free of the robot at all heights of the torso, (k,)."""
        heights = range(len(self.model.settings.torso_heights_m))
        rows = [self._alone.are_free(self._at(arms, i), held) for i in heights]
        return np.all(rows, axis=0)

    def _at(self, arms: Array, i: int) -> Array:
        """Return configurations at a height of the torso, shape (k, 4 + a)."""
        height_m = self.model.settings.torso_heights_m[i]
        return np.hstack([np.tile([0.0, 0.0, 0.0, height_m], (len(arms), 1)), arms])


def _arms(model: RobotModel) -> Array:
    """Return solutions for tools in front of the robot, shape (k, a)."""
    low_m = model.settings.torso_heights_m[0]
    low, high = np.array(TOOL_LOW), np.array(TOOL_HIGH)
    tools = halton(N_POSES + 1, 6)[1:] * (high - low) + low
    arms = [np.empty((0, model.n_arm))]
    for x, y, z, *angles in tools:
        T_base_tool = np.concatenate([facing(*angles), (x, y, z)])
        arms.append(arm_solutions(model, T_base_tool, low_m)[:2])
    return np.vstack(arms)

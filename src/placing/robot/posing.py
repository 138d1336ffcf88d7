"""Where every link of a robot is in each frame of a film, fingers included.

The planner holds the fingers still; whoever watches sees them open and close.

Shapes: t frames, a arm joints.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from placing.robot.model import RobotModel
from placing.robot.settings import RobotSettings
from placing.robot.tree import fixed_values, gripper_values
from placing.robot.urdf import Joint

Array = NDArray[np.float64]
Values = Mapping[str, Array]


def moving_joints(settings: RobotSettings) -> tuple[str, ...]:
    """Return the names of the joints that move in a film: torso, arm, fingers."""
    return (settings.torso, *settings.chain, *settings.gripper_open)


def joint_values(model: RobotModel, q: Array, opening_m: Array) -> dict[str, Array]:
    """Return the value of each joint by name, (t,), or (1,) if it stands [rad or m]."""
    settings = model.settings
    fixed = fixed_values(settings, model.description, 0.0)
    values = {name: np.array([value]) for name, value in fixed.items()}
    values |= zip((settings.torso, *settings.chain), q[:, 3:].T, strict=True)
    shut = gripper_values(settings, 0.0)
    share = np.clip(opening_m / settings.max_opening_m, 0, 1)
    for name, wide in gripper_values(settings, settings.max_opening_m).items():
        values[name] = shut[name] + (wide - shut[name]) * share
    return values


def base_poses(q: Array) -> Array:
    """Return the base in the world, shape (t, 4, 4)."""
    T = np.tile(np.eye(4), (len(q), 1, 1))
    T[:, :3, :3] = Rotation.from_euler("z", q[:, [2]]).as_matrix()
    T[:, :2, 3] = q[:, :2]
    return T


def joint_poses(joint: Joint, values: Values) -> Array:
    """Return the child of a joint in its parent, (t, 4, 4), one where it stands."""
    value = values.get(joint.name, np.zeros(1))
    T = np.tile(np.eye(4), (len(value), 1, 1))
    if joint.kind == "prismatic":
        T[:, :3, 3] = value[:, None] * joint.axis
    elif joint.kind != "fixed":
        T[:, :3, :3] = Rotation.from_rotvec(value[:, None] * joint.axis).as_matrix()
    return joint.T_parent_joint @ T


def link_poses_over(model: RobotModel, q: Array, opening_m: Array) -> dict[str, Array]:
    """Return every link in the world by name, shape (t, 4, 4)."""
    values = joint_values(model, q, opening_m)
    above = {joint.child: joint for joint in model.description.joints.values()}

    @cache
    def pose(link: str) -> Array:
        if link not in above:
            return base_poses(q)
        joint = above[link]
        return pose(joint.parent) @ joint_poses(joint, values)

    return {link: pose(link) for link in model.links}


def part_of(model: RobotModel) -> dict[str, str]:
    """Return of each link the first link of the part of the robot it is fixed to."""
    moving = moving_joints(model.settings)
    above = {joint.child: joint for joint in model.description.joints.values()}

    @cache
    def first(link: str) -> str:
        joint = above.get(link)
        if joint is None or joint.name in moving:
            return link
        return first(joint.parent)

    return {link: first(link) for link in model.links}


def vectors(T: Array) -> tuple[Array, Array]:
    """Return translations (t, 3) [m] and quaternions xyzw (t, 4) of poses (t, 4, 4)."""
    return T[:, :3, 3], Rotation.from_matrix(T[:, :3, :3]).as_quat(canonical=True)

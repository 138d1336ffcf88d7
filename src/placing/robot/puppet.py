"""A robot in a world of the rigid-body simulator, read from its own description.

The simulator reads the URDF itself and places the links: nothing of the planner's model
of the robot is used, so that one can judge the other.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pybullet
from numpy.typing import NDArray

from placing import rigid
from placing.robot.settings import RobotSettings
from placing.robot.urdf import read_srdf

Array = NDArray[np.float64]


class Puppet:
    """A robot that stands wherever it is told, whatever is in its way."""

    def __init__(self, client: int, settings: RobotSettings, is_fixed: bool) -> None:
        """Load the robot; `is_fixed` keeps its base from falling.

        The simulator does not look for contacts of a fixed base and furniture.
        """
        self.client, self.settings = client, settings
        with _quiet():
            self.body = pybullet.loadURDF(
                str(settings.urdf),
                useFixedBase=is_fixed,
                flags=pybullet.URDF_USE_SELF_COLLISION,
                physicsClientId=client,
            )
        infos = [
            pybullet.getJointInfo(self.body, i, physicsClientId=client)
            for i in range(pybullet.getNumJoints(self.body, physicsClientId=client))
        ]
        root, _ = pybullet.getBodyInfo(self.body, physicsClientId=client)
        self.links = {root.decode(): -1} | {i[12].decode(): i[0] for i in infos}
        self.joints = {info[1].decode(): info[0] for info in infos}
        self.parents = {info[0]: info[16] for info in infos}
        self.limits = {
            info[1].decode(): (info[8], info[9])
            if info[8] < info[9]
            else (-np.inf, np.inf)
            for info in infos
        }
        """Least and greatest value by joint; infinite where it turns all around."""
        self.moving = (settings.torso, *settings.chain)
        self._numbers = [info[0] for info in infos if info[2] != pybullet.JOINT_FIXED]
        self._names = [infos[i][1].decode() for i in self._numbers]
        self._still = {n: float(np.clip(0.0, *self.limits[n])) for n in self._names}
        self._still |= settings.other_joints
        self._T_base_mass = self._mass_of_base()
        self._ignore_what_never_touches()

    def is_lifted(self, link: int) -> bool:
        """Return whether a link goes up and down with the torso, by its number."""
        torso = self.joints[self.settings.torso]
        while link not in (-1, torso):
            link = self.parents[link]
        return link == torso

    def names(self) -> dict[int, str]:
        """Return the name of each link by its number."""
        return {number: name for name, number in self.links.items()}

    def pose(self, q: Array, opening_m: float) -> None:
        """Put the robot at a configuration (4 + a,), fingers apart by a distance."""
        x, y, yaw, *values = q.tolist()
        T = rigid.compose(rigid.from_yaw(yaw, (x, y, 0.0)), self._T_base_mass)
        turn = (*T[1:4].tolist(), T[0])
        pybullet.resetBasePositionAndOrientation(
            self.body, T[4:].tolist(), turn, physicsClientId=self.client
        )
        share = np.clip(opening_m / self.settings.max_opening_m, 0.0, 1.0)
        opened, closed = self.settings.gripper_open, self.settings.gripper_closed
        fingers = {n: closed[n] + share * (opened[n] - closed[n]) for n in opened}
        all_ = self._still | fingers | dict(zip(self.moving, values, strict=True))
        pybullet.resetJointStatesMultiDof(
            self.body,
            self._numbers,
            [[all_[name]] for name in self._names],
            [[0.0]] * len(self._numbers),
            physicsClientId=self.client,
        )

    def tool(self) -> Array:
        """Return the pose of the tool `T_world_tool`, shape (7,)."""
        state = pybullet.getLinkState(
            self.body,
            self.links[self.settings.tool_frame],
            computeForwardKinematics=1,
            physicsClientId=self.client,
        )
        (x, y, z, w), position = state[5], state[4]
        T_world_frame = np.array([w, x, y, z, *position])
        roll, pitch, yaw = np.deg2rad(self.settings.tool_rpy_deg)
        x, y, z, w = pybullet.getQuaternionFromEuler((roll, pitch, yaw))
        T_frame_tool = np.array([w, x, y, z, *self.settings.tool_offset_m])
        return rigid.compose(T_world_frame, T_frame_tool)

    def _mass_of_base(self) -> Array:
        """Return where the mass of the base is, by which it is moved, shape (7,)."""
        info = pybullet.getDynamicsInfo(self.body, -1, physicsClientId=self.client)
        position, (x, y, z, w) = info[3:5]
        return np.array([w, x, y, z, *position])

    def _ignore_what_never_touches(self) -> None:
        """Leave out the pairs of links that the robot's maker says never collide."""
        pairs = {(child, parent) for child, parent in self.parents.items()}
        if self.settings.srdf is None:
            pairs |= self._overlapping()
        else:
            for names in read_srdf(self.settings.srdf):
                numbers = [self.links[name] for name in names if name in self.links]
                pairs |= {tuple(numbers)} if len(numbers) == 2 else set()
        for i, j in sorted(pairs):
            pybullet.setCollisionFilterPair(
                self.body, self.body, i, j, 0, physicsClientId=self.client
            )

    def _overlapping(self) -> set[tuple[int, int]]:
        """Return the pairs of links that overlap while the arm is stowed."""
        # ASSUME: where the maker says nothing, these overlap by construction.
        settings, pairs = self.settings, set()
        stowed = np.array([0, 0, 0, settings.torso_heights_m[0], *settings.stow])
        for opening_m in (0.0, settings.max_opening_m):
            self.pose(stowed, opening_m)
            pybullet.performCollisionDetection(physicsClientId=self.client)
            found = pybullet.getContactPoints(
                self.body, self.body, physicsClientId=self.client
            )
            pairs |= {(contact[3], contact[4]) for contact in found}
        return pairs


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the simulator from warning of every link without inertia."""
    saved = os.dup(1), os.dup(2)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        os.dup2(nowhere.fileno(), 2)
        try:
            yield
        finally:
            for i, number in enumerate(saved, start=1):
                os.dup2(number, i)
                os.close(number)

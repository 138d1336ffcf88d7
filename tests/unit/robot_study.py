"""The robots of the study, and their descriptions as the physics engine reads them."""

import os
from functools import cache
from pathlib import Path

import numpy as np
import pybullet

from placing import rigid
from placing.robot.model import load_robot, tool_pose
from placing.robot.settings import read_robot
from placing.robot.tree import fixed_values
from placing.rooms.file import read_yaml

ROOT = Path(__file__).parents[2]
ROBOTS = ("pr2", "tiago")


def schema():
    return read_yaml(ROOT / "workflow/schemas/robot.schema.yaml")


@cache
def settings(name):
    return read_robot(ROOT / f"config/robots/{name}.yaml", schema())


@cache
def model(name):
    return load_robot(settings(name))


def random_configurations(rng, name, n):
    """Configurations within all limits, endless joints within one turn."""
    low = np.where(np.isinf(model(name).lower), -np.pi, model(name).lower)
    high = np.where(np.isinf(model(name).upper), np.pi, model(name).upper)
    return rng.uniform(low, high, (n, len(low)))


class Bullet:
    """One robot in the physics engine, moved by its own kinematics."""

    def __init__(self, robot):
        self.model, self.client = robot, pybullet.connect(pybullet.DIRECT)
        flags = pybullet.URDF_USE_SELF_COLLISION
        flags |= pybullet.URDF_USE_SELF_COLLISION_INCLUDE_PARENT
        with silence():
            self.body = self.call("loadURDF", str(robot.settings.urdf), flags=flags)
        info = [
            self.call("getJointInfo", self.body, i)
            for i in range(self.call("getNumJoints", self.body))
        ]
        root = self.call("getBodyInfo", self.body)[0].decode()
        self.link = {root: -1, **{row[12].decode(): row[0] for row in info}}
        self.joint = {row[1].decode(): row[0] for row in info}
        self.open(robot.settings.max_opening_m)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pybullet.disconnect(self.client)

    def call(self, name, *arguments, **options):
        return getattr(pybullet, name)(
            *arguments, physicsClientId=self.client, **options
        )

    def open(self, opening_m):
        robot = self.model
        values = fixed_values(robot.settings, robot.description, opening_m)
        for name, value in values.items():
            self.call("resetJointState", self.body, self.joint[name], value)

    def move(self, q):
        w, x, y, z = rigid.yaw_quaternion(q[2])
        pose = (q[0], q[1], 0), (x, y, z, w)
        self.call("resetBasePositionAndOrientation", self.body, *pose)
        names = (self.model.settings.torso, *self.model.settings.chain)
        for name, value in zip(names, q[3:], strict=True):
            self.call("resetJointState", self.body, self.joint[name], value)

    def pose(self, link):
        """Return `T_world_link`, (7,)."""
        if self.link[link] < 0:
            at, (x, y, z, w) = self.call("getBasePositionAndOrientation", self.body)
        else:
            state = self.call(
                "getLinkState", self.body, self.link[link], computeForwardKinematics=1
            )
            at, (x, y, z, w) = state[4], state[5]
        return np.array([w, x, y, z, *at])

    def check_only(self, pairs):
        """Look for contacts of these pairs of links alone."""
        known = {frozenset(pair) for pair in pairs}
        solids = sorted({hull.link for hull in self.model.hulls})
        for i, a in enumerate(solids):
            for b in solids[i + 1 :]:
                ends = self.link[a], self.link[b]
                wanted = int(frozenset((a, b)) in known)
                body = self.body, self.body
                self.call("setCollisionFilterPair", *body, *ends, wanted)

    def contacts(self):
        """Return the pairs of links, or link and other body, that touch."""
        self.call("performCollisionDetection")
        name = {i: link for link, i in self.link.items()}
        found = [c for c in self.call("getContactPoints") if c[8] <= 0]
        ends = [((c[1], c[3]), (c[2], c[4])) for c in found]
        return sorted(
            {
                tuple(sorted(name[i] if b == self.body else "thing" for b, i in pair))
                for pair in ends
            }
        )

    def hold(self, size_m, at_m, q):
        """Put a box at `at_m` in the frame of the tool, which the gripper may touch."""
        half = [length / 2 for length in size_m]
        shape = self.call("createCollisionShape", pybullet.GEOM_BOX, halfExtents=half)
        T = rigid.compose(tool_pose(self.model, q), np.array([1, 0, 0, 0, *at_m]))
        w, x, y, z = T[:4]
        box = self.call(
            "createMultiBody",
            baseCollisionShapeIndex=shape,
            basePosition=T[4:],
            baseOrientation=(x, y, z, w),
        )
        for link in self.model.settings.gripper_links:
            self.call("setCollisionFilterPair", self.body, box, self.link[link], -1, 0)
        return box


class silence:
    """Keep the engine's remarks about links without mass out of the output."""

    def __enter__(self):
        self.kept = [os.dup(1), os.dup(2)]
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        os.close(nowhere)

    def __exit__(self, *_):
        for number, kept in enumerate(self.kept, 1):
            os.dup2(kept, number)
            os.close(kept)

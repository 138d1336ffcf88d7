"""Walk a certificate in a world of its own and look at every step of it."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body
from placing.physics.simulator import World, add_body
from placing.rigid import Array
from placing.robot.certificates import Certificate, Segment
from placing.robot.puppet import Puppet
from placing.robot.replay_config import ReplayConfig
from placing.robot.touching import Stage, faults


class Failed(Exception):
    """A certificate does not hold; the message says where and why."""


class Walk:
    """One certificate in a world that holds the furniture and the robot."""

    def __init__(
        self,
        world: World,
        puppet: Puppet,
        certificate: Certificate,
        bodies: Mapping[str, Body],
        config: ReplayConfig,
    ) -> None:
        """Put the objects that stood there into the world."""
        self.world, self.puppet, self.config = world, puppet, config
        self.certificate, self.body = certificate, bodies[certificate.object_id]
        self.n_looks, self.end = 0, None
        self.standing = [
            add_body(world, name, bodies[name], T)
            for name, T in certificate.standing.items()
        ]
        start = certificate.T_world_start
        far = np.array([1.0, 0, 0, 0, 0, 0, -50.0])
        self.T_world_item = start if start is not None else far
        item = add_body(world, certificate.object_id, self.body, self.T_world_item)
        self.stage = Stage(world, puppet, item, config)

    def to_end(self) -> Array:
        """Walk all segments; return where the object is let go, shape (7,)."""
        last, was_holding = None, self.certificate.T_world_start is None
        for segment in self.certificate.segments:
            if last is not None:
                self._check_continuity(last, segment)
            self._switch(segment, was_holding)
            for q in finer(segment.path, self.config):
                self._look(segment, q)
            last, was_holding = segment, segment.is_holding
        if was_holding or self.end is None:
            raise Failed("end: the object is never let go")
        return self.end

    def clear(self) -> None:
        """Take the objects out of the world again."""
        for number in (*self.standing, self.stage.item):
            pybullet.removeBody(number, physicsClientId=self.world.client)

    def _check_continuity(self, last: Segment, segment: Segment) -> None:
        """Raise `Failed` if a segment does not start where the last one ended."""
        way = segment.path[0] - last.path[-1]
        turns = [
            2,
            *(4 + i for i, n in enumerate(self.puppet.moving[1:]) if self._turns(n)),
        ]
        way[turns] = rigid.wrap(way[turns])
        worst = int(np.argmax(np.abs(way)))
        if abs(way[worst]) > self.config.joint_rad:
            raise Failed(f"{segment.name}: jumps by {way[worst]:.3f} in column {worst}")

    def _turns(self, joint: str) -> bool:
        """Return whether a joint has no limits."""
        return bool(np.isinf(self.puppet.limits[joint][1]))

    def _switch(self, segment: Segment, was_holding: bool) -> None:
        """Grasp the object or let it go before a segment starts."""
        if segment.is_holding == was_holding:
            return
        if not segment.is_holding:
            self.end = self.T_world_item
            over = self.end.copy()
            high = over[6] - self.certificate.T_world_object[6]
            over[6] -= np.clip(high, 0.0, self.config.drop_m)
            self._check_pose(segment, over, self.certificate.T_world_object)
            self._move(over)  # it drops at once
        else:
            self.puppet.pose(segment.path[0], segment.opening_m)
            self._carry()
            start = self.certificate.T_world_start
            self._check_pose(segment, self.T_world_item, start)

    def _check_pose(
        self, segment: Segment, T_world_found: Array, T_world_planned: Array | None
    ) -> None:
        """Raise `Failed` if the object is not where it was to be."""
        if T_world_planned is None:
            raise Failed(f"{segment.name}: grasps what is nowhere")
        error_m, error_deg = rigid.difference(T_world_found, T_world_planned)
        if error_m > self.config.max_error_m or error_deg > self.config.max_error_deg:
            raise Failed(
                f"{segment.name}: the object is {error_m * 1e3:.0f} mm and "
                f"{error_deg:.1f} deg from its place"
            )

    def _carry(self) -> None:
        """Move the object with the gripper."""
        self._move(rigid.compose(self.puppet.tool(), self.certificate.T_tool_object))

    def _move(self, T: Array) -> None:
        """Put the object at a pose in the world."""
        self.T_world_item = T
        w, x, y, z = T[:4]
        centre = rigid.apply(T, self.body.mass_centre_m[None])[0]
        pybullet.resetBasePositionAndOrientation(
            self.stage.item, centre, (x, y, z, w), physicsClientId=self.world.client
        )

    def _look(self, segment: Segment, q: Array) -> None:
        """Put the robot at a configuration and raise `Failed` if anything is wrong."""
        self.n_looks += 1
        for name, value in zip(self.puppet.moving, q[3:].tolist(), strict=True):
            low, high = self.puppet.limits[name]
            if not low - 1e-6 <= value <= high + 1e-6:  # guards rounding
                raise Failed(
                    f"{segment.name}: {name} is {value:.3f}, outside its limits"
                )
        self.puppet.pose(q, segment.opening_m)
        if segment.is_holding:
            self._carry()
        pybullet.performCollisionDetection(physicsClientId=self.world.client)
        if fault := next(faults(self.stage, segment), ""):
            raise Failed(f"{segment.name}: {fault}")


def finer(path: Array, config: ReplayConfig) -> Array:
    """Return a path with steps of at most those of the configuration, (t, 4 + a)."""
    rows = [path[:1]]
    limits = np.full(path.shape[1], config.step_rad)
    limits[[0, 1, 3]] = config.step_m
    for start, end in pairwise(path):
        n = max(1, int(np.ceil(np.max(np.abs(end - start) / limits))))
        share = np.linspace(0, 1, n + 1)[1:, None]
        rows.append((1 - share) * start + share * end)
    return np.concatenate(rows)

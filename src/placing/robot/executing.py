"""Carry out plans in simulation, with physics (Section 4.3).

The robot follows its paths; an object hangs on the gripper by a fixed constraint from
when it is grasped until it is let go, and gravity does the rest. All objects can move,
so that what is put down badly falls, and what is hit is pushed.

Shapes: t frames, n objects.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pybullet
from numpy.typing import NDArray

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.physics.settling import SettleConfig
from placing.physics.simulator import World, add_body, add_fixed, new_world
from placing.robot.certificates import Certificate
from placing.robot.film import Film, PlaybackConfig, Stretch, stretches
from placing.robot.puppet import Puppet
from placing.robot.settings import RobotSettings

Array = NDArray[np.float64]

WAIT = "wait"
"""Phase in which the robot stands still and objects come to rest."""


@dataclass(frozen=True)
class ExecutionConfig:
    """How plans are carried out; values: config/config.yaml."""

    grip_n: float
    """Largest force of the constraint that holds an object."""
    rest_s: float
    """Simulated time before the first motion, after each letting go and at the end."""


class Stage:
    """A world with furniture, objects and a robot in which time passes."""

    def __init__(
        self,
        world: World,
        puppet: Puppet,
        objects: Mapping[str, tuple[Body, Array]],
        step_rate_hz: float,
        config: ExecutionConfig,
        frame_s: float,
    ) -> None:
        """Put the objects down; a frame is kept every `frame_s`."""
        self.world, self.puppet, self.config = world, puppet, config
        self.bodies = [body for body, _ in objects.values()]
        self.names = tuple(objects)
        self.items = [add_body(world, n, body, T) for n, (body, T) in objects.items()]
        self.step_s, self.n_steps = 1 / step_rate_hz, 0
        self.n_between = max(1, round(frame_s * step_rate_hz))
        self.held, self.moving, self.phase = -1, -1, WAIT
        self._grip, self._T_tool_item = -1, np.zeros(7)
        # What is held stays no farther behind the hand than it moves in two steps.
        pybullet.setPhysicsEngineParameter(erp=0.8, physicsClientId=world.client)
        self._frames: list[tuple] = []

    def run(self, certificates: Sequence[Certificate], config: PlaybackConfig) -> Film:
        """Carry out all certificates in turn and return what was seen."""
        plan = stretches(certificates, config)
        turns = [self.names.index(c.object_id) for c in certificates]
        self.rest(plan[0].q[0], float(plan[0].opening_m[0]))
        for stretch in plan:
            self._touch(turns[stretch.moving])
            self._hold(turns[stretch.moving] if stretch.is_holding else -1, stretch)
            self.phase = stretch.phase
            self._follow(stretch)
        self._touch(-1)
        self.phase = WAIT
        self.rest(plan[-1].q[-1], float(plan[-1].opening_m[-1]))
        self._keep(plan[-1].q[-1], float(plan[-1].opening_m[-1]))
        return self._film()

    def rest(self, q: Array, opening_m: float) -> None:
        """Let objects come to rest while the robot stands still."""
        phase, self.phase = self.phase, WAIT
        for _ in range(round(self.config.rest_s / self.step_s)):
            self._step(q, opening_m)
        self.phase = phase

    def pose_of(self, i: int) -> Array:
        """Return the pose of an object `T_world_object`, shape (7,)."""
        position, (x, y, z, w) = pybullet.getBasePositionAndOrientation(
            self.items[i], physicsClientId=self.world.client
        )
        T = np.array([w, x, y, z, *position])
        T[4:] = rigid.apply(T, -self.bodies[i].mass_centre_m[None])[0]
        return T

    def _follow(self, stretch: Stretch) -> None:
        """Follow one stretch of the plan, ending at its end."""
        start, end = stretch.time_s[[0, -1]]
        n = max(1, int(np.ceil((end - start) / self.step_s - 1e-9)))
        times = np.linspace(start, end, n + 1)[1:]
        q = np.column_stack([np.interp(times, stretch.time_s, c) for c in stretch.q.T])
        opening = np.interp(times, stretch.time_s, stretch.opening_m)
        for row, width in zip(q, opening.tolist(), strict=True):
            self._step(row, width)

    def _step(self, q: Array, opening_m: float) -> None:
        """Move the robot and what it holds, and let a moment pass."""
        self.puppet.pose(q, opening_m)
        if self.held >= 0:
            self._pull()
        if self.n_steps % self.n_between == 0:
            self._keep(q, opening_m)
        pybullet.stepSimulation(physicsClientId=self.world.client)
        self.n_steps += 1

    def _keep(self, q: Array, opening_m: float) -> None:
        """Keep a frame of how everything stands."""
        poses = np.array([self.pose_of(i) for i in range(len(self.items))])
        now = self.n_steps * self.step_s
        seen = self.held, self.phase, self.moving
        self._frames.append((now, q.copy(), opening_m, poses, *seen))

    def _touch(self, moving: int) -> None:
        """Let the gripper pass through the object that it is about to move, only."""
        # ASSUME: fingers are soft; what holds is the constraint, not their friction.
        for i, on in ((self.moving, 1), (moving, 0)):
            links = self.puppet.settings.gripper_links if i >= 0 else ()
            for link in links:
                pybullet.setCollisionFilterPair(
                    *(self.puppet.body, self.items[i], self.puppet.links[link], -1, on),
                    physicsClientId=self.world.client,
                )
        self.moving = moving

    def _hold(self, item: int, stretch: Stretch) -> None:
        """Grasp an object where it is now, or let go and wait until it rests."""
        if item == self.held:
            return
        q, opening_m = stretch.q[0], float(stretch.opening_m[0])
        if self.held >= 0:
            pybullet.removeConstraint(self._grip, physicsClientId=self.world.client)
            self.held = -1
            self.rest(q, opening_m)
            return
        self.puppet.pose(q, opening_m)
        T_tool_world = rigid.inverse(self.puppet.tool())
        T_world_item = self._pose_of_mass(item)
        self._T_tool_item = rigid.compose(T_tool_world, T_world_item)
        self._grip = pybullet.createConstraint(
            *(self.items[item], -1, -1, -1, pybullet.JOINT_FIXED, (0, 0, 0)),
            *((0, 0, 0), T_world_item[4:].tolist()),
            physicsClientId=self.world.client,
        )
        self.held = item

    def _pose_of_mass(self, i: int) -> Array:
        """Return the pose of the mass centre of an object in the world, shape (7,)."""
        position, (x, y, z, w) = pybullet.getBasePositionAndOrientation(
            self.items[i], physicsClientId=self.world.client
        )
        return np.array([w, x, y, z, *position])

    def _pull(self) -> None:
        """Have the held object follow the gripper."""
        w, x, y, z, *at = rigid.compose(self.puppet.tool(), self._T_tool_item).tolist()
        pybullet.changeConstraint(
            self._grip,
            jointChildPivot=at,
            jointChildFrameOrientation=(x, y, z, w),
            maxForce=self.config.grip_n,
            physicsClientId=self.world.client,
        )

    def _film(self) -> Film:
        """Return all frames."""
        time_s, q, opening, poses, held, phase, moving = zip(*self._frames, strict=True)
        return Film(
            time_s=np.array(time_s),
            q=np.array(q),
            opening_m=np.array(opening),
            objects=self.names,
            T_world_objects=np.array(poses),
            held=np.array(held),
            phase=phase,
            moving=np.array(moving),
        )


def execute(
    certificates: Sequence[Certificate],
    settings: RobotSettings,
    fixed: Mapping[str, tuple[Piece, ...]],
    objects: Mapping[str, tuple[Body, Array]],
    configs: tuple[ExecutionConfig, PlaybackConfig, SettleConfig],
) -> Film:
    """Return what is seen when plans are carried out among furniture and objects.

    `objects` holds the body of each and where it starts, (7,).
    """
    config, playback, settling = configs
    rates = settling.step_rate_hz, settling.friction, settling.margin_m
    with new_world(*rates) as world:
        for name, pieces in fixed.items():
            for piece in pieces:
                add_fixed(world, name, piece)
        puppet = Puppet(world.client, settings, is_fixed=True)
        args = objects, settling.step_rate_hz, config, playback.frame_s
        return Stage(world, puppet, *args).run(certificates, playback)

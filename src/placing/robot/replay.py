"""Judge a certificate in a world of its own, with nothing of the planner.

The robot walks every path again, among the true furniture and the objects that stood
there, at a finer step than it was planned with: its joints keep their limits, nothing
touches what it may not, no part of the motion jumps, the object ends where it was to
end, and it stays there when it is let go.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pybullet
from numpy.typing import NDArray

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.settling import SettleConfig, near_pieces
from placing.physics.simulator import (
    MAX_STEEPNESS,
    World,
    add_body,
    add_fixed,
    deepest_overlap,
    motion,
    new_world,
)
from placing.robot.certificates import Certificate, Segment
from placing.robot.puppet import Puppet
from placing.robot.settings import RobotSettings

Array = NDArray[np.float64]
Fixed = Mapping[str, tuple[Piece, ...]]

AT_SUPPORT = ("lower", "lift")
"""Segments in which an object leaves or reaches what carries it."""
AT_OBJECT = ("approach", "retreat")
"""Segments in which the open fingers are around an object that stands."""


@dataclass(frozen=True)
class ReplayConfig:
    """How closely a certificate is looked at; values: config/config.yaml."""

    step_m: float
    """Base and torso move no more than this between two looks."""
    step_rad: float
    """No joint turns more than this between two looks."""
    touch_m: float
    """Deeper overlaps are collisions."""
    support_m: float
    """Deepest overlap of an object with what carries it when it is put down."""
    finger_m: float
    """Deepest overlap of the open fingers with the object between them."""
    wheel_m: float
    """Deepest overlap of the wheels with the floor."""
    drop_m: float
    """An object is let go no higher than this above where it ends."""
    max_error_m: float
    """Farthest that an object may be from its place when it is grasped and let go."""
    max_error_deg: float
    joint_rad: float
    """Guards the comparison of two ends of segments that are the same."""


@dataclass(frozen=True)
class Verdict:
    """What was found about a certificate."""

    n_looks: int
    end_error_m: float
    """How far from its place it is let go, the height that it drops included."""
    end_error_deg: float
    moved_m: float
    """How far from its place it comes to rest."""
    tilted_deg: float
    reason: str
    """Where it fails and why; empty if it holds."""


class Failed(Exception):
    """A certificate does not hold; the message says where and why."""


class Replay:
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
        self.links, self.n_looks, self.end = puppet.names(), 0, None
        self.standing = [
            add_body(world, name, bodies[name], T)
            for name, T in certificate.standing.items()
        ]
        start = certificate.T_world_start
        self.is_there = start is not None
        far = np.array([1.0, 0, 0, 0, 0, 0, -50.0])
        at = start if start is not None else far
        self.item = add_body(world, certificate.object_id, self.body, at)
        self.T_world_item = at

    def walk(self) -> Array:
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
        for number in (*self.standing, self.item):
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
        error_m, error_deg = difference(T_world_found, T_world_planned)
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
            self.item, centre, (x, y, z, w), physicsClientId=self.world.client
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
        self._check_robot(segment)
        if segment.is_holding:
            self._check_item(segment)

    def _check_robot(self, segment: Segment) -> None:
        """Raise `Failed` if a link touches what it may not."""
        for contact in self._contacts(self.puppet.body):
            link, depth = self.links[contact[3]], -contact[8]
            if contact[2] == self.puppet.body:
                other, most = self.links[contact[4]], self.config.touch_m
            else:
                other = self.world.names[contact[2]]
                most = self._allowed(segment, link, contact)
            if depth > most:
                raise Failed(
                    f"{segment.name}: {link} in {other} by {depth * 1e3:.1f} mm"
                )

    def _allowed(self, segment: Segment, link: str, contact: tuple) -> float:
        """Return how deep a link may be in what is not the robot [m]."""
        if contact[2] == self.item and link in self.puppet.settings.gripper_links:
            is_near = segment.is_holding or segment.name.endswith(AT_OBJECT)
            return self.config.finger_m if is_near else self.config.touch_m
        is_below = contact[7][2] > MAX_STEEPNESS and contact[6][2] < self.config.wheel_m
        return self.config.wheel_m if is_below else self.config.touch_m

    def _check_item(self, segment: Segment) -> None:
        """Raise `Failed` if the held object touches what it may not."""
        for contact in self._contacts(self.item):
            depth = -contact[8]
            if contact[2] == self.puppet.body:
                continue
            is_below = contact[7][2] > MAX_STEEPNESS
            is_at = segment.name.endswith(AT_SUPPORT) and is_below
            most = self.config.support_m if is_at else self.config.touch_m
            if depth > most:
                other = self.world.names[contact[2]]
                text = f"object in {other} by {depth * 1e3:.1f} mm"
                raise Failed(f"{segment.name}: {text}")

    def _contacts(self, body: int) -> tuple[tuple, ...]:
        """Return the contacts of a body that overlap."""
        found = pybullet.getContactPoints(bodyA=body, physicsClientId=self.world.client)
        return tuple(contact for contact in found if contact[8] < 0)


def judge(
    replay: Replay,
    fixed: Fixed,
    bodies: Mapping[str, Body],
    settling: SettleConfig,
    reach_m: float,
) -> Verdict:
    """Return what is found about a certificate: walked, then let go at its end."""
    nothing = np.nan, np.nan, np.nan, np.nan
    try:
        end = replay.walk()
    except Failed as failed:
        return Verdict(replay.n_looks, *nothing, str(failed))
    finally:
        replay.clear()
    certificate = replay.certificate
    error = difference(end, certificate.T_world_object)
    still = {
        other: tuple(moved(piece, bodies[other], T) for piece in bodies[other].pieces)
        for other, T in certificate.standing.items()
    }
    body = bodies[certificate.object_id]
    planned = certificate.T_world_object
    rest = let_go({**fixed, **still}, (body, end), planned, settling, reach_m)
    went_m, sank_m, turned_deg, speed_m_s = rest
    reason = ""
    if max(went_m, abs(sank_m)) > settling.max_moved_m:
        reason = f"let go: comes to rest {went_m * 1e3:.0f} mm from its place"
    elif turned_deg > settling.max_tilted_deg:
        reason = f"let go: comes to rest {turned_deg:.0f} deg from its place"
    elif speed_m_s > settling.max_speed_m_s:
        reason = f"let go: still moves at {speed_m_s:.2f} m/s"
    return Verdict(replay.n_looks, *error, went_m, turned_deg, reason)


def judge_all(
    certificates: Sequence[Certificate],
    settings: RobotSettings,
    fixed: Fixed,
    bodies: Mapping[str, Body],
    config: ReplayConfig,
    settling: SettleConfig,
    reach_m: float,
) -> list[Verdict]:
    """Return what is found about certificates of one scene, one after the other."""
    rates = settling.step_rate_hz, settling.friction, settling.margin_m
    with new_world(*rates) as world:
        for name, pieces in fixed.items():
            for piece in pieces:
                add_fixed(world, name, piece)
        puppet = Puppet(world.client, settings, is_fixed=False)
        return [
            judge(
                Replay(world, puppet, certificate, bodies, config),
                fixed,
                bodies,
                settling,
                reach_m,
            )
            for certificate in certificates
        ]


def let_go(
    fixed: Fixed,
    placed: tuple[Body, Array],
    T_world_planned: Array,
    settling: SettleConfig,
    reach_m: float,
) -> tuple[float, float, float, float]:
    """Return how far from a pose a body comes to rest, as `simulator.motion` does.

    Where it overlaps with what carries it, it is lifted by at most `reach_m` before.
    """
    body, T = placed
    config = settling.step_rate_hz, settling.friction, settling.margin_m
    with new_world(*config) as world:
        for name, piece in near_pieces(fixed, {"": placed}, settling.near_m):
            add_fixed(world, name, piece)
        number = add_body(world, "", body, T)
        pybullet.performCollisionDetection(physicsClientId=world.client)
        if deepest_overlap(world, number)[0] > settling.max_penetration_m:
            put_down(world, {number: (body, T)}, reach_m)
        for _ in range(round(settling.duration_s * settling.step_rate_hz)):
            pybullet.stepSimulation(physicsClientId=world.client)
        return motion(world, number, body, T_world_planned)


def moved(piece: Piece, body: Body, T_world_body: Array) -> Piece:
    """Return a piece of a body in the world, where it stands still."""
    corners = rigid.apply(T_world_body, piece.vertices_m + body.mass_centre_m)
    return Piece(corners, piece.faces, piece.is_convex)


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


def difference(T_world_a: Array, T_world_b: Array) -> tuple[float, float]:
    """Return how far two poses are apart [m] and how far they are turned [deg]."""
    cosine = min(1.0, float(abs(T_world_a[:4] @ T_world_b[:4])))
    way = float(np.linalg.norm(T_world_a[4:] - T_world_b[4:]))
    return way, float(np.rad2deg(2 * np.arccos(cosine)))

"""The exact check: the true meshes of robot, furniture and objects in a simulator.

What was planned from a cloud is verified here, against what is really there, in finer
steps. A collision is an overlap of two shapes; those that spheres and boxes around them
keep apart are not compared. Nothing is simulated but the last thing asked: whether an
object that is let go stays. Letters: t configurations, a arm joints.
"""

import math
import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from itertools import pairwise

import numpy as np
import pybullet

from placing import rigid
from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.settling import SettleConfig, settle, unrest
from placing.physics.simulator import (
    MAX_STEEPNESS,
    World,
    add_body,
    add_fixed,
    new_world,
    overlaps,
)
from placing.rigid import Array
from placing.robot.checker import CheckerConfig, levers
from placing.robot.kernels import Spheres, Tree, n_steps
from placing.robot.model import RobotModel, tool_pose
from placing.robot.nearby import (
    NOTHING_HELD,
    Held,
    near,
    near_thing,
    no_things,
    scratch_of,
    solids_of,
    with_thing,
)
from placing.robot.tree import fixed_values, gripper_values

AWAY_M = 100.0
"""Where the robot waits while an object is put down, and what is not in the scene."""
APART_M = 5.0
"""Distance of two bodies that are not in the scene."""


class Truth:
    """A robot among true furniture and objects; one client of the simulator.

    A context manager. Furniture comes as `physics.arrangements.fixed_of` gives it.
    """

    def __init__(
        self,
        model: RobotModel,
        pieces: Mapping[str, tuple[Piece, ...]],
        config: CheckerConfig,
        settling: SettleConfig,
    ) -> None:
        """Keep what the world is made of; it is made when the context is entered."""
        self._model, self._pieces = model, pieces
        self._config, self._settling = config, settling
        self._stack = ExitStack()
        self._standing: dict[str, tuple[int, Body, Array]] = {}
        self._made: dict[tuple[str, int], tuple[int, Body]] = {}
        gripper = set(model.settings.gripper_links)
        self._gripper = gripper
        self._lever_m = levers(model)
        frames = zip(model.links, model.tree.link_frame.tolist(), strict=True)
        self._base = {link for link, frame in frames if frame == 0}
        self._solids = solids_of(model.spheres, model.self_pairs)
        self._scratch = scratch_of(self._solids, len(model.tree.axis))
        self._things, self._bodies = no_things(), []

    def __enter__(self) -> "Truth":
        """Make the world."""
        s = self._settling
        world = new_world(s.step_rate_hz, s.friction, s.margin_m)
        self._world = self._stack.enter_context(world)
        for name, pieces in self._pieces.items():
            for piece in pieces:
                self._know(add_fixed(self._world, name, piece), (piece,))
        with silence():
            self._robot = pybullet.loadURDF(
                str(self._model.settings.urdf),
                flags=pybullet.URDF_USE_SELF_COLLISION,
                physicsClientId=self._client,
            )
        self._links = {-1: self._model.links[0]}
        self._joints = {}
        for i in range(pybullet.getNumJoints(self._robot, self._client)):
            joint = pybullet.getJointInfo(self._robot, i, self._client)
            self._joints[joint[1].decode()] = i
            self._links[i] = joint[12].decode()
        number = {name: i for i, name in self._links.items()}
        names = self._model.links
        self._solid = [number[names[link]] for link in self._solids.link.tolist()]
        self._hold_still()
        return self

    def __exit__(self, *error: object) -> None:
        """Leave the simulator."""
        self._stack.close()

    @property
    def _client(self) -> int:
        return self._world.client

    def _hold_still(self) -> None:
        """Set the joints that no configuration moves, and find those that it moves."""
        settings = self._model.settings
        widest_m = settings.max_opening_m
        self._hold(fixed_values(settings, self._model.description, widest_m))
        names = (settings.torso, *settings.chain)
        self._moving = [self._joints[name] for name in names]
        inertial = pybullet.getDynamicsInfo(self._robot, -1, self._client)[3:5]
        position, (x, y, z, w) = inertial
        self._T_base_mass = np.array([w, x, y, z, *position])

    def _hold(self, values: Mapping[str, float]) -> None:
        """Set joints that no configuration moves, by name."""
        for name, value in values.items():
            pybullet.resetJointState(
                self._robot, self._joints[name], value, physicsClientId=self._client
            )

    def _know(self, i: int, pieces: tuple[Piece, ...]) -> None:
        """Look at a body from now on; its pieces are in the frame the simulator has."""
        self._things = with_thing(self._things, pieces, self._settling.margin_m)
        self._bodies.append(i)
        n_links, n_things = len(self._solids.link), len(self._bodies)
        self._near = np.zeros((n_links + 1, n_things + n_links), np.bool_)

    def put(self, object_id: str, body: Body, T_world_object: Array) -> None:
        """Let an object stand at a pose, or move it there."""
        if object_id not in self._standing:
            key = object_id, id(body)
            if key not in self._made:
                i = add_body(self._world, object_id, body, T_world_object)
                # The body is kept so that no other one gets its number.
                self._made[key] = (i, body)
                self._know(i, body.pieces)
            self._standing[object_id] = (self._made[key][0], body, T_world_object)
        self._move(object_id, T_world_object)

    def remove(self, object_id: str) -> None:
        """Take an object out of the scene; it waits for the next time far below."""
        i, _, _ = self._standing.pop(object_id)
        self._things.is_here[self._bodies.index(i)] = False
        away = (APART_M * i, 0.0, -AWAY_M)
        pybullet.resetBasePositionAndOrientation(i, away, (0, 0, 0, 1), self._client)

    def open_fingers(self, opening_m: float) -> None:
        """Hold the fingers so far apart from now on; they are longer when shut."""
        self._hold(gripper_values(self._model.settings, opening_m))

    def hits(
        self,
        q: Array,
        held_id: str | None = None,
        T_tool_object: Array | None = None,
        touching: bool = False,
    ) -> tuple[str, ...]:
        """Return what a configuration (4 + a,) hits, as sorted `link/thing` pairs.

        The gripper may reach into `held_id`, which moves with the tool if its pose
        there is given. Put down or lifted (`touching`) it may overlap with things a
        little.
        """
        q, held = np.asarray(q, float), self._held(held_id, T_tool_object)
        found = self._hits(q, held, held_id, T_tool_object, touching)
        self._carry(q, held_id, T_tool_object)
        return found

    def check_path(
        self,
        path: Array,
        held_id: str | None = None,
        T_tool_object: Array | None = None,
        touching: bool = False,
    ) -> str:
        """Return the first hit on the way along a path (t, 4 + a); empty if none."""
        spheres, lever_m = self._moving_points(held_id, T_tool_object)
        args = self._model.tree, spheres, lever_m, self._config.exact_step_m
        held, q, hit = self._held(held_id, T_tool_object), path[0], ""
        for n, q in steps(path, *args):
            found = self._hits(q, held, held_id, T_tool_object, touching)
            if found:
                hit = f"{found[0]} after row {n}"
                break
            held = held._replace(is_known=True)
        self._carry(q, held_id, T_tool_object)
        return hit

    def _held(self, held_id: str | None, T_tool_object: Array | None) -> Held:
        """Return what moves with the tool."""
        if held_id is None or T_tool_object is None:
            return NOTHING_HELD
        i, body, _ = self._standing[held_id]
        fixed = np.eye(4)
        fixed[:3] = self._model.tree.T_frame_tool
        T = fixed @ rigid.homogeneous(_centred(T_tool_object, body))
        return Held(self._bodies.index(i), np.ascontiguousarray(T[:3]), False)

    def _hits(
        self,
        q: Array,
        held: Held,
        held_id: str | None,
        T_tool_object: Array | None,
        touching: bool,
    ) -> tuple[str, ...]:
        """Return what `hits` does; what is held is where it was if nothing is near."""
        args = self._model.tree, q, self._solids, self._things, held
        if not near(*args, self._scratch, self._near):
            return ()
        self._set(q)
        self._carry(q, held_id, T_tool_object)
        found = self._robot_hits(held_id)
        if held_id is not None and T_tool_object is not None:
            depth_m = self._config.touch_depth_m if touching else 0.0
            found |= self._held_hits(held_id, depth_m)
        return tuple(sorted(found))

    def _carry(
        self, q: Array, held_id: str | None, T_tool_object: Array | None
    ) -> None:
        """Move what is held, if anything, to where the tool has it."""
        if held_id is not None and T_tool_object is not None:
            T_world_tool = tool_pose(self._model, q)
            self._move(held_id, rigid.compose(T_world_tool, T_tool_object))

    def _moving_points(
        self, held_id: str | None, T_tool_object: Array | None
    ) -> tuple[Spheres, Array]:
        """Return the spheres of the robot with the corners of what it holds as more.

        And how far a unit of each coordinate moves one of them at most, (4 + a,).
        """
        spheres, tree = self._model.spheres, self._model.tree
        if held_id is None or T_tool_object is None:
            return spheres, self._lever_m
        corners = rigid.apply(T_tool_object, self._standing[held_id][1].corners_m)
        at = corners @ tree.T_frame_tool[:, :3].T + tree.T_frame_tool[:, 3]
        frame = np.full(len(at), len(tree.axis) - 1)
        more = spheres._replace(
            frame=np.concatenate([spheres.frame, frame]),
            at_m=np.vstack([spheres.at_m, at]),
        )
        return more, levers(self._model, corners)

    def touching_pose(self, object_id: str, reach_m: float) -> Array:
        """Move an object up or down until it touches; return where it is, (7,)."""
        i, body, T_world_object = self._standing[object_id]
        start = {i: (body, T_world_object)}
        T = put_down(self._world, start, reach_m, self._depth_of)[i][1]
        self._move(object_id, T)
        return T

    def _depth_of(self, world: World, i: int) -> float:
        """Return how deep a body of the simulator overlaps with things [m]."""
        at, (x, y, z, w) = pybullet.getBasePositionAndOrientation(i, world.client)
        thing, out = self._bodies.index(i), self._near[-1]
        T_world_thing = rigid.homogeneous(np.array([w, x, y, z, *at]))
        self._things.T_world_thing[thing] = T_world_thing[:3]
        near_thing(self._things, thing, out)
        depths = [
            o.depth_m
            for other in self._others()
            for o in overlaps(world, i, (-1, other, -1))
        ]
        return max(depths, default=0.0)

    def _others(self) -> list[int]:
        """Return the bodies that what is held may overlap with."""
        return [self._bodies[k] for k in np.flatnonzero(self._near[-1]).tolist()]

    def let_go(self, object_id: str, above_m: float, reach_m: float) -> str:
        """Return why an object does not stay that is let go above where it stands.

        Empty if it comes to rest where it stands now, among the furniture and all else
        that stands. Let go at no height, it is put down before, as `settle` does it
        with `reach_m`. The world of the exact check is left as it is.
        """
        bodies = {k: (body, T) for k, (_, body, T) in self._standing.items()}
        near = _near(bodies, object_id, self._settling.near_m)
        body, T = bodies[object_id]
        near[object_id] = body, T + np.array([0, 0, 0, 0, 0, 0, above_m])
        reach_m = 0.0 if above_m > 0 else reach_m
        aims = {object_id: T}
        args = self._pieces, near, self._settling, reach_m, aims
        settled = settle(*args, until=object_id)
        return unrest(settled[object_id], self._settling)

    def _set(self, q: Array) -> None:
        """Move the robot to a configuration."""
        w, x, y, z, *at = self._T_base_mass.tolist()
        c, s = math.cos(q[2] / 2), math.sin(q[2] / 2)
        turned = (c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z)
        c, s = math.cos(q[2]), math.sin(q[2])
        position = (q[0] + c * at[0] - s * at[1], q[1] + s * at[0] + c * at[1], at[2])
        pybullet.resetBasePositionAndOrientation(
            self._robot, position, turned, self._client
        )
        pybullet.resetJointStatesMultiDof(
            self._robot,
            self._moving,
            [[value] for value in q[3:].tolist()],
            physicsClientId=self._client,
        )

    def _move(self, object_id: str, T_world_object: Array) -> None:
        """Move an object."""
        i, body, _ = self._standing[object_id]
        self._standing[object_id] = (i, body, T_world_object)
        T_world_mass = _centred(T_world_object, body)
        thing = self._bodies.index(i)
        self._things.T_world_thing[thing] = rigid.homogeneous(T_world_mass)[:3]
        self._things.is_here[thing] = True
        w, x, y, z, *centre = T_world_mass.tolist()
        pybullet.resetBasePositionAndOrientation(i, centre, (x, y, z, w), self._client)

    def _robot_hits(self, held_id: str | None) -> set[str]:
        """Return what the robot overlaps with, what its gripper holds if too deep."""
        found = set()
        for pair in self._near_pairs():
            link, other = self._links[pair[0]], pair[1]
            is_self = other == self._robot
            thing = self._links[pair[2]] if is_self else self._world.names[other]
            is_held = not is_self and thing == held_id and link in self._gripper
            depth_m = self._config.finger_m if is_held else 0.0
            hit = "/".join(sorted((link, thing)) if is_self else (link, thing))
            # The base rolls over what is low.
            low_m = self._config.floor_m if link in self._base else -np.inf
            if hit not in found and self._is_overlap(self._robot, pair, depth_m, low_m):
                found.add(hit)
        return found

    def _near_pairs(self) -> list[tuple[int, int, int]]:
        """Return which link may overlap with which body, and with which link of it."""
        n_things, pairs = len(self._bodies), []
        for row, column in np.argwhere(self._near[:-1]).tolist():
            link = self._solid[row]
            if column < n_things:
                pairs.append((link, self._bodies[column], -1))
            else:
                ends = sorted((link, self._solid[column - n_things]))
                pairs.append((ends[0], self._robot, ends[1]))
        return pairs

    def _held_hits(self, held_id: str, depth_m: float) -> set[str]:
        """Return what a held object overlaps with by at least `depth_m`."""
        i = self._standing[held_id][0]
        return {
            f"{held_id}/{self._world.names[other]}"
            for other in self._others()
            if self._is_overlap(i, (-1, other, -1), depth_m)
        }

    def _is_overlap(
        self, i: int, pair: tuple[int, int, int], depth_m: float, low_m: float = -np.inf
    ) -> bool:
        """Return whether a body overlaps with one near it by at least `depth_m`.

        What it stands on does not count where that is lower than `low_m`.
        """
        return any(
            o.depth_m >= depth_m
            and not (o.normal[2] > MAX_STEEPNESS and o.at_m[2] < low_m)
            for o in overlaps(self._world, i, pair)
        )


@contextmanager
def silence() -> Iterator[None]:
    """Keep what the simulator writes about a robot file off the terminal."""
    kept = [(number, os.dup(number)) for number in (1, 2)]
    try:
        with open(os.devnull, "w") as nowhere:
            for number, _ in kept:
                os.dup2(nowhere.fileno(), number)
            yield
    finally:
        for number, copy in kept:
            os.dup2(copy, number)
            os.close(copy)


def steps(
    path: Array, tree: Tree, spheres: Spheres, lever_m: Array, step_m: float
) -> Iterator[tuple[int, Array]]:
    """Yield configurations along a path (t, 4 + a), each with the row before it.

    No centre of a sphere moves farther than `step_m` from one to the next.
    """
    rows = np.asarray(path, float)
    yield 0, rows[0]
    for n, (q0, q1) in enumerate(pairwise(rows)):
        args = tree, spheres.frame, spheres.at_m, lever_m, q0, q1, step_m
        n_moves = n_steps(*args)
        for k in range(1, n_moves + 1):
            yield n, q0 + k / n_moves * (q1 - q0)


def _centred(T_a_object: Array, body: Body) -> Array:
    """Return the pose of the mass centre of a body, turned as the body is, (7,)."""
    centre = rigid.apply(T_a_object, body.mass_centre_m[None])[0]
    return np.concatenate([T_a_object[:4], centre])


def _near(
    bodies: Mapping[str, tuple[Body, Array]], object_id: str, near_m: float
) -> dict[str, tuple[Body, Array]]:
    """Return an object and those whose bounds, seen from above, come near it."""

    def bounds(name: str) -> tuple[Array, Array]:
        body, T = bodies[name]
        corners = rigid.apply(T, body.corners_m)[:, :2]
        return corners.min(0), corners.max(0)

    low, high = bounds(object_id)
    near = {}
    for name in bodies:
        other_low, other_high = bounds(name)
        if np.all(other_low <= high + near_m) and np.all(other_high >= low - near_m):
            near[name] = bodies[name]
    return near

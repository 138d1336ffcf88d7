"""The exact check: the true meshes of robot, furniture and objects in a simulator.

What was planned from a cloud is verified here, against what is really there, in finer
steps. A collision is an overlap of two shapes; nothing is simulated but the last thing
asked: whether an object that is let go stays. Letters: t configurations, a arm joints.
"""

import math
import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pybullet
from numpy.typing import NDArray

from placing import rigid
from placing.physics.arrangements import unrest
from placing.physics.bodies import Body, Piece
from placing.physics.putting_down import put_down
from placing.physics.settling import SettleConfig, settle
from placing.physics.simulator import add_body, add_fixed, new_world
from placing.rigid import Array
from placing.robot.checker import CheckerConfig, Held, levers
from placing.robot.kernels import Spheres, Tree, sphere_centres
from placing.robot.model import RobotModel, tool_pose
from placing.robot.tree import fixed_values

AWAY_M = 100.0
"""Where the robot waits while an object is put down without it."""
CURVED = 1.2
"""Way along an arc, and its fastest part, against the chords of its thirds."""
BLOCK = 8
"""Cells of a cloud along each edge of a piece: what is far away costs nothing."""


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
        gripper = set(model.settings.gripper_links)
        self._gripper = gripper
        self._lever_m = levers(model)

    def __enter__(self) -> "Truth":
        """Make the world."""
        s = self._settling
        world = new_world(s.step_rate_hz, s.friction, s.margin_m)
        self._world = self._stack.enter_context(world)
        for name, pieces in self._pieces.items():
            for piece in pieces:
                add_fixed(self._world, name, piece)
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
        self._hold_still()
        self._allow()
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
        values = fixed_values(settings, self._model.description, settings.max_opening_m)
        for name, value in values.items():
            pybullet.resetJointState(
                self._robot, self._joints[name], value, physicsClientId=self._client
            )
        names = (settings.torso, *settings.chain)
        self._moving = [self._joints[name] for name in names]
        inertial = pybullet.getDynamicsInfo(self._robot, -1, self._client)[3:5]
        position, (x, y, z, w) = inertial
        self._T_base_mass = np.array([w, x, y, z, *position])

    def _allow(self) -> None:
        """Let links overlap that do so by design or never move against each other."""
        number = {name: i for i, name in self._links.items()}
        names = self._model.links
        checked = {tuple(pair) for pair in self._model.self_pairs.tolist()}
        solid = sorted({hull.link for hull in self._model.hulls}, key=names.index)
        for i, one in enumerate(solid):
            for other in solid[i + 1 :]:
                if (names.index(one), names.index(other)) not in checked:
                    pybullet.setCollisionFilterPair(
                        self._robot,
                        self._robot,
                        number[one],
                        number[other],
                        0,
                        self._client,
                    )

    def put(self, object_id: str, body: Body, T_world_object: Array) -> None:
        """Let an object stand at a pose, or move it there."""
        if object_id not in self._standing:
            i = add_body(self._world, object_id, body, T_world_object)
            self._standing[object_id] = (i, body, T_world_object)
        self._move(object_id, T_world_object)

    def remove(self, object_id: str) -> None:
        """Take an object out of the world."""
        i, _, _ = self._standing.pop(object_id)
        pybullet.removeBody(i, self._client)
        del self._world.names[i]

    def hits(
        self,
        q: Array,
        held_id: str | None = None,
        T_tool_object: Array | None = None,
        touching: bool = False,
    ) -> tuple[str, ...]:
        """Return what a configuration (4 + a,) hits, as sorted `link/thing` pairs.

        The gripper may touch `held_id`, which moves with the tool if its pose there is
        given. Put down or lifted (`touching`) it may overlap with things a little.
        """
        self._set(np.asarray(q, float))
        if held_id is not None and T_tool_object is not None:
            T_world_tool = tool_pose(self._model, q)
            self._move(held_id, rigid.compose(T_world_tool, T_tool_object))
        pybullet.performCollisionDetection(self._client)
        found = self._robot_hits(held_id)
        if held_id is not None and T_tool_object is not None:
            depth_m = self._config.touch_depth_m if touching else 0.0
            found |= self._held_hits(held_id, depth_m)
        return tuple(sorted(found))

    def check_path(
        self,
        path: Array,
        held_id: str | None = None,
        T_tool_object: Array | None = None,
        touching: bool = False,
    ) -> str:
        """Return the first hit on the way along a path (t, 4 + a); empty if none."""
        spheres = self._moving_points(held_id, T_tool_object)
        args = self._model.tree, spheres, self._lever_m, self._config.exact_step_m
        for n, q in steps(path, *args):
            if hit := self.hits(q, held_id, T_tool_object, touching):
                return f"{hit[0]} after row {n}"
        return ""

    def _moving_points(
        self, held_id: str | None, T_tool_object: Array | None
    ) -> Spheres:
        """Return the spheres of the robot, and the corners of what it holds as more."""
        spheres, tree = self._model.spheres, self._model.tree
        if held_id is None or T_tool_object is None:
            return spheres
        corners = rigid.apply(T_tool_object, self._standing[held_id][1].corners_m)
        at = corners @ tree.T_frame_tool[:, :3].T + tree.T_frame_tool[:, 3]
        frame = np.full(len(at), len(tree.axis) - 1)
        return spheres._replace(
            frame=np.concatenate([spheres.frame, frame]),
            at_m=np.vstack([spheres.at_m, at]),
        )

    def touching_pose(self, object_id: str, reach_m: float) -> Array:
        """Move an object up or down until it touches; return where it is, (7,)."""
        away = np.zeros(4 + self._model.n_arm)
        away[:2] = AWAY_M
        self._set(away)
        i, body, T_world_object = self._standing[object_id]
        T = put_down(self._world, {i: (body, T_world_object)}, reach_m)[i][1]
        self._standing[object_id] = (i, body, T)
        return T

    def settle(self, object_id: str, reach_m: float = 0.0, above_m: float = 0.0) -> str:
        """Return why an object does not stay where it stands; empty if it stays.

        It is let go among the furniture and all else that stands; `reach_m` as in
        `physics.settling.settle`. By `above_m` it may drop beside what it may move. The
        world of the exact check is left as it is.
        """
        bodies = {k: (body, T) for k, (_, body, T) in self._standing.items()}
        near = _near(bodies, object_id, self._settling.near_m)
        settled = settle(self._pieces, near, self._settling, reach_m)
        most_m = self._settling.max_moved_m + above_m
        return unrest(settled[object_id], replace(self._settling, max_moved_m=most_m))

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
        w, x, y, z = T_world_object[:4]
        centre = rigid.apply(T_world_object, body.mass_centre_m[None])[0]
        pybullet.resetBasePositionAndOrientation(i, centre, (x, y, z, w), self._client)

    def _robot_hits(self, held_id: str | None) -> set[str]:
        """Return what the robot overlaps with, but for what its gripper holds."""
        found = set()
        for contact in pybullet.getContactPoints(
            bodyA=self._robot, physicsClientId=self._client
        ):
            if contact[8] > 0:
                continue
            link, other = self._links[contact[3]], contact[2]
            if other == self._robot:
                found.add("/".join(sorted((link, self._links[contact[4]]))))
                continue
            name = self._world.names[other]
            if not (name == held_id and link in self._gripper):
                found.add(f"{link}/{name}")
        return found

    def _held_hits(self, held_id: str, depth_m: float) -> set[str]:
        """Return what a held object overlaps with by more than `depth_m`."""
        i = self._standing[held_id][0]
        contacts = pybullet.getContactPoints(bodyA=i, physicsClientId=self._client)
        return {
            f"{held_id}/{self._world.names[contact[2]]}"
            for contact in contacts
            if contact[2] != self._robot and contact[8] <= -depth_m
        }


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
        n_steps = _n_steps(q0, q1, tree, spheres, lever_m, step_m)
        for k in range(1, n_steps + 1):
            yield n, q0 + k / n_steps * (q1 - q0)


def _n_steps(
    q0: Array, q1: Array, tree: Tree, spheres: Spheres, lever_m: Array, step_m: float
) -> int:
    """Return in how many steps no centre moves farther than `step_m`.

    The levers of all joints add up to several times what really moves, which is
    measured over every third of the steps that would be enough by the levers.
    """
    most = max(1, int(np.ceil(np.abs(q1 - q0) @ lever_m / step_m)))
    n = -(-most // 3)
    at = np.empty((n + 1, len(spheres.at_m), 3))
    for k in range(n + 1):
        q = q0 + k / n * (q1 - q0)
        sphere_centres(tree, spheres, q, at[k])
    farthest = np.linalg.norm(np.diff(at, axis=0), axis=2).max()
    return max(1, int(np.ceil(CURVED * n * farthest / step_m)))


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


def pieces_of_cloud(points_m: NDArray, cell_m: float) -> dict[str, tuple[Piece, ...]]:
    """Return the pieces of a scene that is known by its cloud (p, 3) alone [m].

    A box per cell, as high as its points: a table top is as high as it was scanned.
    """
    points = np.asarray(points_m, float)
    cells = np.floor(points / cell_m).astype(np.int64)
    cells, which = np.unique(cells, axis=0, return_inverse=True)
    low: Array = (cells * cell_m).astype(np.float64)
    high: Array = (cells * cell_m + cell_m).astype(np.float64)
    z = points[:, 2]
    low[:, 2], high[:, 2] = np.inf, -np.inf
    np.minimum.at(low[:, 2], which, z)
    np.maximum.at(high[:, 2], which, z)
    _, block = np.unique(cells // BLOCK, axis=0, return_inverse=True)
    order = np.argsort(block, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(block[order])) + 1)
    return {"scan": tuple(_boxes(low[group], high[group]) for group in groups)}


def _boxes(low: Array, high: Array) -> Piece:
    """Return boxes between corners (b, 3) as one piece of triangles."""
    corner = np.indices((2, 2, 2)).reshape(3, 8).T.astype(bool)  # (8, 3)
    vertices = np.where(corner, high[:, None], low[:, None])  # (b, 8, 3)
    # ASSUME: a surface of points has the thickness of a sheet of paper.
    vertices[:, :, 2] -= np.where(corner[:, 2], 0.0, 1e-4)
    faces = (np.arange(len(low)) * 8)[:, None, None] + BOX_FACES
    return Piece(vertices.reshape(-1, 3), faces.reshape(-1, 3), False)


BOX_FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
"""Triangles of a box whose corners are numbered with z fastest."""


def held_of(held: Held | None) -> tuple[str | None, Array | None]:
    """Return the arguments that the exact check wants for what the planner holds."""
    return (None, None) if held is None else (held.object_id, held.T_tool_object)

"""Whether the robot is clear of the scene, of what stands there and of itself.

Conservative: spheres contain every link, and keep a margin from the points of the
cloud. What is called free is free in the exact simulation; some of what is free is not
called so. Letters: t configurations, a arm joints, s spheres, h spheres of what is
held, b boxes.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from placing import rigid
from placing.rigid import Array
from placing.robot.distance_field import DistanceField, FieldConfig
from placing.robot.kernels import (
    Body,
    Case,
    Lattice,
    Surroundings,
    are_clear,
    are_free,
    case_of,
    edge_free,
    hand_boxes,
    hands_clear,
    hands_free,
    path_clear,
    state_hits,
    way,
)
from placing.robot.model import RobotModel
from placing.robot.trunk import trunk_of

MAX_CLUSTER = 8
"""Most spheres of a cluster; only speed depends on it."""
N_BODIES = 4
"""Robots without anything in the hand that are kept; a study has one."""
UPRIGHT = np.array([0.0, 0.0, 1.0, 0.0])
"""The third axis of a frame, without its origin."""
HELD_CELL_M = 0.05
"""A sphere around each cube of this edge stands for what is held: 2 cm stand out."""


@dataclass(frozen=True)
class CheckerConfig(FieldConfig):
    """How near the robot may come to things; values: config/config.yaml."""

    spacing_m: float
    """Farthest that a point of a surface is from the next point of the cloud."""
    margin_m: float
    """Kept between the robot and the surfaces between points, and the ground."""
    box_margin_m: float
    """Kept between the robot and the boxes of objects."""
    self_margin_m: float
    """Kept between the links of the robot."""
    lift_m: float
    """How much of what is held, from below, may touch when it is put down."""
    step_m: float
    """Nothing moves farther between two checks of an edge."""
    exact_step_m: float
    """As `step_m`, where the exact check goes over a finished path."""
    touch_depth_m: float
    """Deepest overlap of what is held while it is put down or lifted."""
    finger_m: float
    """Deepest overlap of the fingers with what they hold."""


@dataclass(frozen=True)
class Held:
    """An object in the gripper, as spheres that cover its box."""

    object_id: str
    T_tool_object: Array
    """(7,)."""
    size_m: Array
    """(3,)."""
    centre_m: Array
    """In the frame of the tool, (h, 3)."""
    radius_m: Array
    """(h,)."""


class Hits(NamedTuple):
    """What a configuration hits."""

    scene: bool
    self: bool
    """The robot itself, or the held object the robot."""
    boxes: tuple[int, ...]
    """Numbers of the boxes that are hit, sorted."""


def held(object_id: str, size_m: Sequence[float], T_tool_object: Array) -> Held:
    """Return an object in the gripper, covered by spheres around small cubes."""
    size = np.asarray(size_m, float)
    counts = np.maximum(np.ceil(size / HELD_CELL_M - 1e-9), 1).astype(int)
    cell = size / counts
    corners = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1)
    centres = (corners.reshape(-1, 3) + 0.5) * cell - size / 2
    radius = np.full(len(centres), float(np.linalg.norm(cell)) / 2)
    centre_m = rigid.apply(T_tool_object, centres)
    return Held(object_id, np.asarray(T_tool_object, float), size, centre_m, radius)


@dataclass(frozen=True)
class SceneChecker:
    """The robot among the points of a scene and the boxes of objects."""

    model: RobotModel
    field: DistanceField
    config: CheckerConfig
    boxes: tuple[tuple[float, ...], ...] = ()
    """Centre, size and yaw of each, seven numbers."""

    def __post_init__(self) -> None:
        """Prepare what every check needs."""
        vars(self).update(_counter=np.zeros(1, np.int64), _bodies={}, _cases={})

    @property
    def n_checks(self) -> int:
        """Configurations checked so far, of states and of edges, whatever the boxes."""
        return int(vars(self)["_counter"][0])

    def with_boxes(self, boxes: Array) -> "SceneChecker":
        """Return a checker of the same scene with boxes (b, 7) in place of its own."""
        rows = tuple(map(tuple, np.reshape(boxes, (-1, 7)).tolist()))
        other = replace(self, boxes=rows)
        vars(other).update({key: vars(self)[key] for key in ("_counter", "_bodies")})
        return other

    def are_free(
        self, configurations: Array, held: Held | None = None, touching: bool = False
    ) -> NDArray[np.bool_]:
        """Return whether each configuration (t, 4 + a) is free, (t,)."""
        rows = np.ascontiguousarray(configurations, float)
        out = np.empty(len(rows), np.bool_)
        are_free(self._case(held), rows, touching, out)
        self._count(len(rows))
        return out

    def are_clear(
        self, configurations: Array, held: Held | None = None, touching: bool = False
    ) -> NDArray[np.bool_]:
        """Return whether each of (t, 4 + a) is free of the boxes, whatever else, (t,).

        With rows that are free where there are no boxes it says what `are_free` says.
        """
        rows = np.ascontiguousarray(configurations, float)
        out = np.empty(len(rows), np.bool_)
        are_clear(self._case(held), rows, touching, out)
        return out

    def are_hands_free(
        self, Ts_world_tool: Array, held: Held | None = None, touching: bool = False
    ) -> NDArray[np.bool_]:
        """Return whether the hand alone is free with the tool at (n, 4, 4), (n,).

        Where it is not, no configuration with the tool there is.
        """
        wrists = self._wrists(Ts_world_tool)
        out = np.empty(len(wrists), np.bool_)
        hands_free(self._case(held), wrists, touching, out)
        return out

    def are_hands_clear(
        self, places: Array, T_world_tool: Array, held: Held | None = None
    ) -> NDArray[np.bool_]:
        """Return whether base and torso are clear of the hand with the tool at (4, 4).

        Places are x, y, yaw and a height of the torso (n, 4), what is returned (n,).
        Where they are not, no configuration with the tool there is free.
        """
        wrist = self._wrists(T_world_tool[None])[0]
        out = np.empty(len(places), np.bool_)
        rows = np.ascontiguousarray(places, float)
        hands_clear(self._case(held), rows, wrist, out)
        return out

    def hand_hits(
        self, T_world_tool: Array, held: Held | None = None, touching: bool = False
    ) -> tuple[int, ...]:
        """Return numbers of the boxes that the hand alone hits, tool at (4, 4)."""
        boxes = np.zeros(len(self.boxes), np.bool_)
        wrist = self._wrists(T_world_tool[None])[0]
        hand_boxes(self._case(held), wrist, touching, boxes)
        return tuple(np.flatnonzero(boxes).tolist())

    def is_free(
        self, q: Array, held: Held | None = None, touching: bool = False
    ) -> bool:
        """Return whether a configuration (4 + a,) is free."""
        return bool(self.are_free(np.asarray(q)[None], held, touching)[0])

    def is_edge_free(
        self, q0: Array, q1: Array, held: Held | None = None, touching: bool = False
    ) -> bool:
        """Return whether the straight line between two configurations is free."""
        free, n = edge_free(
            self._case(held),
            np.ascontiguousarray(q0, float),
            np.ascontiguousarray(q1, float),
            touching,
            self.config.step_m,
        )
        self._count(n)
        return bool(free)

    def is_path_free(
        self, path: Array, held: Held | None = None, touching: bool = False
    ) -> bool:
        """Return whether a path (t, 4 + a) is free; its rows are checked first."""
        if not self.are_free(path, held, touching).all():
            return False
        edges = pairwise(np.asarray(path))
        return all(self.is_edge_free(q0, q1, held, touching) for q0, q1 in edges)

    def is_path_clear(
        self, path: Array, held: Held | None = None, touching: bool = False
    ) -> bool:
        """Return whether a path (t, 4 + a) is free of the boxes, whatever else it hits.

        Configurations are those that `is_path_free` looks at.
        """
        rows = np.ascontiguousarray(path, float)
        return bool(path_clear(self._case(held), rows, touching, self.config.step_m))

    def hits(self, q: Array, held: Held | None = None, touching: bool = False) -> Hits:
        """Return all that a configuration (4 + a,) hits."""
        boxes = np.zeros(len(self.boxes), np.bool_)
        row = np.ascontiguousarray(q, float)
        scene, itself = state_hits(self._case(held), row, touching, boxes)
        self._count(1)
        return Hits(bool(scene), bool(itself), tuple(np.flatnonzero(boxes).tolist()))

    def way(
        self,
        q: Array,
        lattice: Lattice,
        goal: int,
        root: int,
        held: Held | None = None,
        is_lost: NDArray[np.bool_] | None = None,
    ) -> NDArray[np.int64]:
        """Return numbers of the poses of a lattice on the way from `goal` to `root`.

        Torso and arm are those of a configuration (4 + a,) that is free of itself. The
        poses (n,) found to have no way to `root` are added to `is_lost`.
        """
        if is_lost is None:
            is_lost = np.zeros(len(lattice.poses), np.bool_)
        row = np.asarray(q, float)
        return way(self._case(held), row, lattice, goal, root, is_lost)

    def _wrists(self, Ts_world_tool: Array) -> Array:
        """Return the last frame of the arm with the tool at (n, 4, 4), (n, 3, 4)."""
        return np.ascontiguousarray((Ts_world_tool @ self.model.T_tool_frame)[:, :3])

    def _count(self, n: int) -> None:
        """Add to the number of checks."""
        vars(self)["_counter"][0] += n

    def _case(self, held: Held | None) -> Case:
        """Return what the kernels look at, made once for what is held."""
        cases, key = vars(self)["_cases"], id(held)
        if key not in cases:
            # What is held is kept with its body.
            cases[key] = case_of(self.model.tree, self._body(held), self._around)
        return cases[key]

    def _body(self, held: Held | None) -> Body:
        """Return the spheres of the robot and of what it holds, made once for each."""
        bodies, key = vars(self)["_bodies"], id(held)
        if key not in bodies:
            # The object is kept so that no other one gets its number.
            if held is None:
                body = make_body(self.model, self.config)
            else:
                body = holding(self._body(None), self.model, held, self.config)
            bodies[key] = (body, held)
        return bodies[key][0]

    @cached_property
    def _around(self) -> Surroundings:
        """What may be hit, as the kernels want it."""
        rows = np.array(self.boxes, float).reshape(-1, 7)
        half, yaw = rows[:, 3:6] / 2, rows[:, 6:]
        turned = [rows[:, :3], half, np.cos(yaw), np.sin(yaw)]
        diagonal = np.linalg.norm(half, axis=1, keepdims=True)
        config = self.config
        return Surroundings(
            *self.field,
            config.floor_m,
            np.hstack([*turned, diagonal]),
            config.margin_m,
            config.box_margin_m,
            config.self_margin_m,
            config.lift_m,
        )


@lru_cache(maxsize=N_BODIES)
def make_body(model: RobotModel, config: CheckerConfig) -> Body:
    """Return the spheres of a robot that holds nothing, sorted for the kernels."""
    spheres, tree = model.spheres, model.tree
    numbers = np.unique(spheres.link)  # (l,), sorted
    numbers = numbers[np.argsort(-tree.link_frame[numbers], kind="stable")]
    parts = [
        (spheres.at_m[m], spheres.radius_m[m]) for m in spheres.link == numbers[:, None]
    ]
    gripper = [model.links.index(link) for link in model.settings.gripper_links]
    position = {number: i for i, number in enumerate(numbers.tolist())}
    pairs = [(position[i], position[j]) for i, j in model.self_pairs.tolist()]
    lever_m, frame = levers(model), tree.link_frame[numbers]
    trunk = trunk_of(parts, frame, pairs, tree, config.self_margin_m)
    arms = [(i, j) for i, j in pairs if not _is_trunk(frame[i], frame[j])]
    outer_frame, outer_m = outermost(spheres.frame, spheres.at_m)
    return Body(
        *_clustered(parts, config),
        frame=frame,
        is_gripper=np.isin(numbers, gripper),
        n_robot=len(numbers),
        pairs=np.array(arms, np.int64).reshape(-1, 2),
        trunk=trunk,
        outer_frame=outer_frame,
        outer_m=outer_m,
        lever_m=lever_m,
        span_m=float(lever_m[2] + spheres.radius_m.max()),
    )


def _is_trunk(one: int, other: int) -> bool:
    """Return whether of two frames one is of the arm, and one of base or torso."""
    return min(one, other) < 2 <= max(one, other)


def holding(body: Body, model: RobotModel, held: Held, config: CheckerConfig) -> Body:
    """Return the spheres of a robot and of what it holds as a further, last link."""
    T = model.tree.T_frame_tool
    at = held.centre_m @ T[:, :3].T + T[:, 3]
    more = _clustered([(at, held.radius_m)], config)
    others = ~body.is_gripper & (body.frame > 1)
    pairs = [(body.n_robot, i) for i in np.flatnonzero(others).tolist()]
    ends = (more[3][1:] + body.cluster[-1], more[5][1:] + body.link[-1])
    lever_m, radius = levers(model, held.centre_m), np.append(body.radius_m, more[1])
    last = len(model.tree.axis) - 1
    _, outer_m = outermost(np.full(len(at), last), at)
    return Body(
        np.vstack([body.at_m, more[0]]),
        radius,
        np.append(body.reach_m, more[2]),
        np.append(body.cluster, ends[0]),
        np.vstack([body.cluster_ball, more[4]]),
        np.append(body.link, ends[1]),
        np.vstack([body.link_ball, more[6]]),
        frame=np.append(body.frame, last),
        is_gripper=np.append(body.is_gripper, True),
        n_robot=body.n_robot,
        pairs=np.vstack([body.pairs, np.reshape(pairs, (-1, 2))]),
        trunk=body.trunk,
        outer_frame=np.append(body.outer_frame, np.full(len(outer_m), last)),
        outer_m=np.vstack([body.outer_m, outer_m]),
        lever_m=lever_m,
        span_m=float(lever_m[2] + radius.max()),
    )


def _clustered(
    parts: Sequence[tuple[Array, Array]], config: CheckerConfig
) -> tuple[Array, Array, Array, NDArray[np.int64], Array, NDArray[np.int64], Array]:
    """Return the first seven fields of a body from the spheres of each link."""
    chunks, link = [], [0]
    for at, radius in parts:
        chunks += [(at[i], radius[i]) for i in _halved(at, np.arange(len(at)))]
        link.append(len(chunks))
    at = np.concatenate([at for at, _ in chunks])
    radius = np.concatenate([radius for _, radius in chunks])
    # A sphere that touches a surface is this far from the next point of the cloud.
    reach = np.hypot(radius + config.margin_m, config.spacing_m)
    cluster = np.cumsum([0, *(len(r) for _, r in chunks)])
    balls = [_ball(at, radius, config) for at, radius in chunks]
    whole = [_ball(at, radius, config) for at, radius in parts]
    return (
        np.ascontiguousarray(at),
        radius,
        reach,
        cluster,
        np.array(balls),
        np.array(link),
        np.array(whole),
    )


def _halved(at: Array, chosen: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return groups of few spheres each, halved along their longest side."""
    if len(chosen) <= MAX_CLUSTER:
        return [chosen]
    axis = int(np.argmax(np.ptp(at[chosen], axis=0)))
    order = chosen[np.argsort(at[chosen, axis], kind="stable")]
    half = len(order) // 2
    return _halved(at, order[:half]) + _halved(at, order[half:])


def _ball(at: Array, radius: Array, config: CheckerConfig) -> Array:
    """Return centre, radius and reach of a ball around spheres, (5,)."""
    low, high = (at - radius[:, None]).min(0), (at + radius[:, None]).max(0)
    centre = (low + high) / 2
    away = np.linalg.norm(at - centre, axis=1)
    reach = np.hypot(radius + config.margin_m, config.spacing_m)
    return np.array([*centre, (away + radius).max(), (away + reach).max()])


def outermost(frame: NDArray[np.int64], at_m: Array) -> tuple[NDArray[np.int64], Array]:
    """Return those of points (s, 3) in frames (s,) that all of a frame are between.

    However a frame moves, none of its points moves farther than one of these.
    """
    chosen = [np.empty(0, np.int64)]
    for number in np.unique(frame):
        some = np.flatnonzero(frame == number)
        with suppress(QhullError):  # of few or flat ones all are kept
            some = some[ConvexHull(at_m[some]).vertices]
        chosen.append(some)
    rows = np.concatenate(chosen)
    return frame[rows], at_m[rows]


def levers(model: RobotModel, held_m: Array | None = None) -> Array:
    """Return how far a unit of each coordinate moves a centre at most, (4 + a,).

    `held_m` (h, 3) are more points, in the frame of the tool.
    """
    tree, spheres = model.tree, model.spheres
    length = np.zeros(len(tree.axis) + 1)  # of what hangs on each frame, stretched out
    np.maximum.at(length, spheres.frame, np.linalg.norm(spheres.at_m, axis=1))
    if held_m is not None:
        at = held_m @ tree.T_frame_tool[:, :3].T + tree.T_frame_tool[:, 3]
        length[-2] = max(length[-2], np.linalg.norm(at, axis=1).max())
    for k in range(len(tree.axis) - 2, -1, -1):
        # The upper limit of a joint that slides lengthens what hangs on it.
        slide = 0.0 if tree.is_turning[k + 1] else abs(model.upper[k + 3])
        hung = np.linalg.norm(tree.T_parent_joint[k + 1, :, 3]) + slide + length[k + 1]
        length[k] = max(length[k], hung)
    turns = np.where(tree.is_turning, length[:-1], 1.0)
    # The base turns about the vertical: what the torso lifts moves no farther for it.
    lifts = not tree.is_turning[1] and abs(tree.axis[1, 2]) > 1 - 1e-9
    if lifts and abs(tree.T_parent_joint[1, 2] @ UPRIGHT) > 1 - 1e-9:
        body = np.linalg.norm(spheres.at_m[spheres.frame < 2, :2], axis=1).max()
        sideways = np.linalg.norm(tree.T_parent_joint[1:3, :2, 3], axis=1)
        turns[0] = sideways[0] + max(body, sideways[1] + length[2])
    return np.array([1.0, 1.0, *turns])

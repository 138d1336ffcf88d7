"""Where the base can go: a lattice of base poses on the floor of a scene.

Poses are free with the arm as it is carried and the torso low; they are neighbours in
place, one heading apart, or at one heading, one cell apart. What can be reached from
the most open spot is found once; every way starts and ends there.

Letters: n poses of the lattice, e edges, t rows of a path.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placing.errors import NoFloor
from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.floor_lattice import Ints, grid, near, pairs, poses
from placing.robot.planning import PlanningConfig

N_TREES = 32
"""Trees of ways that are kept, the last ones: each holds a megabyte or two."""


class Floor:
    """The base poses of a scene that can be reached from its most open spot."""

    def __init__(
        self, checker: SceneChecker, config: PlanningConfig, scene: str
    ) -> None:
        """Find where the robot can stand, and the ways from the most open spot."""
        self.checker, self.config, self.scene = checker, config, scene
        settings = checker.model.settings
        self.low_m = float(settings.torso_heights_m[0])
        self.shape, self.origin_m = grid(checker, config)
        self.poses = poses(self.shape, self.origin_m, config)  # (n, 3)
        self.is_free = checker.are_free(self.configurations(self.poses))
        if not self.is_free.any():
            raise NoFloor(
                f"{scene}: floor: no spot where the robot {settings.robot} can stand;"
                " expected a scan with open floor"
            )
        self.edges, self.lengths = self._joined(checker, self.is_free)
        self.start_pose = self._most_open()
        self.distance, self.before = self._tree(self.start_pose, None)
        self.reachable = np.flatnonzero(np.isfinite(self.distance))
        self._trees: dict[tuple, tuple[Array, Ints]] = {}

    @property
    def start(self) -> Array:
        """The configuration in which the robot waits, arm as carried, (4 + a,)."""
        return self.configurations(self.poses[self.start_pose])[0]

    def configurations(
        self, poses: Array, torso_m: float | None = None, arm: Array | None = None
    ) -> Array:
        """Return base poses (b, 3) as configurations, shape (b, 4 + a)."""
        poses = np.atleast_2d(poses)
        settings = self.checker.model.settings
        arm = np.asarray(settings.carry if arm is None else arm, float)
        torso = np.full((len(poses), 1), self.low_m if torso_m is None else torso_m)
        arms = np.repeat(arm[None], len(poses), axis=0)
        return np.hstack([poses, torso, arms])

    def are_reachable(self, poses: Array) -> NDArray[np.bool_]:
        """Return whether the lattice's pose next to each (b, 3) is reachable, (b,)."""
        return np.isfinite(self._distances_at(poses))

    def poses_around(
        self, x: float, y: float, reach_m: tuple[float, float], bearing: Array
    ) -> Array:
        """Return the reachable poses that see a point near enough and in front, (b, 3).

        `bearing` (2,) are the least and the largest direction seen from the base [rad].
        """
        poses = self.poses[self.reachable]
        offset = np.array([x, y]) - poses[:, :2]
        away = np.hypot(*offset.T)
        seen = np.arctan2(offset[:, 1], offset[:, 0]) - poses[:, 2]
        middle = bearing.mean()
        seen = middle + (seen - middle + np.pi) % (2 * np.pi) - np.pi
        is_near = (away >= reach_m[0]) & (away <= reach_m[1])
        return poses[is_near & (seen >= bearing[0]) & (seen <= bearing[1])]

    def is_reachable(self, x: float, y: float, yaw: float) -> bool:
        """Return whether the robot can drive to the lattice's pose next to this one."""
        return bool(self.are_reachable(np.array([[x, y, yaw]]))[0])

    def path(
        self,
        goal: Array,
        checker: SceneChecker | None = None,
        held: Held | None = None,
        start: Array | None = None,
    ) -> Array | None:
        """Return a way of the base to the base pose of `goal`, (t, 4 + a), if any.

        The torso is low and the arm is that of `start`, by default as it is carried.
        `checker` knows what stands there, by default furniture alone.
        """
        checker = checker or self.checker
        first = self.start if start is None else start.copy()
        first[3] = self.low_m
        last = np.concatenate([goal[:3], first[3:]])
        last[2] = near(last[2], first[2])
        if not (checker.is_free(first, held) and checker.is_free(last, held)):
            return None
        if checker.is_edge_free(first, last, held):
            return np.array([first, last])
        trees = self._lazily(first, checker, held, start is None)
        for before in trees:
            path = self._along(before, first, last)
            if path is not None:
                path = shortened(path, checker, held)
                if checker.is_path_free(path, held):
                    return path
        return None

    def _lazily(
        self, first: Array, checker: SceneChecker, held: Held | None, from_start: bool
    ) -> Iterator[Ints]:
        """Yield trees of ways: that of furniture alone, then one of what is there."""
        at = self.start_pose if from_start else int(self._nearest(first[None, :3])[0])
        yield self.before if from_start else self._tree(at, None)[1]
        key = (
            at,
            None if held is None else (held.object_id, held.T_tool_object.tobytes()),
            checker.boxes,
            first[3:].tobytes(),
        )
        if key not in self._trees:
            q = self.configurations(self.poses[self.is_free], arm=first[4:])
            is_free = self.is_free.copy()
            is_free[self.is_free] = checker.are_free(q, held)
            if len(self._trees) >= N_TREES:
                del self._trees[next(iter(self._trees))]
            self._trees[key] = self._tree(at, is_free)
        yield self._trees[key][1]

    def _along(self, before: Ints, first: Array, last: Array) -> Array | None:
        """Return the way along a tree from its root to next to `last`, (t, 4 + a)."""
        node = int(self._nearest(last[None, :3])[0])
        nodes = [node]
        while before[node] >= 0:
            node = int(before[node])
            nodes.append(node)
        if not self._is_root(node, first):
            return None
        base = self.poses[nodes[::-1]]
        base = np.vstack([first[:3], base, last[:3]])
        base[:, 2] = np.unwrap(base[:, 2])
        return np.hstack([base, np.repeat(first[None, 3:], len(base), axis=0)])

    def _is_root(self, node: int, first: Array) -> bool:
        """Return whether a way that ends at `node` came from the pose next to first."""
        return node == int(self._nearest(first[None, :3])[0])

    def _most_open(self) -> int:
        """Return the pose farthest from where the robot cannot turn in place."""
        can_turn = self.is_free.reshape(self.shape).all(2)
        if not can_turn.any():
            return int(np.flatnonzero(self.is_free)[0])
        # ASSUME: heading 0, as every heading is free there.
        room = ndimage.distance_transform_edt(np.pad(can_turn, 1))[1:-1, 1:-1]
        cell = int(room.argmax())
        return cell * self.shape[2]

    def _joined(
        self, checker: SceneChecker, is_free: NDArray[np.bool_]
    ) -> tuple[Ints, Array]:
        """Return pairs of neighbours (e, 2) that are free midway, and their lengths."""
        edges = pairs(self.shape)
        edges = edges[is_free[edges].all(1)]
        a, b = self.poses[edges[:, 0]], self.poses[edges[:, 1]].copy()
        b[:, 2] = near(b[:, 2], a[:, 2])
        away = np.hypot(*(b - a)[:, :2].T)
        angle = np.abs(b[:, 2] - a[:, 2])
        # Cells are nearer to each other than what the checker steps over.
        is_joined = away > 0
        turns = np.flatnonzero(~is_joined)
        middle = self.configurations((a + b)[turns] / 2)
        is_joined[turns] = checker.are_free(middle)
        return edges[is_joined], (away + angle * self.config.turn_m)[is_joined]

    def _tree(self, root: int, is_free: NDArray[np.bool_] | None) -> tuple[Array, Ints]:
        """Return the length of the way from `root` to each pose, and the pose before.

        Only free poses are used, by default those of the lattice.
        """
        edges, lengths = self.edges, self.lengths
        if is_free is not None:
            kept = is_free[edges].all(1)
            edges, lengths = edges[kept], lengths[kept]
        n = len(self.poses)
        graph = csr_matrix((lengths, edges.T), shape=(n, n))
        distance, before = dijkstra(
            graph, directed=False, indices=root, return_predecessors=True
        )
        return distance, before.astype(np.int64)

    def _nearest(self, poses: Array) -> Ints:
        """Return the pose of the lattice next to each (b, 3), shape (b,)."""
        nx, ny, n = self.shape
        cell = np.rint((poses[:, :2] - self.origin_m) / self.config.floor_cell_m)
        i, j = np.clip(cell.astype(np.int64), 0, (nx - 1, ny - 1)).T
        k = np.rint(poses[:, 2] / (2 * np.pi) * n).astype(np.int64) % n
        return (i * ny + j) * n + k

    def _distances_at(self, poses: Array) -> Array:
        """Return the length of the way to the pose next to each, shape (b,) [m]."""
        return self.distance[self._nearest(poses)]


def shortened(path: Array, checker: SceneChecker, held: Held | None) -> Array:
    """Return a path with the corners left out that a free straight edge skips."""
    kept, i = [0], 0
    while i < len(path) - 1:
        j = len(path) - 1
        while j > i + 1 and not checker.is_edge_free(path[i], path[j], held):
            j = i + max(1, (j - i) * 2 // 3)
        kept.append(j)
        i = j
    return path[kept]

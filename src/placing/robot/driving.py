"""Where the base can go: a lattice of base poses on the floor of a scene.

Poses are free with the arm as it is carried and the torso low; they are neighbours in
place, one heading apart, or at one heading, one cell apart. How far everything is from
the most open spot is found once, and guides every search for a way.

Letters: n poses of the lattice, e edges, t rows of a path.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placing.errors import NoFloor
from placing.rigid import Array, near
from placing.robot.checker import Held, SceneChecker
from placing.robot.floor_lattice import Ints, grid, pairs, poses
from placing.robot.kernels import Lattice
from placing.robot.planning import PlanningConfig


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
        self.start_pose = self._most_open()
        self.lattice = self._joined()
        self.reachable = np.flatnonzero(np.isfinite(self.lattice.distance_m))

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
        seen = near(seen, bearing.mean())
        is_near = (away >= reach_m[0]) & (away <= reach_m[1])
        return poses[is_near & (seen >= bearing[0]) & (seen <= bearing[1])]

    def path(
        self,
        goal: Array,
        checker: SceneChecker | None = None,
        held: Held | None = None,
        start: Array | None = None,
        is_lost: NDArray[np.bool_] | None = None,
    ) -> Array | None:
        """Return a way of the base to the base pose of `goal`, (t, 4 + a), if any.

        The torso is low and the arm is that of `start`, by default as it is carried.
        `checker` knows what stands there, by default furniture alone. Poses of the
        lattice (n,) that have no way from the start are looked up in `is_lost`, and
        added to it.
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
        base = self._way(first, last, checker, held, is_lost)
        if not len(base):
            return None
        base = np.vstack([first[:3], base, last[:3]])
        base[:, 2] = np.unwrap(base[:, 2])
        path = np.hstack([base, np.repeat(first[None, 3:], len(base), axis=0)])
        path = shortened(path, checker, held)
        return path if checker.is_path_free(path, held) else None

    def _way(
        self,
        first: Array,
        last: Array,
        checker: SceneChecker,
        held: Held | None,
        is_lost: NDArray[np.bool_] | None,
    ) -> Array:
        """Return poses of the lattice between two configurations, (n, 3)."""
        root, goal = self._nearest(np.array([first[:3], last[:3]])).tolist()
        nodes = checker.way(first, self.lattice, goal, root, held, is_lost)
        return self.poses[nodes[::-1]]

    def _most_open(self) -> int:
        """Return the pose farthest from where the robot cannot turn in place."""
        can_turn = self.is_free.reshape(self.shape).all(2)
        if not can_turn.any():
            return int(np.flatnonzero(self.is_free)[0])
        # ASSUME: heading 0, as every heading is free there.
        room = ndimage.distance_transform_edt(np.pad(can_turn, 1))[1:-1, 1:-1]
        cell = int(room.argmax())
        return cell * self.shape[2]

    def _joined(self) -> Lattice:
        """Return the free poses with the free ways between them."""
        edges = pairs(self.shape)
        edges = edges[self.is_free[edges].all(1)]
        a, b = self.poses[edges[:, 0]], self.poses[edges[:, 1]].copy()
        b[:, 2] = near(b[:, 2], a[:, 2])
        away = np.hypot(*(b - a)[:, :2].T)
        angle = np.abs(b[:, 2] - a[:, 2])
        # Cells are nearer to each other than what the checker steps over.
        is_joined = away > 0
        turns = np.flatnonzero(~is_joined)
        middle = self.configurations((a + b)[turns] / 2)
        is_joined[turns] = self.checker.are_free(middle)
        lengths_m = (away + angle * self.config.turn_m)[is_joined]
        n = len(self.poses)
        graph = csr_matrix((lengths_m, edges[is_joined].T), shape=(n, n))
        graph = (graph + graph.T).tocsr()
        first, other = graph.indptr.astype(np.int64), graph.indices.astype(np.int64)
        distance_m = dijkstra(graph, indices=self.start_pose)
        return Lattice(self.poses, first, other, graph.data, distance_m)

    def _nearest(self, poses: Array) -> Ints:
        """Return the pose of the lattice next to each (b, 3), shape (b,)."""
        nx, ny, n = self.shape
        cell = np.rint((poses[:, :2] - self.origin_m) / self.config.floor_cell_m)
        i, j = np.clip(cell.astype(np.int64), 0, (nx - 1, ny - 1)).T
        k = np.rint(poses[:, 2] / (2 * np.pi) * n).astype(np.int64) % n
        return (i * ny + j) * n + k


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

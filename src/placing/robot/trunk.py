"""Base and torso of a robot, and how far from their spheres each spot beside them is.

Letters: l links with spheres, s spheres, f 0 for the base and 1 for the torso.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from placing.rigid import Array
from placing.robot.kernels import Tree, Trunk, least_distances

CELL_M = 0.04
"""Width of the cells; only speed and memory depend on it."""
AROUND_M = 0.3
"""Cells reach so far around the trunk; only speed and memory depend on it."""

BIN_RAD = 0.05
"""Angles of the first joint of the arm looked at together; only speed depends on it."""


def trunk_of(
    parts: Sequence[tuple[Array, Array]],
    frame: NDArray[np.int64],
    pairs: Sequence[tuple[int, int]],
    tree: Tree,
    margin_m: float,
) -> Trunk:
    """Return the trunk as the links of pairs may hit it, nearer than a margin.

    `parts` are centres (s, 3) and radii (s,) of the spheres of each link, in the frame
    (l,) that carries it. What is held may hit every link of the trunk.
    """
    of_trunk = [np.flatnonzero(frame == f).tolist() for f in (0, 1)]
    hit = [[_mates(k, pairs, some) for some in of_trunk] for k in range(len(frame))]
    rows = [links if frame[k] > 1 else [[], []] for k, links in enumerate(hit)]
    rows.append(of_trunk)
    counts = np.array([[len(links) for links in row] for row in rows])  # (l + 1, 2)
    ends = np.cumsum(counts.ravel()).reshape(-1, 2)
    first = np.column_stack([ends[:, 0] - counts[:, 0], ends])
    sets = {tuple(links): 0 for row in rows for links in row if links}
    sets = {links: n for n, links in enumerate(sets)}
    origin, near = _distances(parts, of_trunk[0] + of_trunk[1])
    least = [np.min([near[m] for m in links], axis=0) for links in sets]
    near_torso = [
        (parts[k], parts[m])
        for k, (_, links) in enumerate(hit)
        for m in links
        if frame[k] == 2
    ]
    return Trunk(
        origin,
        CELL_M,
        AROUND_M,
        np.array(least, np.float32),
        np.array([[sets.get(tuple(links), -1) for links in row] for row in rows]),
        first,
        np.array([m for row in rows for links in row for m in links], np.int64),
        -np.pi,
        BIN_RAD,
        _apart(near_torso, tree, margin_m),
    )


def _apart(
    pairs: Sequence[tuple[tuple[Array, Array], tuple[Array, Array]]],
    tree: Tree,
    margin_m: float,
) -> NDArray[np.bool_]:
    """Return in which bins spheres of frame 2 and of the torso cannot meet, (n,)."""
    angles = np.arange(-np.pi, np.pi, BIN_RAD) + BIN_RAD / 2
    turns = Rotation.from_rotvec(angles[:, None] * tree.axis[2]).as_matrix()
    T, is_apart = tree.T_parent_joint[2], np.full(len(turns), tree.is_turning[2])
    for (moving, radii), (still, other_radii) in pairs:
        farthest = np.linalg.norm(moving, axis=1).max() * BIN_RAD / 2
        reach = radii[:, None] + other_radii + margin_m + farthest
        for i, turn in enumerate(turns):
            at = (moving @ turn.T) @ T[:, :3].T + T[:, 3]
            is_apart[i] &= np.all(cdist(at, still) > reach)
    return is_apart


def _mates(k: int, pairs: Sequence[tuple[int, int]], some: Sequence[int]) -> list[int]:
    """Return those of some links that link k makes a pair with, sorted."""
    with_k = {i + j - k for i, j in pairs if k in (i, j)}
    return sorted(with_k & set(some))


def _distances(
    parts: Sequence[tuple[Array, Array]], links: Sequence[int]
) -> tuple[Array, dict[int, NDArray[np.float32]]]:
    """Return where the cells begin (3,) [m], and least distances to each link."""
    low = np.min([(parts[m][0] - parts[m][1][:, None]).min(0) for m in links], axis=0)
    high = np.max([(parts[m][0] + parts[m][1][:, None]).max(0) for m in links], axis=0)
    shape = np.ceil((high - low + 2 * AROUND_M) / CELL_M).astype(int) + 1
    origin, near = low - AROUND_M, {}
    for m in links:
        near[m] = np.empty(shape, np.float32)
        least_distances(*parts[m], origin, CELL_M, near[m])
    return origin, near

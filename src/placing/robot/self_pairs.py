"""Which links of a robot must not touch each other."""

import numpy as np
from numpy.typing import NDArray

from placing.robot.kernels import Spheres, Tree
from placing.robot.settings import RobotSettings
from placing.robot.urdf import Description, read_srdf

Array = NDArray[np.float64]


def self_pairs_of(
    settings: RobotSettings,
    description: Description,
    links: tuple[str, ...],
    tree: Tree,
) -> NDArray[np.int64]:
    """Return pairs of solid links that move against each other, sorted, (p, 2).

    Pairs are left out that the description lists as harmless; where there is no list,
    those that a joint connects, and neighbours along the arm with all that they carry.
    """
    solids = {shape.link for shape in description.shapes}
    frame = tree.link_frame
    if settings.srdf is None:
        harmless = _joined(description, solids)
    else:
        harmless = read_srdf(settings.srdf)
    numbers = [i for i, link in enumerate(links) if link in solids]
    pairs = [
        (i, j)
        for i in numbers
        for j in numbers
        if i < j
        and frame[i] != frame[j]
        # ASSUME: what stands still and is carried by the torso clears the base at all
        # heights; tests compare with the physics engine.
        and max(frame[i], frame[j]) > 1
        and frozenset((links[i], links[j])) not in harmless
        and not (settings.srdf is None and _are_next(int(frame[i]), int(frame[j])))
    ]
    return np.array(pairs, np.int64).reshape(-1, 2)


def _are_next(i: int, j: int) -> bool:
    """Return whether two frames of the arm turn about one joint of it."""
    return min(i, j) > 1 and abs(i - j) == 1


def _joined(description: Description, solids: set[str]) -> frozenset[frozenset[str]]:
    """Return each solid link with the next solid link towards the base."""
    parent = {joint.child: joint.parent for joint in description.joints.values()}
    pairs = []
    for link in solids:
        above = parent.get(link)
        while above is not None and above not in solids:
            above = parent.get(above)
        if above is not None:
            pairs.append(frozenset((link, above)))
    return frozenset(pairs)


def apart(
    pairs: NDArray[np.int64], spheres: Spheres, poses: Array
) -> NDArray[np.int64]:
    """Return the pairs whose spheres do not overlap at poses (l, 4, 4), (<= p, 2)."""
    T = poses[spheres.link]
    at = np.einsum("sij,sj->si", T[:, :3, :3], spheres.centre_m) + T[:, :3, 3]
    is_near = [_is_near(spheres, at, i, j) for i, j in pairs]
    return pairs[~np.array(is_near, bool)]


def _is_near(spheres: Spheres, at: Array, i: int, j: int) -> bool:
    """Return whether spheres of two links overlap."""
    a, b = spheres.link == i, spheres.link == j
    distance = np.linalg.norm(at[a][:, None] - at[b], axis=-1)
    return bool(np.any(distance < spheres.radius_m[a][:, None] + spheres.radius_m[b]))

"""What a robot takes up: convex solids of its links, and spheres around them."""

import numpy as np
from numpy.typing import NDArray

from placing.errors import BadInput
from placing.robot.covering import cover
from placing.robot.kernels import Spheres, Tree
from placing.robot.meshes import Hull, hull_of, hull_of_points
from placing.robot.settings import RobotSettings
from placing.robot.tree import carried, fixed_values
from placing.robot.urdf import Description

Array = NDArray[np.float64]

N_OPENINGS = 9
"""Openings whose hull stands for all: 0.1 mm between them, within the padding."""

# SOURCE: Bullet inflates each convex mesh of a description by its margin of 1 mm.
PADDING_M = 0.001


def hulls_of(
    settings: RobotSettings,
    description: Description,
    links: tuple[str, ...],
    widest_m: float,
) -> tuple[Hull, ...]:
    """Return the solids of all links in the order of the links."""
    swept = _swept(settings, description, links, widest_m)
    hulls = []
    for shape in description.shapes:
        hull = hull_of(shape)
        if shape.link in swept:
            points = hull.points_m
            moved = [points @ T[:3, :3].T + T[:3, 3] for T in swept[shape.link]]
            hull = hull_of_points(shape.link, np.concatenate(moved))
        hulls.append(hull)
    order = {link: i for i, link in enumerate(links)}
    if not hulls:
        raise BadInput(f"{description.file}: has no collision shape; expected some")
    return tuple(sorted(hulls, key=lambda hull: order[hull.link]))


def _swept(
    settings: RobotSettings,
    description: Description,
    links: tuple[str, ...],
    widest_m: float,
) -> dict[str, list[Array]]:
    """Return where links of the gripper are at all openings, seen from the widest."""
    openings = np.linspace(widest_m, 0, N_OPENINGS).tolist()
    values = [fixed_values(settings, description, opening) for opening in openings]
    # Seen from the base with all joints that move at 0.
    poses = [carried(description, {}, value)[1] for value in values]
    moved = {k: [np.linalg.inv(poses[0][k]) @ T[k] for T in poses] for k in links}
    return {k: Ts for k, Ts in moved.items() if not np.allclose(Ts, np.eye(4))}


def spheres_of(
    settings: RobotSettings, links: tuple[str, ...], tree: Tree, hulls: tuple[Hull, ...]
) -> Spheres:
    """Return the spheres around all solids, those of the last frame first."""
    parts = []
    for hull in hulls:
        link = links.index(hull.link)
        frame = tree.link_frame[link]
        centres, radii = cover(hull, _bulge(settings, frame, hull))
        T, n = tree.T_frame_link[link], len(radii)
        at = centres @ T[:, :3].T + T[:, 3]
        numbers = np.full(n, link), np.full(n, frame)
        parts.append((centres, radii + PADDING_M, *numbers, at))
    columns = zip(*parts, strict=True)
    centre, radius, link, frame, at = (np.concatenate(column) for column in columns)
    # What moves most collides first, and larger spheres before smaller ones.
    order = np.lexsort((-radius, link, -frame))
    return Spheres(
        centre_m=np.ascontiguousarray(centre[order]),
        radius_m=radius[order],
        link=link[order].astype(np.int64),
        frame=frame[order].astype(np.int64),
        at_m=np.ascontiguousarray(at[order]),
    )


def _bulge(settings: RobotSettings, frame: int, hull: Hull) -> float:
    """Return how far the spheres of a solid may stand out of it [m]."""
    low, high = hull.points_m.min(axis=0), hull.points_m.max(axis=0)
    size = float(np.prod(high - low) ** (1 / 3))
    limits = settings.arm_bulge_m if frame > 1 else settings.body_bulge_m
    if hull.link in settings.gripper_links:
        limits = settings.gripper_bulge_m
    return float(np.clip(settings.bulge_share * size, *limits))

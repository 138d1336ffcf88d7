"""How an object can be put down: upright, on each stable face, leaning, on edge, hung.

An orientation turns the frame of the object before the yaw is applied. All of them
come from the cloud of the object alone. Letters for shapes: n points, f faces.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from placing import rigid
from placing.rigid import Array

if TYPE_CHECKING:
    from placing.psi.object_clouds import ObjectCloud

HUNG = "hung"
ALIKE_M = 0.006
"""Guards the comparison of two ways to lie against the spacing of the cloud."""
N_BANDS = 16
"""Heights at which the width of an object is measured."""


@dataclass(frozen=True)
class OrientationsConfig:
    """Which orientations are tried; the values live in `config/config.yaml`."""

    n_most: int
    """Most orientations of an object."""
    n_faces: int
    """Most stable faces besides the one it stands on upright."""
    merge_deg: float
    """Faces of the hull whose normals differ by less are one."""
    min_tipping_deg: float
    """A stable face carries the object even when the ground tilts this much."""
    lean_deg: tuple[float, ...]
    """How far from the vertical an object leans against something behind it."""
    max_thinness: float
    """What is thinner than this share of its next extent goes into slots and leans."""
    max_stem_m: float
    """What hangs upside down has a stem at most this wide above its foot."""


@dataclass(frozen=True)
class Orientation:
    """A way to put an object down."""

    name: str
    """`upright`, `edge`, `face1` .. , `lean1` .. or `hung`."""
    quaternion: Array
    """(4,) wxyz; turns the object's frame before the yaw is applied."""


def orientations(
    cloud: "ObjectCloud", config: OrientationsConfig
) -> tuple[Orientation, ...]:
    """Return the ways to put an object down, `upright` first."""
    found = [Orientation("upright", np.array(rigid.IDENTITY))]
    # A slot, a wall behind or a rail take less room in the list than faces, and what
    # lies on a face is often unstable: they come first.
    if is_thin(cloud, config):
        found.append(Orientation("edge", np.array(rigid.ON_EDGE)))
    if stem_below(cloud, config) is not None:
        found.append(Orientation(HUNG, np.array(rigid.UPSIDE_DOWN)))
    leaning = list(_leaning(cloud, config))
    n_faces = min(config.n_faces, config.n_most - len(found) - len(leaning))
    found += _faces(cloud, [o.quaternion for o in found], n_faces, config)
    return tuple([*found, *leaning][: config.n_most])


def extents_of(cloud: "ObjectCloud") -> Array:
    """Return the size of the box around the cloud, shape (3,) [m]."""
    return np.ptp(cloud.points, axis=0)


def is_thin(cloud: "ObjectCloud", config: OrientationsConfig) -> bool:
    """Return whether an object is flat or long and lies along x when upright."""
    x, y, z = extents_of(cloud)
    return bool(z < config.max_thinness * x and (min(y, z) < config.max_thinness * x))


def _leaning(cloud: "ObjectCloud", config: OrientationsConfig) -> Iterator[Orientation]:
    """Yield how a thin object leans on edge and a tall one upright."""
    x, y, z = extents_of(cloud)
    is_tall = max(x, z) > min(x, y) / config.max_thinness
    if is_thin(cloud, config):
        start, axis = np.array(rigid.ON_EDGE), (1.0, 0.0, 0.0)
    elif is_tall:
        start, axis = np.array(rigid.IDENTITY), (0.0, 1.0, 0.0)
    else:
        return
    for i, degrees in enumerate(config.lean_deg):
        tilt = rigid.about(axis, np.deg2rad(degrees))
        yield Orientation(f"lean{i + 1}", rigid.multiply(tilt, start))


def _faces(
    cloud: "ObjectCloud", known: list[Array], n_most: int, config: OrientationsConfig
) -> list[Orientation]:
    """Return the stable faces of the hull that lie unlike the known orientations."""
    shapes = [_silhouette(cloud, quaternion) for quaternion in known]
    found: list[Orientation] = []
    for normal in _stable_normals(cloud, config):
        if len(found) >= n_most:
            break
        quaternion = rigid.turn_down(normal)
        shape = _silhouette(cloud, quaternion)
        if all(np.abs(shape - other).max() > ALIKE_M for other in shapes):
            shapes.append(shape)
            found.append(Orientation(f"face{len(found) + 1}", quaternion))
    return found


def _silhouette(cloud: "ObjectCloud", quaternion: Array) -> Array:
    """Return lengths that agree for two ways to lie that look alike, shape (4,) [m].

    Mirror images and turns about the vertical do not change them.
    """
    points = cloud.points @ rigid.matrix(quaternion).T
    low, high = points.min(0), points.max(0)
    # The spread along both horizontal axes sees a quarter turn as no change.
    spread = np.sqrt(np.linalg.eigvalsh(np.cov(points[:, :2].T)))
    above = (rigid.matrix(quaternion) @ cloud.mass_centre)[2] - low[2]
    return np.array([high[2] - low[2], above, *spread])


def _stable_normals(cloud: "ObjectCloud", config: OrientationsConfig) -> Array:
    """Return the outer normals of the faces it can rest on, largest first, (f, 3)."""
    hull = ConvexHull(cloud.points)
    corners = cloud.points[hull.simplices]  # (f, 3, 3)
    normals = hull.equations[:, :3]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    least = np.cos(np.deg2rad(config.merge_deg))
    left, stable = np.ones(len(normals), bool), []
    totals = []
    for i in np.argsort(-areas, kind="stable"):
        if not left[i]:
            continue
        near = left & (normals @ normals[i] > least)
        left &= ~near
        mean = (normals[near] * areas[near, None]).sum(0)
        mean /= np.linalg.norm(mean)
        if tipping_deg(cloud, mean) >= config.min_tipping_deg:
            stable.append(mean)
            totals.append(areas[near].sum())
    order = np.argsort(-np.array(totals), kind="stable")
    return np.array(stable).reshape(-1, 3)[order]


def tipping_deg(cloud: "ObjectCloud", normal: Array) -> float:
    """Return how far the ground may tilt before the object tips off a face [deg].

    Below 0 it tips on level ground.
    """
    R = rigid.matrix(rigid.turn_down(normal))
    points, centre = cloud.points @ R.T, R @ cloud.mass_centre
    low = points[:, 2].min()
    # ASSUME: what is within a few millimetres of the ground touches it.
    base = points[points[:, 2] < low + ALIKE_M / 2, :2]
    if len(base) < 3 or np.linalg.matrix_rank(base - base[0], tol=1e-6) < 2:
        return -90.0
    lines = ConvexHull(base).equations  # (e, 3), negative inside
    inside = -(lines[:, :2] @ centre[:2] + lines[:, 2]).max()
    return float(np.rad2deg(np.arctan2(inside, centre[2] - low)))


def stem_below(cloud: "ObjectCloud", config: OrientationsConfig) -> float | None:
    """Return how high the foot below a stem is, None where there is no stem [m]."""
    up, (x, y, z) = cloud.points, extents_of(cloud)
    bands = np.minimum(
        ((up[:, 2] - up[:, 2].min()) / z * N_BANDS).astype(int), N_BANDS - 1
    )
    away = np.linalg.norm(up[:, :2], axis=1)
    widths = np.array(
        [
            2 * away[bands == b].max() if np.any(bands == b) else 0
            for b in range(N_BANDS)
        ]
    )
    stem = np.flatnonzero((widths > 0) & (widths < config.max_stem_m))
    # The foot is below the stem and wider; the stem is in the lower two thirds.
    if z < max(x, y) or not len(stem) or stem[0] == 0 or stem[0] > N_BANDS // 2:
        return None
    if widths[0] < 2 * widths[stem[0]] or widths[stem[-1] + 1 :].max(initial=0) == 0:
        return None
    wide = up[(away > config.max_stem_m / 2) & (bands < stem[0]), 2]
    return float(wide.max() - up[:, 2].min()) if len(wide) else None


def drop_of(
    cloud: "ObjectCloud", orientation: Orientation, config: OrientationsConfig
) -> float:
    """Return how far below its placing area the lowest point of an object is [m].

    It is 0 for all that stands on its area; what hangs does so by its foot.
    """
    if orientation.name != HUNG:
        return 0.0
    foot = stem_below(cloud, config)
    return 0.0 if foot is None else float(extents_of(cloud)[2] - foot)

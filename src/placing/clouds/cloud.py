"""Clouds of points: sampled from meshes, and preprocessed whatever their source.

Preprocessing makes every cloud alike: without outliers, thinned to one point per voxel
and side, with normals, level, and with its floor at z = 0. Clouds sampled from meshes
have true normals; those of a scanner get theirs from neighbouring points.

Letters for shapes: n points, f faces.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from numba import njit
from numpy.random import Generator
from numpy.typing import NDArray

from placing.clouds.levelling import estimate_normals, level
from placing.clouds.ply import Cloud
from placing.clouds.voxels import (
    add_sides,
    average,
    average_known,
    cell_keys,
    count_around,
    lowest,
)
from placing.errors import BadInput

MAX_EXTENT_M = 100.0
"""Guards the memory: no scene is that wide, but one stray cluster makes a scan so."""
TILE = 64
"""Period of the jitter of the sampling lattice, in lattice cells."""


@dataclass(frozen=True)
class CloudConfig:
    """Settings of the preprocessing; the values live in `config/config.yaml`."""

    crop_m: tuple[tuple[float, float, float], tuple[float, float, float]] | None
    """Lower and upper corner of what is kept of the raw cloud; None keeps all."""
    up: tuple[float, float, float]
    """Where up is in the raw cloud, right to `max_tilt_rad`."""
    voxel_m: float
    """Edge of the voxels that hold one point per side of what they cut."""
    outlier_cell_m: float
    """Edge of the cells in which neighbours of a point are counted."""
    outlier_neighbors: int
    """A point is an outlier if its cell and those around hold no more others."""
    normal_neighbors: int
    """Neighbours that a plane is fitted to where the cloud has no normals."""
    max_tilt_rad: float
    """Largest angle between `up` and the true vertical."""
    floor_fraction: float
    """Points of the floor, as a fraction of those of the fullest level."""
    min_points: int
    """Fewest points that make a scene."""


def sample_cloud(
    rng: Generator,
    meshes: Sequence[trimesh.Trimesh],
    spacing_m: float,
    softness: Sequence[float] | None = None,
) -> Cloud:
    """Return points on the faces of the meshes, one per square of `spacing_m`.

    The points are a jittered lattice in the coordinate plane that a face is closest
    to: other than independent draws in proportion to area it leaves no gaps. `softness`
    is that of each mesh, where known.
    """
    if not meshes:
        raise ValueError("expected at least one mesh to sample")
    triangles = np.concatenate([m.triangles for m in meshes]).astype(float)  # (f, 3, 3)
    colors = np.concatenate([_face_colors(m) for m in meshes])  # (f, 3)
    edges = triangles[:, 1:] - triangles[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])  # (f, 3)
    length = np.linalg.norm(normals, axis=1)
    is_face = length > 1e-12  # Faces without area have no normal.
    triangles, colors = triangles[is_face], colors[is_face]
    soft = None if softness is None else _per_face(softness, meshes)[is_face]
    normals = normals[is_face] / length[is_face, None]
    axes = np.abs(normals).argmax(axis=1)
    jitter = rng.random((3, TILE, TILE, 2))
    points, faces = _rasterise(triangles, axes, jitter, spacing_m)
    return Cloud(
        points,
        normals[faces].astype(np.float32),
        colors[faces],
        None if soft is None else soft[faces],
    )


def preprocess(cloud: Cloud, config: CloudConfig) -> Cloud:
    """Return the cloud cropped, thinned, cleaned, with normals, level, floor at 0."""
    cloud = crop(cloud, config)
    _check_count(cloud, config)  # Before compiled loops, which trust there to be some.
    if cloud.normals.any(axis=1).sum() < len(cloud) / 2:  # Few are as good as none.
        cloud = replace(cloud, normals=np.zeros_like(cloud.normals))
    cloud = drop_outliers(thin(cloud, config.voxel_m), config)
    _check_count(cloud, config)
    _check_extent(cloud)
    if not cloud.normals.any():
        cloud = estimate_normals(
            cloud, config.normal_neighbors, config.up, config.max_tilt_rad
        )
    return level(cloud, config.up, config.max_tilt_rad, config.floor_fraction)


def crop(cloud: Cloud, config: CloudConfig) -> Cloud:
    """Return the points between the corners of what is kept, all without corners."""
    if config.crop_m is None:
        return cloud
    low, high = np.asarray(config.crop_m, np.float32)
    inside = (cloud.points >= low) & (cloud.points <= high)
    return cloud.take(inside.all(axis=1))


def _check_count(cloud: Cloud, config: CloudConfig) -> None:
    """Refuse a cloud with too few points to be a scene."""
    if len(cloud) < config.min_points:
        raise BadInput(
            f"cloud: field points is {len(cloud)} after cropping and thinning,"
            f" expected at least {config.min_points}, in metres"
        )


def _check_extent(cloud: Cloud) -> None:
    """Refuse a cloud too wide for tables with a row for each cell of its floor plan."""
    extent = float(np.ptp(cloud.points, axis=0).max())
    if extent > MAX_EXTENT_M:
        raise BadInput(
            f"cloud: field extent is {extent:.0f} m, expected at most"
            f" {MAX_EXTENT_M:.0f} m; crop_m keeps a part"
        )


def thin(cloud: Cloud, voxel_m: float) -> Cloud:
    """Return the mean of the points of each voxel, one for each side of a thin board.

    Points whose normals have different main directions are not averaged, so that a
    board thinner than a voxel keeps its upper and its lower face.
    """
    low = lowest(cloud.points) - 0.37 * voxel_m  # Off the round heights of designs.
    keys = add_sides(cell_keys(cloud.points, low, voxel_m)[0], cloud.normals)
    order = np.argsort(keys, kind="stable")
    means = average(keys, order, cloud.points, cloud.normals, cloud.colors)
    if cloud.softness is None:
        return Cloud(*means)
    return Cloud(*means, average_known(keys, order, cloud.softness))


def drop_outliers(cloud: Cloud, config: CloudConfig) -> Cloud:
    """Return the cloud without points that have few others around them."""
    # Counting in cells is more than ten times as fast as a search for neighbours.
    low = lowest(cloud.points) - config.outlier_cell_m
    keys, shape = cell_keys(cloud.points, low, config.outlier_cell_m)
    n_around = count_around(keys, np.argsort(keys, kind="stable"), shape)
    return cloud.take(n_around > config.outlier_neighbors)


def _per_face(
    values: Sequence[float], meshes: Sequence[trimesh.Trimesh]
) -> NDArray[np.float32]:
    """Return the value of the mesh that each face belongs to, shape (f,)."""
    return np.repeat(np.asarray(values, np.float32), [len(m.faces) for m in meshes])


def _face_colors(mesh: trimesh.Trimesh) -> NDArray[np.uint8]:
    """Return red, green and blue of each face, shape (f, 3)."""
    return np.asarray(getattr(mesh.visual, "face_colors"))[:, :3]  # noqa: B009


def _rasterise(
    triangles: NDArray, axes: NDArray, jitter: NDArray, spacing_m: float
) -> tuple[NDArray[np.float32], NDArray[np.intp]]:
    """Return lattice points on the triangles, and the triangle of each."""
    none, no_faces = np.empty((0, 3), np.float32), np.empty(0, np.intp)
    n = _fill_lattice(triangles, axes, jitter, spacing_m, none, no_faces)
    points, faces = np.empty((n, 3), np.float32), np.empty(n, np.intp)
    _fill_lattice(triangles, axes, jitter, spacing_m, points, faces)
    return points, faces


@njit(cache=True)
def _fill_lattice(
    triangles: NDArray,
    axes: NDArray,
    jitter: NDArray,
    spacing_m: float,
    points: NDArray,
    faces: NDArray,
) -> int:
    """Count the lattice points on all triangles, and write them where there is room."""
    n = 0
    for f in range(len(triangles)):
        w = axes[f]
        u, v = (w + 1) % 3, (w + 2) % 3
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        area = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u])
        i_first = int(np.floor(min(a[u], b[u], c[u]) / spacing_m)) - 1
        i_last = int(np.floor(max(a[u], b[u], c[u]) / spacing_m))
        j_first = int(np.floor(min(a[v], b[v], c[v]) / spacing_m)) - 1
        j_last = int(np.floor(max(a[v], b[v], c[v]) / spacing_m))
        for i in range(i_first, i_last + 1):
            for j in range(j_first, j_last + 1):
                shift = jitter[w, i % TILE, j % TILE]
                p, q = (i + shift[0]) * spacing_m, (j + shift[1]) * spacing_m
                t_b = ((p - a[u]) * (c[v] - a[v]) - (q - a[v]) * (c[u] - a[u])) / area
                t_c = ((b[u] - a[u]) * (q - a[v]) - (b[v] - a[v]) * (p - a[u])) / area
                if t_b < 0 or t_c < 0 or t_b + t_c > 1:
                    continue
                if n < len(points):
                    points[n, u], points[n, v] = p, q
                    points[n, w] = a[w] + t_b * (b[w] - a[w]) + t_c * (c[w] - a[w])
                    faces[n] = f
                n += 1
    return n

"""What a renderer needs of meshes: one mesh of all, and normals for round surfaces."""

from collections.abc import Sequence

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from trimesh.visual import ColorVisuals

SMOOTH_DEG = 35.0
"""Faces that meet at less than this angle are shaded as one round surface."""


def joined(meshes: Sequence[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Return all meshes as one, colours of the faces kept."""
    offsets = np.cumsum([0, *[len(mesh.vertices) for mesh in meshes]])
    return trimesh.Trimesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([m.faces + n for m, n in zip(meshes, offsets, strict=False)]),
        face_colors=np.concatenate([face_colours(mesh) for mesh in meshes]),
        process=False,
    )


def face_colours(mesh: trimesh.Trimesh) -> NDArray[np.uint8]:
    """Return the colour of each face, shape (t, 4); grey where it has none."""
    if isinstance(mesh.visual, ColorVisuals):
        return np.asarray(mesh.visual.face_colors, np.uint8)
    return np.full((len(mesh.faces), 4), 170, np.uint8)


def smooth_normals(mesh: trimesh.Trimesh) -> NDArray[np.float64]:
    """Return the normal at each corner of each face, shape (t, 3, 3).

    It is the mean, by area, of the faces around the vertex that the face meets at
    less than `SMOOTH_DEG`.
    """
    n_corners = mesh.faces.size
    cross = np.asarray(mesh.triangles_cross, float)
    unit = cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-20)

    shape = (n_corners, len(mesh.vertices))
    entries = (np.ones(n_corners, np.int8), (np.arange(n_corners), mesh.faces.ravel()))
    at = csr_matrix(entries, shape)
    pair = (at @ at.T).tocoo()  # corners that share a vertex
    a, b = pair.row // 3, pair.col // 3
    is_close = np.einsum("ij,ij->i", unit[a], unit[b]) > np.cos(np.radians(SMOOTH_DEG))
    near = csr_matrix(
        (np.ones(is_close.sum()), (pair.row[is_close], b[is_close])),
        (n_corners, len(mesh.faces)),
    )
    total = near @ cross
    norm = np.linalg.norm(total, axis=1, keepdims=True)
    normal = np.where(norm > 1e-20, total / np.maximum(norm, 1e-20), [0, 0, 1.0])
    return normal.reshape(-1, 3, 3)

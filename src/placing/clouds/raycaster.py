"""Meshes that rays are cast at: what they hit first, and how near the meshes are.

Shapes: f faces, p rays or points.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import trimesh
from numpy.typing import NDArray

if TYPE_CHECKING:
    from open3d.core import Tensor

NO_FACE = np.iinfo(np.uint32).max


class Hits(NamedTuple):
    """What rays hit first."""

    is_hit: NDArray[np.bool_]
    """(p,)."""
    t: NDArray[np.float32]
    """(p,) lengths of the directions of the rays to the hit; `inf` without one."""
    face: NDArray[np.int64]
    """(p,) index into the faces of all meshes; 0 without a hit."""
    normal: NDArray[np.float32]
    """(p, 3) unit normal of the face; it may point away from the ray's start."""


class Raycaster:
    """All faces of some meshes, sorted in space."""

    def __init__(self, meshes: Sequence[trimesh.Trimesh]) -> None:
        """Sort the faces of all meshes."""
        import open3d as o3d  # here, because it takes a second that few stages need

        self._tensor = o3d.core.Tensor.from_numpy
        self._scene = o3d.t.geometry.RaycastingScene()
        offsets = np.cumsum([0, *[len(mesh.vertices) for mesh in meshes]])
        faces = [m.faces + n for m, n in zip(meshes, offsets, strict=False)]
        self._scene.add_triangles(
            self._tensor(np.concatenate([m.vertices for m in meshes]).astype("f4")),
            self._tensor(np.concatenate(faces).astype("u4")),
        )

    def cast(self, starts: NDArray, directions: NDArray) -> Hits:
        """Return what the rays from the starts, (p, 3) or (3,), hit first."""
        answer = self._scene.cast_rays(self._rays(starts, directions))
        t, face = answer["t_hit"].numpy(), answer["primitive_ids"].numpy()
        is_hit = face != NO_FACE
        normal = answer["primitive_normals"].numpy()
        return Hits(is_hit, t, np.where(is_hit, face, 0).astype(np.int64), normal)

    def is_between(self, starts: NDArray, ends: NDArray) -> NDArray[np.bool_]:
        """Tell between which starts (p, 3) and ends (p, 3) or (3,) something is."""
        rays = self._rays(starts, ends - starts)
        # A thousandth of the way off the start, to not hit where the ray begins.
        return self._scene.test_occlusions(rays, 1e-3, 1.0).numpy()

    def distance(self, points: NDArray) -> NDArray[np.float32]:
        """Return how far points are from the nearest face, shape (p,) [m]."""
        packed = np.ascontiguousarray(points, np.float32)
        return self._scene.compute_distance(self._tensor(packed)).numpy()

    def _rays(self, starts: NDArray, directions: NDArray) -> "Tensor":
        """Return rays as the library wants them, shape (p, 6)."""
        rays = np.empty((len(directions), 6), np.float32)
        rays[:, :3], rays[:, 3:] = starts, directions
        return self._tensor(rays)

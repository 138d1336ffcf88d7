"""Pictures of each object by itself, from where most of it can be seen.

Shapes: e eyes around the object, s points of it.
"""

from collections.abc import Sequence

import numpy as np
import trimesh
from numpy.typing import NDArray

from placing.clouds.raycaster import Raycaster
from placing.dressing import Meshes
from placing.pictures.cameras import Camera
from placing.pictures.renderer import Picture, render

Array = NDArray[np.float64]

SIZE = (360, 270)
"""Width and height [px]; ASSUME: 80 of them have 1 MB."""
AZIMUTHS_DEG = tuple(range(15, 375, 30))
ELEVATIONS_DEG = (35.0, 55.0, 18.0)
"""The first from which as much can be seen as from any other is taken."""
FOV_DEG = 36.0
MIN_WIDTH_M, WIDTHS = 0.9, 2.2
"""A picture is as wide as so many objects, and shows something around a small one."""
N_POINTS = 40
FEW = 0.1
"""Share of the points that does not count: an eye before another has that much more."""


def close_ups(room: Meshes, objects: Meshes) -> dict[str, Picture]:
    """Return a picture of each object, walls and all furniture drawn."""
    names, meshes = list(objects), [*objects.values(), *room.values()]
    seer = _Seer(meshes)
    pictures = {}
    for number, name in enumerate(names):
        camera = _camera(seer, number, objects[name])
        near = [mesh for mesh in meshes if _is_near(mesh, camera)]
        pictures[name] = render(near, camera, SIZE)
    return pictures


class _Seer:
    """All meshes, ready to be asked whether one of them can be seen."""

    def __init__(self, meshes: Sequence[trimesh.Trimesh]) -> None:
        """Give each mesh its number."""
        self._caster = Raycaster(meshes)
        self._first = np.cumsum([0, *(len(mesh.faces) for mesh in meshes)])

    def seen(self, number: int, eyes: Array, points: Array) -> Array:
        """Return the share of a mesh's points (s, 3) seen from each eye, (e,)."""
        ahead = points[None] - eyes[:, None]
        starts = np.broadcast_to(eyes[:, None], ahead.shape)
        hits = self._caster.cast(starts.reshape(-1, 3), ahead.reshape(-1, 3))
        first, end = self._first[number : number + 2]
        is_seen = hits.is_hit & (hits.face >= first) & (hits.face < end)
        return is_seen.reshape(len(eyes), -1).mean(axis=1)


def _camera(seer: _Seer, number: int, mesh: trimesh.Trimesh) -> Camera:
    """Return the camera before an object that sees most of it."""
    low, high = mesh.bounds
    target, extent = (low + high) / 2, high - low
    width_m = max(MIN_WIDTH_M, WIDTHS * float(np.linalg.norm(extent)))
    distance_m = width_m / 2 / np.tan(np.radians(FOV_DEG) / 2)
    angles = [(a, e) for e in ELEVATIONS_DEG for a in AZIMUTHS_DEG]
    a, e = np.radians(np.array(angles)).T
    away = np.column_stack([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
    eyes = target + distance_m * away
    centres = mesh.triangles_center
    points = centres[np.linspace(0, len(centres) - 1, N_POINTS).astype(int)]
    seen = seer.seen(number, eyes, points)
    best = int(np.flatnonzero(seen >= seen.max() - FEW)[0])
    return Camera(tuple(eyes[best]), tuple(target), FOV_DEG)


def _is_near(mesh: trimesh.Trimesh, camera: Camera) -> bool:
    """Return whether a mesh may be in the picture: no farther than two widths."""
    eye, target = np.asarray(camera.eye), np.asarray(camera.target)
    low, high = mesh.bounds
    gap = np.maximum(np.maximum(low - target, target - high), 0)
    return bool(np.linalg.norm(gap) < 2 * np.linalg.norm(eye - target))

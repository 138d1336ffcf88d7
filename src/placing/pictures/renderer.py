"""Head-less pictures of meshes: rays are cast on the CPU, no display is needed.

A surface is lit by the sky (more from above than from below), by one sun with sharp
shadows, and by a weak light at the camera; shadows on the ground reach past the meshes.
Pixels on outlines are the mean of four rays. The same input gives the same bytes.

Shapes: t triangles, p rays.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from PIL import Image

from placing.artifacts.atomic import replacing
from placing.pictures.cameras import Camera
from placing.pictures.shading import face_colours, joined, smooth_normals

Array = NDArray[np.float32]
Picture = NDArray[np.uint8]

OFFSET_M = 1e-3
"""Shadow rays start this far from the surface, to not hit it again."""
HIDING_M = 0.01
"""What is nearer to a point does not hide it: it is on the surface of a mesh."""
OUTLINE = 5.0
"""Pixels that differ from a neighbour by more, of 255, are sampled again."""
SUBPIXELS = ((-0.125, -0.375), (0.375, -0.125), (0.125, 0.375), (-0.375, 0.125))
"""Where the four rays of a pixel on an outline pass, from its centre."""


@dataclass(frozen=True)
class Light:
    """How a picture is lit."""

    sun: tuple[float, float, float] = (-0.35, -0.45, 0.82)
    """Direction to the sun as the camera sees it: right, forth, up."""
    background: tuple[int, int, int] = (246, 246, 244)
    ground_m: float | None = None
    """Height of the ground that catches shadows where nothing is hit; None for none."""
    sun_share: float = 0.40
    """Brightness that a surface loses in the shadow."""


INDOORS = Light(sun=(0.12, -0.38, 0.92), sun_share=0.24)
"""From a high sun behind the camera, so that far walls and floor are lit."""


def render(
    meshes: Sequence[trimesh.Trimesh],
    camera: Camera,
    size: tuple[int, int],
    light: Light = INDOORS,
) -> Picture:
    """Return a picture of the meshes, `size` is (width, height), shape (h, w, 3)."""
    surface = _Surface(meshes, light, camera)
    width, height = size
    centres = np.indices((height, width), np.float32)[::-1].reshape(2, -1).T + 0.5
    eye = np.asarray(camera.eye, np.float32)
    picture = surface.shade(eye, camera.rays(centres, size)).reshape(height, width, 3)

    again = np.flatnonzero(_outlines(picture))
    samples = (centres[again, None] + np.array(SUBPIXELS, np.float32)).reshape(-1, 2)
    finer = surface.shade(eye, camera.rays(samples, size)).reshape(-1, 4, 3)
    picture.reshape(-1, 3)[again] = finer.mean(axis=1)
    return (picture + 0.5).astype(np.uint8)


def hidden(
    meshes: Sequence[trimesh.Trimesh], points: NDArray[np.float64], eyes: NDArray
) -> NDArray[np.float64]:
    """Return the share of points on the meshes that each eye does not see, shape (e,).

    `points` is (r, 3), `eyes` is (e, 3).
    """
    import open3d as o3d  # here, because it takes a second that few stages need

    mesh = joined(meshes)
    tensor = o3d.core.Tensor.from_numpy
    caster = o3d.t.geometry.RaycastingScene()
    caster.add_triangles(
        tensor(np.array(mesh.vertices, np.float32)),
        tensor(np.array(mesh.faces, np.uint32)),
    )
    away = eyes[:, None] - points  # (e, r, 3)
    far = np.linalg.norm(away, axis=2, keepdims=True)
    rays = np.concatenate([points + HIDING_M * away / far, away / far], axis=2)
    occluded = caster.test_occlusions(tensor(rays.astype(np.float32)))
    return occluded.numpy().mean(axis=1)


def _outlines(picture: Array) -> NDArray[np.bool_]:
    """Return which pixels differ from a neighbour, shape (h, w)."""
    outline = np.zeros(picture.shape[:2], bool)
    for before, after in (
        (np.s_[:-1], np.s_[1:]),
        (np.s_[:, :-1], np.s_[:, 1:]),
        (np.s_[:-1, :-1], np.s_[1:, 1:]),
        (np.s_[:-1, 1:], np.s_[1:, :-1]),
    ):
        step = np.abs(picture[before] - picture[after])
        differs = np.maximum(np.maximum(step[..., 0], step[..., 1]), step[..., 2])
        outline[before] |= differs > OUTLINE
        outline[after] |= differs > OUTLINE
    return outline


def write_picture(picture: Picture, path: Path) -> None:
    """Write a picture as a PNG that is whole or absent."""
    with replacing(path) as part:
        Image.fromarray(picture).save(part)


class _Surface:
    """All triangles of a picture, ready to be hit by rays."""

    def __init__(
        self, meshes: Sequence[trimesh.Trimesh], light: Light, camera: Camera
    ) -> None:
        """Gather triangles, colours and smooth normals and build the ray caster."""
        import open3d as o3d  # here, because it takes a second that few stages need

        mesh = joined(meshes)
        self.light = light
        sun = camera.turn_to_world(np.asarray(light.sun))
        self.sun = (sun / np.linalg.norm(sun)).astype(np.float32)
        self.colours = face_colours(mesh)[:, :3].astype(np.float32)
        self.normals = smooth_normals(mesh).astype(np.float32)  # (t, 3, 3)
        self._tensor = o3d.core.Tensor.from_numpy
        self._caster = o3d.t.geometry.RaycastingScene()
        self._caster.add_triangles(
            self._tensor(np.array(mesh.vertices, np.float32)),
            self._tensor(np.array(mesh.faces, np.uint32)),
        )

    def shade(self, eye: Array, rays: Array) -> Array:
        """Return the colour that each ray from the eye sees, shape (p, 3)."""
        packed = np.column_stack([np.broadcast_to(eye, rays.shape), rays])
        answer = self._caster.cast_rays(self._tensor(packed))
        hit = {name: tensor.numpy() for name, tensor in answer.items()}
        colour = np.empty(rays.shape, np.float32)
        colour[:] = self.light.background

        is_hit = np.isfinite(hit["t_hit"])
        seen = np.flatnonzero(is_hit)
        colour[seen] = self._lit({k: v[seen] for k, v in hit.items()}, eye, rays[seen])
        if self.light.ground_m is not None:
            rest = np.flatnonzero(~is_hit & (rays[:, 2] < -1e-3))
            reach = (self.light.ground_m - eye[2]) / rays[rest, 2]
            shadow = self._in_shadow(eye + reach[:, None] * rays[rest])
            colour[rest] *= 1 - 0.17 * shadow[:, None]
        return colour

    def _lit(self, hit: dict[str, NDArray], eye: Array, rays: Array) -> Array:
        """Return the colour of the surfaces hit, shape (p, 3)."""
        face, uv = hit["primitive_ids"], hit["primitive_uvs"]
        flat = hit["primitive_normals"]
        away = -np.sign(np.einsum("ij,ij->i", flat, rays))[:, None]  # -1 seen inside
        weight = np.column_stack([1 - uv.sum(axis=1), uv])
        normal = away * np.einsum("ij,ijk->ik", weight, self.normals[face])
        normal /= np.sqrt(np.einsum("ij,ij->i", normal, normal))[:, None] + 1e-12

        cosine = np.maximum(normal @ self.sun, 0)
        cosine[(away * flat) @ self.sun <= 0] = 0
        lit = np.flatnonzero(cosine > 0)
        starts = eye + hit["t_hit"][lit, None] * rays[lit]
        starts += OFFSET_M * away[lit] * flat[lit]
        cosine[lit] *= 1 - self._in_shadow(starts)

        facing = np.abs(np.einsum("ij,ij->i", normal, rays))
        share = self.light.sun_share
        bright = 0.90 - share + 0.09 * normal[:, 2] + share * cosine + 0.08 * facing
        return np.minimum(self.colours[face] * bright[:, None], 255)

    def _in_shadow(self, points: Array) -> Array:
        """Return 1 where something is between a point and the sun, shape (p,)."""
        rays = np.column_stack([points, np.broadcast_to(self.sun, points.shape)])
        occluded = self._caster.test_occlusions(self._tensor(rays.astype(np.float32)))
        return occluded.numpy().astype(np.float32)

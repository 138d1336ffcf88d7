"""A scene as a depth camera sees it: noisy images with holes, fused to one cloud.

Somebody stands at a few places, looks around, and holds a structured-light camera. A
pixel has no depth where nothing is in range, where the projector does not reach, beside
an edge, or where too little light comes back: from what is dark, shiny, far or seen at
a small angle. What has one is noisy and quantised, the more so the farther it is, and
each image believes in a pose that is slightly wrong.

Letters for shapes: p pixels, f faces, n points.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import ndimage

from placing import rigid
from placing.clouds.fusing import Seen, cloud_of, fuse, fuse_to, joined, keep_surest
from placing.clouds.ply import Cloud
from placing.clouds.raycaster import Hits, Raycaster
from placing.errors import BadInput
from placing.pictures.shading import face_colours
from placing.scene import Layout
from placing.shapes.colours import DARK_STEEL, GLASS, STEEL
from placing.viewpoints import Standing, find_viewpoints

Array = NDArray[np.float64]

# ASSUME: what has the colour of metal or glass reflects like a mirror.
SHINY = (STEEL, DARK_STEEL, GLASS)
GAMMA = 2.2
"""Exponent from a colour to the share of light that comes back; SOURCE: sRGB."""


@dataclass(frozen=True)
class CameraConfig:
    """Settings of the depth camera; the values live in `config/config.yaml`."""

    eye_m: float
    """Height of the camera above the floor."""
    free_m: float
    """Nothing is nearer to whoever holds it."""
    spacing_m: float
    """Every free place is so near to a viewpoint."""
    max_viewpoints: int
    n_headings: int
    """Directions to look at from each viewpoint."""
    tilts_deg: tuple[float, ...]
    """How far down it looks in each of them."""
    size: tuple[int, int]
    """Pixels from left to right and from top to bottom."""
    fov_deg: float
    """Angle of view from the left to the right edge."""
    range_m: tuple[float, float]
    """Least and largest depth that it measures."""
    baseline_m: float
    """From the camera to the projector on its left."""
    noise_m: float
    """Standard deviation of the depth at `noise_from_m`."""
    noise_growth_per_m: float
    """What is added to it, times the square of the depth beyond `noise_from_m`."""
    noise_from_m: float
    step_per_m: float
    """Step of the inverse depth."""
    lateral_px: float
    """Standard deviation of where a pixel looks."""
    edge_step: float
    """Bend of the inverse depth from pixel to pixel, a share of it, that is an edge."""
    edge_loss: float
    """Share of the pixels beside an edge without depth."""
    min_signal_per_m2: float
    """Least light that gives a depth: reflected share, times cosine, by depth²."""
    signal_spread: float
    """Standard deviation of the logarithm of that light."""
    shiny_share: float
    """Share of the light that a shiny face scatters; the rest leaves as in a mirror."""
    max_incidence_deg: float
    """Largest angle between the ray and the normal of what it hits."""
    pose_error_m: float
    """Standard deviation of the believed place of an image, on each axis."""
    pose_error_deg: float
    """Standard deviation of its believed rotation, about each axis."""
    voxel_m: float
    """Edge of the voxels in which points are averaged, larger if those are too many."""
    surest_cell_m: float
    """Edge of the cells in which the points before and behind a point are looked up."""
    surest_reach_m: float
    """How far before and behind a point surer ones replace it."""
    surest_share: float
    """Least inverse variance of a point that is kept, as a share of the surest's."""
    n_points: int
    """Most points of the fused cloud."""
    normal_neighbors: int
    """Neighbours that a plane is fitted to."""


@dataclass(frozen=True)
class View:
    """A pose of the camera."""

    eye: Array
    """(3,) [m]."""
    axes: Array
    """(3, 3) directions right, down and ahead in the world."""


class Surfaces:
    """What the camera can see: faces, the light they scatter, and how soft they are."""

    def __init__(
        self,
        meshes: Sequence[trimesh.Trimesh],
        softness: Sequence[float],
        shiny_share: float,
    ) -> None:
        """Gather faces, colours and softness, one value of it for each mesh."""
        self.caster = Raycaster(meshes)
        colors = [face_colours(mesh)[:, :3] for mesh in meshes]
        self.colors = np.concatenate(colors).astype(np.uint8)  # (f, 3)
        counts = [len(mesh.faces) for mesh in meshes]
        self.softness = np.repeat(np.asarray(softness, np.float32), counts)
        self.scattered = self._scattered(shiny_share)

    def _scattered(self, shiny_share: float) -> Array:
        """Return the share of light that each face scatters, shape (f,)."""
        luma = self.colors @ np.array([0.2126, 0.7152, 0.0722])  # SOURCE: BT.709.
        is_shiny = np.zeros(len(luma), bool)
        for color in SHINY:
            is_shiny |= (self.colors == color).all(axis=1)
        return (luma / 255) ** GAMMA * np.where(is_shiny, shiny_share, 1.0)


def scan_depth(
    rng: Generator,
    layout: Layout,
    meshes: Sequence[trimesh.Trimesh],
    softness: Sequence[float],
    config: CameraConfig,
) -> Cloud:
    """Return what a depth camera sees of the meshes of a layout, fused.

    `softness` is that of each mesh. Normals are fitted to the fused points and face
    the places from which they were seen.
    """
    surfaces = Surfaces(meshes, softness, config.shiny_share)
    standing = Standing(
        config.eye_m, config.free_m, config.spacing_m, config.max_viewpoints
    )
    seen = []
    for eye in find_viewpoints(layout, surfaces.caster, standing):
        around = [look(rng, surfaces, view, config) for view in views_at(eye, config)]
        seen.append(fuse(joined(around), config.voxel_m))
    every = joined(seen)
    if len(every.points) < config.normal_neighbors:
        raise BadInput(
            f"scene {layout.scene}: field points is {len(every.points)} in all depth"
            f" images, expected at least {config.normal_neighbors}"
        )
    sure = keep_surest(
        every, config.surest_cell_m, config.surest_reach_m, config.surest_share
    )
    fused = fuse_to(sure, config.voxel_m, config.n_points)
    return cloud_of(fused, config.normal_neighbors)


def views_at(eye: Array, config: CameraConfig) -> list[View]:
    """Return the views from a viewpoint, all around at each tilt."""
    views = []
    for tilt in np.radians(config.tilts_deg):
        for heading in 2 * np.pi * np.arange(config.n_headings) / config.n_headings:
            forth = np.array([np.cos(heading), np.sin(heading), 0.0])
            ahead = np.cos(tilt) * forth - np.sin(tilt) * np.array([0, 0, 1.0])
            right = np.array([np.sin(heading), -np.cos(heading), 0.0])
            views.append(View(eye, np.stack([right, np.cross(ahead, right), ahead])))
    return views


def look(rng: Generator, surfaces: Surfaces, view: View, config: CameraConfig) -> Seen:
    """Return the points of one depth image where the camera believes they are."""
    depth, face = depth_image(rng, surfaces, view, config)
    pixels = np.flatnonzero(depth)
    depth, face = depth.ravel()[pixels], face.ravel()[pixels]
    believed = _believed(rng, view, config)
    rays = rays_of(config).reshape(-1, 3)[pixels] @ believed.axes
    weight = 1 / noise_m(depth, config) ** 2
    back = -rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return Seen(
        points=believed.eye + depth[:, None] * rays,
        back=back,
        colors=surfaces.colors[face].astype(float),
        softness=surfaces.softness[face].astype(float),
        weight=weight,
        surest=weight,
    )


def depth_image(
    rng: Generator, surfaces: Surfaces, view: View, config: CameraConfig
) -> tuple[Array, NDArray[np.int64]]:
    """Return measured depth, 0 where there is none, and face of each pixel, (h, w)."""
    width, height = config.size
    jitter = config.lateral_px * rng.standard_normal((height, width, 2))
    rays = rays_of(config, jitter).reshape(-1, 3) @ view.axes
    hits = surfaces.caster.cast(view.eye, rays)
    is_lost = ~hits.is_hit | _is_dim(rng, surfaces, rays, hits, config)
    depth = np.where(hits.is_hit, hits.t, np.inf).astype(float)
    is_lost |= _is_beside_edge(rng, depth.reshape(height, width), config).ravel()
    lit = np.flatnonzero(~is_lost)
    projector = view.eye - config.baseline_m * view.axes[0]
    reached = view.eye + depth[lit, None] * rays[lit]
    is_lost[lit] = surfaces.caster.is_between(reached, projector)
    near, far = config.range_m
    measured = measure(rng, np.where(is_lost, far, depth), config)
    is_lost |= (measured < near) | (measured > far) | (depth > far)
    measured[is_lost] = 0.0
    return measured.reshape(height, width), hits.face.reshape(height, width)


def measure(rng: Generator, depth: Array, config: CameraConfig) -> Array:
    """Return depths with noise, then rounded to steps of the disparity [m]."""
    noisy = depth + noise_m(depth, config) * rng.standard_normal(depth.shape)
    steps = np.round(1 / (np.maximum(noisy, 0.01) * config.step_per_m))
    return 1 / (np.maximum(steps, 1) * config.step_per_m)


def noise_m(depth: Array, config: CameraConfig) -> Array:
    """Return the standard deviation of the noise at a depth, same shape [m]."""
    beyond = np.maximum(depth - config.noise_from_m, 0.0)
    return config.noise_m + config.noise_growth_per_m * beyond**2


def rays_of(config: CameraConfig, jitter: Array | float = 0.0) -> Array:
    """Return the rays of the pixels (right, down, ahead = 1), shape (h, w, 3)."""
    width, height = config.size
    focal_px = width / 2 / np.tan(np.radians(config.fov_deg) / 2)
    pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1) + 0.5
    slopes = (pixels + jitter - np.array(config.size) / 2) / focal_px
    return np.insert(slopes, 2, 1.0, axis=2)


def _is_dim(
    rng: Generator, surfaces: Surfaces, rays: Array, hits: Hits, config: CameraConfig
) -> NDArray[np.bool_]:
    """Tell from where too little light comes back, shape (p,)."""
    along = np.einsum("pk,pk->p", rays, hits.normal)
    cosine = np.abs(along) / np.linalg.norm(rays, axis=1)
    spread = np.exp(config.signal_spread * rng.standard_normal(len(rays)))
    share = surfaces.scattered[hits.face]
    depth = np.where(hits.is_hit, hits.t, np.inf)
    is_dark = share * cosine * spread < config.min_signal_per_m2 * depth**2
    return is_dark | (cosine < np.cos(np.radians(config.max_incidence_deg)))


def _is_beside_edge(
    rng: Generator, depth: Array, config: CameraConfig
) -> NDArray[np.bool_]:
    """Tell which pixels beside a jump of the depth are lost, shape (h, w)."""
    # The inverse depth of a plane is linear in the pixels: no edge, however steep.
    inverse = 1 / depth
    is_edge = np.abs(ndimage.laplace(inverse)) > config.edge_step * inverse
    return is_edge & (rng.random(depth.shape) < config.edge_loss)


def _believed(rng: Generator, view: View, config: CameraConfig) -> View:
    """Return the pose that an image is taken for."""
    turn = np.radians(config.pose_error_deg) * rng.standard_normal(3)
    quaternion = np.array([1.0, *(turn / 2)])  # Of a small angle.
    R = rigid.matrix(quaternion / np.linalg.norm(quaternion))
    shift = config.pose_error_m * rng.standard_normal(3)
    return View(view.eye + shift, view.axes @ R.T)

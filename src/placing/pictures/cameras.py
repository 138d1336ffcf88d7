"""Cameras for pictures: where they stand, and how they frame what they look at."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera that stands at `eye`, looks at `target` and has z up."""

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    fov_deg: float = 30.0
    """Angle of view from the left to the right edge."""

    def axes(self) -> Array:
        """Return the directions right, down and ahead in the world, shape (3, 3)."""
        ahead = np.subtract(self.target, self.eye)
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(ahead, right), ahead])

    def rays(
        self, pixels: NDArray[np.float32], size: tuple[int, int]
    ) -> NDArray[np.float32]:
        """Return the unit ray from the eye through points of the picture, (n, 3)."""
        right, down, ahead = self.axes().astype(np.float32)
        u, v = (
            (pixels - np.array(size, np.float32) / 2) / np.float32(self._focal(size))
        ).T
        rays = ahead + u[:, None] * right + v[:, None] * down
        return rays / np.sqrt(1 + u**2 + v**2)[:, None]

    def project(self, points: Array, size: tuple[int, int]) -> Array:
        """Return the pixel (u, v) of points in the world, shape (n, 2)."""
        seen = (np.asarray(points, float) - self.eye) @ self.axes().T
        return seen[:, :2] / seen[:, 2:] * self._focal(size) + np.array(size) / 2

    def _focal(self, size: tuple[int, int]) -> float:
        """Return the focal length in pixels."""
        return size[0] / 2 / np.tan(np.radians(self.fov_deg) / 2)

    def turn_to_world(self, direction: Array) -> Array:
        """Return a direction (right, forth, up) of the camera's heading, shape (3,)."""
        right = self.axes()[0]
        forth = np.cross([0.0, 0.0, 1.0], right)
        return direction[0] * right + direction[1] * forth + [0, 0, direction[2]]


def framing(
    corners: Array,
    azimuth_deg: float,
    elevation_deg: float,
    size: tuple[int, int],
    fov_deg: float = 30.0,
    margin: float = 0.06,
) -> Camera:
    """Return the camera that just sees all corners from an azimuth and elevation.

    The azimuth is the heading from the target to the camera, from world +x.
    """
    a, e = np.radians([azimuth_deg, elevation_deg])
    back = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
    corners = np.asarray(corners, float)
    target = (corners.min(axis=0) + corners.max(axis=0)) / 2
    tangent = np.tan(np.radians(fov_deg) / 2) * (1 - 2 * margin)
    slopes = tangent * np.array([1.0, size[1] / size[0]])

    axes = Camera(tuple(target + back), tuple(target)).axes()
    seen = (corners - target) @ axes.T
    offset, ahead = seen[:, :2], seen[:, 2:]
    right_of = (offset - slopes * ahead).max(axis=0)  # needed beyond the high side
    left_of = (-offset - slopes * ahead).max(axis=0)  # and beyond the low side
    centre = (right_of - left_of) / 2
    distance = np.max((right_of + left_of) / 2 / slopes)
    middle = target + centre @ axes[:2]
    return Camera(tuple(middle + distance * back), tuple(middle), fov_deg)


def corners_of(low: Array, high: Array) -> Array:
    """Return the eight corners of a box in the world, shape (8, 3)."""
    x, y, z = np.stack([low, high]).T
    return np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)

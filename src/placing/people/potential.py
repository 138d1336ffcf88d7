"""The potential of a human pose and an object, in logs (eq. 2 of the paper).

    Psi_human = Psi_loc Psi_ori,   Psi_loc = Psi_dist Psi_rel Psi_height

The distance d of the object on the floor plane is log-normal, its bearing r in the
person's frame (0 = straight ahead) von Mises, its height h above the reference point
of the pose normal, and the heading o of the object relative to the person von Mises.
SOURCE: the three factors of Psi_loc and their families are those restated by Jiang,
Koppula and Saxena, "Hallucinated humans as the hidden context for labeling 3D scenes",
CVPR 2013.

Shapes: n objects, q human poses.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.special import i0e

Array = NDArray[np.float64]

MIN_DISTANCE_M = 0.05
"""Below one grid cell the planar density of a log-normal distance has no meaning."""


@dataclass(frozen=True)
class Theta:
    """Parameters of the potential for one category."""

    log_distance_mean: float
    log_distance_sigma: float
    bearing_mean_rad: float
    bearing_kappa: float
    height_mean_m: float
    height_sigma_m: float
    orientation_mean_rad: float
    orientation_kappa: float

    def vector(self) -> Array:
        """Return the parameters in the order of the fields, shape (8,)."""
        return np.array(list(vars(self).values()))


def log_psi_human(
    theta: Theta, objects: Array, has_front: NDArray[np.bool_], poses: Array
) -> NDArray[np.float32]:
    """Return log Psi_human of each object with each pose, shape (n, q).

    `objects` (n, 4) = x, y, z, yaw in the world; `poses` (q, 5) = x, y, z of the
    reference point, cosine and sine of the yaw. An object without a front leaves out
    Psi_ori.
    """
    logs = np.empty((len(objects), len(poses)), np.float32)
    constants = log_constants(theta)
    _fill(logs, objects, has_front, poses, theta.vector(), *constants)
    return logs


def log_factors(theta: Theta, location: Array, reference: Array) -> Array:
    """Return the logs of Psi_dist, Psi_rel and Psi_height, shape (3,).

    `location` (3,) of an object; `reference` (5,) of a pose, as in `log_psi_human`. The
    sum is log Psi_loc: Psi_dist is the density of the distance over the distance.
    """
    dx, dy, height = location - reference[:3]
    d = max(np.hypot(dx, dy), MIN_DISTANCE_M)
    u = (np.log(d) - theta.log_distance_mean) / theta.log_distance_sigma
    scale = theta.log_distance_sigma * np.sqrt(2 * np.pi)
    distance = -0.5 * u * u - np.log(scale) - 2 * np.log(d)
    cos, sin = np.cos(theta.bearing_mean_rad), np.sin(theta.bearing_mean_rad)
    ahead = (dx * cos + dy * sin) * reference[3] + (dy * cos - dx * sin) * reference[4]
    bearing = theta.bearing_kappa * ahead / d
    bearing += _log_von_mises_constant(theta.bearing_kappa)
    v = (height - theta.height_mean_m) / theta.height_sigma_m
    scale = theta.height_sigma_m * np.sqrt(2 * np.pi)
    return np.array([distance, bearing, -0.5 * v * v - np.log(scale)])


def log_psi_ori(theta: Theta, yaw: Array, pose_yaw: Array) -> Array:
    """Return log Psi_ori, the density of the heading relative to the person [1/rad]."""
    relative = yaw - pose_yaw - theta.orientation_mean_rad
    return theta.orientation_kappa * np.cos(relative) + log_constants(theta)[1]


def log_constants(theta: Theta) -> tuple[float, float]:
    """Return the log normalisers of Psi_loc and Psi_ori."""
    location = -np.log(theta.log_distance_sigma * theta.height_sigma_m * 2 * np.pi)
    location += _log_von_mises_constant(theta.bearing_kappa)
    return float(location), _log_von_mises_constant(theta.orientation_kappa)


def _log_von_mises_constant(kappa: float) -> float:
    """Return -log(2 pi I0(kappa)), which does not overflow for large kappa."""
    return float(-np.log(2 * np.pi * i0e(kappa)) - kappa)


@njit(cache=True)
def _fill(logs, objects, has_front, poses, theta, log_loc, log_ori):  # noqa: ANN001, ANN202
    """Fill `logs` (n, q).

    Cosines of differences are products of unit vectors: no angle is computed per pair.
    """
    m_d, s_d, m_r, k_r, m_h, s_h, m_o, k_o = theta
    cos_r, sin_r = np.cos(m_r), np.sin(m_r)
    for i in range(objects.shape[0]):
        front_x, front_y = np.cos(objects[i, 3] - m_o), np.sin(objects[i, 3] - m_o)
        for k in range(poses.shape[0]):
            dx, dy = objects[i, 0] - poses[k, 0], objects[i, 1] - poses[k, 1]
            d = max(np.sqrt(dx * dx + dy * dy), MIN_DISTANCE_M)
            log_d = np.log(d)
            u = (log_d - m_d) / s_d
            v = (objects[i, 2] - poses[k, 2] - m_h) / s_h
            # The density of a location on the plane is f(d) / d g(r), and the
            # log-normal f(d) brings another 1 / d.
            log_psi = log_loc - 2 * log_d - 0.5 * (u * u + v * v)
            ahead_x = poses[k, 3] * cos_r - poses[k, 4] * sin_r
            ahead_y = poses[k, 3] * sin_r + poses[k, 4] * cos_r
            log_psi += k_r * (dx * ahead_x + dy * ahead_y) / d
            if has_front[i]:
                faced = poses[k, 3] * front_x + poses[k, 4] * front_y
                log_psi += log_ori + k_o * faced
            logs[i, k] = log_psi


@lru_cache(maxsize=128)
def planar_table(
    theta: Theta, spacing_m: float, radius_m: float, n_headings: int
) -> NDArray[np.float32]:
    """Return the planar part of Psi_loc on a lattice, shape (n_headings, w, w).

    Entry [a, i, j] belongs to a pose that looks along heading a and a displacement of
    ((i, j) - (w - 1) / 2) * spacing; displacements beyond `radius_m` have none. The
    table is kept, as all scenes of a fold ask for the same ones: do not write to it.
    """
    half = round(radius_m / spacing_m)
    steps = np.arange(-half, half + 1) * spacing_m
    dx, dy = np.meshgrid(steps, steps, indexing="ij")
    d = np.maximum(np.hypot(dx, dy), MIN_DISTANCE_M)
    u = (np.log(d) - theta.log_distance_mean) / theta.log_distance_sigma
    radial = np.exp(-0.5 * u * u) / (d * d)  # (w, w)
    yaw = np.arange(n_headings) * (2 * np.pi / n_headings) + theta.bearing_mean_rad
    ahead = np.stack([np.cos(yaw), np.sin(yaw)])[:, :, None, None]  # (2, a, 1, 1)
    cosine = np.minimum((ahead[0] * dx + ahead[1] * dy) / d, 1.0)  # (a, w, w)
    table = radial * np.exp(theta.bearing_kappa * (cosine - 1))
    table *= i0e(theta.bearing_kappa) ** -1 / (2 * np.pi)
    table *= 1 / (np.sqrt(2 * np.pi) * theta.log_distance_sigma)
    is_within = np.hypot(dx, dy) <= radius_m + 1e-9  # the lattice meets the radius
    return np.where(is_within, table, 0).astype(np.float32)


def height_factor(theta: Theta, z: Array, reference_z: Array) -> Array:
    """Return Psi_height of objects at `z` (n,) for references (q,), shape (n, q)."""
    v = z[:, None] - reference_z[None, :] - theta.height_mean_m
    scale = np.sqrt(2 * np.pi) * theta.height_sigma_m
    return np.exp(-0.5 * (v / theta.height_sigma_m) ** 2) / scale

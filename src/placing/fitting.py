"""Theta in closed form from pairs of an object and the pose that uses it (eq. 4).

Each factor of the potential is an exponential family, so its maximum likelihood is a
matter of means. A few draws of one broad Theta stand in for the objects that a small
data set lacks, and bounds keep a handful of objects from making a factor infinitely
sharp.

Shapes: n pairs.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.special import i0e, i1e

from placing.potential import MIN_DISTANCE_M, Theta

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FittingConfig:
    """Settings of the fit; the values live in `config/config.yaml`."""

    prior_strength: float
    """How many objects the broad Theta counts for in every category."""
    max_kappa: float
    min_log_distance_sigma: float
    min_height_sigma_m: float


# ASSUME: objects are used within arm's reach and in front, below the shoulder, with
# their front towards their user; broad enough for all categories.
BROAD = Theta(np.log(0.7), 0.7, 0.0, 1.0, -0.3, 0.5, np.pi, 0.3)


def fit(pairs: pd.DataFrame, config: FittingConfig) -> Theta:
    """Return the Theta of one category from pairs of object and pose.

    Columns: `log_distance`, `bearing`, `height`, `orientation`, `has_front`, `weight`.
    """
    w = pairs["weight"].to_numpy()
    w_front = w * pairs["has_front"].to_numpy()
    n0 = config.prior_strength
    mean_d, sigma_d = _fit_normal(pairs["log_distance"], w, BROAD.vector()[:2], n0)
    mean_h, sigma_h = _fit_normal(pairs["height"], w, BROAD.vector()[4:6], n0)
    mean_r, kappa_r = _fit_von_mises(pairs["bearing"], w, BROAD.vector()[2:4], n0)
    mean_o, kappa_o = _fit_von_mises(
        pairs["orientation"], w_front, BROAD.vector()[6:8], n0
    )
    return Theta(
        mean_d,
        max(sigma_d, config.min_log_distance_sigma),
        mean_r,
        min(kappa_r, config.max_kappa),
        mean_h,
        max(sigma_h, config.min_height_sigma_m),
        mean_o,
        min(kappa_o, config.max_kappa),
    )


def relative(objects: Array, references: Array) -> tuple[Array, Array, Array, Array]:
    """Return log distance, bearing, height and orientation of pairs, (n,) each.

    `objects` (n, 4) x, y, z, yaw; `references` (n, 5) as of `HumanPoses.references`.
    """
    dx, dy = (objects[:, :2] - references[:, :2]).T
    log_distance = np.log(np.maximum(np.hypot(dx, dy), MIN_DISTANCE_M))
    yaw = np.arctan2(references[:, 4], references[:, 3])
    bearing = np.arctan2(dy, dx) - yaw
    height = objects[:, 2] - references[:, 2]
    return log_distance, bearing, height, objects[:, 3] - yaw


def _fit_normal(
    values: pd.Series, w: Array, broad: Array, n0: float
) -> tuple[float, float]:
    """Return mean and sigma of weighted values and `n0` draws of the broad normal."""
    x, total = values.to_numpy(), w.sum() + n0
    mean = (w @ x + n0 * broad[0]) / total
    variance = w @ (x - mean) ** 2 + n0 * (broad[1] ** 2 + (broad[0] - mean) ** 2)
    return float(mean), float(np.sqrt(variance / total))


def _fit_von_mises(
    angles: pd.Series, w: Array, broad: Array, n0: float
) -> tuple[float, float]:
    """Return mean and kappa of weighted angles and `n0` draws of the broad law.

    SOURCE: kappa from the mean resultant length as in Best and Fisher (1981),
    "The bias of the maximum likelihood estimators of the von Mises-Fisher
    concentration parameters".
    """
    broad_length = i1e(broad[1]) / i0e(broad[1])
    resultant = w @ np.exp(1j * angles.to_numpy())
    resultant += n0 * broad_length * np.exp(1j * broad[0])
    resultant /= w.sum() + n0
    r = min(abs(resultant), 0.999)
    if r < 0.53:
        kappa = 2 * r + r**3 + 5 * r**5 / 6
    elif r < 0.85:
        kappa = -0.4 + 1.39 * r + 0.43 / (1 - r)
    else:
        kappa = 1 / (r**3 - 4 * r**2 + 3 * r)
    return float(np.angle(resultant)), float(kappa)

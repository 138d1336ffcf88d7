"""Theta in closed form from pairs of an object and the pose that uses it (eq. 4).

Each factor of the potential is an exponential family, so its maximum likelihood is a
matter of sums. A few draws of one broad Theta stand in for the objects that a small
data set lacks, and bounds keep a handful of objects from making a factor infinitely
sharp.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import i0e, i1e

from placing.people.potential import Theta

Array = NDArray[np.float64]

STATISTICS = (
    *("count", "log_distance", "log_distance_squared", "bearing_cos", "bearing_sin"),
    *("height", "height_squared", "front_count", "orientation_cos", "orientation_sin"),
)
"""Sums over pairs; the orientation counts for objects with a front alone."""


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


def fit(sums: Array, config: FittingConfig) -> Theta:
    """Return the likeliest Theta of one category from the sums of `STATISTICS`, (10,).

    Where a bound holds, it is the likeliest Theta within the bounds.
    """
    s = sums + config.prior_strength * expected_statistics(BROAD)
    mean_d, sigma_d = _fit_normal(s[0], s[1], s[2])
    mean_h, sigma_h = _fit_normal(s[0], s[5], s[6])
    mean_r, kappa_r = _fit_von_mises(s[0], s[3], s[4])
    mean_o, kappa_o = _fit_von_mises(s[7], s[8], s[9])
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


def expected_statistics(theta: Theta) -> Array:
    """Return the expected statistics of one pair drawn from Theta, shape (10,)."""
    m_d, s_d, m_r, k_r, m_h, s_h, m_o, k_o = theta.vector()
    r, o = i1e(k_r) / i0e(k_r), i1e(k_o) / i0e(k_o)
    distance = [1, m_d, m_d**2 + s_d**2, r * np.cos(m_r), r * np.sin(m_r)]
    height = [m_h, m_h**2 + s_h**2, 1, o * np.cos(m_o), o * np.sin(m_o)]
    return np.array([*distance, *height])


def _fit_normal(count: float, total: float, squares: float) -> tuple[float, float]:
    """Return mean and sigma from the sums of values and of their squares."""
    mean = total / count
    return float(mean), float(np.sqrt(max(squares / count - mean**2, 0.0)))


def _fit_von_mises(count: float, cos: float, sin: float) -> tuple[float, float]:
    """Return mean and kappa from the sums of the cosines and sines of angles."""
    length = min(np.hypot(cos, sin) / count, 0.999)
    return float(np.arctan2(sin, cos)), _kappa_of(length)


def _kappa_of(length: float) -> float:
    """Return kappa from the mean resultant length of angles.

    SOURCE: the start is that of Best and Fisher (1981), "The bias of the maximum
    likelihood estimators of the von Mises-Fisher concentration parameters",
    Communications in Statistics - Simulation and Computation 10(5), 493-502; three
    steps of Newton on I1(kappa) / I0(kappa) = length make it exact.
    """
    r = length
    if r < 0.53:
        kappa = 2 * r + r**3 + 5 * r**5 / 6
    elif r < 0.85:
        kappa = -0.4 + 1.39 * r + 0.43 / (1 - r)
    else:
        kappa = 1 / (r**3 - 4 * r**2 + 3 * r)
    for _ in range(3 if kappa > 0 else 0):
        ratio = i1e(kappa) / i0e(kappa)
        kappa -= (ratio - r) / (1 - ratio**2 - ratio / kappa)
    return float(kappa)

"""Theta by maximum likelihood on sampled human poses (eq. 4 of the paper).

    Theta* = argmax sum_scenes sum_j sum_i log Psi_human(O_i, H_i^j; Theta)

with H_i^j the pose that object i picked in sample j. Poses are sampled under the
current Theta, then each factor is fitted in closed form, and so on; the first round
samples under one broad Theta for all categories.

DIFFERS: eq. 4 as printed sums j to n and has no sum over samples.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.special import i0e, i1e

from placing import dpmm
from placing.potential import Theta, log_psi_human

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LearningConfig:
    """Settings of the learning; the values live in `config/config.yaml`."""

    n_iterations: int
    """Rounds of sampling poses and fitting Theta."""
    n_burn_in: int
    n_samples: int
    """Sweeps dropped and kept per scene and round."""
    prior_strength: float
    """How many objects the broad Theta counts for in every category."""
    max_kappa: float
    min_log_distance_sigma: float
    min_height_sigma_m: float


@dataclass(frozen=True)
class Example:
    """One labelled arrangement of a training scene and the valid poses around it."""

    scene: str
    categories: tuple[str, ...]
    """(n,) category of each object."""
    objects: Array
    """(n, 4) x, y, z, yaw of each object."""
    has_front: NDArray[np.bool_]
    references: Array
    """(q, 4) x, y, z of the reference point and yaw of each valid pose."""
    prior: Array
    """(q,) P0."""


# ASSUME: objects are used within arm's reach and in front, below the shoulder, with
# their front towards their user; broad enough for all categories.
BROAD = Theta(np.log(0.7), 0.7, 0.0, 1.0, -0.3, 0.5, np.pi, 0.3)


def learn_theta(
    rng: Generator,
    examples: Sequence[Sequence[Example]],
    sampling: dpmm.DpmmConfig,
    config: LearningConfig,
) -> tuple[dict[str, Theta], pd.DataFrame]:
    """Return Theta per category and the trace of the learning.

    `examples` holds the labelled arrangements of each training scene; every round
    looks at one arrangement of each scene, in turn.
    """
    chain_config = dpmm.DpmmConfig(
        sampling.concentration,
        sampling.n_auxiliary,
        config.n_burn_in,
        config.n_samples,
    )
    names = sorted({c for scene in examples for e in scene for c in e.categories})
    thetas, trace = dict.fromkeys(names, BROAD), []
    for iteration in range(config.n_iterations):
        round_examples = [scene[iteration % len(scene)] for scene in examples]
        sampled = [_sample_pairs(rng, e, thetas, chain_config) for e in round_examples]
        pairs = pd.concat([table for table, _ in sampled], ignore_index=True)
        log_likelihood = float(np.mean([value for _, value in sampled]))
        by_category = dict(list(pairs.groupby("category")))
        for name in by_category:
            thetas[name] = fit(by_category[name], config)
        trace += _trace_rows(iteration, thetas, log_likelihood)
    return thetas, pd.DataFrame(trace)


def fit(pairs: pd.DataFrame, config: LearningConfig) -> Theta:
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
    """Return log distance, bearing, height and orientation of pairs, (n,) each."""
    dx, dy = (objects[:, :2] - references[:, :2]).T
    log_distance = np.log(np.maximum(np.hypot(dx, dy), 0.05))
    bearing = np.arctan2(dy, dx) - references[:, 3]
    height = objects[:, 2] - references[:, 2]
    return log_distance, bearing, height, objects[:, 3] - references[:, 3]


def log_rows(example: Example, thetas: dict[str, Theta]) -> NDArray[np.float32]:
    """Return log Psi_human of each object with each valid pose, shape (n, q)."""
    rows = np.empty((len(example.objects), len(example.references)), np.float32)
    for i, name in enumerate(example.categories):
        rows[i] = log_psi_human(
            thetas[name],
            example.objects[i : i + 1],
            example.has_front[i : i + 1],
            example.references,
        )[0]
    return rows


def _sample_pairs(
    rng: Generator,
    example: Example,
    thetas: dict[str, Theta],
    config: dpmm.DpmmConfig,
) -> tuple[pd.DataFrame, float]:
    """Return sampled pairs of object and pose, and the mean log joint."""
    rows = dpmm.weight_rows(log_rows(example, thetas))
    chain = dpmm.sample(rng, rows, example.prior, config)
    n_samples, n_objects = chain.pose.shape
    i = np.tile(np.arange(n_objects), n_samples)
    objects, references = example.objects[i], example.references[chain.pose.ravel()]
    columns = ("log_distance", "bearing", "height", "orientation")
    values = relative(objects, references)
    pairs = pd.DataFrame(dict(zip(columns, values, strict=True)))
    pairs["category"] = np.array(example.categories)[i]
    pairs["has_front"] = example.has_front[i]
    pairs["weight"] = 1.0 / n_samples
    return pairs, float(chain.log_joint.mean())


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


def _trace_rows(
    iteration: int, thetas: dict[str, Theta], log_likelihood: float
) -> list[dict[str, object]]:
    """Return the trace of one round, one row per category and parameter."""
    return [
        {
            "iteration": iteration,
            "category": name,
            "parameter": field.name,
            "value": getattr(theta, field.name),
            "log_likelihood": log_likelihood,
        }
        for name, theta in sorted(thetas.items())
        for field in fields(Theta)
    ]

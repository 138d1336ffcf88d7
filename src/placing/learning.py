"""Theta by maximum likelihood on sampled human poses (eq. 4 of the paper).

    Theta* = argmax sum_scenes sum_j sum_i log Psi_human(O_i, H_i^j; Theta)

with H_i^j the pose that object i picked in sample j. Poses are sampled under the
current Theta, then each factor is fitted in closed form, and so on; the first round
samples under one broad Theta for all categories.

DIFFERS: eq. 4 as printed sums j to n and has no sum over samples.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing import dpmm
from placing.fitting import BROAD, FittingConfig, fit, relative
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
    """(q, 5) as `HumanPoses.references` returns."""
    prior: Array
    """(q,) P0."""


def learn_theta(
    rng: Generator,
    examples: Sequence[Sequence[Example]],
    sampling: dpmm.DpmmConfig,
    config: LearningConfig,
    fitting: FittingConfig,
) -> tuple[dict[str, Theta], pd.DataFrame]:
    """Return Theta per category and the trace of the learning.

    `examples` holds the labelled arrangements of each training scene; every round
    looks at one arrangement of each scene, in turn.
    """
    chain_config = replace(
        sampling,
        n_chains=1,
        n_burn_in=config.n_burn_in,
        n_samples=config.n_samples,
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
            thetas[name] = fit(by_category[name], fitting)
        trace += _trace_rows(iteration, thetas, log_likelihood)
    return thetas, pd.DataFrame(trace)


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
    _, n_samples, n_objects = chain.pose.shape
    i = np.tile(np.arange(n_objects), n_samples)
    objects, references = example.objects[i], example.references[chain.pose.ravel()]
    columns = ("log_distance", "bearing", "height", "orientation")
    values = relative(objects, references)
    pairs = pd.DataFrame(dict(zip(columns, values, strict=True)))
    pairs["category"] = np.array(example.categories)[i]
    pairs["has_front"] = example.has_front[i]
    pairs["weight"] = 1.0 / n_samples
    return pairs, float(chain.log_joint.mean())


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

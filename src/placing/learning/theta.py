"""Theta by maximum likelihood on sampled human poses (eq. 4 of the paper).

    Theta* = argmax sum_scenes sum_j sum_i log Psi_human(O_i, H_i^j; Theta)

with H_i^j the pose that object i picked in sample j. Poses are sampled under the
current Theta, then each factor is fitted in closed form, and so on; the first round
samples under one broad Theta for all categories. The likelihood is nearly flat along
the distance, as a pose may slide along the bearing, so that rounds from different
starts end at different distances: several runs are compared.

DIFFERS: eq. 4 as printed sums j to n and has no sum over samples.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing.learning.fitting import BROAD, STATISTICS, FittingConfig, fit
from placing.people import dpmm
from placing.people.offsets import (
    Offsets,
    Spots,
    find_offsets,
    parameters_of,
    sufficient_statistics,
    weight_rows,
)
from placing.people.potential import Theta

Array = NDArray[np.float64]

# ASSUME: starts differ by half of what the broad Theta allows.
JITTER = 0.3
"""Spread of the starts, in log distance, bearing [rad] and height [m]."""


@dataclass(frozen=True)
class LearningConfig:
    """Settings of the learning; the values live in `config/config.yaml`."""

    n_iterations: int
    """Rounds of sampling poses and fitting Theta."""
    n_burn_in: int
    n_samples: int
    """Sweeps dropped and kept per scene and round."""
    scenes_per_round: int
    """Most scenes that a round looks at; of more it takes every second, third …"""
    n_restarts: int
    """Runs from different starts, of which the likeliest is kept."""


@dataclass(frozen=True)
class Example:
    """One labelled arrangement of a training scene and the valid poses around it."""

    scene: str
    categories: tuple[str, ...]
    """(n,) category of each object."""
    objects: Array
    """(n, 4) x, y, z, yaw of each object."""
    has_front: NDArray[np.bool_]
    spots: Spots
    prior: Array
    """(q,) P0."""

    @cached_property
    def offsets(self) -> Offsets:
        """Where the objects are as seen from the poses, found once."""
        return find_offsets(self.objects, self.spots)


def learn_theta(
    rng: Generator,
    examples: Sequence[Sequence[Example]],
    sampling: dpmm.DpmmConfig,
    config: LearningConfig,
    fitting: FittingConfig,
    n_components: int = 0,
) -> tuple[dict[str, Theta], pd.DataFrame]:
    """Return Theta per category and the trace of the learning.

    `examples` holds the labelled arrangements of each training scene, in any order of
    the scenes; every round looks at one arrangement of each of its scenes, in turn.
    `n_components` > 0 learns under the finite mixture of that many poses.
    """
    chain = replace(
        sampling,
        n_chains=1,
        n_burn_in=config.n_burn_in,
        n_samples=config.n_samples,
    )
    scenes = sorted(examples, key=lambda scene: scene[0].scene)
    runs = []
    for restart, stream in enumerate(rng.spawn(config.n_restarts)):
        start = BROAD if restart == 0 else _jittered(stream)
        visit = partial(_visit, stream, chain, n_components)
        runs.append(_learn_once(restart, start, scenes, visit, config, fitting))
    best, _ = max(runs, key=lambda run: _late_log_likelihood(run[1]))
    return best, pd.concat([trace for _, trace in runs], ignore_index=True)


def _jittered(rng: Generator) -> Theta:
    """Return another broad Theta to start from."""
    jitter = rng.normal(0, JITTER, 3)
    return replace(
        BROAD,
        log_distance_mean=BROAD.log_distance_mean + jitter[0],
        bearing_mean_rad=BROAD.bearing_mean_rad + jitter[1],
        height_mean_m=BROAD.height_mean_m + jitter[2],
    )


def _learn_once(
    restart: int,
    start: Theta,
    scenes: Sequence[Sequence[Example]],
    visit: Callable[[Example, Array], tuple[Array, float]],
    config: LearningConfig,
    fitting: FittingConfig,
) -> tuple[dict[str, Theta], pd.DataFrame]:
    """Return Theta per category after all rounds from one start, and the trace.

    The statistics of an arrangement are kept until its next turn, so that every fit
    looks at all labelled arrangements seen so far: the incremental variant of EM.
    SOURCE: Neal and Hinton (1998), "A view of the EM algorithm that justifies
    incremental, sparse, and other variants".
    """
    names = sorted({c for scene in scenes for e in scene for c in e.categories})
    thetas, trace = dict.fromkeys(names, start), []
    kept: dict[tuple[int, int], Array] = {}
    n_groups = -(-len(scenes) // config.scenes_per_round)
    for iteration in range(config.n_iterations):
        parameters, values = parameters_of([thetas[name] for name in names]), []
        for number in range(iteration % n_groups, len(scenes), n_groups):
            scene = scenes[number]
            turn = iteration // n_groups % len(scene)
            code = np.searchsorted(names, scene[turn].categories)
            statistics, value = visit(scene[turn], parameters[code])
            kept[number, turn] = np.zeros((len(names), len(STATISTICS)))
            np.add.at(kept[number, turn], code, statistics)
            values.append(value)
        sums = np.sum(list(kept.values()), axis=0)
        thetas = {name: fit(sums[c], fitting) for c, name in enumerate(names)}
        trace += _trace_rows(iteration, restart, thetas, float(np.mean(values)))
    return thetas, pd.DataFrame(trace)


def _visit(
    rng: Generator,
    config: dpmm.DpmmConfig,
    n_components: int,
    example: Example,
    parameters: Array,
) -> tuple[Array, float]:
    """Return the statistics of each object (n, 10), and the mean log joint.

    `parameters` (n, 10) of each object, as of `parameters_of`.
    """
    where, has_front = (example.offsets, example.spots), example.has_front
    rows, top = weight_rows(*where, parameters, has_front)
    chain = dpmm.sample(rng, rows, example.prior, config, n_components=n_components)
    statistics = sufficient_statistics(*where, has_front, chain.pose[0])
    return statistics, float(chain.log_joint.mean() + top.sum())


def _late_log_likelihood(trace: pd.DataFrame) -> float:
    """Return the mean log joint over the later half of the rounds."""
    by_round = trace.groupby("iteration")["log_likelihood"].first()
    return float(by_round.iloc[len(by_round) // 2 :].mean())


def _trace_rows(
    iteration: int, restart: int, thetas: dict[str, Theta], log_likelihood: float
) -> list[dict[str, object]]:
    """Return the trace of one round, one row per category and parameter."""
    return [
        {
            "iteration": iteration,
            "restart": restart,
            "category": name,
            "parameter": field.name,
            "value": getattr(theta, field.name),
            "log_likelihood": log_likelihood,
        }
        for name, theta in sorted(thetas.items())
        for field in fields(Theta)
    ]

"""Gibbs sampling of human poses under a Dirichlet process mixture (eq. 3).

Each object picks a human pose among those in use or a new one; then each pose in use
is redrawn given the objects that picked it. Poses come from the discrete set of valid
poses of the scene, so that a pose is an index and the potential of object i with every
pose is a row of a table. `exact_birth` weighs a new pose by its exact sum over that
set; `algorithm8` is Algorithm 8 of Neal (2000), "Markov chain sampling methods for
Dirichlet process mixture models", with m auxiliary poses drawn from the prior P0.

DIFFERS: objects whose placement is unknown are summed out rather than sampled, since a
chain that carries their placements does not mix: their row is the sum of the potential
over all placements, and placements are read off at the end.

Shapes: n objects, q valid poses, c slots of wanted objects, r chains, s samples.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.people import gibbs

Array = NDArray[np.float64]

MIN_WEIGHT = 1e-12
"""Floor of a row relative to its largest entry, so that products stay positive."""


@dataclass(frozen=True)
class DpmmConfig:
    """Settings of the sampler; the values live in `config/config.yaml`."""

    sampler: Literal["exact_birth", "algorithm8"]
    concentration: float
    """Concentration alpha of the Dirichlet process; larger means more poses."""
    n_auxiliary: int
    """Auxiliary poses m that `algorithm8` offers to each object."""
    n_chains: int
    """Chains; they start in turn from one pose for all and one pose for each object."""
    n_burn_in: int
    """Sweeps dropped at the start of each chain."""
    n_samples: int
    """Sweeps kept of each chain."""


@dataclass(frozen=True)
class Chains:
    """The sweeps kept of all chains."""

    choice: NDArray[np.int32]
    """(r, s, n) number of the pose that each object picked."""
    pose: NDArray[np.int32]
    """(r, s, n) index of that pose among the valid poses."""
    log_joint: Array
    """(r, s) log p(choices, poses, objects) up to a constant."""
    n_poses: NDArray[np.int32]
    """(r, s) poses in use."""
    p_new: Array
    """(r, s) probability of a new pose, mean over the objects."""
    weight: Array
    """(r, c, q + 1) mean probability that a wanted object picks each pose, sum 1; the
    last column is a new pose, drawn from P0 times the row of the object."""


def scale_row(row: Array) -> NDArray[np.float32]:
    """Return a row of potentials scaled to a largest entry of 1, shape (q,)."""
    return np.maximum(row / max(row.max(), 1e-300), MIN_WEIGHT).astype(np.float32)


def weight_rows(log_psi: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return log potentials as weights scaled to 1 per row, shape (n, q)."""
    highest = log_psi.max(1, keepdims=True)
    return np.exp(np.maximum(log_psi - highest, np.log(MIN_WEIGHT))).astype(np.float32)


def sample(
    rng: Generator,
    rows: NDArray[np.float32],
    prior: Array,
    config: DpmmConfig,
    slot: NDArray[np.int64] | None = None,
    n_components: int = 0,
) -> Chains:
    """Run the chains of one question.

    `rows` (n, q) potential of each object with each pose, up to a factor per object;
    `prior` (q,) P0; `slot` (n,) the row of `Chains.weight` that an object adds to, -1
    for none; `n_components` poses of a finite mixture, 0 for the Dirichlet process.
    """
    slot = np.full(len(rows), -1) if slot is None else slot
    n_auxiliary = config.n_auxiliary if config.sampler == "algorithm8" else 0
    mixture = gibbs.Mixture(config.concentration, n_auxiliary, n_components)
    tiles = gibbs.tile_rows(np.ascontiguousarray(rows), prior)
    size = (config.n_chains, config.n_samples)
    choice = np.empty((*size, len(rows)), np.int32)
    pose = np.empty_like(choice)
    trace = np.empty((config.n_chains, 3, config.n_samples))
    weight = np.zeros((config.n_chains, slot.max(initial=-1) + 1, len(prior) + 1))
    for r in range(config.n_chains):
        together = n_components > 0 or r % 2 == 0
        out = choice[r], pose[r], trace[r], weight[r]
        gibbs.run(rng, tiles, mixture, together, config.n_burn_in, slot, *out)
    weight /= np.maximum(weight.sum(2, keepdims=True), 1e-300)  # guards an empty slot
    log_joint, n_poses, p_new = np.moveaxis(trace, 1, 0)
    return Chains(choice, pose, log_joint, n_poses.astype(np.int32), p_new, weight)

"""Gibbs sampling of human poses under a Dirichlet process mixture (eq. 3).

Algorithm 8 of Neal (2000), "Markov chain sampling methods for Dirichlet process
mixture models": each object picks a human pose among those in use and a few auxiliary
poses drawn from the prior P0; then each pose in use is redrawn given the objects that
picked it. Poses come from the discrete set of valid poses of the scene, so that a pose
is an index and the potential of object i with every pose is a row of a table.

DIFFERS: objects whose placement is unknown are summed out rather than sampled, since a
chain that carries their placements does not mix: their row is the sum of the potential
over all placements, and placements are read off at the end.

Shapes: n objects, q valid poses, m auxiliary poses, s samples.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_WEIGHT = 1e-12
"""Floor of a row relative to its largest entry, so that products stay positive."""


@dataclass(frozen=True)
class DpmmConfig:
    """Settings of the sampler; the values live in `config/config.yaml`."""

    concentration: float
    """Concentration alpha of the Dirichlet process; larger means more poses."""
    n_auxiliary: int
    """Auxiliary poses m offered to each object."""
    n_burn_in: int
    """Sweeps dropped at the start of the chain."""
    n_samples: int
    """Sweeps kept after the burn-in."""


@dataclass(frozen=True)
class Chain:
    """The sweeps kept from one chain."""

    choice: NDArray[np.int32]
    """(s, n) number of the pose that each object picked, from 0 in every sweep."""
    pose: NDArray[np.int32]
    """(s, n) index of that pose among the valid poses."""
    log_joint: Array
    """(s,) log p(choices, poses, objects) up to a constant."""


def scale_row(row: Array) -> NDArray[np.float32]:
    """Return a row of potentials scaled to a largest entry of 1, shape (q,)."""
    return np.maximum(row / max(row.max(), 1e-300), MIN_WEIGHT).astype(np.float32)


def weight_rows(log_psi: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return log potentials as weights scaled to 1 per row, shape (n, q)."""
    highest = log_psi.max(1, keepdims=True)
    return np.exp(np.maximum(log_psi - highest, np.log(MIN_WEIGHT))).astype(np.float32)


def sample(
    rng: Generator, rows: NDArray[np.float32], prior: Array, config: DpmmConfig
) -> Chain:
    """Run one chain from a single pose that every object picks.

    `rows` (n, q) potential of each object with each pose, up to a factor per object;
    `prior` (q,) P0.
    """
    n_objects, n_sweeps = len(rows), config.n_burn_in + config.n_samples
    pose = np.empty((n_sweeps, n_objects), np.int32)
    choice = np.empty((n_sweeps, n_objects), np.int32)
    log_joint = np.empty(n_sweeps)
    _run(
        rng,
        rows,
        np.cumsum(prior),
        prior,
        config.concentration,
        config.n_auxiliary,
        choice,
        pose,
        log_joint,
    )
    kept = slice(config.n_burn_in, None)
    return Chain(choice[kept], pose[kept], log_joint[kept])


@njit(cache=True)
def _run(rng, rows, cumulated, prior, alpha, m, choices, poses, log_joint):  # noqa: ANN001, ANN202
    """Fill `choices`, `poses` and `log_joint` sweep by sweep."""
    n = len(rows)
    choice = np.zeros(n, np.int64)
    pose_of = np.zeros(n, np.int64)  # pose of each cluster; at most n are in use
    n_members = np.zeros(n, np.int64)
    n_members[0] = n
    pose_of[0] = _draw(rng, cumulated)
    buffer = np.empty(len(prior))
    for sweep in range(len(choices)):
        for i in range(n):
            _choose_pose(rng, rows, cumulated, alpha, m, i, choice, pose_of, n_members)
        for k in range(n):
            if n_members[k] > 0:
                pose_of[k] = _redraw_pose(rng, rows, prior, k, choice, buffer)
        log_joint[sweep] = _log_joint(rows, prior, alpha, choice, pose_of, n_members)
        for i in range(n):
            choices[sweep, i] = choice[i]
            poses[sweep, i] = pose_of[choice[i]]


@njit(cache=True)
def _draw(rng, cumulated):  # noqa: ANN001, ANN202
    """Return an index drawn in proportion to the steps of `cumulated`."""
    u = rng.random() * cumulated[-1]
    return min(np.searchsorted(cumulated, u, side="right"), len(cumulated) - 1)


@njit(cache=True)
def _choose_pose(rng, rows, cumulated, alpha, m, i, choice, pose_of, n_members):  # noqa: ANN001, ANN202
    """Redraw the pose object `i` picks, given all else (Neal 2000, eq. 3.6)."""
    n = len(choice)
    old = choice[i]
    n_members[old] -= 1
    auxiliary = np.empty(m, np.int64)
    for j in range(m):
        auxiliary[j] = _draw(rng, cumulated)
    if n_members[old] == 0:  # nobody else uses it: it is the first auxiliary
        auxiliary[0] = pose_of[old]
    weight = np.empty(n + m)
    for k in range(n):
        weight[k] = n_members[k] * rows[i, pose_of[k]] if n_members[k] > 0 else 0.0
    for j in range(m):
        weight[n + j] = alpha / m * rows[i, auxiliary[j]]
    new = _draw(rng, np.cumsum(weight))
    if new >= n:
        pose = auxiliary[new - n]
        new = 0
        while n_members[new] > 0:
            new += 1
        pose_of[new] = pose
    choice[i] = new
    n_members[new] += 1


@njit(cache=True)
def _redraw_pose(rng, rows, prior, k, choice, buffer):  # noqa: ANN001, ANN202
    """Return a pose drawn in proportion to P0 times the rows of its objects."""
    buffer[:] = prior
    for i in range(len(choice)):
        if choice[i] == k:
            buffer *= rows[i]
    total = 0.0
    for q in range(len(buffer)):
        total += buffer[q]
        buffer[q] = total
    return _draw(rng, buffer)


@njit(cache=True)
def _log_joint(rows, prior, alpha, choice, pose_of, n_members):  # noqa: ANN001, ANN202
    """Return log [prod alpha (n_k - 1)! P0(H_k) prod Psi(O_i, H_choice)]."""
    total = 0.0
    for k in range(len(n_members)):
        if n_members[k] > 0:
            total += np.log(alpha) + np.log(max(prior[pose_of[k]], 1e-300))
            for j in range(1, n_members[k]):
                total += np.log(j)
    for i in range(len(choice)):
        total += np.log(rows[i, pose_of[choice[i]]])
    return total

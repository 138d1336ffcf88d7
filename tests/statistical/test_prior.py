"""Objects that like all poses alike follow the prior of the mixture."""

import numpy as np
import pytest

from placing.people import dpmm

N_SAMPLES = 20_000
Q = 70
"""Poses: three tiles, so that two clusters share a pose now and then."""


def mean_n_poses(sampler, n, concentration, n_components):
    """Return the mean number of poses in use, and its standard error."""
    config = dpmm.DpmmConfig(sampler, concentration, 2, 2, 50, N_SAMPLES // 2)
    rows, prior = np.ones((n, Q), np.float32), np.full(Q, 1 / Q)
    rng = np.random.default_rng(n)
    chains = dpmm.sample(rng, rows, prior, config, n_components=n_components)
    batches = chains.n_poses.reshape(100, -1).mean(1)
    return batches.mean(), batches.std(ddof=1) / 10


@pytest.mark.parametrize("sampler", ["exact_birth", "algorithm8"])
@pytest.mark.parametrize("concentration", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("n", [1, 5, 17])
def test_poses_in_use_grow_as_the_chinese_restaurant_says(n, concentration, sampler):
    mean, error = mean_n_poses(sampler, n, concentration, 0)
    exact = (concentration / (concentration + np.arange(n))).sum()
    assert abs(mean - exact) <= 4 * error
    assert error < 0.05 * exact


@pytest.mark.parametrize("sampler", ["exact_birth", "algorithm8"])
@pytest.mark.parametrize("n_components", [1, 3, 40])
@pytest.mark.parametrize("n", [1, 5, 17])
def test_components_in_use_are_those_of_a_symmetric_dirichlet(n, n_components, sampler):
    mean, error = mean_n_poses(sampler, n, 2.0, n_components)
    each = 2.0 / n_components  # a component stays empty: prod (others + j) / (all + j)
    j = np.arange(n)
    exact = n_components * (1 - np.prod((2.0 - each + j) / (2.0 + j)))
    assert abs(mean - exact) <= 4 * error + 1e-9
    assert error < 0.05 * exact

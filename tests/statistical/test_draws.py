"""The draws that read few tiles follow the exact weights of all poses."""

import numpy as np
import pytest
from enumeration import scene_of
from numba import njit
from scipy.stats import chi2

from placing.people import gibbs

N_DRAWS = 100_000
MEMBERS = ([0], [1, 4], [0, 2, 3], [0, 1, 2, 3, 4])


@njit
def draws(rng, tiles, members, n_draws):
    """Return poses drawn for some objects."""
    out, buffers = np.empty(n_draws, np.int64), gibbs.buffers_of(tiles)
    for s in range(n_draws):
        out[s] = gibbs.draw_pose(rng, tiles, members, buffers)
    return out


@njit
def births(rng, tiles, i, n_draws):
    """Return poses drawn for one object that shares its pose with none."""
    out = np.empty(n_draws, np.int64)
    for s in range(n_draws):
        out[s] = gibbs.draw_birth(rng, tiles, i)
    return out


def assert_follows(drawn, weight):
    """Assert that chi-square does not tell draws from a weight of every pose."""
    assert weight[drawn].min() > 0
    expected = np.sort(weight / weight.sum())[::-1] * len(drawn)
    order = np.argsort(-weight, kind="stable")
    seen = np.bincount(drawn, minlength=len(weight))[order]
    # Poses of less than ten expected draws are lumped into one bin.
    n = max(np.count_nonzero(expected >= 10), 1)
    seen, expected = (np.append(a[:n], a[n:].sum()) for a in (seen, expected))
    used = expected > 0
    distance = ((seen - expected)[used] ** 2 / expected[used]).sum()
    assert distance <= chi2.isf(1e-4, max(used.sum() - 1, 1))


@pytest.mark.parametrize("sharpness", [0.0, 0.3, 2.0, 12.0])
@pytest.mark.parametrize("members", MEMBERS)
def test_a_lazy_draw_follows_the_product_of_the_rows(members, sharpness):
    rng = np.random.default_rng(7)
    rows, prior = scene_of(rng, 5, 300, sharpness)
    drawn = draws(rng, gibbs.tile_rows(rows, prior), np.array(members), N_DRAWS)
    assert_follows(drawn, prior * rows[members].astype(float).prod(0))


@pytest.mark.parametrize("sharpness", [0.0, 0.3, 2.0, 12.0])
@pytest.mark.parametrize("q", [1, 31, 32, 33, 300])
def test_a_birth_follows_prior_and_row(q, sharpness):
    rng = np.random.default_rng(8)
    rows, prior = scene_of(rng, 2, q, sharpness)
    drawn = births(rng, gibbs.tile_rows(rows, prior), 1, N_DRAWS)
    assert_follows(drawn, prior * rows[1].astype(float))


def test_poses_that_the_prior_rules_out_are_never_drawn():
    rng = np.random.default_rng(9)
    rows, prior = scene_of(rng, 5, 300, 1.0)
    prior[:40] = prior[100:140] = prior[250:] = 0
    tiles = gibbs.tile_rows(rows, prior / prior.sum())
    weight = prior * rows.astype(float).prod(0)
    assert_follows(draws(rng, tiles, np.arange(5), N_DRAWS), weight)
    assert_follows(births(rng, tiles, 1, N_DRAWS), prior * rows[1].astype(float))


def test_many_objects_that_disagree_within_a_tile_still_get_a_pose():
    # Each object likes another pose of one tile: the bound is far above every sum.
    rows = np.full((32, 64), 1e-12, np.float32)
    rows[np.arange(32), np.arange(32)] = 1
    tiles = gibbs.tile_rows(rows, np.full(64, 1 / 64))
    drawn = draws(np.random.default_rng(10), tiles, np.arange(32), 20_000)
    assert_follows(drawn, np.repeat([1.0, 1e-12], [32, 32]))

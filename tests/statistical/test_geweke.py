"""Objects and poses drawn in turn are distributed as when drawn from the model.

Geweke (2004), "Getting it right": if the sampler leaves the posterior unchanged, then
alternating it with a draw of the objects given their poses leaves the joint unchanged,
from which objects and poses can be drawn directly as well.
"""

import numpy as np
import pytest
from numba import njit

from placing.people import gibbs

N_OBJECTS, N_POSES, N_VALUES = 4, 70, 5
N_DRAWS, THIN = 12_000, 4
NAMES = ("poses in use", "their square", "together", "prior", "psi", "pose", "value")


@njit
def statistics(out, choice, pose, value, log_prior, log_psi):
    """Fill `out` with the statistics of one draw, in the order of `NAMES`."""
    n_used, prior, psi = 0.0, 0.0, 0.0
    for i in range(len(choice)):
        if not (choice[:i] == choice[i]).any():
            n_used += 1
            prior += log_prior[pose[i]]
        psi += log_psi[value[i], pose[i]]
    out[:3] = n_used, n_used**2, 1.0 if choice[0] == choice[1] else 0.0
    out[3:] = prior, psi, float(pose[0]), float(value[0])


@njit
def draw_values(rng, pose, psi, value):
    """Draw what every object is, given its pose."""
    for i in range(len(value)):
        value[i] = gibbs.search(np.cumsum(psi[:, pose[i]]), rng.random())


@njit
def forward(rng, psi, prior, mixture, out):
    """Fill `out` (s, 7) with draws of the model."""
    n, alpha = N_OBJECTS, mixture.concentration
    each = alpha / mixture.n_components if mixture.n_components else 0.0
    below, log_prior, log_psi = np.cumsum(prior), np.log(prior), np.log(psi)
    choice, pose = np.zeros(n, np.int64), np.zeros(n, np.int64)
    value = np.zeros(n, np.int64)
    for s in range(len(out)):
        for i in range(n):
            used = choice[:i].max() + 1 if i else 0
            mass = np.zeros(used + 1)
            for k in range(used):
                mass[k] = (choice[:i] == k).sum() + each
            mass[used] = alpha - used * each
            choice[i] = gibbs.search(np.cumsum(mass), rng.random())
            pose[i] = gibbs.search(below, rng.random())
            for j in range(i):
                if choice[j] == choice[i]:
                    pose[i] = pose[j]
        draw_values(rng, pose, psi, value)
        statistics(out[s], choice, pose, value, log_prior, log_psi)


@njit
def alternate(rng, psi, prior, mixture, forgets, out):
    """Fill `out` (s, 7) by turns of values and sweeps.

    `forgets` plants a bug: the pose of the first object is redrawn for it alone.
    """
    value = np.zeros(N_OBJECTS, np.int64)
    slot, weight = np.full(N_OBJECTS, -1), np.zeros((0, N_POSES + 1))
    log_prior, log_psi = np.log(prior), np.log(psi)
    tiles = gibbs.tile_rows(psi[value].astype(np.float32), prior)
    state, buffers = gibbs.init(rng, tiles, False), gibbs.buffers_of(tiles)
    for s in range(len(out) * THIN):
        tiles = gibbs.tile_rows(psi[value].astype(np.float32), prior)
        gibbs.step(rng, state, tiles, mixture, slot, weight, buffers)
        if forgets:
            state.pose_of[state.choice[0]] = gibbs.draw_birth(rng, tiles, 0)
        pose = state.pose_of[state.choice]
        # Before the values are redrawn, when poses must fit the values they came from.
        statistics(out[s // THIN], state.choice, pose, value, log_prior, log_psi)
        draw_values(rng, pose, psi, value)


def scores(mixture, wrong=None, forgets=False):
    """Return z of every statistic between the two ways to draw, by its name."""
    rng = np.random.default_rng(11)
    psi = rng.dirichlet(np.full(N_VALUES, 0.5), N_POSES).T + 0.01
    psi, prior = psi / psi.sum(0), rng.dirichlet(np.ones(N_POSES)) + 1e-3
    prior /= prior.sum()
    drawn, chain = np.empty((2, N_DRAWS, len(NAMES)))
    forward(rng, psi, prior, mixture, drawn)
    alternate(rng, psi, prior, wrong or mixture, forgets, chain)
    batches = chain.reshape(200, -1, len(NAMES)).mean(1)
    error = np.hypot(drawn.std(0) / N_DRAWS**0.5, batches.std(0, ddof=1) / 200**0.5)
    return dict(zip(NAMES, (chain.mean(0) - drawn.mean(0)) / error, strict=True))


@pytest.mark.parametrize("n_components", [0, 3])
@pytest.mark.parametrize("n_auxiliary", [0, 1, 3])
def test_turns_of_objects_and_sweeps_draw_from_the_model(n_auxiliary, n_components):
    z = scores(gibbs.Mixture(1.0, n_auxiliary, n_components))
    assert max(map(abs, z.values())) < 4, z


@pytest.mark.parametrize("n_auxiliary", [0, 3])
def test_a_wrong_concentration_in_the_sampler_is_noticed(n_auxiliary):
    mixture = gibbs.Mixture(1.0, n_auxiliary, 0)
    z = scores(mixture, wrong=mixture._replace(concentration=1.3))
    assert abs(z["poses in use"]) > 8, z


def test_a_pose_drawn_without_looking_at_all_its_objects_is_noticed():
    z = scores(gibbs.Mixture(1.0, 0, 0), forgets=True)
    assert abs(z["psi"]) > 8, z

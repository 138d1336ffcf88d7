"""The sampler visits partitions and poses as often as exact enumeration says."""

from math import factorial

import numpy as np
import pytest
from enumeration import enumerate_all, iid_variation, pack, scene_of, variation

from placing.people import dpmm

N_OBJECTS = 5
N_POSES = 90
"""Three tiles, the last one not full."""
THIN = 5
"""Sweeps between two that count, after which a chain has forgotten the first."""
N_DRAWS = 12_000

SAMPLERS = {
    "exact birth": ("exact_birth", 0, 0),
    "algorithm 8, m = 1": ("algorithm8", 1, 0),
    "algorithm 8, m = 3": ("algorithm8", 3, 0),
    "finite mixture": ("exact_birth", 0, 3),
    "finite mixture, m = 3": ("algorithm8", 3, 3),
}


def run(rng, rows, prior, kind="exact birth", concentration=1.0, **settings):
    """Return the chains of a kind of sampler."""
    sampler, m, n_components = SAMPLERS[kind]
    given = {"n_chains": 2, "n_burn_in": 100, "n_samples": N_DRAWS * THIN // 2}
    config = dpmm.DpmmConfig(sampler, concentration, m, **(given | settings))
    slot = np.arange(len(rows)) - len(rows) + 1  # the last object is wanted
    slot = np.where(slot < 0, -1, slot)
    return dpmm.sample(rng, rows, prior, config, slot, n_components)


def visits_of(chain, chains=slice(None)):
    """Return how often every partition is visited, and poses of the first object."""
    choice = chain.choice[chains, ::THIN].reshape(-1, chain.choice.shape[2])
    pose = chain.pose[chains, ::THIN, 0].ravel()
    partitions = np.bincount(pack(choice), minlength=2**10)
    return partitions, np.bincount(pose, minlength=N_POSES)


@pytest.mark.parametrize("concentration", [0.8, 3.0])
@pytest.mark.parametrize("kind", SAMPLERS)
def test_partitions_and_poses_are_visited_as_often_as_enumeration_says(
    kind, concentration
):
    rng = np.random.default_rng(3)
    rows, prior = scene_of(rng, N_OBJECTS, N_POSES, 1.5)
    n_components = SAMPLERS[kind][2]
    partition, pose = enumerate_all(rows, prior, concentration, n_components)
    by_partition, by_pose = visits_of(run(rng, rows, prior, kind, concentration))
    assert variation(by_partition, partition) < iid_variation(partition, N_DRAWS)
    assert variation(by_pose, pose[0]) < iid_variation(pose[0], N_DRAWS)


@pytest.mark.parametrize("change", [{"concentration": 1.15}, {"n_components": 8}])
def test_a_slightly_wrong_model_does_not_pass_as_the_right_one(change):
    rng = np.random.default_rng(3)
    rows, prior = scene_of(rng, N_OBJECTS, N_POSES, 1.5)
    exact = enumerate_all(rows, prior, **({"concentration": 1.0} | change))[0]
    visits = visits_of(run(rng, rows, prior))[0]
    assert variation(visits, exact) > iid_variation(exact, N_DRAWS)


@pytest.mark.parametrize("kind", ["exact birth", "algorithm 8, m = 3"])
def test_the_order_of_objects_and_of_poses_does_not_matter(kind):
    rng = np.random.default_rng(4)
    rows, prior = scene_of(rng, N_OBJECTS, N_POSES, 1.5)
    exact = enumerate_all(rows, prior, 1.0)[0]
    objects, poses = rng.permutation(N_OBJECTS), rng.permutation(N_POSES)
    shuffled = np.ascontiguousarray(rows[objects][:, poses])
    chain = run(rng, shuffled, prior[poses], kind)
    choice = chain.choice[:, ::THIN].reshape(-1, N_OBJECTS)[:, np.argsort(objects)]
    visits = np.bincount(pack(choice), minlength=2**10)
    assert variation(visits, exact) < iid_variation(exact, N_DRAWS)


def test_chains_from_opposite_starts_agree():
    rng = np.random.default_rng(5)
    rows, prior = scene_of(rng, N_OBJECTS, N_POSES, 3.0)
    exact = enumerate_all(rows, prior, 1.0)[0]
    chain = run(rng, rows, prior)
    floor = iid_variation(exact, N_DRAWS // 2)
    for r in range(2):
        assert variation(visits_of(chain, slice(r, r + 1))[0], exact) < floor


@pytest.mark.parametrize("kind", ["exact birth", "algorithm 8, m = 3"])
def test_the_weight_of_a_wanted_object_is_its_exact_posterior_over_poses(kind):
    rng = np.random.default_rng(6)
    rows, prior = scene_of(rng, N_OBJECTS, N_POSES, 1.5)
    chain = run(rng, rows, prior, kind)
    weight = chain.weight[:, 0].mean(0)
    seen, unseen = weight[:-1], weight[-1]
    born = prior * rows[-1] / (prior @ rows[-1])
    exact = enumerate_all(rows, prior, 1.0)[1][-1]
    assert seen.sum() + unseen == pytest.approx(1)
    distance = 0.5 * np.abs(seen + unseen * born - exact).sum()
    assert distance < iid_variation(exact, N_DRAWS)


@pytest.mark.parametrize("kind", SAMPLERS)
def test_a_single_object_picks_poses_in_proportion_to_prior_and_potential(kind):
    rng = np.random.default_rng(1)
    rows, prior = scene_of(rng, 1, N_POSES, 1.5)
    chain = run(rng, rows, prior, kind)
    exact = prior * rows[0] / (prior @ rows[0])
    assert variation(visits_of(chain)[1], exact) < iid_variation(exact, N_DRAWS)


def test_log_joint_is_the_log_of_the_product_it_names():
    rng = np.random.default_rng(2)
    rows, prior = scene_of(rng, N_OBJECTS, 3, 1.0)
    settings = {"n_burn_in": 0, "n_samples": 50}
    chain = run(rng, rows, prior, "algorithm 8, m = 3", 0.7, **settings)
    for choice, pose, log_joint in zip(
        chain.choice[0], chain.pose[0], chain.log_joint[0], strict=True
    ):
        value = np.prod([rows[i, h] for i, h in enumerate(pose)], dtype=float)
        for k in set(choice):
            members = np.flatnonzero(choice == k)
            value *= 0.7 * factorial(len(members) - 1) * prior[pose[members[0]]]
        assert log_joint == pytest.approx(np.log(value), abs=1e-4)

"""The sampler visits partitions as often as exact enumeration says it should."""

from collections import Counter
from math import factorial

import numpy as np
import pytest

from placing import dpmm

N_POSES = 3


def partitions(items):
    """Yield every set partition of `items` as a list of blocks."""
    if not items:
        yield []
        return
    head, *rest = items
    for partition in partitions(rest):
        yield [[head], *partition]
        for b, block in enumerate(partition):
            yield [*partition[:b], [head, *block], *partition[b + 1 :]]


def exact_distribution(rows, prior, concentration):
    """Return P(partition) by summing the joint over every pose of every block."""
    weight = {}
    for partition in partitions(list(range(len(rows)))):
        w = 1.0
        for block in partition:
            w *= concentration * factorial(len(block) - 1)
            w *= prior @ rows[block].prod(0)
        weight[frozenset(map(frozenset, partition))] = w
    total = sum(weight.values())
    return {partition: w / total for partition, w in weight.items()}


def partition_of(choice):
    """Return the partition of the objects by the pose they picked."""
    return frozenset(frozenset(np.flatnonzero(choice == k)) for k in set(choice))


@pytest.mark.parametrize("m", [0, 1, 3])
@pytest.mark.parametrize("concentration", [0.8, 3.0])
def test_partitions_are_visited_as_often_as_enumeration_says(m, concentration):
    rng = np.random.default_rng(0)
    rows = dpmm.weight_rows(rng.normal(scale=1.5, size=(4, N_POSES)))
    prior = np.array([0.5, 0.3, 0.2])
    sampler = "algorithm8" if m else "exact_birth"
    config = dpmm.DpmmConfig(sampler, concentration, m, 1, 100, 200_000)

    chain = dpmm.sample(rng, rows, prior, config)
    visits = Counter(map(tuple, chain.choice[0]))
    share = Counter()
    for choice, n in visits.items():
        share[partition_of(np.array(choice))] += n / config.n_samples

    exact = exact_distribution(rows.astype(float), prior, concentration)
    distance = 0.5 * sum(abs(share[p] - q) for p, q in exact.items())
    assert distance < 0.01, f"total variation {distance:.4f} between chain and truth"


def test_a_single_object_picks_poses_in_proportion_to_prior_and_potential():
    rng = np.random.default_rng(1)
    rows = dpmm.weight_rows(rng.normal(size=(1, N_POSES)))
    prior = np.array([0.5, 0.3, 0.2])
    chain = dpmm.sample(
        rng, rows, prior, dpmm.DpmmConfig("algorithm8", 1.0, 4, 1, 10, 50_000)
    )
    share = np.bincount(chain.pose[0, :, 0], minlength=N_POSES) / 50_000
    exact = prior * rows[0] / (prior * rows[0]).sum()
    assert np.abs(share - exact).max() < 0.01


def test_log_joint_is_the_log_of_the_product_it_names():
    rng = np.random.default_rng(2)
    rows = dpmm.weight_rows(rng.normal(size=(5, N_POSES)))
    prior = np.array([0.5, 0.3, 0.2])
    chain = dpmm.sample(
        rng, rows, prior, dpmm.DpmmConfig("algorithm8", 0.7, 2, 1, 0, 50)
    )
    for choice, pose, log_joint in zip(
        chain.choice[0], chain.pose[0], chain.log_joint[0], strict=True
    ):
        value = np.prod([rows[i, h] for i, h in enumerate(pose)], dtype=float)
        for k in set(choice):
            members = np.flatnonzero(choice == k)
            value *= 0.7 * factorial(len(members) - 1) * prior[pose[members[0]]]
        assert log_joint == pytest.approx(np.log(value), abs=1e-4)

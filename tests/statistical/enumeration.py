"""Exact answers for a few objects: every partition, and every pose of every block.

A partition is packed into an integer with one bit per pair of objects, set when both
are in one block.
"""

from itertools import combinations
from math import factorial, prod

import numpy as np

from placing.people import dpmm


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


def pack(choice):
    """Return the partition of each row of choices (s, n) as an integer, (s,)."""
    pairs = combinations(range(choice.shape[1]), 2)
    bits = [(choice[:, i] == choice[:, j]) << b for b, (i, j) in enumerate(pairs)]
    return np.sum([np.zeros(len(choice), int), *bits], axis=0)


def labels(partition, n):
    """Return the block of each object, shape (1, n)."""
    out = np.empty((1, n), int)
    for b, block in enumerate(partition):
        out[0, block] = b
    return out


def prior_mass(sizes, concentration, n_components=0):
    """Return the prior weight of a partition with blocks of these sizes."""
    if n_components == 0:
        return prod(concentration * factorial(size - 1) for size in sizes)
    each = concentration / n_components
    mass = prod((n_components - b) * each for b in range(len(sizes)))
    return mass * prod(each + j for size in sizes for j in range(1, size))


def enumerate_all(rows, prior, concentration, n_components=0):
    """Return P(partition) (2^pairs,) by its packed number, and P(pose of i), (n, q)."""
    n, q = rows.shape
    share, poses = np.zeros(2 ** (n * (n - 1) // 2)), np.zeros((n, q))
    for partition in partitions(list(range(n))):
        mass = prior_mass(list(map(len, partition)), concentration, n_components)
        joint = [prior * rows[block].prod(0) for block in partition]
        mass *= prod(weight.sum() for weight in joint)
        share[pack(labels(partition, n))] = mass
        for block, weight in zip(partition, joint, strict=True):
            poses[block] += mass * weight / weight.sum()
    return share / share.sum(), poses / share.sum()


def variation(visits, exact):
    """Return the total variation between counted visits and exact shares."""
    return 0.5 * np.abs(visits / visits.sum() - exact).sum()


def iid_variation(exact, n_draws):
    """Return the total variation that iid draws do not exceed, with some room.

    The room is for what is left of the correlation between draws of a thinned chain.
    """
    rng = np.random.default_rng(0)
    draws = rng.multinomial(n_draws, exact / exact.sum(), size=1000)
    return 1.1 * np.max(0.5 * np.abs(draws / n_draws - exact).sum(1))


def scene_of(rng, n, q, sharpness):
    """Return rows (n, q) and P0 (q,) of a made-up scene."""
    rows = dpmm.weight_rows(rng.normal(scale=sharpness, size=(n, q)))
    return rows, rng.dirichlet(np.full(q, 2.0))

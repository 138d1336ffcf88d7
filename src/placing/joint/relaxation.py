"""The linear relaxation of the joint placement: a bound, and columns it rules out.

Each object is in one state, so that with prices of the rows a bound is a sum of the
best states of all objects. It holds for any prices that are not negative, exact or not.

Shapes: n objects, c columns, r rows.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import linprog

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

PACE = 0.1
"""First length of a step: the share of the bound that its excess is to cost."""
N_IDLE = 10
"""Steps without a better bound after which they get shorter."""


@dataclass(frozen=True)
class Relaxed:
    """A solution of the relaxation, and what its prices prove."""

    chosen: Array
    """(c,) how much of each column."""
    bound: float
    """No arrangement has a larger sum of log scores."""
    loss: Array
    """(c,) by how much the bound falls for arrangements with that column."""
    prices: Array
    """(r,) of the rows."""


def once_rows(owner: Ints) -> sparse.csr_array:
    """Return rows that add up the columns of each object, (n, c)."""
    at = (owner, np.arange(len(owner)))
    return sparse.csr_array(sparse.coo_array((np.ones(len(owner)), at)))


def bound_at(
    prices: Array, value: Array, owner: Ints, columns: sparse.csr_array, free: Array
) -> tuple[float, Array, Ints]:
    """Return the bound of prices, the loss of columns (c,) and the best ones (n,).

    `columns` (c, r) are the rows turned round.
    """
    net = value - columns @ prices  # (c,)
    order = np.lexsort((-net, owner))
    taken = order[np.r_[True, np.diff(owner[order]) > 0]]
    bound = float(net[taken].sum() + prices @ free)
    return bound, net[taken][owner] - net, taken


def price(
    value: Array,
    owner: Ints,
    rows: sparse.csr_array,
    free: Array,
    n_steps: int,
) -> Relaxed:
    """Return the relaxation priced by subgradient steps, many times faster than LP.

    Each step takes the best state of every object at the present prices and makes the
    rows dearer that these states break. `chosen` is how often states were taken lately.
    """
    columns = sparse.csr_array(rows.T)
    prices = best_prices = np.zeros(len(free))
    chosen, best, pace, n_idle = np.zeros(len(value)), np.inf, PACE, 0
    for _ in range(n_steps):
        bound, _, taken = bound_at(prices, value, owner, columns, free)
        n_idle = 0 if bound < best else n_idle + 1
        if bound < best:
            best, best_prices = bound, prices
        if n_idle == N_IDLE:
            pace, n_idle, prices = pace / 2, 0, best_prices
        picked = np.zeros(len(value))
        picked[taken] = 1.0
        chosen = 0.97 * chosen + 0.03 * picked
        excess = rows @ picked - free  # (r,)
        excess[(excess < 0) & (prices <= 0)] = 0.0
        length = max(float(excess @ excess), 1e-9)
        prices = np.maximum(prices + pace * max(abs(bound), 1.0) / length * excess, 0)
    bound, loss, _ = bound_at(best_prices, value, owner, columns, free)
    return Relaxed(chosen, bound, loss, best_prices)


def relax(
    value: Array, owner: Ints, rows: sparse.csr_array, free: Array
) -> Relaxed | None:
    """Return the relaxation of max value x, rows x <= free; None if HiGHS gave up."""
    once = once_rows(owner)
    n = once.shape[0]
    # An object is placed once at most: the bound of 1 on x is implied.
    found = linprog(-value, rows, free, once, np.ones(n), (0, None), method="highs")
    if found.status != 0:
        return None
    prices = np.maximum(-found.ineqlin.marginals, 0.0)
    columns = sparse.csr_array(rows.T)
    bound, loss, _ = bound_at(prices, value, owner, columns, free)
    return Relaxed(found.x, bound, loss, prices)


def essential(rows: sparse.csr_array, free: Array) -> NDArray[np.bool_]:
    """Return which rows do not follow from others, shape (r,).

    A row of ones says nothing if its columns are among those of another clique.
    """
    ones = sparse.csr_array((rows > 0).astype(np.float64))
    size = np.diff(ones.indptr)
    is_clique = (free == 1) & (np.abs(rows).sum(1) == size)
    is_within = (ones @ ones.T).toarray() >= size[:, None]
    is_within &= is_clique[:, None] & is_clique
    number = np.arange(len(free))
    is_first = ~is_within.T | (number < number[:, None])  # of rows that are the same
    return (size > 0) & ~(is_within & is_first).any(1) | ~is_clique

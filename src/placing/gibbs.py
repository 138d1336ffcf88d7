"""The compiled sweep of the pose sampler, and exact draws that read little of a row.

The valid poses are cut into tiles of neighbouring poses. A tile knows the largest
entry of each object's row and the sum of P0 times the row. A pose for several objects
is drawn by rejection over tiles: a tile is drawn in proportion to P0 times the product
of the largest entries, and accepted with the probability exact sum / bound; a refused
tile takes its exact sum as its bound. Whatever the bounds are, an accepted tile t has
probability proportional to its exact sum, so that the draw is exact, and only the
tiles that were drawn are read.

Shapes: n objects, q valid poses, t tiles, c slots of wanted objects.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

TILE = 32
"""Poses in a tile."""


class Tiles(NamedTuple):
    """The rows of a question, and what the sampler knows of their tiles."""

    rows: NDArray[np.float32]
    """(n, q) potential of each object with each pose, up to a factor per object."""
    prior: Array
    """(q,) P0."""
    prior_below: Array
    """(q,) cumulative P0."""
    tile_prior: Array
    """(t,) P0 of each tile."""
    highest: NDArray[np.float32]
    """(n, t) largest entry of each row in each tile."""
    birth_below: Array
    """(n, t) cumulative sum of P0 times the row; its end is the weight of a birth."""


class Mixture(NamedTuple):
    """How objects share poses a priori, in the order in which they come."""

    concentration: float
    n_auxiliary: int
    """0: a new pose is drawn from its exact conditional; else m of algorithm 8."""
    n_components: int
    """0: the Dirichlet process; else the finite mixture of that many poses."""


class State(NamedTuple):
    """One state of the chain; arrays are changed in place."""

    choice: NDArray[np.int64]
    """(n,) cluster that each object picked."""
    pose_of: NDArray[np.int64]
    """(n,) pose of each cluster."""
    n_members: NDArray[np.int64]
    """(n,) objects of each cluster; 0 marks an unused one."""


@njit(cache=True)
def tile_rows(rows, prior):  # noqa: ANN001, ANN201
    """Return the tiles of `rows` (n, q) under P0 `prior` (q,)."""
    n, q = rows.shape
    n_tiles = (q + TILE - 1) // TILE
    tile_prior = np.zeros(n_tiles)
    highest = np.zeros((n, n_tiles), np.float32)
    birth_below = np.zeros((n, n_tiles))
    for t in range(n_tiles):
        tile_prior[t] = prior[t * TILE : (t + 1) * TILE].sum()
    for i in range(n):
        below = 0.0
        for t in range(n_tiles):
            top = np.float32(0.0)
            for h in range(t * TILE, min(q, (t + 1) * TILE)):
                top = max(top, rows[i, h])
                below += prior[h] * rows[i, h]
            highest[i, t], birth_below[i, t] = top, below
    return Tiles(rows, prior, np.cumsum(prior), tile_prior, highest, birth_below)


@njit(cache=True)
def init(rng, tiles, starts_together):  # noqa: ANN001, ANN201
    """Start from one pose that every object picks, or from one pose for each."""
    n = len(tiles.rows)
    state = State(np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int64))
    for i in range(n):
        state.choice[i] = 0 if starts_together else i
        state.n_members[state.choice[i]] += 1
        if i == state.choice[i]:
            state.pose_of[i] = draw_birth(rng, tiles, i)
    return state


@njit(cache=True)
def step(rng, state, tiles, mixture, slot, weight):  # noqa: ANN001, ANN201
    """Sweep once over the objects, then over the poses in use.

    `slot` (n,) row of `weight` (c, q + 1) that adds up the probability of each pose for
    an object, and of an unseen new one in its last column; -1 for none. Return the
    probability of a new pose, mean over the objects.
    """
    n = len(state.choice)
    p_new = 0.0
    for i in range(n):
        p_new += choose_pose(rng, state, tiles, mixture, i, slot[i], weight) / n
    for k in range(n):
        if state.n_members[k] > 0:
            members = np.flatnonzero(state.choice == k)
            state.pose_of[k] = draw_pose(rng, tiles, members)
    return p_new


@njit(cache=True)
def birth_mass(mixture, n_used):  # noqa: ANN001, ANN201
    """Return the prior weight of a pose that no object uses yet."""
    if mixture.n_components == 0:
        return mixture.concentration
    left = mixture.n_components - n_used
    return left * mixture.concentration / mixture.n_components


@njit(cache=True)
def shared_mass(mixture, n_members):  # noqa: ANN001, ANN201
    """Return the prior weight of a pose that `n_members` other objects use."""
    if mixture.n_components == 0:
        return float(n_members)
    return n_members + mixture.concentration / mixture.n_components


@njit(cache=True)
def choose_pose(rng, state, tiles, mixture, i, slot, weight):  # noqa: ANN001, ANN201
    """Redraw the pose object `i` picks, given all else; return P(new pose).

    Neal (2000), eq. 3.6, with m auxiliary poses; with m = 0 a new pose has the exact
    weight sum_h P0(h) Psi(O_i, h), as in his algorithm 2.
    """
    n, m = len(state.choice), mixture.n_auxiliary
    old = state.choice[i]
    state.n_members[old] -= 1
    auxiliary = np.empty(m, np.int64)
    for j in range(m):
        auxiliary[j] = search(tiles.prior_below, rng.random())
    if m > 0 and state.n_members[old] == 0:  # nobody else uses it: the first auxiliary
        auxiliary[0] = state.pose_of[old]
    below, new = weigh_poses(state, tiles, mixture, i, auxiliary)
    if slot >= 0:
        add_shares(state, below, auxiliary, weight[slot])
    picked = search(below, rng.random())
    if picked >= n:
        pose = auxiliary[picked - n] if m > 0 else draw_birth(rng, tiles, i)
        picked = new
        state.pose_of[new] = pose
    state.choice[i] = picked
    state.n_members[picked] += 1
    return 1 - below[n - 1] / below[-1]


@njit(cache=True)
def weigh_poses(state, tiles, mixture, i, auxiliary):  # noqa: ANN001, ANN201
    """Return cumulative weights of clusters and new poses, and an unused cluster."""
    n, m = len(state.choice), len(auxiliary)
    below = np.empty(n + max(m, 1))
    total, n_used, new = 0.0, 0, -1
    for k in range(n):
        if state.n_members[k] > 0:
            mass = shared_mass(mixture, state.n_members[k])
            total += mass * tiles.rows[i, state.pose_of[k]]
            n_used += 1
        elif new < 0:
            new = k
        below[k] = total
    mass = birth_mass(mixture, n_used)
    if m == 0:
        below[n] = total + mass * tiles.birth_below[i, -1]
    for j in range(m):
        total += mass / m * tiles.rows[i, auxiliary[j]]
        below[n + j] = total
    return below, new


@njit(cache=True)
def add_shares(state, below, auxiliary, weight):  # noqa: ANN001, ANN201
    """Add the probability of each pose to `weight` (q + 1,); new and unseen: last."""
    n, last = len(state.choice), 0.0
    for k in range(len(below)):
        share = (below[k] - last) / below[-1]
        last = below[k]
        if k < n:
            if state.n_members[k] > 0:
                weight[state.pose_of[k]] += share
        elif len(auxiliary) > 0:
            weight[auxiliary[k - n]] += share
        else:
            weight[-1] += share


@njit(cache=True)
def search(below, u):  # noqa: ANN001, ANN201
    """Return the index that a uniform `u` draws under the cumulative sums `below`."""
    found = np.searchsorted(below, u * below[-1], side="right")
    return min(found, len(below) - 1)


@njit(cache=True)
def draw_birth(rng, tiles, i):  # noqa: ANN001, ANN201
    """Return a pose drawn in proportion to P0 times the row of one object."""
    t = search(tiles.birth_below[i], rng.random())
    first, last = t * TILE, min(len(tiles.prior), (t + 1) * TILE)
    return first + search(
        np.cumsum(tiles.prior[first:last] * tiles.rows[i, first:last]), rng.random()
    )


@njit(cache=True)
def draw_pose(rng, tiles, members):  # noqa: ANN001, ANN201
    """Return a pose drawn in proportion to P0 times the rows of `members`."""
    bound, scale = bound_tiles(tiles, members)
    is_exact = np.zeros(len(bound), np.bool_)
    while True:
        t = search(np.cumsum(bound), rng.random())
        below = sum_tile(tiles, members, scale, t)
        u = rng.random() * bound[t]
        if is_exact[t] or u < below[-1]:
            return t * TILE + search(below, min(u / below[-1], 1.0))
        bound[t], is_exact[t] = below[-1], True


@njit(cache=True)
def bound_tiles(tiles, members):  # noqa: ANN001, ANN201
    """Return P0 times the product of the largest entries per tile, (t,), largest 1.

    The second array (members,) is the factor after each member that keeps it there.
    """
    bound, scale = tiles.tile_prior.copy(), np.empty(len(members))
    for j in range(len(members)):
        bound *= tiles.highest[members[j]]
        scale[j] = 1 / bound.max()
        bound *= scale[j]
    return bound, scale


@njit(cache=True)
def sum_tile(tiles, members, scale, t):  # noqa: ANN001, ANN201
    """Return cumulative sums of P0 times the rows of `members` in a tile, scaled."""
    first, last = t * TILE, min(len(tiles.prior), (t + 1) * TILE)
    product = tiles.prior[first:last].copy()
    for j in range(len(members)):
        product *= tiles.rows[members[j], first:last]
        product *= scale[j]
    return np.cumsum(product)


@njit(cache=True)
def log_joint(state, tiles, mixture):  # noqa: ANN001, ANN201
    """Return the log joint of choices, poses and objects up to a constant.

    log [prod_k birth_mass P0(H_k) prod_j shared_mass(j)] + sum_i log Psi(O_i, H_i)
    """
    total, n_used = 0.0, 0
    for k in range(len(state.n_members)):
        if state.n_members[k] > 0:
            total += np.log(birth_mass(mixture, n_used))
            total += np.log(max(tiles.prior[state.pose_of[k]], 1e-300))  # guards log 0
            for j in range(1, state.n_members[k]):
                total += np.log(shared_mass(mixture, j))
            n_used += 1
    for i in range(len(state.choice)):
        total += np.log(tiles.rows[i, state.pose_of[state.choice[i]]])
    return total

"""The compiled sweep of the pose sampler, and exact draws that read little of a row.

The valid poses are cut into tiles of neighbouring poses, and these into blocks. Both
know the largest entry of each object's row and the mean of the row under P0. A pose for
several objects is drawn by rejection: a block is drawn in proportion to an upper bound
of its weight and accepted with the probability that the bounds of its tiles allow, then
a tile of it likewise, by its exact weight; what was looked into has the better bound
from then on. Whatever the bounds are, an accepted tile has probability proportional to
its exact weight, so that the draw is exact, and only what was drawn is read.

All kernels stand in one file, since a cached kernel does not see an edit of another.

Shapes: n objects, q valid poses, t tiles, b blocks, c slots of wanted objects.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

TILE = 32
"""Poses in a tile."""
BLOCK = 16
"""Tiles in a block."""
MIN_BOUND = 1e-100
"""A cluster whose bounds fall below is scaled up, so that no product underflows."""
MIN_TOTAL = 1e-250
"""A cluster whose exact weights fall below that is drawn for in logs: its objects
disagree everywhere."""


class Tiles(NamedTuple):
    """The rows of a question, and what the sampler knows of their tiles."""

    rows: NDArray[np.float32]
    """(n, q) potential of each object with each pose, up to a factor per object."""
    prior: Array
    """(q,) P0."""
    prior_below: Array
    """(q,) cumulative P0."""
    highest: Array
    """(n, t) largest entry of each row in each tile."""
    relative: Array
    """(n, t) sum of P0 times the row over the tile, relative to `highest`."""
    block_highest: Array
    block_relative: Array
    """(n, b) the same of blocks."""
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


class Buffers(NamedTuple):
    """Memory that a draw writes to, so that a sweep allocates little."""

    bound: Array
    """(t,) upper bound of the weight of each tile, or the weight itself."""
    is_exact: NDArray[np.bool_]
    """(t,) whether it is the weight itself."""
    block: Array
    """(b,) upper bound of the weight of each block, or the sum over its tiles."""
    is_open: NDArray[np.bool_]
    """(b,) whether it is that sum."""
    below: Array
    """(TILE,) cumulative weights of the poses of a tile."""


@njit(cache=True)
def tile_rows(rows, prior):  # noqa: ANN001, ANN201
    """Return the tiles of `rows` (n, q) under P0 `prior` (q,)."""
    n, q = rows.shape
    n_tiles = (q + TILE - 1) // TILE
    highest, relative = np.zeros((n, n_tiles)), np.zeros((n, n_tiles))
    birth_below = np.zeros((n, n_tiles))
    for i in range(n):
        below = 0.0
        for t in range(n_tiles):
            top, total = np.float32(0.0), 0.0
            for h in range(t * TILE, min(q, (t + 1) * TILE)):
                top = max(top, rows[i, h])
                total += prior[h] * rows[i, h]
            below += total
            highest[i, t], birth_below[i, t] = top, below
            relative[i, t] = total / top if top > 0 else 0.0
    blocks = bound_blocks(highest, relative)
    return Tiles(rows, prior, np.cumsum(prior), highest, relative, *blocks, birth_below)


@njit(cache=True)
def bound_blocks(highest, relative):  # noqa: ANN001, ANN201
    """Return what `highest` and `relative` (n, t) are for blocks of tiles, (n, b)."""
    n, n_tiles = highest.shape
    n_blocks = (n_tiles + BLOCK - 1) // BLOCK
    tops, sums = np.zeros((n, n_blocks)), np.zeros((n, n_blocks))
    for i in range(n):
        for b in range(n_blocks):
            part = slice(b * BLOCK, (b + 1) * BLOCK)
            tops[i, b] = highest[i, part].max()
            total = (highest[i, part] * relative[i, part]).sum()
            sums[i, b] = total / tops[i, b] if tops[i, b] > 0 else 0.0
    return tops, sums


@njit(cache=True)
def buffers_of(tiles):  # noqa: ANN001, ANN201
    """Return the memory for draws from these tiles."""
    n_tiles, n_blocks = tiles.highest.shape[1], tiles.block_highest.shape[1]
    is_exact, is_open = np.zeros(n_tiles, np.bool_), np.zeros(n_blocks, np.bool_)
    block, below = np.zeros(n_blocks), np.zeros(TILE)
    return Buffers(np.zeros(n_tiles), is_exact, block, is_open, below)


@njit(cache=True)
def run(rng, tiles, mixture, together, n_burn_in, slot, choice, pose, trace, weight):  # noqa: ANN001, ANN201
    """Fill `choice`, `pose` (s, n), `trace` (3, s) and `weight` sweep by sweep.

    The rows of `trace` are the log joint, the poses in use and the probability of a
    new one.
    """
    state = init(rng, tiles, together)
    buffers, nowhere = buffers_of(tiles), np.full(len(slot), -1)
    for sweep in range(n_burn_in + len(choice)):
        s = sweep - n_burn_in
        to = slot if s >= 0 else nowhere
        p_new = step(rng, state, tiles, mixture, to, weight, buffers)
        if s >= 0:
            choice[s] = state.choice
            pose[s] = state.pose_of[state.choice]
            trace[0, s] = log_joint(state, tiles, mixture)
            trace[1, s] = (state.n_members > 0).sum()
            trace[2, s] = p_new


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
def step(rng, state, tiles, mixture, slot, weight, buffers):  # noqa: ANN001, ANN201
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
            state.pose_of[k] = draw_pose(rng, tiles, members, buffers)
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
def draw_pose(rng, tiles, members, buffers):  # noqa: ANN001, ANN201
    """Return a pose drawn in proportion to P0 times the rows of `members`."""
    if len(members) == 1:
        return draw_birth(rng, tiles, members[0])
    bound, is_exact, block, is_open, below = buffers
    scale = weigh_blocks(tiles, members, block)
    is_open[:] = False
    while True:
        whole = block.sum()
        if whole <= MIN_TOTAL:
            return draw_in_logs(rng, tiles, members)
        b = draw_index(block, 0, len(block), rng.random() * whole)
        first, last = b * BLOCK, min(len(bound), (b + 1) * BLOCK)
        if not is_open[b]:
            closed = block[b]
            block[b] = weigh_tiles(tiles, members, scale, first, last, bound)
            is_open[b], is_exact[first:last] = True, False
            if rng.random() * closed >= block[b]:
                continue
        t = draw_index(bound, first, last, rng.random() * bound[first:last].sum())
        size = sum_tile(tiles, members, scale, t, below)
        total, u = below[size - 1], rng.random()
        if is_exact[t] or u * bound[t] < total:
            u = u if is_exact[t] else u * bound[t] / total
            return t * TILE + search(below[:size], u)
        bound[t], is_exact[t] = total, True
        block[b] = bound[first:last].sum()


@njit(cache=True)
def weigh_blocks(tiles, members, block):  # noqa: ANN001, ANN201
    """Fill `block` (b,) with an upper bound of the weight of each block.

    The sum of P0 times several rows is at most the product of their largest entries
    times the smallest sum of P0 times one of them, relative to its largest entry.
    Return the factors (members,) that multiply the product after each of them.
    """
    scale = np.ones(len(members))
    block[:] = tiles.block_relative[members[0]]
    for j in range(1, len(members)):
        np.minimum(block, tiles.block_relative[members[j]], block)
    for j in range(len(members)):
        block *= tiles.block_highest[members[j]]
        if j % 8 == 7 and block.max() < MIN_BOUND:
            scale[j] = 1 / block.max()
            block *= scale[j]
    return scale


@njit(cache=True)
def weigh_tiles(tiles, members, scale, first, last, bound):  # noqa: ANN001, ANN201
    """Fill `bound` from tile `first` to `last` with upper bounds; return their sum."""
    total = 0.0
    for t in range(first, last):
        smallest, product = np.inf, 1.0
        for j in range(len(members)):
            smallest = min(smallest, tiles.relative[members[j], t])
            product *= tiles.highest[members[j], t] * scale[j]
        bound[t] = smallest * product
        total += bound[t]
    return total


@njit(cache=True)
def draw_index(weight, first, last, left):  # noqa: ANN001, ANN201
    """Return the index from `first` at which the sum of `weight` passes `left`."""
    i = first
    while i < last - 1 and left >= weight[i]:
        left -= weight[i]
        i += 1
    return i


@njit(cache=True)
def draw_in_logs(rng, tiles, members):  # noqa: ANN001, ANN201
    """Return what `draw_pose` draws, from logs of all weights."""
    logs = np.log(np.maximum(tiles.prior, 1e-300))  # guards log 0
    for j in range(len(members)):
        logs += np.log(tiles.rows[members[j]])
    return search(np.cumsum(np.exp(logs - logs.max())), rng.random())


@njit(cache=True)
def sum_tile(tiles, members, scale, t, below):  # noqa: ANN001, ANN201
    """Fill `below` with cumulative weights of the poses of a tile; return how many."""
    first, size = t * TILE, min(TILE, len(tiles.prior) - t * TILE)
    for h in range(size):
        below[h] = tiles.prior[first + h]
    for j in range(len(members)):
        row = tiles.rows[members[j]]
        factor = scale[j]
        for h in range(size):
            below[h] *= row[first + h] * factor
    for h in range(1, size):
        below[h] += below[h - 1]
    return size


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

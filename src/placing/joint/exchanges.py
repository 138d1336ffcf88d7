"""Better arrangements by exchanges: an object moves in, those in its way move on.

Shapes: n objects, s columns that stand on areas.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def exchange(
    value: Array,
    owner: Ints,
    conflict: NDArray[np.bool_],
    is_free: NDArray[np.bool_],
    standing: Ints,
    nowhere: Array,
) -> Ints:
    """Return a column for each object that is at least as good, -1 nowhere: (n,).

    `standing` (n,) are the columns now, -1 nowhere and -2 for objects that stay out of
    this; `is_free` (s,) tells which columns those leave; `nowhere` (n,) is the value of
    being nowhere. `value` and `owner` (s,) belong to columns ordered by owner.
    """
    order = np.lexsort((-value, owner))
    starts = np.searchsorted(owner, np.arange(len(standing) + 1))
    picked = standing.copy()
    blockers = np.zeros(len(value), np.int64)
    blockers[~is_free] = len(standing) + 1  # more than can be moved away
    for column in picked[picked >= 0]:
        blockers += conflict[column]
    _exchange(value, owner, conflict, order, starts, picked, nowhere, blockers)
    return picked


@njit(cache=True)
def _exchange(value, owner, conflict, order, starts, picked, nowhere, blockers):  # noqa: ANN001, ANN202
    """Change `picked` by the first exchange that helps, until none does."""
    n, is_better = len(picked), True
    while is_better:
        is_better = False
        for i in range(n):
            if picked[i] == -2:
                continue
            for at in range(starts[i], starts[i + 1]):
                if _move_in(
                    order[at], value, owner, conflict, order, starts, picked, nowhere,
                    blockers,
                ):  # fmt: skip
                    is_better = True
                    break


@njit(cache=True)
def _move_in(k, value, owner, conflict, order, starts, picked, nowhere, blockers):  # noqa: ANN001, ANN202
    """Pick column k and move those in its way, two at most, if it helps."""
    i = owner[k]
    in_way = [
        j for j in range(len(picked))
        if j != i and picked[j] >= 0 and conflict[k, picked[j]]
    ]  # fmt: skip
    own = 1 if picked[i] >= 0 else 0  # its own columns are in conflict
    if picked[i] == k or len(in_way) > 2 or blockers[k] - own != len(in_way):
        return False
    gain = value[k] - (value[picked[i]] if own else nowhere[i])
    slack = gain  # what is gained if those in the way get their best
    for j in in_way:
        slack += value[order[starts[j]]] - value[picked[j]]
    if slack <= 1e-9:
        return False
    leaving = [picked[j] for j in in_way]
    if own:
        leaving.append(picked[i])
    coming = [k]
    for j in in_way:
        best = value[order[starts[j]]]
        among = order[starts[j] : starts[j + 1]]
        least = best - slack + 1e-9  # what is worth less makes it all worse
        column = _first_left(among, value, least, conflict, blockers, leaving, coming)
        # Nowhere is far worse than any column, so that nothing is moved there.
        if column < 0:
            return False
        slack += value[column] - best
        coming.append(column)
    for column in coming:
        _put(owner[column], column, picked, conflict, blockers)
    return True


@njit(cache=True)
def _first_left(among, value, least, conflict, blockers, leaving, coming):  # noqa: ANN001, ANN202
    """Return the first column worth over `least` with nothing in its way, or -1."""
    for column in among:
        if value[column] <= least:
            break
        if _is_left(column, conflict, blockers, leaving, coming):
            return column
    return -1


@njit(cache=True)
def _is_left(column, conflict, blockers, leaving, coming):  # noqa: ANN001, ANN202
    """Return whether nothing is in conflict with a column after an exchange."""
    in_way = blockers[column]
    row = conflict[column]
    for other in leaving:
        in_way -= row[other]
    for other in coming:
        in_way += row[other]
    return in_way == 0


@njit(cache=True)
def _put(i, column, picked, conflict, blockers):  # noqa: ANN001, ANN202
    """Move object i to a column, -1 nowhere, and keep count of the blockers."""
    if picked[i] >= 0:
        row = conflict[picked[i]]
        for c in range(len(row)):
            blockers[c] -= row[c]
    picked[i] = column
    if column >= 0:
        row = conflict[column]
        for c in range(len(row)):
            blockers[c] += row[c]

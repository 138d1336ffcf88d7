"""Exchanges make an arrangement better and keep it free of conflicts."""

import numpy as np
import pytest

from placing.joint.exchanges import exchange


@pytest.mark.parametrize("seed", range(8))
def test_exchanges_never_lose_and_never_overlap(seed):
    rng = np.random.default_rng(seed)
    owner = np.repeat(np.arange(5), 8)
    value = rng.normal(size=40)
    conflict = rng.random((40, 40)) < 0.15
    conflict = conflict | conflict.T | (owner[:, None] == owner)
    nowhere = np.full(5, -50.0)
    start = np.full(5, -1)
    picked = exchange(value, owner, conflict, np.ones(40, np.bool_), start, nowhere)
    again = exchange(value, owner, conflict, np.ones(40, np.bool_), picked, nowhere)
    placed = picked[picked >= 0]
    assert conflict[np.ix_(placed, placed)].sum() == len(placed)
    assert (owner[placed] == np.flatnonzero(picked >= 0)).all()
    assert len(placed) >= 1
    np.testing.assert_array_equal(picked, again)


def test_two_objects_change_places():
    # Object 0 wants column 0 and has 1, object 1 wants 3 and has 2.
    owner, value = np.array([0, 0, 1, 1]), np.array([0.0, -2, -1, 0])
    conflict = owner[:, None] == owner
    conflict[0, 2] = conflict[2, 0] = conflict[1, 3] = conflict[3, 1] = True
    free, nowhere = np.ones(4, np.bool_), np.full(2, -9.0)
    picked = exchange(value, owner, conflict, free, np.array([1, 2]), nowhere)
    assert list(picked) == [0, 3]


def test_objects_in_stacks_stay_out_of_it():
    owner, value = np.array([0, 0, 1]), np.array([0.0, -1, 0])
    conflict = owner[:, None] == owner
    is_free = np.array([False, True, True])
    start, nowhere = np.array([-1, -2]), np.full(2, -9.0)
    assert list(exchange(value, owner, conflict, is_free, start, nowhere)) == [1, -2]

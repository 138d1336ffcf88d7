"""Matching is as cheap as any can be."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from placing.tables.matching import match


@pytest.mark.parametrize("n", [0, 1, 2, 3, 5, 9, 14])
@pytest.mark.parametrize("has_ties", [False, True])
def test_total_cost_is_that_of_scipy(n, has_ties):
    rng = np.random.default_rng(n)
    for _ in range(20):
        cost = rng.exponential(size=(n, n))
        cost = np.round(2 * cost) if has_ties else cost
        found = match(cost)
        assert sorted(found) == list(range(n))
        best = cost[linear_sum_assignment(cost)].sum()
        assert cost[found, np.arange(n)].sum() == pytest.approx(best)

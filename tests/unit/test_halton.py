"""Points of a Halton sequence are those of scipy."""

import numpy as np
from scipy.stats import qmc

from placing.robot.halton import PRIMES, halton


def test_points_are_those_of_scipy_to_the_last_digit():
    for d in range(1, len(PRIMES) + 1):
        wanted = qmc.Halton(d, scramble=False).random(2000)
        assert np.array_equal(halton(2000, d), wanted)

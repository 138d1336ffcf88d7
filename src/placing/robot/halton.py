"""Points spread evenly over a cube.

They are those of `scipy.stats.qmc`, which takes half a second and 29 MB to import.
"""

import numpy as np

from placing.rigid import Array

PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37)
"""Bases of as many coordinates as an arm may have joints."""


def halton(n: int, d: int) -> Array:
    """Return the first points of a Halton sequence, from 0 to 1, (n, d)."""
    points = np.zeros((n, d))
    for k in range(d):
        base = PRIMES[k]
        number, share = np.arange(n), 1.0 / base
        while number.any():
            points[:, k] += number % base * share
            number, share = number // base, share / base
    return points

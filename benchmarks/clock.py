"""Measure how long a call takes, and how fast memory is on this machine.

Times are those of the processor, all threads added up: others who use the machine
lengthen them little.
"""

import time
from collections.abc import Callable

import numpy as np
from numba import njit


def seconds_of(call: Callable[[], object], budget_s: float = 0.5) -> float:
    """Return the median time of a call after one that warms it up [s]."""
    call()
    taken: list[float] = []
    while len(taken) < 3 or (sum(taken) < budget_s and len(taken) < 100):
        start = time.process_time()
        call()
        taken.append(time.process_time() - start)
    return float(np.median(taken))


def triad_rate(n_bytes: float) -> float:
    """Return the rate of a = b + s c over arrays of `n_bytes` in all [B/s]."""
    n = max(int(n_bytes // 24), 1)
    a, b, c = np.zeros(n), np.ones(n), np.ones(n)
    n_rounds = max(1, int(1e8 // n_bytes))
    return n_rounds * 24 * n / seconds_of(lambda: _triad(a, b, c, n_rounds))


def gather_rate(n_bytes: float = 8e6) -> float:
    """Return how many random f32 entries of an array are read in a second [1/s]."""
    rng = np.random.default_rng(0)
    values = rng.random(int(n_bytes // 4), np.float32)
    index = rng.integers(0, len(values), 2_000_000)
    return len(index) / seconds_of(lambda: _gather(values, index))


@njit
def _triad(a, b, c, n_rounds):  # noqa: ANN001, ANN202
    """Fill `a` with b + s c several times; `s` changes so that none is left out."""
    for s in range(n_rounds):
        for i in range(len(a)):
            a[i] = b[i] + s * c[i]


@njit
def _gather(values, index):  # noqa: ANN001, ANN202
    """Return the sum of some entries of `values`, added up in four lanes."""
    total = np.zeros(4, np.float32)
    for i in range(0, len(index) - 3, 4):
        for lane in range(4):
            total[lane] += values[index[i + lane]]
    return total.sum()

"""The cheapest matching of predictions to labels.

`scipy.optimize.linear_sum_assignment` does the same; importing it takes longer than
scoring a fold does, and the things of one category are few.

Shapes: n things on either side.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def match(cost: Array) -> NDArray[np.intp]:
    """Return the row that each column is matched to, least in total cost, shape (n,).

    Rows enter one by one, each by the cheapest path that alternates between pairs that
    are matched and pairs that are not (Kuhn and Munkres, with potentials).
    """
    n = len(cost)
    if n == 1:
        return np.zeros(1, np.intp)
    of_row, of_column = np.zeros(n), np.zeros(n + 1)  # the potentials
    row_of = np.full(n + 1, -1)  # column n is where the entering row waits
    for entering in range(n):
        row_of[n], column = entering, n
        least, came_from = np.full(n, np.inf), np.full(n, n)
        is_open = np.ones(n, np.bool_)
        while row_of[column] >= 0:
            row = row_of[column]
            reduced = cost[row] - of_row[row] - of_column[:n]
            is_nearer = is_open & (reduced < least)
            least[is_nearer], came_from[is_nearer] = reduced[is_nearer], column
            nearest = int(np.where(is_open, least, np.inf).argmin())
            step = least[nearest]
            closed = np.append(~is_open, True)
            of_row[row_of[closed]] += step
            of_column[closed] -= step
            least[is_open] -= step
            is_open[nearest], column = False, nearest
        while column != n:
            row_of[column], column = row_of[came_from[column]], came_from[column]
    return row_of[:n]

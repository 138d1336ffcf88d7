"""Cliques of options of which at most one can be chosen, as cuts of a linear program.

Two options are in conflict if their boxes overlap or if they are options of the same
object. Each clique of the conflict graph gives a row that every arrangement without
overlap meets, so that cuts never remove one.

Shapes: c columns (options), k cuts.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_VIOLATION = 1e-3
"""A clique that is violated less is left out: its row would change next to nothing."""


def violated_cliques(
    conflict: NDArray[np.bool_], chosen: Array, value: Array
) -> list[NDArray[np.int64]]:
    """Return maximal cliques whose columns add up to more than one.

    `conflict` (c, c), `chosen` (c,) solution of a relaxation, `value` (c,) tells which
    columns extend a clique first. Every conflict of two columns with `chosen` 1 is in
    one of the cliques.
    """
    support = np.flatnonzero(chosen > 1e-7)
    support = support[np.argsort(-chosen[support], kind="stable")]
    others = np.flatnonzero(chosen <= 1e-7)
    others = others[np.argsort(-value[others], kind="stable")]
    found: dict[bytes, NDArray[np.int64]] = {}
    for seed in support:
        clique = _grow(conflict, seed, support)
        if chosen[clique].sum() > 1 + MIN_VIOLATION:
            clique = np.sort(_extend(conflict, clique, others))
            found[clique.tobytes()] = clique
    return list(found.values())


@njit(cache=True)
def _grow(conflict, seed, order):  # noqa: ANN001, ANN202
    """Return a clique with `seed`, columns taken greedily in this order."""
    clique = [seed]
    for column in order:
        if column != seed and _fits(conflict, clique, column):
            clique.append(column)
    return np.array(clique)


@njit(cache=True)
def _extend(conflict, clique, order):  # noqa: ANN001, ANN202
    """Return the clique made maximal, columns taken greedily in this order."""
    grown = list(clique)
    for column in order:
        if _fits(conflict, grown, column):
            grown.append(column)
    return np.array(grown)


@njit(cache=True)
def _fits(conflict, clique, column):  # noqa: ANN001, ANN202
    """Return whether a column is in conflict with all columns of a clique."""
    row = conflict[column]
    for member in clique:  # noqa: SIM110
        if not row[member]:
            return False
    return True

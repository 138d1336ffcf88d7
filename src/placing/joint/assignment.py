"""Joint placement of many objects as an integer program with linear stacking.

Each object takes one of its options, or stands on another object, so that no two boxes
overlap and the sum of the log scores is largest (Section 3.1). Rows that keep boxes
apart are added where a solution needs them, as cliques of options that exclude each
other; options that cannot be part of anything better than what is known already are
left out. Neither changes the optimum.

Shapes: n objects, o options of an object, c columns, s of them standing on areas.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.joint.assignment_config import AssignmentConfig
from placing.joint.joint_columns import make_columns
from placing.joint.options import Options
from placing.joint.search import Search
from placing.joint.stacking import StackPair, find_arcs

Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Assignment:
    """A placement of all objects, and how far from the best it can be."""

    choice: Ints
    """(n,) option of each object, -1 where it is not placed."""
    on: Ints
    """(n,) object it stands on, -1 on an area."""
    level: Ints
    """(n,) 0 on an area, -1 where it is not placed."""
    reason: tuple[str, ...]
    """(n,) why it is not placed, empty where it is."""
    objective: float
    """Sum of the log scores and penalties [nat]."""
    bound: float
    """No placement has a larger one [nat]."""
    gap: float
    """Between both [nat]; 0 where the placement is the best."""
    n_nodes: int
    n_rounds: int
    """Relaxations and integer programs that were solved."""


def assign(
    objects: Sequence[Options],
    pairs: Sequence[StackPair],
    config: AssignmentConfig,
) -> Assignment:
    """Return the placement of all objects with the largest sum of log scores."""
    arcs = find_arcs(objects, pairs, config.max_levels, config.max_overhang)
    columns = make_columns(objects, arcs, config.unplaced_penalty)
    search = Search(objects, columns, config)
    search.run()
    picked = search.picked
    objective = float(columns.value[picked].sum())
    bound = max(search.bound, objective)
    return Assignment(
        columns.option[picked],
        columns.lower[picked],
        columns.level[picked],
        tuple(_reasons(objects, columns.option[picked])),
        objective,
        bound,
        bound - objective,
        search.n_nodes,
        search.n_solved,
    )


def _reasons(objects: Sequence[Options], choice: Ints) -> list[str]:
    """Return why each object is not placed, empty where it is."""
    return [
        "" if at >= 0 else CROWDED_OUT if options.is_usable.any() else NO_OPTION
        for options, at in zip(objects, choice, strict=True)
    ]


NO_OPTION = "it fits nowhere"
CROWDED_OUT = "other objects take its places"

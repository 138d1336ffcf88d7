"""Location errors of whole arrangements: of a method, of labellers, and by chance.

An error is the horizontal distance between an object and its label. Objects of one
category are matched to the labels so that the sum of their errors is smallest; chance
and labellers are matched in the same way, so that all three are errors of one kind.

Shapes: a arrangements, n objects of the scene, k of one category, p places, d draws.
"""

from collections.abc import Sequence

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.candidates import Candidates, fits
from placing.scene import Arrangement, SceneObject
from placing.tables.matching import match

Array = NDArray[np.float64]

N_DRAWS = 2000
"""Draws of chance for several objects of a category: a centimetre of its error."""


def locations(arrangement: Arrangement, objects: Sequence[SceneObject]) -> Array:
    """Return where each object of an arrangement is on the floor plan, (n, 2) [m]."""
    placed = {p.object_id: p.location[:2] for p in arrangement.placements}
    return np.array([placed[item.object_id] for item in objects]).reshape(-1, 2)


def by_category(objects: Sequence[SceneObject]) -> list[list[int]]:
    """Return the numbers of the objects of each category."""
    groups: dict[str, list[int]] = {}
    for number, item in enumerate(objects):
        groups.setdefault(item.category, []).append(number)
    return list(groups.values())


def answer_errors(
    answer: Array, labelled: Array, chance: Array, objects: Sequence[SceneObject]
) -> tuple[NDArray[np.intp], Array]:
    """Return the label (n,) that each object is matched to, and its error (n,) [m].

    `answer` (n, 2) is NaN where an object was not placed: it has the error that chance
    has at its label. `labelled` (n, 2), `chance` (n,) by label.
    """
    to, error = np.zeros(len(objects), np.intp), np.zeros(len(objects))
    for members in by_category(objects):
        offset = answer[members][:, None] - labelled[members][None]  # (k, k, 2)
        cost = np.hypot(offset[..., 0], offset[..., 1])
        cost = np.where(np.isnan(cost), chance[members][None], cost)
        at = match(cost)  # (k,) object of each label
        for label, k in enumerate(at):
            to[members[k]], error[members[k]] = members[label], cost[k, label]
    return to, error


def chance_errors(
    rng: Generator,
    objects: Sequence[SceneObject],
    labelled: Array,
    candidates: Candidates,
    min_overlap: float,
) -> Array:
    """Return the error at each label (n,) of objects put anywhere they fit [m].

    Every place on which an object fits is as likely as every other. The only object of
    its category has the mean over these places; several are drawn and matched.
    """
    places = [_places(candidates, item, min_overlap) for item in objects]
    error = np.zeros(len(objects))
    for members in by_category(objects):
        if len(members) == 1:
            offset = places[members[0]] - labelled[members]
            error[members] = np.hypot(*offset.T).mean()
        else:
            drawn = [
                places[m][rng.integers(len(places[m]), size=N_DRAWS)] for m in members
            ]
            error[members] = matched_error(np.stack(drawn, 1), labelled[members])
    return error


def matched_error(drawn: Array, labelled: Array) -> Array:
    """Return the mean error at each label (k,) of draws (d, k, 2) matched to them."""
    from scipy.optimize import linear_sum_assignment  # thousands of small problems

    offset = drawn[:, :, None] - labelled[None, None]
    cost = np.hypot(offset[..., 0], offset[..., 1])  # (d, k, k)
    # The matrix is square, so that the rows come back in their order.
    label_of = np.array([linear_sum_assignment(of_draw)[1] for of_draw in cost])
    error = np.take_along_axis(cost, label_of[:, :, None], axis=2)[..., 0]
    return np.take_along_axis(error, np.argsort(label_of, axis=1), axis=1).mean(0)


def _places(candidates: Candidates, item: SceneObject, min_overlap: float) -> Array:
    """Return the places on which an object fits, on the floor plan, (p, 2) [m]."""
    is_fit = fits(candidates, item, min_overlap)
    # ASSUME: what fits nowhere upright is as likely at every place; it may lie there.
    return candidates.location[is_fit if is_fit.any() else slice(None), :2]

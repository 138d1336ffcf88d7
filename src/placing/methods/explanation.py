"""Why an object stands where it does: the score of its placement as a sum of terms.

The score is what the decision looks at, the log of the smoothed density at the place,
plus the log probability of the heading. It is told through one person, the likeliest
user of the object at that place, and compared with the best place elsewhere.

Shapes: p places, q valid poses.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.methods.arranging import TINY, UseOfObject
from placing.people import skeleton
from placing.people.potential import log_factors

Array = NDArray[np.float64]

TERMS = (
    *("person", "distance", "bearing", "height", "competition", "other_people"),
    *("objects", "neighbourhood", "heading"),
)
"""What the score adds up: the log probability that the object's user is this person;
the three factors of Psi_loc; -log Z, as places compete for the use by that person, with
the constants of the density; what all other people add; what the objects around add
(0 for methods without them); what the places around change; the heading."""
EXPLANATION_COLUMNS = (
    *("scene", "task", "method", "question", "object", "category", "person_kind"),
    *("person_x_m", "person_y_m", "person_z_m", "person_yaw_rad", "person_share"),
    *("alternative_area", "alternative_x_m", "alternative_y_m", "alternative_z_m"),
    *("term", "value", "alternative_value", "is_decisive"),
)
# ASSUME: a place nearer than this is the same placement to whoever reads the table.
ELSEWHERE_M = 0.5


@dataclass(frozen=True)
class Field:
    """The densities of a category over the places of a scene, under one method."""

    density: Array
    """(p,) before smoothing."""
    smooth: Array
    """(p,) what the decision maximises."""
    human: Array
    """(p,) the part of the human context, sum 1; `density` where it is the only one."""
    human_share: float
    """The weight omega of that part in `density`; 1 where it is the only one."""


@dataclass(frozen=True)
class Account:
    """Why a place is likely."""

    place: int
    pose: int
    """Index of the pose of the likeliest user of an object at that place."""
    share: float
    """Probability that this is the user, given the place."""
    terms: Mapping[str, float]
    """By `TERMS`; they add up to the score."""


@dataclass(frozen=True)
class Explanation:
    """Why an object stands at its place, and not at the best place elsewhere."""

    chosen: Account
    alternative: Account | None
    """None where no other place is fitting and far enough."""

    def decisive(self) -> str | None:
        """Return the term by which the alternative loses most, None without one."""
        if self.alternative is None:
            return None
        other = self.alternative.terms
        return max(TERMS, key=lambda term: self.chosen.terms[term] - other[term])


def explain(
    use: UseOfObject,
    weight: Array,
    field: Field,
    chosen: tuple[int, float],
    yaws: Array,
    places: tuple[Array, NDArray[np.bool_]],
) -> Explanation:
    """Explain one placed object.

    `weight` (q,) probability that its user has each pose; `chosen` its place and the
    probability of its heading; `yaws` the headings it may have; `places` where all
    places are (p, 3) and at which ones it fits (p,).
    """
    location, is_fitting = places
    other = _elsewhere(field.smooth, chosen[0], location, is_fitting)
    if other is None:
        return Explanation(account(use, weight, field, *chosen, location), None)
    likeliest = float(use.heading_probability(other, weight, yaws).max())
    return Explanation(
        account(use, weight, field, *chosen, location),
        account(use, weight, field, other, likeliest, location),
    )


def _elsewhere(
    smooth: Array, place: int, location: Array, is_fitting: NDArray[np.bool_]
) -> int | None:
    """Return the fitting place of highest smoothed density that is not near a place."""
    distance = np.linalg.norm(location - location[place], axis=1)
    left = np.flatnonzero(is_fitting & (distance >= ELSEWHERE_M))
    return int(left[np.argmax(smooth[left])]) if len(left) else None


def account(
    use: UseOfObject,
    weight: Array,
    field: Field,
    place: int,
    heading_probability: float,
    location: Array,
) -> Account:
    """Return why a place is likely; `location` (p, 3) of all places."""
    shares = use.shares(place, weight)
    pose = int(np.argmax(shares))
    total = float(shares.sum())
    at = location[place] + [0, 0, use.half_height_m]
    factors = log_factors(use.theta, at, use.lattice.people[pose])
    person, needs = _log(weight[pose]), _log(use.row()[pose])
    human = _log(field.human_share) + _log(field.human[place])
    mixed, smooth = _log(field.density[place]), _log(field.smooth[place])
    # Every term is a difference of neighbours in one chain of logs, from that person to
    # the score, so that they add up to it whatever is rounded or zero in between.
    values = (
        *(person, *map(float, factors)),
        human - _log(total) - needs,
        _log(total) - (person + float(factors.sum()) - needs),
        *(mixed - human, smooth - mixed, _log(heading_probability)),
    )
    share = float(shares[pose]) / max(total, TINY)
    return Account(place, pose, share, dict(zip(TERMS, values, strict=True)))


def explanation_rows(
    key: tuple[str, str, str, str, str, str],
    explanation: Explanation,
    use: UseOfObject,
    candidates: Candidates,
    areas: Sequence[str],
) -> list[tuple[object, ...]]:
    """Return one row of `EXPLANATION_COLUMNS` per term.

    `key` = scene, task, method, question, object and category; `areas` are the names of
    the placing areas of the scene. The alternative is a point on its area.
    """
    chosen, other = explanation.chosen, explanation.alternative
    poses, decisive = use.lattice.poses, explanation.decisive()
    kind = skeleton.KINDS[poses.kind[chosen.pose]]
    at = *map(float, poses.location[chosen.pose]), float(poses.yaw[chosen.pose])
    person = kind, *at, chosen.share
    elsewhere: tuple[object, ...] = ("", np.nan, np.nan, np.nan)
    if other is not None:
        area = areas[candidates.area[other.place]]
        elsewhere = area, *map(float, candidates.location[other.place])
    return [
        (
            *(*key, *person, *elsewhere, term, chosen.terms[term]),
            np.nan if other is None else other.terms[term],
            term == decisive,
        )
        for term in TERMS
    ]


def _log(value: float) -> float:
    """Return the log of a probability, of a tiny one in place of zero."""
    return float(np.log(max(value, TINY)))

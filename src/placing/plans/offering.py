"""The places a robot may choose among: where people would have an object, and how.

Of the density by which `dp` chooses, the highest modes that keep a distance from each
other, and places far from all of these, so that an object the robot cannot put where
people would have it still has somewhere to go.

Shapes: p places, k places offered, y headings.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.joint.options import Options, spread_out
from placing.methods.answering import Asked
from placing.scene import SceneObject

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

OFFERED = "dp"
"""The method whose density the robot chooses by."""
OPTION_COLUMNS = (
    *("scene", "task", "question", "labels", "object", "category", "option"),
    *("is_mode", "area", "x_m", "y_m", "z_m", "yaw_rad", "log_density", "log_heading"),
)
"""One row per option and heading, both from best to worst; z of the placing area."""


@dataclass(frozen=True)
class OfferingConfig:
    """Which places are offered; the values live in `config/config.yaml`."""

    n_best: int
    """Highest modes of the density."""
    n_spread: int
    """Places beside them, far from each other."""
    n_headings: int
    """Likeliest headings at each place."""
    distance_m: float
    """Between two modes."""


def offered_rows(
    task: str, asked: Asked, config: OfferingConfig
) -> list[tuple[object, ...]]:
    """Return what the robot may choose for every wanted object that it can carry."""
    question, model = asked.question, asked.model
    turns: dict[tuple[str, int], Array] = {}
    rows: list[tuple[object, ...]] = []
    for item in question.wanted:
        if not item.is_movable:
            continue
        _, smooth = asked.density(asked.stream(OFFERED), OFFERED, item.category)
        location, allowed = model.candidates.location, asked.allowed[item.object_id]
        places, n_modes = offered_places(location, item, smooth, allowed, config)
        named = (model.scene.scene, task, question.name, question.labels)
        for option, place in enumerate(places.tolist()):
            key = item.category, place
            if key not in turns:  # what all objects of a category share
                turns[key] = _headings(asked, item, place)
            row = (*named, item.object_id, item.category, option, option < n_modes)
            area = model.scene.areas[model.candidates.area[place]].area
            where = (area, *location[place].tolist())
            rows += [
                (*row, *where, float(model.yaws[h]), *np.log([smooth[place], share]))
                for h, share in _likeliest(turns[key], config.n_headings)
            ]
    return rows


def offered_places(
    location: Array,
    item: SceneObject,
    smooth: Array,
    allowed: NDArray[np.bool_],
    config: OfferingConfig,
) -> tuple[Indices, int]:
    """Return the places offered, (k,), and how many of them are modes: the first.

    Modes and others are each in falling density.
    """
    at = np.flatnonzero(allowed & (smooth > 0))
    order = at[np.argsort(-smooth[at], kind="stable")]
    modes = _modes(location, order, config)
    others = order[~np.isin(order, modes)]
    n = min(config.n_spread, len(others))
    far = spread_out(_as_options(location, item, smooth), others, modes, n)
    far = far[np.argsort(-smooth[far], kind="stable")]
    return np.concatenate([modes, far]), len(modes)


def _modes(location: Array, order: Indices, config: OfferingConfig) -> Indices:
    """Return the first of `order` that keep a distance from those before them, (k,)."""
    modes = []
    while len(order) and len(modes) < config.n_best:
        modes.append(order[0])
        away = np.linalg.norm(location[order] - location[order[0]], axis=1)
        order = order[away >= config.distance_m]
    return np.array(modes, np.int64)


def _as_options(location: Array, item: SceneObject, smooth: Array) -> Options:
    """Return every place as an option of an object."""
    n = len(location)
    with np.errstate(divide="ignore"):  # a place that nobody likes stays so
        score = np.log(smooth)
    zeros = np.zeros(n, np.int32)
    size = np.tile(item.size_m, (n, 1))
    free = np.full(n, np.inf)
    return Options(location, size, np.zeros(n), zeros, zeros, free, score)


def _likeliest(shares: Array, n: int) -> list[tuple[int, float]]:
    """Return the likeliest headings and their shares, at most `n`, none impossible."""
    order = np.argsort(-shares, kind="stable")[:n]
    return [(int(h), float(shares[h])) for h in order if shares[h] > 0]


def _headings(asked: Asked, item: SceneObject, place: int) -> Array:
    """Return the probability of each heading of an object at a place, (y,)."""
    model, people = asked.model, asked.people(asked.stream(OFFERED), OFFERED)
    if people is None:
        return np.full(len(model.yaws), 1 / len(model.yaws))
    use = model.use(people.theta, item.category)
    return use.heading_probability(place, people.weight[item.category], model.yaws)

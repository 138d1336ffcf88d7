"""How likely a method finds the places where labellers put the objects.

Shapes: p places, k labelled objects.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.methods.regions import ranks_of
from placing.scene import Placement, Scene, resting_point
from placing.tasks import Question

Array = NDArray[np.float64]
Nearest = Mapping[str, Mapping[str, int]]
"""The place nearest to where each labelled object rests, by arrangement and object."""

LIKELIHOOD_COLUMNS = [
    *("scene", "task", "method", "question", "labels", "object", "category"),
    *("nll", "rank"),
]


@dataclass(frozen=True)
class ScoringConfig:
    """Settings of the scores; the values live in `config/config.yaml`."""

    uniform_share: float
    """Share of a uniform density mixed into every density before its log is taken."""


def likelihood_rows(
    nearest: Nearest,
    question: Question,
    mixed: Mapping[str, Array],
    spacing_m: float,
) -> Iterator[tuple[str, str, str, float, float]]:
    """Yield labels, object, category, nll and rank of every labelled object.

    `mixed` densities (p,) per wanted category, see `with_uniform`; nll is in nats, of a
    density per square metre of placing area. An empty scene is compared with every
    labelled arrangement.
    """
    labels = [question.labels] if question.labels else list(nearest)
    for category, density in mixed.items():
        wanted = [item.object_id for item in question.of_category(category)]
        names = [(of, n) for of in labels for n in wanted if n in nearest[of]]
        at = [nearest[of][name] for of, name in names]
        values = fit(density, at, spacing_m)
        for (of, name), (nll, rank) in zip(names, values, strict=True):
            yield of, name, category, float(nll), float(rank)


def nearest_places(scene: Scene, places: Array) -> dict[str, dict[str, int]]:
    """Return the place nearest to where each labelled object rests, by arrangement.

    In a scene without places no object has one.
    """
    if len(places) == 0:
        return {arrangement.name: {} for arrangement in scene.arrangements}
    items = {item.object_id: item for item in scene.objects}
    at = np.ascontiguousarray(places.T)  # (3, p)

    def nearest(placement: Placement) -> int:
        x, y, z = resting_point(items[placement.object_id], placement)
        away = (at[0] - x) ** 2 + (at[1] - y) ** 2 + (at[2] - z) ** 2
        return int(away.argmin())

    return {
        arrangement.name: {p.object_id: nearest(p) for p in arrangement.placements}
        for arrangement in scene.arrangements
    }


def with_uniform(density: Array, config: ScoringConfig) -> Array:
    """Return a density (p,) with a uniform share mixed in: its log is finite."""
    share = config.uniform_share
    return (1 - share) * density + share / max(len(density), 1)


def fit(mixed: Array, at: Sequence[int], spacing_m: float) -> Array:
    """Return nll and rank of the places `at` under a density (p,), shape (k, 2)."""
    places = np.array(at, np.intp)
    nll = nll_at(mixed, places, spacing_m)
    return np.column_stack([nll, ranks_of(mixed, places)])


def nll_at(mixed: Array, places: NDArray[np.intp], spacing_m: float) -> Array:
    """Return nll of places under a density (p,), shape (k,) [nat, of 1/m²]."""
    return -np.log(mixed[places] / spacing_m**2)


def density_key(method: str, question: str, category: str) -> str:
    """Return the name under which a density is stored."""
    return f"{method}/{question}/{category}"

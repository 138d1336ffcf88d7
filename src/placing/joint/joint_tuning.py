"""What the labelled scenes of `rooms` choose for the joint placement.

Omega of the mixture of human and object context by held-out likelihood; K of the finite
mixture as most folds chose it; and how often objects of a category stand on each other.

Shapes: p places.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from placing.learning.likelihoods import (
    ScoringConfig,
    nearest_places,
    nll_at,
    with_uniform,
)
from placing.scene import Placement, Scene, SceneObject, extents, resting_point

Array = NDArray[np.float64]

TOUCHING_M = 0.01
"""What rests no further above the top of another object stands on it."""


def weight_nll(
    scene: Scene,
    places: Array,
    densities: Mapping[str, Array],
    weights: Sequence[float],
    spacing_m: float,
    scoring: ScoringConfig,
) -> Array:
    """Return the mean nll of the labelled places under each omega, shape (w,).

    `densities` (n, p) of the objects of a scene by `dp` and by `object_context`.
    """
    number = {item.object_id: i for i, item in enumerate(scene.objects)}
    nearest = nearest_places(scene, places)
    nll = []
    for w in weights:
        mixed = w * densities["dp"] + (1 - w) * densities["object_context"]
        full = [with_uniform(density, scoring) for density in mixed]
        of_label = [
            nll_at(full[number[name]], np.array([place]), spacing_m)[0]
            for of in nearest.values()
            for name, place in of.items()
        ]
        nll.append(np.mean(of_label))
    return np.array(nll)


def most_frequent(chosen: Iterable[int]) -> int:
    """Return what was chosen most often, the smaller of two."""
    counts = Counter(chosen)
    return min(counts, key=lambda k: (-counts[k], k))


def stack_shares(scenes: Sequence[Scene]) -> dict[str, float]:
    """Return how often an object stands on another of its category, by category.

    A share of 0 is left out. It counts labelled objects that have such another.
    """
    stacked: Counter[str] = Counter()
    seen: Counter[str] = Counter()
    for scene in scenes:
        items = {item.object_id: item for item in scene.objects}
        of_category = Counter(item.category for item in scene.objects)
        for arrangement in scene.arrangements:
            for placement in arrangement.placements:
                category = items[placement.object_id].category
                if of_category[category] > 1:
                    seen[category] += 1
                    args = placement, arrangement.placements, items
                    stacked[category] += stands_on_its_like(*args)
    return {c: stacked[c] / seen[c] for c in sorted(stacked) if stacked[c]}


def stands_on_its_like(
    upper: Placement,
    placements: Sequence[Placement],
    items: Mapping[str, SceneObject],
) -> bool:
    """Return whether an object stands on another of its category."""
    item = items[upper.object_id]
    x, y, z = resting_point(item, upper)
    for lower in placements:
        other = items[lower.object_id]
        if lower is upper or other.category != item.category:
            continue
        size = extents(other, lower)
        offset = np.abs([x, y] - lower.location[:2])
        top = lower.location[2] + size[2] / 2
        if abs(z - top) <= TOUCHING_M and (offset <= size[:2] / 2).all():
            return True
    return False

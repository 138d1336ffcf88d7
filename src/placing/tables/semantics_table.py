"""How often the placing area that a labeller chose is among those held most probable.

Shapes: n objects, m areas, p places.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.methods.baselines import BaselinesConfig, chance_density, histogram_density
from placing.scene import Scene

Array = NDArray[np.float64]

COLUMNS = ["category", "method", "n_objects", "top1", "top3", "nll"]
LEAST = 1e-6
"""Share of a uniform choice mixed in before a log is taken."""


def height_shares(
    scene: Scene,
    candidates: Candidates,
    histograms: Mapping[str, Array],
    config: BaselinesConfig,
) -> Array:
    """Return the probability of each area by how high a category lies, (n, m)."""
    # What no training scene shows may lie anywhere.
    anywhere = chance_density(candidates)
    rows = []
    for item in scene.objects:
        histogram, density = histograms.get(item.category), anywhere
        if histogram is not None:
            density = histogram_density(histogram, candidates, "height", config)
        rows.append(np.bincount(candidates.area, density, len(scene.areas)))
    return np.array(rows).reshape(len(rows), len(scene.areas))


def hit_rows(
    scene: Scene, shares: Array, found: Mapping[str, Array]
) -> list[tuple[object, ...]]:
    """Return a row per labelled object and method: hits and negative log probability.

    `shares` (n, m) are those of the labels, `found` (n, m) per method is in proportion
    to the probability of each area.
    """
    rows = []
    for i, item in enumerate(scene.objects):
        for method, weights in found.items() if shares[i].any() else ():
            top1, top3, nll = hits(weights[i], shares[i])
            rows.append((item.category, method, 1, top1, top3, nll))
    return rows


def hits(weights: Array, shares: Array) -> tuple[float, float, float]:
    """Return the share of labels (m,) on the first area, the first three, and the nll.

    Areas of one weight share their ranks.
    """
    probability = weights / weights.sum()
    probability = (1 - LEAST) * probability + LEAST / len(weights)
    above = (weights[None] > weights[:, None]).sum(1)
    equal = (weights[None] == weights[:, None]).sum(1)
    top1, top3 = (np.clip((k - above) / equal, 0, 1) @ shares for k in (1, 3))
    return float(top1), float(top3), float(-shares @ np.log(probability))


def tabulate_semantics(rows: Sequence[tuple[object, ...]]) -> pd.DataFrame:
    """Return the means per category and method, and over all objects."""
    table = pd.DataFrame(rows, columns=COLUMNS)
    every = pd.concat([table, table.assign(category="all")])
    how = {"n_objects": "sum", "top1": "mean", "top3": "mean", "nll": "mean"}
    return every.groupby(["category", "method"], as_index=False).agg(how)[COLUMNS]

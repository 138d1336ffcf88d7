"""How much the errors depend on the numbers that were chosen.

The same scenes are arranged again with one number changed at a time; every variation
is compared with `base`, the configuration, scene by scene.

Shapes: c categories, s scenes, b resamples; values are (c, s), weights (b, s).
"""

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing.tables.averages import Side, difference, jackknife_se, mean_of, resamples
from placing.tables.metrics import tables_by_scene

Array = NDArray[np.float64]

BASE = "base"
"""The variation in which nothing is changed."""
METRICS = {"location": "location_m", "height": "height_m", "nll": "nll"}
"""The measures of the table, and the names of their columns."""
SENSITIVITY_COLUMNS = (
    *("dataset", "task", "method", "variation", "n_scenes"),
    *(
        f"{name}{end}"
        for name in METRICS.values()
        for end in ("", "_se", "_difference", "_low", "_high")
    ),
)


def compare_variations(rng: Generator, scores: pd.DataFrame) -> pd.DataFrame:
    """Return one row per data set, task, method and variation.

    `scores` have a column `variation`. Differences are to `base` over the scenes that
    both have, with the interval of a paired bootstrap; those of `base` itself are 0.
    `base` comes first, then the variations in the order of the scores.
    """
    keys = ["dataset", "task", "method", "variation"]
    tables, _, scenes = tables_by_scene(scores, keys)
    weights = resamples(rng, len(scenes))
    first = {v: i for i, v in enumerate([BASE, *pd.unique(scores["variation"])][::-1])}
    rows = []
    for key in sorted(tables, key=lambda key: (*key[:3], -first[key[3]])):
        base = tables.get((*key[:3], BASE))
        cells: list[float] = []
        for measure in METRICS:
            values = tables[key][measure]
            cells += [mean_of(values), jackknife_se(values)]
            reference = None if base is None else base[measure]
            cells += _paired(values, reference, weights)
        n_scenes = int(np.isfinite(tables[key]["location"]).any(0).sum())
        rows.append((*key, n_scenes, *cells))
    return pd.DataFrame(rows, columns=list(SENSITIVITY_COLUMNS))


def _paired(
    values: Array, base: Array | None, weights: Array
) -> tuple[float, float, float]:
    """Return the difference to `base` and its interval, NaN where there is no base."""
    if base is None:
        return np.nan, np.nan, np.nan
    has_both = np.isfinite(values).any(0) & np.isfinite(base).any(0)
    sides = [np.where(has_both, side, np.nan) for side in (values, base)]
    return difference(*(Side.of(side, weights) for side in sides))

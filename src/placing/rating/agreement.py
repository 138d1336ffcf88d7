"""How far raters agree: Cohen's kappa of yes and no, and the difference of scores.

Shapes: n things that both raters answered.
"""

from itertools import combinations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.rating.answers import WHOLE

AGREEMENT_COLUMNS = (
    *("rater", "other", "n_objects", "same", "kappa", "n_arrangements"),
    "score_difference",
)


def cohen_kappa(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> float:
    """Return Cohen's kappa of two raters' answers (n,).

    It is NaN where it is not defined: both gave one and the same answer throughout.
    """
    if len(one) == 0:
        return np.nan
    observed = float((one == other).mean())
    p, q = one.mean(), other.mean()
    expected = float(p * q + (1 - p) * (1 - q))
    # Two shares of the same n: they are exactly 1 or below it by far more than this.
    return np.nan if expected > 1 - 1e-12 else (observed - expected) / (1 - expected)


def agreement(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each pair of raters, over what both of them were asked."""
    asked = ratings[ratings["is_asked"].astype(bool)]
    table = asked.pivot_table("answer", ["arrangement", "object"], "rater")
    is_whole = table.index.get_level_values("object") == WHOLE
    rows = []
    for rater, other in combinations(sorted(set(asked["rater"])), 2):
        both = table[[rater, other]].notna().all(axis=1)
        words = table.loc[both & ~is_whole, [rater, other]].to_numpy(float) > 0
        marks = table.loc[both & is_whole, [rater, other]].to_numpy(float)
        same = _mean(words[:, 0] == words[:, 1])
        kappa = cohen_kappa(words[:, 0], words[:, 1])
        difference = _mean(np.abs(marks[:, 0] - marks[:, 1]))
        rows.append((rater, other, len(words), same, kappa, len(marks), difference))
    return pd.DataFrame(rows, columns=list(AGREEMENT_COLUMNS))


def _mean(values: NDArray[np.generic]) -> float:
    """Return the mean, NaN of nothing."""
    return float(values.mean()) if len(values) else np.nan

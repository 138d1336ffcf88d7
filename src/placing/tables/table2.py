"""Table 2: the share of correct places and a score from 0 to 5, by scene and method.

Both are measured, not rated: `Co` by a judge that is no part of the model, `Sc` by the
location error between the spread of the labels (5) and chance (0).

Shapes: s scenes.
"""

import numpy as np
import pandas as pd

from placing.methods.names import JOINT_NAMES, LABELS
from placing.tables.table2_scores import CHANCE

MAX_SCORE = 5.0
"""SOURCE: Section 4.2, the scale on which the paper's raters scored."""
CELL_COLUMNS = (
    *("scene", "method", "n", "n_unplaced", "co", "co_se", "sc", "sc_se"),
    *("location_error_m", "location_error_se_m", "spread_m", "chance_m"),
)
AVERAGE = "average"
SCENES = ("office1", "office2", "office3", "apt1", "apt2")
"""In the order of the paper; any others follow."""


def cells(scores: pd.DataFrame) -> pd.DataFrame:
    """Return one row per scene and method of Table 2, and `labels`, with their parts.

    Standard errors are over the objects of the scene; that of `Sc` takes spread and
    chance as known.
    """
    rows = []
    for scene, of_scene in scores.groupby("scene", sort=True):
        by_method = dict(list(of_scene.groupby("method")))
        chance = _mean_error(by_method[CHANCE])
        spread = _mean_error(by_method[LABELS]) if LABELS in by_method else np.nan
        for method in (*JOINT_NAMES, LABELS):
            if method in by_method:
                found = _cell(by_method[method], spread, chance)
                rows.append((scene, method, *found, spread, chance))
    return pd.DataFrame(rows, columns=list(CELL_COLUMNS))


def score(error: float, spread: float, chance: float) -> float:
    """Return the score of a location error: 5 at the spread of labels, 0 at chance.

    It is NaN where labels are no nearer to each other than chance is, or have no
    spread.
    """
    if not spread < chance:
        return np.nan
    share = (chance - error) / (chance - spread)
    return float(np.clip(MAX_SCORE * share, 0.0, MAX_SCORE))


def table2(of_cells: pd.DataFrame) -> pd.DataFrame:
    """Return Table 2: a row per method, `{scene}_co`, `{scene}_sc` and averages.

    An average is the mean over scenes, each of which counts once.
    """
    found = set(of_cells["scene"])
    scenes = [scene for scene in SCENES if scene in found]
    scenes += sorted(found.difference(SCENES))
    rows = []
    for method in JOINT_NAMES:
        of_method = of_cells[of_cells["method"] == method].set_index("scene")
        row: dict[str, object] = {"method": method}
        for scene in scenes:
            for name in ("co", "sc"):
                is_there = scene in of_method.index
                value = of_method.loc[scene, name] if is_there else np.nan
                row[f"{scene}_{name}"] = value
        for name in ("co", "sc"):
            values = [row[f"{scene}_{name}"] for scene in scenes]
            row[f"{AVERAGE}_{name}"] = np.mean(np.array(values, float))
        rows.append(row)
    names = [f"{scene}_{name}" for scene in (*scenes, AVERAGE) for name in ("co", "sc")]
    return pd.DataFrame(rows, columns=["method", *names])


def _cell(rows: pd.DataFrame, spread: float, chance: float) -> tuple[float, ...]:
    """Return the columns of a cell from `n` to the standard error of its error."""
    # Over its objects; what is compared with several labels has one row for each.
    objects = rows.groupby("object")[["is_correct", "is_placed"]].mean()
    correct = 100 * objects["is_correct"].to_numpy(float)
    errors = rows.groupby("object")["location_error_m"].mean().to_numpy(float)
    error, error_se = float(errors.mean()), _standard_error(errors)
    sc = score(error, spread, chance)
    sc_se = np.nan if np.isnan(sc) else MAX_SCORE * error_se / (chance - spread)
    unplaced = int((objects["is_placed"] == 0).sum())
    co = (float(correct.mean()), _standard_error(correct))
    return len(objects), unplaced, *co, sc, sc_se, error, error_se


def _mean_error(rows: pd.DataFrame) -> float:
    """Return the mean location error [m]."""
    return float(rows["location_error_m"].mean())


def _standard_error(values: np.ndarray) -> float:
    """Return the standard error of a mean, NaN of fewer than two values."""
    n = len(values)
    return float(values.std(ddof=1) / np.sqrt(n)) if n > 1 else np.nan

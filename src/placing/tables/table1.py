"""Table 1 of the paper: errors with and without the constraints of a robot.

The errors are those of Figure 6, over the objects that the robot can carry: `without`
is what `dp` decides there. An object that is not placed has no error and is counted.

Shapes: c categories, s scenes.
"""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing.learning.likelihoods import LIKELIHOOD_COLUMNS
from placing.methods.answer_tables import PLACED
from placing.methods.names import LABELS
from placing.plans.robot_plans import CONSTRAINTS, INSIDE, WITH, WITHOUT
from placing.scene import Scene
from placing.tables.averages import LEVEL, average, jackknife_se, mean_of, resamples
from placing.tables.metrics import AVERAGE, tables_by_scene
from placing.tables.scoring import ANSWER_COLUMNS, score_scene

Array = NDArray[np.float64]

CATEGORIES = (
    *("book", "clean_tool", "mouse", "pen", "dishware", "pan", "cushion", "utensil"),
    *("food", "shoe", "remote"),
)
"""Of what the robot can carry, in the order of the paper."""
METRICS = ("location_m", "height_m", "placed_percent")
MEASURE_OF = {"location_m": "location", "height_m": "height"}
LONG_COLUMNS = ("task", "metric", "constraints", "category", "value", "se", "n")
PAIRED_COLUMNS = (
    *("task", "metric", "constraints", "compared_with", "n"),
    *("value", "compared_value", "ratio", "low", "high"),
)
PAIRS = ((WITH, WITHOUT), (INSIDE, WITHOUT), (INSIDE, WITH))


def score_constraints(
    scene: Scene, without: pd.DataFrame, plans: pd.DataFrame
) -> pd.DataFrame:
    """Return the errors of one task of a scene, one row per object that is compared.

    `without` are the answers of `dp`, `plans` what the robot does.
    """
    movable = [item.object_id for item in scene.objects if item.is_movable]
    is_asked = without["question"].isin(plans["question"])
    answers = without[is_asked & without["object"].isin(movable)]
    answers = answers.assign(method=WITHOUT)
    robotic = plans.assign(method=plans["constraints"])
    columns = list(ANSWER_COLUMNS)
    together = pd.concat([answers[columns], robotic[columns]], ignore_index=True)
    no_likelihood = pd.DataFrame(columns=LIKELIHOOD_COLUMNS)
    scores = score_scene(scene, together, no_likelihood)
    return scores[scores["method"] != LABELS]


def long_table(scores: pd.DataFrame) -> pd.DataFrame:
    """Return value, standard error and count of every metric by category, and `AVG`.

    A scene's value of a category is the mean over its objects and labelled
    arrangements; values and standard errors are over scenes, `AVG` over categories.
    """
    rows = [row for metric in METRICS for row in _rows(scores, metric)]
    table = pd.DataFrame(rows, columns=list(LONG_COLUMNS))
    return _in_order(table).reset_index(drop=True)


def wide_table(long: pd.DataFrame) -> pd.DataFrame:
    """Return the values with one column per category, as the paper prints them."""
    keys = ["task", "metric", "constraints"]
    wide = long.set_index([*keys, "category"])["value"].unstack()  # noqa: PD010
    wide = wide.reindex(columns=[*CATEGORIES, AVERAGE]).reset_index()
    return _in_order(wide.rename_axis(columns=None)).reset_index(drop=True)


def reasons_table(plans: pd.DataFrame) -> pd.DataFrame:
    """Return how many objects are not placed for which reason."""
    refused = plans[plans["status"] != PLACED]
    counts = refused.groupby(["task", "constraints", "reason"]).size()
    return _in_order(counts.rename("n").reset_index())


def paired_table(rng: Generator, scores: pd.DataFrame) -> pd.DataFrame:
    """Return ratios of errors over the objects that are placed under both constraints.

    With the interval that drawing scenes with replacement gives.
    """
    rows = []
    for task in sorted(set(scores["task"]), reverse=True):
        of_task = scores[scores["task"] == task]
        for one, other in PAIRS:
            both = _placed_under_both(of_task, one, other)
            if both["method"].nunique() < 2:
                continue
            found, _, scenes = tables_by_scene(both, ["method"])
            weights = resamples(rng, len(scenes))
            for metric, measure in MEASURE_OF.items():
                side, other_side = (found[(m,)][measure] for m in (one, other))
                n, ratio = len(both) // 2, _ratio(side, other_side, weights)
                rows.append((task, metric, one, other, n, *ratio))
    return pd.DataFrame(rows, columns=list(PAIRED_COLUMNS))


def _ratio(one: Array, other: Array, weights: Array) -> tuple[float, ...]:
    """Return both averages, their ratio and the ends of its interval."""
    means = mean_of(one), mean_of(other)
    with np.errstate(divide="ignore", invalid="ignore"):  # all errors may be 0
        resampled = average(one, weights) / average(other, weights)
        ratio = float(np.divide(*means))
    finite = resampled[np.isfinite(resampled)]
    if one.shape[1] < 2 or len(finite) == 0:
        return (*means, ratio, np.nan, np.nan)
    outside = (1 - LEVEL) / 2
    low, high = np.quantile(finite, [outside, 1 - outside])
    return (*means, ratio, float(low), float(high))


def _placed_under_both(scores: pd.DataFrame, one: str, other: str) -> pd.DataFrame:
    """Return the scores of the objects that are placed under both constraints."""
    keys = ["scene", "labels", "object"]
    pair = scores[scores["method"].isin([one, other])].dropna(
        subset=["location_error_m"]
    )
    return pair[pair.groupby(keys)["method"].transform("nunique") == 2]


def _rows(scores: pd.DataFrame, metric: str) -> Iterator[tuple[object, ...]]:
    """Yield the rows of the long table about one metric."""
    if metric == "placed_percent":
        is_placed = 100.0 * (scores["status"] == PLACED)
        scores = scores.assign(location_error_m=is_placed)
    measure = MEASURE_OF.get(metric, "location")
    known = scores.dropna(subset=["location_error_m"])
    keys = ["task", "method"]
    n = known.groupby([*keys, "category"]).size()
    tables, categories, _ = tables_by_scene(known, keys)
    for (task, method), of_key in tables.items():
        values = of_key[measure]
        for row, name in enumerate(categories):
            if np.isfinite(values[row]).any():
                only = values[[row]]
                found = mean_of(only), jackknife_se(only), n[task, method, name]
                yield (task, metric, method, name, *found)
        found = mean_of(values), jackknife_se(values), n[task, method].sum()
        yield (task, metric, method, AVERAGE, *found)


def _in_order(table: pd.DataFrame) -> pd.DataFrame:
    """Return rows in the order of the paper's table."""
    orders = {
        "task": ("filled", "empty"),
        "metric": METRICS,
        "constraints": CONSTRAINTS,
        "category": (*CATEGORIES, AVERAGE),
    }
    keys = [name for name in orders if name in table.columns]

    def place(column: pd.Series) -> pd.Series:
        order = list(orders[str(column.name)])
        return column.map(lambda value: order.index(value))

    return table.sort_values(keys, key=place, kind="stable")

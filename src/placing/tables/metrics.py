"""Errors between predicted and labelled placements, and their averages (Figure 6).

The location error is horizontal, as the height has its own; the error in space stands
beside it. Objects of one category are interchangeable and are matched to the labels
so that the sum of their location errors is smallest; heights and headings are compared
between those that are matched.

Shapes: n objects of one category.
"""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.tables.averages import jackknife_se, mean_of
from placing.tables.matching import match

Array = NDArray[np.float64]

ERRORS = ("location_error_m", "location3d_error_m", "height_error_m")
SCORE_COLUMNS = (
    *("dataset", "task", "method", "scene", "labels", "object", "category"),
    *("status", *ERRORS, "orientation_error_deg", "nll", "rank"),
)
MEASURES = {
    "location": "location_error_m",
    "location3d": "location3d_error_m",
    "height": "height_error_m",
    "nll": "nll",
    "orientation": "orientation_error_deg",
}
"""What is averaged, and its column in the table of scores."""
AVERAGE = "AVG"
"""The category of the rows that average over all categories."""
SUMMARY_COLUMNS = (
    *("dataset", "task", "method", "category", "n", "location_m", "location_se_m"),
    *("location3d_m", "height_m", "height_se_m", "nll", "nll_se"),
    *("orientation_deg", "orientation_se_deg", "unmixed"),
)
SE_OF = {
    "location_m": "location_se_m",
    "height_m": "height_se_m",
    "nll": "nll_se",
    "orientation_deg": "orientation_se_deg",
}
"""The column of the standard error of a column."""
DIAGNOSTICS_COLUMNS = ("scene", "task", "method", "question", "is_mixed")
CHAINS_OF = {"fmm": "fmm", "dp": "dp", "dp_object": "dp"}
"""The method whose chains a method with sampled poses reads."""


def errors(predicted: Array, labelled: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the prediction matched to each labelled object, and its errors.

    `predicted` and `labelled` (n, 3) locations of the objects of one category. The
    match (n,) indexes `predicted`; the errors (n, 3) are in the order of `ERRORS`.
    """
    matched = match_locations(predicted, labelled)
    return matched, distances(predicted[matched] - labelled)


def match_locations(predicted: Array, labelled: Array) -> NDArray[np.intp]:
    """Return the prediction matched to each labelled location, shape (n,)."""
    offset = predicted[:, None, :2] - labelled[None, :, :2]
    return match(np.hypot(offset[..., 0], offset[..., 1]))


def distances(offset: Array) -> Array:
    """Return the errors of offsets (n, 3) in the order of `ERRORS`, shape (n, 3)."""
    x, y, z = offset.T
    flat = np.hypot(x, y)
    return np.column_stack([flat, np.hypot(flat, z), np.abs(z)])


def summarise(
    scores: pd.DataFrame, diagnostics: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Return one row per dataset, task, method and category, and `AVG`.

    A scene's error of a category is the mean over its objects and labelled
    arrangements; the mean and its standard error are over scenes. `AVG` is the mean
    over categories, its standard error the jackknife over scenes. `diagnostics`, one
    row per question that has chains, give the share `unmixed` of the questions.
    """
    keys = ["dataset", "task", "method"]
    placed = scores.dropna(subset=["location_error_m"])
    n_placed = placed.groupby([*keys, "category"]).size()
    rows = []
    tables, categories, _ = tables_by_scene(scores, keys)
    for key, of_key in tables.items():
        counts = n_placed.loc[key]
        for category, n in counts.items():
            row = [categories.index(category)]
            here = {name: values[row] for name, values in of_key.items()}
            rows.append((*key, category, n, *_columns(here)))
        rows.append((*key, AVERAGE, counts.sum(), *_columns(of_key)))
    table = pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS[:-1]))
    shares = {} if diagnostics is None else unmixed(scores, diagnostics)
    named = zip(table["task"], table["method"], table["category"], strict=True)
    return table.assign(unmixed=[shares.get(key, np.nan) for key in named])


def tables_by_scene(
    scores: pd.DataFrame, keys: list[str]
) -> tuple[dict[Any, dict[str, Array]], list[str], list[str]]:
    """Return the mean of every measure by category and scene, each (c, s), per key.

    All tables have the categories and the scenes that are returned with them, sorted;
    what is not there, or was not placed, is NaN.
    """
    placed = scores.dropna(subset=["location_error_m"])
    columns = list(MEASURES.values())
    means = placed.groupby([*keys, "category", "scene"])[columns].mean()
    means = means.reset_index()
    categories, scenes = (sorted(set(means[axis])) for axis in ("category", "scene"))
    found = {}
    for key, of_key in means.groupby(keys):
        at = (
            pd.Index(categories).get_indexer(of_key["category"]),
            pd.Index(scenes).get_indexer(of_key["scene"]),
        )
        tables = {
            name: np.full((len(categories), len(scenes)), np.nan) for name in MEASURES
        }
        for name, column in MEASURES.items():
            tables[name][at] = of_key[column]
        found[key] = tables
    return found, categories, scenes


def unmixed(
    scores: pd.DataFrame, diagnostics: pd.DataFrame
) -> dict[tuple[str, str, str], float]:
    """Return the share of questions outside the gates by task, method and category.

    A question counts for every category that is wanted in it.
    """
    # The question of a score is named as in `placing.tasks`.
    is_filled = scores["task"] == "filled"
    named = (scores["labels"] + "/" + scores["category"]).where(is_filled, "all")
    chains = scores["method"].map(CHAINS_OF)
    asked = scores[["scene", "task", "method", "category"]]
    asked = asked.assign(question=named, chains=chains).dropna().drop_duplicates()
    found = diagnostics[list(DIAGNOSTICS_COLUMNS)].rename(columns={"method": "chains"})
    joined = asked.merge(found, on=["scene", "task", "chains", "question"])
    joined = joined.assign(is_unmixed=~joined["is_mixed"].astype(bool))
    every = joined.drop_duplicates(["scene", "task", "method", "question"])
    parts = pd.concat([joined, every.assign(category=AVERAGE)])
    return parts.groupby(["task", "method", "category"])["is_unmixed"].mean().to_dict()


def _columns(tables: dict[str, Array]) -> list[float]:
    """Return means and standard errors of tables (c, s) as the table has them."""
    mean = {name: mean_of(values) for name, values in tables.items()}
    se = {name: jackknife_se(values) for name, values in tables.items()}
    return [
        *(mean["location"], se["location"], mean["location3d"]),
        *(mean["height"], se["height"], mean["nll"], se["nll"]),
        *(mean["orientation"], se["orientation"]),
    ]

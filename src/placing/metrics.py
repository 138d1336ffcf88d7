"""Errors between predicted and labelled placements, and their averages (Figure 6).

The location error is horizontal, as the height has its own; the error in space stands
beside it. Objects of one category are interchangeable and are matched to the labels
so that the sum of their location errors is smallest.

Shapes: n objects of one category.
"""

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]

ERRORS = ("location_error_m", "location3d_error_m", "height_error_m")
SCORE_COLUMNS = (
    *("dataset", "task", "method", "scene", "labels", "object", "category"),
    *("status", *ERRORS, "nll"),
)


def errors(predicted: Array, labelled: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the prediction matched to each labelled object, and its errors.

    `predicted` and `labelled` (n, 3) locations of the objects of one category. The
    match (n,) indexes `predicted`; the errors (n, 3) are in the order of `ERRORS`.
    """
    offset = predicted[:, None] - labelled[None]  # (n, n, 3)
    horizontal = np.hypot(offset[..., 0], offset[..., 1])
    rows, columns = linear_sum_assignment(horizontal)
    match = rows[np.argsort(columns)]
    x, y, z = (predicted[match] - labelled).T
    flat = np.hypot(x, y)
    return match, np.column_stack([flat, np.hypot(flat, z), np.abs(z)])


def summarise(scores: pd.DataFrame) -> pd.DataFrame:
    """Return one row per dataset, task, method and category, and `AVG`.

    A scene's error of a category is the mean over its objects and labelled
    arrangements; the mean and its standard error are over scenes. `AVG` is the mean
    over categories, its standard error the jackknife over scenes.
    """
    keys = ["dataset", "task", "method"]
    placed = scores.dropna(subset=["location_error_m"])
    columns = [*ERRORS, "nll"]
    by_scene = placed.groupby([*keys, "category", "scene"])[columns].mean()
    rows = []
    for key, group in by_scene.groupby(level=keys):
        values = group.droplevel(keys)
        counts = placed.set_index(keys).loc[[key], "category"].value_counts()
        for category, of_category in values.groupby(level="category"):
            rows.append((*key, category, counts[category], *_mean_and_se(of_category)))
        rows.append((*key, "AVG", counts.sum(), *_average(values)))
    names = ["location_m", "location_se_m", "location3d_m", "height_m", "height_se_m"]
    return pd.DataFrame(rows, columns=[*keys, "category", "n", *names, "nll"])


def _mean_and_se(values: pd.DataFrame) -> list[float]:
    """Return the columns of the table for one category, over scenes."""
    mean, se = values.mean(), values.sem(ddof=1)
    return _columns(mean, se)


def _average(values: pd.DataFrame) -> list[float]:
    """Return the columns of the table for the mean over categories."""
    mean = values.groupby(level="category").mean().mean()
    scenes = values.index.get_level_values("scene")
    left_out = pd.DataFrame(
        [
            values[scenes != scene].groupby(level="category").mean().mean()
            for scene in scenes.unique()
        ]
    )
    n = len(left_out)
    se = np.sqrt((n - 1) / n * ((left_out - left_out.mean()) ** 2).sum())
    return _columns(mean, se if n > 1 else se * np.nan)


def _columns(mean: pd.Series, se: pd.Series) -> list[float]:
    """Return mean and standard error in the order of the table."""
    return [
        mean["location_error_m"],
        se["location_error_m"],
        mean["location3d_error_m"],
        mean["height_error_m"],
        se["height_error_m"],
        mean["nll"],
    ]

"""How well stability is known of objects, and of areas, that nobody learned from.

As the group's earlier papers report it: for the same areas and for new ones, whether
the best of the placements of an object in an area stays (precision at 1), how many of
the five best do, and the area under the ROC curve.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.psi.stability import (
    Models,
    StabilityConfig,
    StabilityModel,
    calibrated,
    fit_trees,
    log_psi_stability,
    sum_trees,
)
from placing.tables.report import row_of

Array = NDArray[np.float64]

SAME, NEW = "same area, new object", "new area, new object"
PROTOCOLS = (SAME, NEW)
REPORT_COLUMNS = (
    "protocol",
    "fixture",
    "n_trials",
    "base_rate",
    "auc",
    "precision_at_1",
    "precision_at_5",
    "calibration_error",
    "n_chosen",
    "chosen_stay",
)
N_BINS = 10
ALL = "all"


def models_without(
    names: Sequence[str],
    features: NDArray,
    table: pd.DataFrame,
    folds: NDArray[np.integer],
    protocol: str,
    config: StabilityConfig,
) -> Models:
    """Return for each kind and fold the model that saw neither of them, calibrated.

    Under the protocol `SAME` it saw the kind, with objects of other folds.
    """
    kinds, stays = table["fixture"].to_numpy(), table["stays"].to_numpy(bool)
    known = sorted(set(kinds))
    models: dict[tuple[str, int], StabilityModel] = {}
    for fold in range(config.n_folds):
        if protocol == SAME:
            used = folds != fold
            model = fit_trees(names, features[used], stays[used], config)
            models.update({(kind, fold): model for kind in known})
            continue
        for kind in known:
            used = (folds != fold) & (kinds != kind)
            models[kind, fold] = fit_trees(names, features[used], stays[used], config)
    sums = held_out(models, features, table, folds, sum_trees)
    # What calibrates a model are the held-out sums of the trials that it learned from.
    return {
        (kind, fold): calibrated(model, sums[used], stays[used])
        for (kind, fold), model in models.items()
        for used in [(folds != fold) & ((kinds != kind) | (protocol == SAME))]
    }


def held_out(
    models: Models,
    features: NDArray,
    table: pd.DataFrame,
    folds: NDArray[np.integer],
    score: Callable[[StabilityModel, NDArray], Array],
) -> Array:
    """Return the score of each trial by a model that did not see it, shape (c,)."""
    scores = np.zeros(len(table))
    for (kind, fold), model in models.items():
        rows = np.flatnonzero((table["fixture"] == kind) & (folds == fold))
        if len(rows):
            scores[rows] = score(model, features[rows])
    return scores


def report_of(
    models: Mapping[str, Models],
    features: NDArray,
    table: pd.DataFrame,
    folds: NDArray[np.integer],
    chosen: pd.DataFrame,
) -> pd.DataFrame:
    """Return the report on the models of each protocol and what is chosen by them."""
    rows = []
    for protocol, known in models.items():
        scores = held_out(known, features, table, folds, log_psi_stability)
        mine = chosen[chosen["protocol"] == protocol]
        rows += report_rows(protocol, table, scores, mine)
    return pd.DataFrame(rows, columns=list(REPORT_COLUMNS))


def report_rows(
    protocol: str, table: pd.DataFrame, scores: Array, chosen: pd.DataFrame
) -> list[dict[str, Any]]:
    """Return a row of the report for each kind of fixture and one for all."""
    rows = []
    for kind in [*sorted(set(table["fixture"])), ALL]:
        mine = (table["fixture"] == kind).to_numpy() | (kind == ALL)
        taken = chosen[(chosen["fixture"] == kind) | (kind == ALL)]
        part, part_scores = table[mine], scores[mine]
        stays = part["stays"].to_numpy(bool)
        values = {
            "protocol": protocol,
            "fixture": kind,
            "n_trials": len(part),
            "base_rate": stays.mean(),
            "auc": area_under_curve(part_scores, stays),
            "precision_at_1": precision_at(1, part, part_scores),
            "precision_at_5": precision_at(5, part, part_scores),
            "calibration_error": calibration_error(np.exp(part_scores), stays),
            "n_chosen": len(taken),
            "chosen_stay": taken["stays"].mean() if len(taken) else np.nan,
        }
        rows.append({column: values[column] for column in REPORT_COLUMNS})
    return rows


def area_under_curve(scores: Array, stays: NDArray[np.bool_]) -> float:
    """Return the chance that one that stays scores above one that does not."""
    n_good, n_bad = int(stays.sum()), int((~stays).sum())
    if n_good == 0 or n_bad == 0:
        return float("nan")
    order = pd.Series(scores).rank().to_numpy()
    return float((order[stays].sum() - n_good * (n_good + 1) / 2) / (n_good * n_bad))


def precision_at(n_best: int, table: pd.DataFrame, scores: Array) -> float:
    """Return the share of the best placements of an object on a kind that stay.

    Mean over the pairs of object and kind of which at least `n_best` trials stay and
    one does not: of the others nothing can be told.
    """
    ranked = table.assign(score=scores)[["fixture", "object", "score", "stays"]]
    shares = []
    for _, group in ranked.groupby(["fixture", "object"]):
        if group["stays"].sum() >= n_best and not group["stays"].all():
            best = group.sort_values("score", ascending=False, kind="stable")
            shares.append(best["stays"].head(n_best).mean())
    return float(np.mean(shares)) if shares else float("nan")


def calibration_error(probability: Array, stays: NDArray[np.bool_]) -> float:
    """Return the mean difference of probability and share that stays, over ten bins."""
    bins = np.minimum((probability * N_BINS).astype(int), N_BINS - 1)
    differences = [
        abs(probability[bins == b].sum() - stays[bins == b].sum()) for b in set(bins)
    ]
    return float(np.sum(differences) / len(stays))


def stability_markdown(report: pd.DataFrame) -> str:
    """Return the report as text for people, with what its columns mean."""
    shown = report.copy()
    for column in REPORT_COLUMNS[3:]:
        shown[column] = [_cell(column, value) for value in report[column]]
    heads = [name.replace("_", " ") for name in REPORT_COLUMNS]
    lines = [
        "# Stability of placements",
        "",
        row_of(heads),
        row_of(["---"] * len(heads)),
    ]
    lines += [row_of([str(value) for value in row]) for row in shown.to_numpy()]
    return "\n".join([*lines, "", *NOTES, ""])


def _cell(column: str, value: float) -> str:
    """Return a number as people read it; `-` where nothing can be told."""
    if not np.isfinite(value):
        return "-"
    return str(int(value)) if column == "n_chosen" else f"{value:.3f}"


NOTES = (
    "Every number is of objects that were not learned from; under `new area` the kind",
    "of fixture was not learned from either. Precision at 1 and 5: share of the best,",
    "and of the five best trials of an object on a kind of fixture that stay, over the",
    "pairs where so many stay and one does not. Chosen: the best of many fresh",
    "placements of each object on each kind of fixture, unless all are too unlikely to",
    "stay, settled again for the full time.",
)

"""How often the regions of each method hold the labelled object.

Regions are calibrated within the training scenes of a fold and measured in its test
scenes. The labelled objects of a scene are not independent, so the standard error is
over scenes.

Shapes: k labelled objects, l levels.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.errors import BadArtifact, BadInput, unknown
from placing.methods.answer_tables import REGION_COLUMNS
from placing.methods.regions import REGION_LEVELS, TOLERANCE, calibrate

Array = NDArray[np.float64]
Ranks = Mapping[str, Mapping[str, Array]]
"""Calibration ranks (n,) by task and method."""

LEVELS = np.arange(1, 20) / 20
"""Stated probabilities at which coverage is measured."""
AREA_COLUMNS = dict(zip(REGION_LEVELS, REGION_COLUMNS, strict=True))
"""Columns of the arrangements that hold the areas of regions, by level."""


def measure_coverage(
    scores: pd.DataFrame, fold_of: Mapping[str, int], calibration: Mapping[int, Ranks]
) -> pd.DataFrame:
    """Return one row per task, method and level for the one data set of `scores`.

    `coverage` is that of the calibrated regions, `coverage_as_stated` that of the
    places which hold the mass `level` of the density as it is; `share_everything` that
    of the objects which no region but everything holds.
    """
    datasets = sorted(set(scores["dataset"]))
    if len(datasets) != 1:
        raise BadInput(f"scores: dataset is {', '.join(datasets)}; expected one")
    ranked = scores.dropna(subset=["rank"])
    tables = []
    for (task, method), of in ranked.groupby(["task", "method"]):
        scenes = of["scene"].to_numpy()
        thresholds = _thresholds(calibration, str(task), str(method))
        limit = np.array([thresholds[_fold(fold_of, scene)] for scene in scenes])
        rank = of["rank"].to_numpy()[:, None]
        calibrated = _share_and_se(rank <= limit + TOLERANCE, scenes)
        as_stated = _share_and_se(rank <= LEVELS + TOLERANCE, scenes)
        columns = {"dataset": datasets[0], "task": task, "method": method}
        columns |= {"level": LEVELS, "n": len(of), "n_scenes": len(set(scenes))}
        columns |= {"coverage": calibrated[0], "coverage_se": calibrated[1]}
        columns |= {"coverage_as_stated": as_stated[0]}
        columns |= {"coverage_as_stated_se": as_stated[1]}
        columns |= {"share_everything": float((rank >= 1 - TOLERANCE).mean())}
        tables.append(pd.DataFrame(columns))
    if not tables:
        raise BadArtifact(
            "scores: no rank is a number; expected one per labelled object"
        )
    return pd.concat(tables, ignore_index=True)


def add_areas(coverage: pd.DataFrame, arrangements: pd.DataFrame) -> pd.DataFrame:
    """Return `coverage` with the mean area in m² of the regions of a wanted object."""
    names = list(AREA_COLUMNS.values())
    means = arrangements.groupby(["task", "method"])[names].mean()
    means.columns = list(AREA_COLUMNS)
    areas = means.melt(
        ignore_index=False, var_name="level", value_name="area_m2"
    ).reset_index()
    return coverage.merge(
        areas.astype({"level": float}), "left", ["task", "method", "level"]
    )


def folds_of(sheet: pd.DataFrame, dataset: str) -> dict[str, int]:
    """Return the fold of each scene of a data set, from the sheet of scenes."""
    rows = sheet[sheet["dataset"] == dataset]
    if rows.empty:
        raise unknown("data set", dataset, sorted(set(sheet["dataset"])))
    return dict(zip(rows["scene"], rows["fold"].astype(int), strict=True))


def read_calibration(document: object, file: str) -> Ranks:
    """Return what the tuning of a fold says under `calibration`, checked."""
    tasks = _mapping(document, file).get("calibration")
    found = {}
    for task, methods in _mapping(tasks, f"{file}: calibration").items():
        where = f"{file}: calibration.{task}"
        named = _mapping(methods, where).items()
        found[task] = {name: _ranks(v, f"{where}.{name}") for name, v in named}
    return found


def _thresholds(
    calibration: Mapping[int, Ranks], task: str, method: str
) -> dict[int, Array]:
    """Return the highest rank in the region of each level (l,) by fold."""
    found = {}
    for fold, ranks in calibration.items():
        of_task = ranks.get(task, {})
        if method not in of_task:
            raise BadArtifact(
                f"tuning of fold {fold}: calibration.{task}: key {method!r} is"
                f" missing; expected the ranks of every method that was scored"
            )
        found[fold] = calibrate(of_task[method], LEVELS)
    return found


def _fold(fold_of: Mapping[str, int], scene: str) -> int:
    """Return the fold of a scene."""
    if scene not in fold_of:
        raise unknown("scene in the scores:", scene, list(fold_of))
    return fold_of[scene]


def _share_and_se(
    is_inside: NDArray[np.bool_], scenes: Sequence[str] | NDArray[np.object_]
) -> tuple[Array, Array]:
    """Return the share (l,) of rows (k, l) and its standard error over scenes (l,)."""
    share = is_inside.mean(0)
    _, scene = np.unique(np.asarray(scenes, str), return_inverse=True)
    n = scene.max() + 1
    residual = np.zeros((n, is_inside.shape[1]))
    np.add.at(residual, scene, is_inside - share)
    if n < 2:
        return share, np.full(len(share), np.nan)
    return share, np.sqrt(n / (n - 1) * (residual**2).sum(0)) / len(is_inside)


def _mapping(value: object, where: str) -> dict[str, object]:
    """Return a value that is a mapping."""
    if not isinstance(value, dict):
        raise BadArtifact(f"{where}: value {_short(value)}; expected a mapping")
    return value


def _ranks(value: object, where: str) -> Array:
    """Return a value that is a list of ranks, shape (n,)."""
    if not isinstance(value, list):
        raise BadArtifact(f"{where}: value {_short(value)}; expected a list of ranks")
    for i, rank in enumerate(value):
        is_number = isinstance(rank, int | float) and not isinstance(rank, bool)
        if not (is_number and 0 <= rank <= 1):
            raise BadArtifact(
                f"{where}[{i}]: value {_short(rank)}; expected a rank from 0 to 1"
            )
    return np.array(value, float)


def _short(value: object) -> str:
    """Return a value on one line of bounded length."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."

"""Check the artifacts of a data set against claims, each a function of this file."""

import logging
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from command import run
from placing.artifacts.formats import read_json, read_table
from placing.errors import BadArtifact
from placing.methods.explanation import EXPLANATION_COLUMNS
from placing.tables.coverage import folds_of
from placing.tables.metrics import ERRORS, SCORE_COLUMNS

log = logging.getLogger(__name__)

TASKS = ("filled", "empty")
MIN_SUPPORTED = 0.95
"""Share of the objects of designers' rooms that rest on a placing area, at least."""
MOST_LINES = 20
"""So many broken claims are listed; the others are counted."""

Folds = dict[str, int]
"""The fold of every scene of the data set."""


def main(dataset: str, scenes_sheet: Path, results: Path, passed: Path) -> None:
    """Write the claims that hold, or fail with a line for each that does not.

    Args:
        dataset: Data set whose artifacts are checked.
        scenes_sheet: Sheet of all scenes.
        results: Directory of the results of the data set.
        passed: Text to write.
    """
    folds = folds_of(pd.read_csv(scenes_sheet), dataset)
    broken = [
        f"{claim.__name__}: {line}"
        for claim in CLAIMS
        for line in claim(results, folds)
    ]
    if broken:
        left = len(broken) - MOST_LINES
        more = [f"and {left} more"] if left > 0 else []
        raise BadArtifact("\n".join([*broken[:MOST_LINES], *more]))
    passed.parent.mkdir(parents=True, exist_ok=True)
    passed.write_text("".join(f"{claim.__name__}\n" for claim in CLAIMS))
    log.info("%s: %d claims hold", dataset, len(CLAIMS))


def scores_of(results: Path, folds: Folds) -> pd.DataFrame:
    """Return the scores of all tasks and folds."""
    paths = [
        results / "scores" / task / f"fold{fold}.parquet"
        for task in TASKS
        for fold in sorted(set(folds.values()))
    ]
    tables = [read_table(path, SCORE_COLUMNS) for path in paths]
    return pd.concat(tables, ignore_index=True)


def every_scene_is_scored_in_both_tasks(results: Path, folds: Folds) -> Iterator[str]:
    """Yield the scenes and tasks without a score."""
    scores = scores_of(results, folds)
    scored = set(zip(scores["scene"], scores["task"], strict=True))
    for scene in sorted(folds):
        for task in TASKS:
            if (scene, task) not in scored:
                yield f"{scene} has no {task} score"


def errors_are_lengths(results: Path, folds: Folds) -> Iterator[str]:
    """Yield the placed objects whose errors are negative or not finite."""
    scores = scores_of(results, folds)
    placed = scores[scores["status"] == "placed"]
    for name in ERRORS:
        values = placed[name].to_numpy(float)
        for row in placed[~(np.isfinite(values) & (values >= 0))].itertuples():
            yield f"{row.scene} {row.task} {row.method} {row.object}: {name}"


def unplaced_objects_have_no_error(results: Path, folds: Folds) -> Iterator[str]:
    """Yield the objects without a place that have an error nevertheless."""
    scores = scores_of(results, folds)
    unplaced = scores[scores["status"] != "placed"]
    for row in unplaced[unplaced[list(ERRORS)].notna().any(axis=1)].itertuples():
        yield f"{row.scene} {row.task} {row.method} {row.object}: {row.status}"


def nothing_is_learned_from_scenes_that_are_held_out(
    results: Path, folds: Folds
) -> Iterator[str]:
    """Yield what was learned from a scene of a fold that is held out."""
    for folder in sorted((results / "theta").glob("fold*")):
        held_out = {int(name.removeprefix("fold")) for name in folder.name.split("_")}
        for path in sorted(folder.glob("*.json")):
            for scene in read_json(path)["training_scenes"]:
                if folds.get(scene) in held_out | {None}:
                    yield f"{path} learned from {scene}"


def terms_of_explanations_are_finite(results: Path, folds: Folds) -> Iterator[str]:
    """Yield the explained objects with a term that is no number."""
    for path in sorted((results / "explanations").glob("*/*.parquet")):
        table = read_table(path, EXPLANATION_COLUMNS)
        for row in table[~np.isfinite(table["value"])].itertuples():
            yield f"{path}: {row.scene} {row.object}: {row.term}"


def every_scene_has_recordings(results: Path, folds: Folds) -> Iterator[str]:
    """Yield the recordings that are missing or empty."""
    for scene, fold in sorted(folds.items()):
        for task in TASKS:
            folder = results / "recordings" / f"fold{fold}" / task / "dp"
            path = folder / f"{scene}.rrd"
            if not path.exists() or path.stat().st_size == 0:
                yield f"{path} is missing or empty"


def designers_objects_are_supported(results: Path, folds: Folds) -> Iterator[str]:
    """Yield that too few objects rest on an area, and misses without a reason."""
    path = results / "checks" / "support.csv"
    if not path.exists():  # only the rooms of designers have this check
        return
    support = pd.read_csv(path, keep_default_na=False)
    missed = support[support["is_supported"].astype(str) != "True"]
    if len(missed) > (1 - MIN_SUPPORTED) * len(support):
        yield f"{path}: {len(missed)} of {len(support)} objects rest on no area"
    for row in missed[missed["reason"] == ""].itertuples():
        yield f"{path}: {row.scene} {row.object} rests on no area without a reason"


CLAIMS: tuple[Callable[[Path, Folds], Iterator[str]], ...] = (
    every_scene_is_scored_in_both_tasks,
    errors_are_lengths,
    unplaced_objects_have_no_error,
    nothing_is_learned_from_scenes_that_are_held_out,
    terms_of_explanations_are_finite,
    every_scene_has_recordings,
    designers_objects_are_supported,
)


if __name__ == "__main__":
    run(main)

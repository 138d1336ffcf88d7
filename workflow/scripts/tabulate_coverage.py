"""Tabulate how often the regions of each method hold the labelled object."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_json, read_table, write_csv
from placing.errors import BadInput
from placing.tables.coverage import (
    AREA_COLUMNS,
    add_areas,
    folds_of,
    measure_coverage,
    read_calibration,
)
from placing.tables.coverage_table import coverage_markdown
from placing.tables.report import write_text

RANK_COLUMNS = ("dataset", "task", "method", "scene", "rank")


def main(
    scores: tuple[Path, ...],
    tuning: tuple[Path, ...],
    scenes_sheet: Path,
    table: Path,
    markdown: Path,
    arrangements: tuple[Path, ...] = (),
) -> None:
    """Tabulate how often the regions of each method hold the labelled object.

    Args:
        scores: Scores of every fold and task of one data set (parquet).
        tuning: What was tuned in the training scenes of each fold, in order of folds.
        scenes_sheet: Sheet that gives the fold of each scene (CSV).
        table: Coverage by task, method and level to write (CSV).
        markdown: The same as a page.
        arrangements: Answers with the areas of regions (parquet); none, no areas.
    """
    scored = pd.concat([read_table(path, RANK_COLUMNS) for path in scores])
    fold_of = folds_of(pd.read_csv(scenes_sheet), scored["dataset"].iloc[0])
    folds = sorted(set(fold_of.values()))
    if len(folds) != len(tuning):
        raise BadInput(f"tuning: {len(tuning)} files; expected one for each of {folds}")
    calibration = {
        fold: read_calibration(read_json(path), str(path))
        for fold, path in zip(folds, tuning, strict=True)
    }
    coverage = measure_coverage(scored, fold_of, calibration)
    if arrangements:
        columns = ["task", "method", *AREA_COLUMNS.values()]
        answers = [read_table(path, columns) for path in arrangements]
        coverage = add_areas(coverage, pd.concat(answers))
    write_csv(table, coverage)
    write_text(markdown, coverage_markdown(coverage))


if __name__ == "__main__":
    run(main)

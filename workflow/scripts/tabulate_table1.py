"""Tabulate Table 1: errors with and without the constraints of the robot."""

import logging
from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.artifacts.plans import read_plans
from placing.artifacts.scenes import read_scene
from placing.plans.offering import OFFERED
from placing.seeds import generator
from placing.tables.report import write_text
from placing.tables.scoring import ANSWER_COLUMNS
from placing.tables.table1 import (
    long_table,
    paired_table,
    reasons_table,
    score_constraints,
    wide_table,
)
from placing.tables.table1_page import table1_markdown

log = logging.getLogger(__name__)


def main(
    dataset: str,
    scenes: tuple[Path, ...],
    arrangements: tuple[Path, ...],
    plans: tuple[Path, ...],
    paper: Path,
    seed: int,
    table: Path,
    long: Path,
    paired: Path,
    reasons: Path,
    markdown: Path,
) -> None:
    """Tabulate Table 1: errors with and without the constraints of the robot.

    Args:
        dataset: Data set of the scenes.
        scenes: Directories of the scenes, every fold.
        arrangements: What every method decides, every task and fold.
        plans: What the robot does, every fold.
        paper: Numbers of the paper.
        seed: Root of all random streams.
        table: Table to write (CSV), as the paper prints it.
        long: The same with standard errors and counts.
        paired: Ratios over the objects that are placed under both constraints.
        reasons: How many objects are not placed for which reason.
        markdown: All of it for people, beside the paper's numbers.
    """
    every = [read_table(path, [*ANSWER_COLUMNS, "task"]) for path in arrangements]
    answers = pd.concat(every, ignore_index=True)
    planned = pd.concat([read_plans(path) for path in plans], ignore_index=True)
    scores = scores_of(scenes, answers[answers["method"] == OFFERED], planned)
    values = long_table(scores)
    ratios = paired_table(generator(seed, "tabulate_table1", dataset), scores)
    why = reasons_table(planned)
    for path, found in zip(
        (table, long, paired, reasons),
        (wide_table(values), values, ratios, why),
        strict=True,
    ):
        write_csv(path, found)
    page = table1_markdown(dataset, values, ratios, why, pd.read_csv(paper))
    write_text(markdown, page)
    log.info("%s: %d placements compared", dataset, len(scores))


def scores_of(
    scenes: tuple[Path, ...], answers: pd.DataFrame, plans: pd.DataFrame
) -> pd.DataFrame:
    """Return the errors of the scenes in which the robot works."""
    parts = []
    for path in sorted(path for folder in scenes for path in folder.glob("*.json")):
        for task, of_task in plans[plans["scene"] == path.stem].groupby("task"):
            is_here = (answers["scene"] == path.stem) & (answers["task"] == task)
            scores = score_constraints(read_scene(path), answers[is_here], of_task)
            parts.append(scores.assign(task=task))
    return pd.concat(parts, ignore_index=True)


if __name__ == "__main__":
    run(main)

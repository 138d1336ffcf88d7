"""Tabulate Figure 6: errors per category and method, with standard errors."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.tables.metrics import DIAGNOSTICS_COLUMNS, SCORE_COLUMNS, summarise
from placing.tables.report import figure6_markdown, write_text


def main(
    scores: tuple[Path, ...],
    paper: Path,
    table: Path,
    markdown: Path,
    diagnostics: tuple[Path, ...] = (),
) -> None:
    """Tabulate Figure 6: errors per category and method, with standard errors.

    Args:
        scores: Scores of one data set, every task and fold.
        paper: Numbers of the paper.
        table: Table to write (CSV).
        markdown: The same for people, beside the paper's numbers.
        diagnostics: Diagnostics of the chains behind the scores, every task and fold.
    """
    tables = [read_table(path, SCORE_COLUMNS) for path in scores]
    chains = [read_table(path, DIAGNOSTICS_COLUMNS) for path in diagnostics]
    figure6 = summarise(
        pd.concat(tables, ignore_index=True),
        pd.concat(chains, ignore_index=True) if chains else None,
    )
    write_csv(table, figure6)
    write_text(markdown, figure6_markdown(figure6, pd.read_csv(paper)))


if __name__ == "__main__":
    run(main)

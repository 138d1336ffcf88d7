"""Tabulate Figure 6: errors per category and method, with standard errors."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.metrics import SCORE_COLUMNS, summarise
from placing.report import figure6_markdown, write_text


def main(scores: tuple[Path, ...], paper: Path, table: Path, markdown: Path) -> None:
    """Tabulate Figure 6: errors per category and method, with standard errors."""
    tables = [read_table(path, SCORE_COLUMNS) for path in scores]
    figure6 = summarise(pd.concat(tables, ignore_index=True))
    write_csv(table, figure6)
    write_text(markdown, figure6_markdown(figure6, pd.read_csv(paper)))


if __name__ == "__main__":
    run(main)

"""Average the errors of one fold."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.tables.metrics import SCORE_COLUMNS, summarise


def main(scores: tuple[Path, ...], summary: Path) -> None:
    """Average the errors of one fold."""
    tables = [read_table(path, SCORE_COLUMNS) for path in scores]
    write_csv(summary, summarise(pd.concat(tables, ignore_index=True)))


if __name__ == "__main__":
    run(main)

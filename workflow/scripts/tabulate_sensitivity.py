"""Tabulate how the errors change with the numbers that were chosen."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.seeds import generator
from placing.tables.metrics import SCORE_COLUMNS
from placing.tables.report import write_text
from placing.tables.sensitivity import compare_variations
from placing.tables.sensitivity_table import sensitivity_markdown


def main(scores: tuple[Path, ...], seed: int, table: Path, markdown: Path) -> None:
    """Tabulate how the errors change with the numbers that were chosen.

    Args:
        scores: Scores of one data set with a column `variation`, every fold.
        seed: Root of the random streams.
        table: Table to write (CSV).
        markdown: The same for people.
    """
    columns = (*SCORE_COLUMNS, "variation")
    tables = [read_table(path, columns) for path in scores]
    found = pd.concat(tables, ignore_index=True)
    dataset = found["dataset"].iloc[0]
    rng = generator(seed, "tabulate_sensitivity", dataset)
    variations = compare_variations(rng, found)
    write_csv(table, variations)
    write_text(markdown, sensitivity_markdown(variations))


if __name__ == "__main__":
    run(main)

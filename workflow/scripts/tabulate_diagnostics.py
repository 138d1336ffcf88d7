"""Tabulate how far the chains of every task and method agree, and where they do not."""

from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.people.diagnostics import DIAGNOSTIC_COLUMNS, DiagnosticsConfig
from placing.tables.diagnostics_table import (
    diagnostics_markdown,
    summarise_diagnostics,
    worst_scenes,
)
from placing.tables.report import write_text


def main(
    dataset: str,
    questions: tuple[Path, ...],
    table: Path,
    markdown: Path,
    diagnostics: DiagnosticsConfig,
) -> None:
    """Tabulate how far the chains of every task and method agree.

    Args:
        dataset: Name of the data set.
        questions: Diagnostics of the questions of every fold and task (parquet).
        table: Medians and worst values by task and method to write (CSV).
        markdown: The same as a page, with the worst scenes.
        diagnostics: Gates of the diagnostics.
    """
    tables = [read_table(path, DIAGNOSTIC_COLUMNS) for path in questions]
    found = pd.concat(tables, ignore_index=True)
    summary = summarise_diagnostics(found, dataset)
    write_csv(table, summary)
    worst = worst_scenes(found, diagnostics)
    write_text(markdown, diagnostics_markdown(summary, worst, diagnostics))


if __name__ == "__main__":
    run(main)

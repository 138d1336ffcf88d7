"""Draw measured against stated probability of the regions of all methods."""

from pathlib import Path

import pandas as pd

from command import run
from placing.tables.coverage_figure import plot_coverage
from placing.tables.figures import save_figure


def main(table: Path, png: Path, svg: Path) -> None:
    """Read the table of coverage and draw it.

    Args:
        table: Coverage of one data set by task, method and level (CSV).
        png: Picture to write.
        svg: The same picture as vectors.
    """
    figure = plot_coverage(pd.read_csv(table))
    for path in (png, svg):
        save_figure(figure, path)


if __name__ == "__main__":
    run(main)

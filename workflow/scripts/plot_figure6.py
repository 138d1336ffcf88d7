"""Draw the errors of all methods per category, as in the paper's Figure 6."""

from pathlib import Path

import pandas as pd

from command import run
from placing.tables.figures import plot_figure6, save_figure


def main(table: Path, task: str, png: Path, svg: Path) -> None:
    """Read the table of errors and draw one task.

    Args:
        table: Errors of every data set, task, method and category (CSV).
        task: `filled` or `empty`.
        png: Picture to write.
        svg: The same picture as vectors.
    """
    figure = plot_figure6(pd.read_csv(table), task)
    for path in (png, svg):
        save_figure(figure, path)


if __name__ == "__main__":
    run(main)

"""Write the results of a run into the README, between their markers."""

import re
from pathlib import Path

import pandas as pd

from command import run
from placing.tables.readme_tables import (
    execution_summary,
    table1_averages,
    table2_averages,
)
from placing.tables.report import averages_by_task, write_text


def main(
    figure6: tuple[Path, ...],
    table1: tuple[Path, ...],
    table2: Path,
    execution: Path,
    paper: Path,
    readme: Path,
) -> None:
    """Write the results of a run into the README.

    Args:
        figure6: Tables of Figure 6, one per data set.
        table1: Long tables of Table 1, results/{dataset}/tables/table1_long.csv.
        table2: Table 2.
        execution: Where the objects of the scenarios came to rest.
        paper: Numbers of the paper.
        readme: File whose parts between markers such as `<!-- figure6 -->` are
            replaced.
    """
    published = pd.read_csv(paper)
    longs = {path.parent.parent.name: pd.read_csv(path) for path in table1}
    parts = {
        "figure6": averages_by_task(pd.concat([pd.read_csv(path) for path in figure6])),
        "table1": table1_averages(longs, published),
        "execution": execution_summary(pd.read_csv(execution)),
        "table2": table2_averages(pd.read_csv(table2), published),
    }
    text = readme.read_text()
    for name, part in parts.items():
        text = replace_part(text, name, part)
    write_text(readme, text)


def replace_part(text: str, name: str, part: str) -> str:
    """Return the text with the part between the markers of `name` replaced."""
    pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
    return re.sub(pattern, lambda m: f"{m[1]}{part}\n{m[2]}", text, flags=re.DOTALL)


if __name__ == "__main__":
    run(main)

"""Write the results of a run into the README, between their markers."""

import re
from pathlib import Path

import pandas as pd

from command import run
from placing.report import averages_by_task, write_text


def main(figure6: tuple[Path, ...], readme: Path) -> None:
    """Write the results of a run into the README.

    Args:
        figure6: Tables of Figure 6, one per data set.
        readme: File whose part between the `<!-- results -->` markers is replaced.
    """
    tables = pd.concat([pd.read_csv(path) for path in figure6])
    text = readme.read_text()
    text = replace_part(text, "results", averages_by_task(tables))
    write_text(readme, text)


def replace_part(text: str, name: str, part: str) -> str:
    """Return the text with the part between the markers of `name` replaced."""
    pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
    return re.sub(pattern, lambda m: f"{m[1]}{part}\n{m[2]}", text, flags=re.DOTALL)


if __name__ == "__main__":
    run(main)

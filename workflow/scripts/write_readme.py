"""Write the results and the time of a run into the README, between their markers."""

import re
from pathlib import Path
from typing import Any

import pandas as pd

from command import run
from placing.artifacts.formats import read_json
from placing.report import averages_by_task, write_text


def main(figure6: tuple[Path, ...], described: Path, readme: Path) -> None:
    """Write the results and the time of a run into the README.

    Args:
        figure6: Tables of Figure 6, one per data set.
        described: Record of the run.
        readme: File whose parts between `<!-- results -->` and `<!-- timing -->`
            markers are replaced.
    """
    tables = pd.concat([pd.read_csv(path) for path in figure6])
    text = readme.read_text()
    text = replace_part(text, "results", averages_by_task(tables))
    text = replace_part(text, "timing", timing(read_json(described)))
    write_text(readme, text)


def replace_part(text: str, name: str, part: str) -> str:
    """Return the text with the part between the markers of `name` replaced."""
    pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
    return re.sub(pattern, lambda m: f"{m[1]}{part}\n{m[2]}", text, flags=re.DOTALL)


def timing(record: dict[str, Any]) -> str:
    """Return time and memory per rule, with the machine they were measured on."""
    machine, rules = record["machine"], record["rules"]
    total = sum(rule["seconds"] for rule in rules.values())
    lines = [
        f"The jobs of a run of both data sets took {total:.0f} seconds together, "
        f"two at a time, on {machine['processor']} ({machine['cores']} cores, "
        f"{machine['memory_mb'] / 1024:.0f} GiB); from `results/run.json`:",
        "",
        "| rule | jobs | seconds | most memory [MB] |",
        "|-|-:|-:|-:|",
    ]
    for name, rule in sorted(rules.items()):
        memory = f"{rule['max_rss_mb']:.0f}"
        cells = [f"`{name}`", str(rule["jobs"]), f"{rule['seconds']:.0f}", memory]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    run(main)

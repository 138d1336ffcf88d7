"""The errors under other settings as a Markdown page."""

import pandas as pd

from placing.tables.averages import N_RESAMPLES
from placing.tables.report import DATA, TITLES, row_of, with_error
from placing.tables.sensitivity import BASE

NOTE = (
    "The same scenes arranged again with one number of `config/config.yaml` changed at "
    "a time. Mean over categories ± standard error over scenes; beside it the "
    f"difference to `{BASE}`, the configuration, with the 95 % interval of a paired "
    f"bootstrap over scenes ({N_RESAMPLES:,} resamples). An asterisk marks intervals "
    "without zero. The configuration was not chosen by this table, and no correction "
    "is made for the number of comparisons."
)
METRICS = {
    "location [m]": ("location_m", 2),
    "height [m]": ("height_m", 3),
    "nll": ("nll", 2),
}


def sensitivity_markdown(table: pd.DataFrame) -> str:
    """Return the page for the one data set of the table."""
    dataset = table["dataset"].iloc[0]
    parts = [f"# What the numbers depend on, data set `{dataset}`", DATA[dataset], NOTE]
    heads = ["method", "variation"]
    heads += [h for name in METRICS for h in (name, "difference")] + ["scenes"]
    for task, title in TITLES.items():
        of_task = table[table["task"] == task]
        lines = [row_of(heads), "|:-|:-|" + "-:|" * (len(heads) - 2)]
        for _, row in of_task.iterrows():
            cells = [f"`{row['method']}`", f"`{row['variation']}`"]
            for column, digits in METRICS.values():
                cells.append(with_error(row[column], row[f"{column}_se"], digits))
                cells.append(_difference(row, column, digits))
            lines.append(row_of([*cells, f"{row['n_scenes']}"]))
        if len(of_task):
            parts += [f"## {title}", "\n".join(lines)]
    return "\n\n".join(parts) + "\n"


def _difference(row: pd.Series, column: str, digits: int) -> str:
    """Return the difference to `base` and its interval."""
    keys = [f"{column}_{name}" for name in ("difference", "low", "high")]
    if row["variation"] == BASE or pd.isna(row[keys[0]]):
        return "–"
    found, low, high = (f"{row[key]:+.{digits}f}".replace("-", "−") for key in keys)
    if pd.isna(row[keys[1]]):
        return found
    mark = "*" if row[keys[1]] > 0 or row[keys[2]] < 0 else ""
    return f"{found} [{low}, {high}]{mark}".replace("*", "\\*")

"""Figure 6 as a Markdown page: our numbers, and what the paper says beside them."""

from pathlib import Path

import pandas as pd

from placing.artifacts.atomic import replacing
from placing.methods.names import ORDER
from placing.tables.metrics import AVERAGE, SE_OF

DATA = {
    "rooms": "Data set `rooms`: 20 rooms, 47 objects and four arrangements of each "
    "room, written for this project by language models after the protocol of the "
    "paper. They are not the paper's data, and no human subjects took part.",
    "thor": "Data set `thor`: rooms of AI2-THOR and RoboTHOR, made by professional "
    "designers for another purpose (package `procthor`, Apache-2.0). They are not the "
    "paper's data; the designers' own arrangement is the only answer, so there is no "
    "spread between labels. The five arrangements of an apartment plan count as five "
    "scenes.",
}
TITLES = {"filled": "Arranging filled rooms", "empty": "Arranging empty rooms"}
NOTE = (
    "Location is the horizontal error, height the vertical one, both in metres, and "
    "orientation the angle between the headings, in degrees, of objects that have a "
    "front; mean ± standard error over scenes. `nll` is the negative log of the "
    "density that a method gives to the labelled place, in nats of a density per "
    "square metre. `AVG` is the mean over categories, n counts objects and the "
    "labelled arrangements they are compared with. `labels` compares one labelled "
    "arrangement with another: no method can be expected to come below it."
)
MARK = "†"
"""Marks numbers that rest in part on chains outside the gates of the diagnostics."""
AVERAGES = {
    "location [m]": ("location_m", 2),
    "location 3-D [m]": ("location3d_m", 2),
    "height [m]": ("height_m", 3),
    "orientation [°]": ("orientation_deg", 0),
    "nll": ("nll", 2),
}
"""Columns of the table by method: their title, column and digits."""
BY_CATEGORY = {
    "Location error [m]": ("location_m", 2),
    "Height error [m]": ("height_m", 2),
}
"""Tables by category."""


def figure6_markdown(figure6: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the page for the one data set of `figure6`."""
    dataset = figure6["dataset"].iloc[0]
    parts = [f"# Figure 6 on `{dataset}`", DATA[dataset], NOTE]
    for task, title in TITLES.items():
        of_task = figure6[figure6["task"] == task]
        said = paper[(paper["task"] == task) & (paper["constraints"] == "without")]
        parts += [f"## {title}", _averages(of_task, said), *footnote(of_task)]
        for name, (column, digits) in BY_CATEGORY.items():
            published = said[(said["metric"] == column) & (said["source"] == "Table 1")]
            values = published.set_index("category")["value"]
            parts += [f"### {name} by category: {title.lower()}"]
            parts += [_by_category(of_task, column, digits, values)]
    parts.append(
        "*paper*: what Table 1 of the paper says of its own method with human context, "
        "without constraints of a robot, in its own rooms; it has 11 categories. Each "
        "sentence of the paper that compares methods is tested in `claims.md`."
    )
    return "\n\n".join(parts) + "\n"


def averages_by_task(figure6: pd.DataFrame) -> str:
    """Return the averages of every data set and task as one Markdown table."""
    heads = ["data set", "task", "method", *AVERAGES, "n"]
    del heads[heads.index("location 3-D [m]")]
    lines = [row_of(heads), "|-|-|-|" + "-:|" * (len(heads) - 3)]
    average = figure6[figure6["category"] == AVERAGE]
    for dataset in sorted(average["dataset"].unique()):
        for task in TITLES:
            is_here = (average["dataset"] == dataset) & (average["task"] == task)
            for _, row in in_order(average[is_here]).iterrows():
                cells = [f"`{name}`" for name in (dataset, task, row["method"])]
                cells += [_cell(row, *AVERAGES[head]) for head in heads[3:-1]]
                lines.append(row_of([*cells, f"{row['n']:.0f}"]))
    return "\n\n".join(["\n".join(lines), NOTE, *footnote(average)])


def in_order(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows in the order of the methods."""
    at = {method: number for number, method in enumerate(ORDER)}
    return rows.sort_values("method", key=lambda names: names.map(at), kind="stable")


def footnote(figure6: pd.DataFrame) -> list[str]:
    """Return what share of the questions is outside the gates, if any is."""
    average = figure6[(figure6["category"] == AVERAGE) & (figure6["unmixed"] > 0)]
    if average.empty:
        return []
    shares = in_order(average).groupby("method", sort=False)["unmixed"]
    said = [
        f"{_range(100 * of_method)} % of the questions to `{method}`"
        for method, of_method in shares
    ]
    return [
        f"{MARK} Rests in part on chains outside the gates of the diagnostics: "
        f"{', '.join(said)}. These are counted like all others; the share in each "
        "category is the column `unmixed` of `figure6.csv`, and `diagnostics.md` says "
        "which they are."
    ]


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all."""
    with replacing(path) as part:
        part.write_text(text)


def row_of(cells: list[str]) -> str:
    """Return cells as a row of a Markdown table."""
    return f"| {' | '.join(cells)} |"


def with_error(value: float, error: float, digits: int = 2) -> str:
    """Return mean ± standard error, the mean alone without one, or a dash."""
    if pd.isna(value):
        return "–"
    shown = f"{value:.{digits}f}"
    return shown if pd.isna(error) else f"{shown} ± {error:.{digits}f}"


def _averages(figure6: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the table of the methods' averages and the paper's."""
    heads = ["method", *AVERAGES, "n"]
    lines = [row_of(heads), "|:-|" + "-:|" * (len(heads) - 1)]
    for _, row in in_order(figure6[figure6["category"] == AVERAGE]).iterrows():
        cells = [_cell(row, *of) for of in AVERAGES.values()]
        lines.append(row_of([f"`{row['method']}`", *cells, f"{row['n']:.0f}"]))
    said = paper[paper["category"] == AVERAGE].set_index("metric")["value"]
    location, height = f"within {said['location_m']}", f"about {said['height_m']}"
    cells = [location, "–", height, *["–"] * 3]
    lines.append(row_of(["*paper, human context, its data*", *cells]))
    return "\n".join(lines)


def _by_category(
    figure6: pd.DataFrame, column: str, digits: int, paper: pd.Series
) -> str:
    """Return the table of one error by category and method, the paper's beside."""
    methods = [m for m in ORDER if m in set(figure6["method"])]
    heads = ["category", "n", *(f"`{method}`" for method in methods), "*paper*"]
    lines = [row_of(heads), "|:-|" + "-:|" * (len(heads) - 1)]
    rows = {(row["category"], row["method"]): row for _, row in figure6.iterrows()}
    names = sorted(set(figure6["category"]), key=lambda name: (name == AVERAGE, name))
    answered = figure6[figure6["method"] != "labels"]
    n = answered.groupby("category")["n"].max()
    for name in names:
        found = [rows.get((name, method)) for method in methods]
        cells = ["–" if row is None else _cell(row, column, digits) for row in found]
        theirs = f"{paper[name]:.2f}" if name in paper.index else "–"
        label = f"**{name}**" if name == AVERAGE else name
        lines.append(row_of([label, f"{n.get(name, 0):.0f}", *cells, theirs]))
    return "\n".join(lines)


def _cell(row: pd.Series, column: str, digits: int) -> str:
    """Return a number with its standard error and the mark it deserves."""
    error = row[SE_OF[column]] if column in SE_OF else float("nan")
    shown = with_error(row[column], error, digits)
    return f"{shown} {MARK}" if row["unmixed"] > 0 and shown != "–" else shown


def _range(values: pd.Series) -> str:
    """Return one number, or the least and the greatest of several that differ."""
    ends = [f"{values.min():.1f}", f"{values.max():.1f}"]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)

"""Figure 6 as a Markdown page: our numbers, and what the paper says beside them."""

from pathlib import Path

import pandas as pd

from placing.artifacts.atomic import replacing

DATA = {
    "rooms": "Data set `rooms`: 20 rooms, 47 objects and their arrangements, written "
    "for this project after the protocol of the paper. They are not the paper's data, "
    "and no human subjects took part.",
    "thor": "Data set `thor`: rooms of AI2-THOR and RoboTHOR, made by professional "
    "designers for another purpose (package `procthor`, Apache-2.0). They are not the "
    "paper's data; the designers' own arrangement is the only answer, so there is no "
    "spread between labels.",
}
TITLES = {"filled": "Arranging filled rooms", "empty": "Arranging empty rooms"}
ORDER = (
    *("chance", "height", "room", "area", "random_human"),
    *("object", "fmm", "dp", "dp_object", "labels"),
)
"""Methods in the order of the paper's Figure 6; `labels` is the labels' spread."""
NOTE = (
    "Location is the horizontal error, height the vertical one, both in metres, mean "
    "± standard error over scenes; `nll` is the negative log of the density that a "
    "method gives to the labelled place, in nats of a density per square metre. "
    "`AVG` is the mean over categories. `labels` compares one labelled arrangement "
    "with another: no method can be expected to come below it."
)
CLAIMS = (
    ("filled", "dp", "chance", "human context beats chance"),
    ("filled", "dp", "height", "human context beats `height`"),
    ("filled", "dp", "room", "human context beats a place relative to the room"),
    ("empty", "dp", "chance", "human context beats chance"),
    ("empty", "dp", "height", "human context beats `height`"),
    ("empty", "dp", "room", "human context beats a place relative to the room"),
)
"""What Section 4.1 says of methods that are compared here: task, better, worse."""


def figure6_markdown(figure6: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the page for the one data set of `figure6`."""
    dataset = figure6["dataset"].iloc[0]
    parts = [f"# Figure 6 on `{dataset}`", DATA[dataset], NOTE]
    for task, title in TITLES.items():
        of_task = figure6[figure6["task"] == task]
        published = paper[(paper["task"] == task) & (paper["constraints"] == "without")]
        parts += [f"## {title}", _averages(of_task, published)]
        parts += [f"### `dp` by category: {title.lower()}"]
        parts += [_categories(of_task, published)]
    parts += ["## What the paper says of these methods", _claims(figure6)]
    return "\n\n".join(parts) + "\n"


def averages_by_task(figure6: pd.DataFrame) -> str:
    """Return the averages of every data set and task as one Markdown table."""
    lines = ["| data set | task | method | location [m] | height [m] | nll | n |"]
    lines += ["|-|-|-|-:|-:|-:|-:|"]
    average = figure6[figure6["category"] == "AVG"]
    for dataset in sorted(average["dataset"].unique()):
        for task in TITLES:
            of_task = average[
                (average["dataset"] == dataset) & (average["task"] == task)
            ]
            named = of_task.set_index("method")
            for method in (m for m in ORDER if m in named.index):
                row = named.loc[method]
                cells = [f"`{name}`" for name in (dataset, task, method)]
                cells += [_with_error(row["location_m"], row["location_se_m"])]
                cells += [_with_error(row["height_m"], row["height_se_m"], 3)]
                cells += [_number(row["nll"]), f"{row['n']:.0f}"]
                lines.append(f"| {' | '.join(cells)} |")
    return "\n".join([*lines, "", NOTE])


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all."""
    with replacing(path) as part:
        part.write_text(text)


def _averages(figure6: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the table of the methods' averages and the paper's."""
    lines = ["| method | location [m] | location 3-D [m] | height [m] | nll | n |"]
    lines += ["|:-|-:|-:|-:|-:|-:|"]
    average = figure6[figure6["category"] == "AVG"].set_index("method")
    for method in (m for m in ORDER if m in average.index):
        row = average.loc[method]
        nll = _number(row["nll"])
        location = _with_error(row["location_m"], row["location_se_m"])
        height = _with_error(row["height_m"], row["height_se_m"], 3)
        space = f"{row['location3d_m']:.2f}"
        cells = [f"`{method}`", location, space, height, nll, f"{row['n']:.0f}"]
        lines.append(f"| {' | '.join(cells)} |")
    said = paper[paper["category"] == "AVG"].set_index("metric")["value"]
    location, height = f"within {said['location_m']}", f"about {said['height_m']}"
    cells = ["*paper, human context (its data)*", location, "–", height, "–", "–"]
    lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _categories(figure6: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the table of the categories under `dp` beside the paper's Table 1."""
    lines = ["| category | n | location [m] | paper | height [m] | paper | nll |"]
    lines += ["|:-|-:|-:|-:|-:|-:|-:|"]
    published = paper[paper["source"] == "Table 1"]
    values = published.set_index(["category", "metric"])["value"].to_dict()
    of_dp = figure6[(figure6["method"] == "dp") & (figure6["category"] != "AVG")]
    for _, row in of_dp.sort_values("category").iterrows():
        name = row["category"]
        location = _with_error(row["location_m"], row["location_se_m"])
        height = _with_error(row["height_m"], row["height_se_m"], 3)
        theirs = [values.get((name, m)) for m in ("location_m", "height_m")]
        paper_cells = ["–" if v is None else f"{v:.2f}" for v in theirs]
        cells = [name, f"{row['n']:.0f}", location, paper_cells[0]]
        cells += [height, paper_cells[1], f"{row['nll']:.2f}"]
        lines.append(f"| {' | '.join(cells)} |")
    lines += ["", "Paper: Table 1 without constraints, its own rooms; 11 categories."]
    return "\n".join(lines)


def _claims(figure6: pd.DataFrame) -> str:
    """Return one line per claim with both averages; intervals are not yet computed."""
    average = figure6[figure6["category"] == "AVG"].set_index(["task", "method"])
    lines = ["| task | claim | location [m] | nll |", "|:-|:-|-:|-:|"]
    for task, better, worse, claim in CLAIMS:
        a, b = average.loc[(task, better)], average.loc[(task, worse)]
        location = f"{a['location_m']:.2f} against {b['location_m']:.2f}"
        nll = f"{a['nll']:.2f} against {b['nll']:.2f}"
        lines.append(f"| {task} | {claim} | {location} | {nll} |")
    return "\n".join(lines)


def _with_error(value: float, error: float, digits: int = 2) -> str:
    """Return mean ± standard error, the mean alone where there is no error."""
    shown = f"{value:.{digits}f}"
    return shown if pd.isna(error) else f"{shown} ± {error:.{digits}f}"


def _number(value: float) -> str:
    """Return a number with two decimals, a dash where there is none."""
    return "–" if pd.isna(value) else f"{value:.2f}"

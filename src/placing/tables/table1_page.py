"""Table 1 as a Markdown page: our numbers, and the paper's beside them."""

import pandas as pd

from placing.plans.robot_plans import CONSTRAINTS, INSIDE, WITH, WITHOUT
from placing.tables.metrics import AVERAGE
from placing.tables.report import DATA, TITLES, row_of, with_error
from placing.tables.table1 import CATEGORIES

NOTE = (
    "Errors in metres as in Figure 6, over the objects that the robot can carry; mean "
    "± standard error over scenes, `AVG` is the mean over categories. `without`: what "
    "`dp` decides without a robot. `with`: the paper's way, arranged without regard to "
    "the robot, then filtered; the best placement that survives counts. `inside`: "
    "chosen by the same density among all placements that the robot can carry out. "
    "An object for which no placement is left is not placed: it has no error and is "
    "counted, so the rows are not about the same objects; the ratios below are. Every "
    "motion that counts was planned for the PR2 in the point cloud and accepted by the "
    "exact check among the true furniture."
)
PAPER_NOTE = (
    "*paper*: its Table 1, in its own rooms. Its last column is lost in print (12 "
    "heads and 11 numbers in every row); its `AVG` is recomputed here as the mean of "
    "the 11."
)
UNITS = {"location_m": "Location error [m]", "height_m": "Height error [m]"}
DIGITS = {"location_m": 2, "height_m": 3, "placed_percent": 0}


def table1_markdown(
    dataset: str,
    long: pd.DataFrame,
    paired: pd.DataFrame,
    reasons: pd.DataFrame,
    paper: pd.DataFrame,
) -> str:
    """Return the page for one data set."""
    parts = [f"# Table 1 on `{dataset}`", DATA[dataset], NOTE, PAPER_NOTE]
    published = paper[paper["source"] == "Table 1"]
    for task, title in TITLES.items():
        of_task = long[long["task"] == task]
        said = published[published["task"] == task]
        parts += [f"## {title}"]
        for metric, name in UNITS.items():
            ours = of_task[of_task["metric"] == metric]
            parts += [f"### {name}: {title.lower()}"]
            parts += [_errors(ours, said[said["metric"] == metric], DIGITS[metric])]
        share = of_task[of_task["metric"] == "placed_percent"]
        parts += [f"### Objects placed [%]: {title.lower()}"]
        parts += [_errors(share, said.iloc[:0], DIGITS["placed_percent"])]
    parts += ["## The same objects under both", _ratios(paired, published)]
    parts += ["## Why objects are not placed", _reasons(reasons)]
    return "\n\n".join(parts) + "\n"


def recomputed(paper: pd.DataFrame, task: str, metric: str, constraints: str) -> float:
    """Return the paper's lost average: the mean of its 11 categories."""
    here = paper[(paper["task"] == task) & (paper["metric"] == metric)]
    here = here[here["constraints"] == constraints]
    return float(here[here["category"].isin(CATEGORIES)]["value"].mean())


def _errors(ours: pd.DataFrame, paper: pd.DataFrame, digits: int) -> str:
    """Return one table: a row per category, ours and the paper's side by side."""
    rows = ours.set_index(["category", "constraints"])
    said = paper.set_index(["category", "constraints"])["value"].to_dict()
    if len(paper):
        task, metric = paper[["task", "metric"]].iloc[0]
        for name in (WITHOUT, WITH):
            said[AVERAGE, name] = recomputed(paper, task, metric, name)
    published = [name for name in (WITHOUT, WITH) if len(paper)]
    heads = [f"`{name}`" for name in CONSTRAINTS]
    heads = ["category", *heads, *(f"*paper, {name}*" for name in published)]
    lines = [row_of(heads), "|:-|" + "-:|" * (len(heads) - 1)]
    for category in (*CATEGORIES, AVERAGE):
        cells = [f"**{category}**" if category == AVERAGE else category]
        for name in CONSTRAINTS:
            is_known = (category, name) in rows.index
            row = rows.loc[(category, name)] if is_known else None
            cells.append(
                "–" if row is None else with_error(row["value"], row["se"], digits)
            )
        cells += [f"{said[category, name]:.{min(digits, 3)}f}" for name in published]
        lines.append(row_of(cells))
    return "\n".join(lines)


def _ratios(paired: pd.DataFrame, paper: pd.DataFrame) -> str:
    """Return the ratios of errors over objects placed under both constraints."""
    heads = ["task", "error", "of", "to", "n", "means [m]", "ratio", "*paper*"]
    lines = [row_of(heads), "|:-|:-|:-|:-|-:|-:|-:|-:|"]
    for row in paired.to_dict("records"):
        names = row["constraints"], row["compared_with"]
        values = [recomputed(paper, row["task"], row["metric"], n) for n in names]
        theirs = "–" if INSIDE in names else f"{values[0] / values[1]:.2f}"
        shown = _with_interval(row["ratio"], row["low"], row["high"])
        means = f"{row['value']:.3f}, {row['compared_value']:.3f}"
        error = row["metric"].removesuffix("_m")
        cells = [row["task"], error, *(f"`{name}`" for name in names)]
        lines.append(row_of([*cells, str(row["n"]), means, shown, theirs]))
    note = "Intervals hold 95 % of the ratios when scenes are drawn with replacement."
    return "\n".join(lines) + f"\n\n{note}"


def _with_interval(ratio: float, low: float, high: float) -> str:
    """Return a ratio with its interval, each only if it is known."""
    if pd.isna(ratio):
        return "–"
    return f"{ratio:.2f}" + ("" if pd.isna(low) else f" ({low:.2f} to {high:.2f})")


def _reasons(reasons: pd.DataFrame) -> str:
    """Return how many objects are not placed, by reason."""
    if reasons.empty:
        return "Every object is placed."
    lines = [row_of(["task", "constraints", "reason", "n"]), "|:-|:-|:-|-:|"]
    for row in reasons.to_dict("records"):
        cells = [row["task"], f"`{row['constraints']}`", row["reason"], str(row["n"])]
        lines.append(row_of(cells))
    note = (
        "The reason is that of the placement that people would have most; every "
        "question counts its objects once."
    )
    return "\n".join(lines) + f"\n\n{note}"

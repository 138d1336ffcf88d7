"""Table 2 as a Markdown page: what we measured, and beside it what people rated."""

from collections.abc import Callable, Sequence

import pandas as pd

from placing.methods.names import JOINT_NAMES, LABELS
from placing.tables.report import row_of, with_error

INTRODUCTION = (
    "Data set `scans`: three offices and two apartments, made for this project and "
    "seen by a simulated depth camera. They are not the paper's scenes. The blocks "
    "below have the same heads and do not measure the same thing: numbers of one block "
    "are compared with each other, not with those of another block."
)
CO = (
    "`Co`: per cent of **all** objects of the scene in a semantically correct place, "
    "by a judge that is no part of the methods: one table of category, kind of surface "
    "and kind of room, written before the methods ran on these scenes "
    "(`config/correct_places.csv`). An object that was not placed is not correct."
)
SC = (
    "`Sc`: 5 where the mean location error of the scene is the spread between labelled "
    "arrangements, 0 where it is that of chance, linear between and clipped to 0–5. "
    "The error of a method is the mean horizontal distance over labelled arrangements "
    "and objects, objects of one category matched to the labels by the Hungarian "
    "method; the spread is the same error of one labelled arrangement against each "
    "other one; chance puts each object anywhere it fits, every place as likely. An "
    "object that was not placed has the error of chance."
)
RATED = (
    "Here `Co` is the per cent of objects whose place a rater called semantically "
    "correct (an object that was not placed is not), `Sc` the rater's score from 0 to "
    "5 for the whole; both are means over raters, who did not know the method."
)
PAPER = (
    "The numbers printed in the paper, in its own scenes: its `Co` and `Sc` are those "
    "of two people who looked at the arrangements. Averages are unweighted means over "
    "scenes; the printed 90 is 90.6."
)
DETAILS = (
    "Mean ± standard error over the objects of a scene. Every row follows from "
    "`scores/table2.csv`, which has each object with its error, its verdict and, if it "
    "was not placed, the reason."
)


def table2_markdown(
    of_cells: pd.DataFrame,
    table: pd.DataFrame,
    paper: pd.DataFrame,
    rated: pd.DataFrame,
    agreement: pd.DataFrame,
) -> str:
    """Return the page; `rated` is a table as `table`, empty without raters."""
    parts = ["# Table 2", INTRODUCTION, "## Measured", _block(table), CO, SC]
    parts += [_of_labels(of_cells), "## As the paper's raters saw it", PAPER]
    parts += [_block(paper_table(paper))]
    if not rated.empty:
        parts += ["## As our raters saw it", _block(rated), RATED]
        parts += [_agreement(agreement)]
    parts += ["## What the measured scores are made of", _details(of_cells)]
    parts.append(DETAILS)
    return "\n\n".join(parts) + "\n"


def paper_table(paper: pd.DataFrame) -> pd.DataFrame:
    """Return the paper's Table 2 from its numbers, as wide as our table."""
    said = paper[paper["source"] == "Table 2"]
    rows = [
        {"method": method}
        | {
            f"{scene}_{metric}": value
            for scene, metric, value in zip(
                rows["scene"], rows["metric"], rows["value"], strict=True
            )
        }
        for method, rows in said.groupby("method", sort=False)
    ]
    return pd.DataFrame(rows)


def _block(table: pd.DataFrame) -> str:
    """Return a table of methods, two columns for each scene and the averages."""
    scenes = [name.removesuffix("_co") for name in table if name.endswith("_co")]
    heads = [f"{scene} {name}" for scene in scenes for name in ("Co", "Sc")]
    lines = _head(["method", *heads])
    for _, row in table.iterrows():
        cells = [JOINT_NAMES[row["method"]]]
        for scene in scenes:
            cells.append(with_error(row[f"{scene}_co"], float("nan"), 0))
            cells.append(with_error(row[f"{scene}_sc"], float("nan"), 1))
        lines.append(row_of(cells))
    return "\n".join(lines)


def _of_labels(of_cells: pd.DataFrame) -> str:
    """Return what the judge says of the labelled arrangements themselves."""
    labels = of_cells[of_cells["method"] == LABELS]
    if labels.empty:
        return "No scene has two labelled arrangements, and so no `Sc`."
    shares = [f"{row['scene']} {row['co']:.0f} %" for _, row in labels.iterrows()]
    return (
        "For comparison, the judge's `Co` of the labelled arrangements themselves: "
        f"{', '.join(shares)}; their `Sc` is 5 by definition. A dash stands where "
        "labels are no nearer to each other than chance is, or there is one only."
    )


def _details(of_cells: pd.DataFrame) -> str:
    """Return the table of the errors behind the scores."""
    heads = ["scene", "method", "objects", "not placed", "Co", "Sc", "error [m]"]
    lines = _head([*heads, "spread [m]", "chance [m]"], n_words=2)
    shown: list[Callable[[pd.Series], str]] = [
        lambda row: f"{row['n']:.0f}",
        lambda row: f"{row['n_unplaced']:.0f}",
        lambda row: with_error(row["co"], row["co_se"], 0),
        lambda row: with_error(row["sc"], row["sc_se"], 1),
        lambda row: with_error(row["location_error_m"], row["location_error_se_m"]),
        lambda row: with_error(row["spread_m"], float("nan")),
        lambda row: with_error(row["chance_m"], float("nan")),
    ]
    for _, row in of_cells.iterrows():
        method = JOINT_NAMES.get(str(row["method"]), str(row["method"]))
        lines.append(
            row_of([str(row["scene"]), method, *(show(row) for show in shown)])
        )
    return "\n".join(lines)


def _agreement(agreement: pd.DataFrame) -> str:
    """Return how far each pair of raters agrees."""
    if agreement.empty:
        return "One rater, so that nothing can be said of agreement."
    heads = ["raters", "objects", "same answer", "Cohen's kappa", "arrangements"]
    lines = _head([*heads, "mean difference of scores"])
    for _, row in agreement.iterrows():
        same = f"{100 * row['same']:.0f} %" if row["n_objects"] else "–"
        cells = [f"{row['rater']}, {row['other']}", f"{row['n_objects']:.0f}", same]
        cells += [with_error(row["kappa"], float("nan"))]
        cells += [f"{row['n_arrangements']:.0f}"]
        cells += [with_error(row["score_difference"], float("nan"))]
        lines.append(row_of(cells))
    note = (
        "Cohen's kappa of yes and no for each pair of raters: 1 is full agreement, 0 "
        "what their shares of yes would give by chance; a dash where both said one and "
        "the same throughout. The difference of scores is absolute, in points of 5."
    )
    return "\n".join(lines) + "\n\n" + note


def _head(heads: Sequence[str], n_words: int = 1) -> list[str]:
    """Return the first two lines of a table whose first columns are words."""
    return [row_of(list(heads)), "|" + ":-|" * n_words + "-:|" * (len(heads) - n_words)]

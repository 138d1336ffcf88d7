"""The diagnostics of a data set as a table and a Markdown page."""

from dataclasses import asdict

import numpy as np
import pandas as pd

from placing.people.diagnostics import STATISTICS, DiagnosticsConfig
from placing.tables.report import DATA, ORDER, TITLES

N_WORST = 10
"""Scenes that the page names."""
NAMES = {"n_poses": "poses", "log_joint": "log joint", "p_new": "P(new pose)"}
NOTE = (
    "Rank-normalised split R-hat and bulk effective sample size (ESS) of three traces "
    "of every question: the number of poses in use, the log of the joint density, and "
    "the probability of a new pose. Variation is the largest total variation between "
    "the placement histograms of two chains. A question is mixed if every R-hat is "
    "below {max_rhat:g} and its variation below {max_variation:g}; one that is not is "
    "marked here and stays in every other table. A trace that never changes has "
    "R-hat 1."
)


def summarise_diagnostics(questions: pd.DataFrame, dataset: str) -> pd.DataFrame:
    """Return one row per task and method of the diagnostics of a data set."""
    grouped = questions.groupby(["task", "method"])
    columns = {
        "questions": grouped.size(),
        "share_mixed": grouped["is_mixed"].mean(),
    }
    for name in STATISTICS:
        columns[f"rhat_{name}_median"] = grouped[f"rhat_{name}"].median()
        columns[f"rhat_{name}_worst"] = grouped[f"rhat_{name}"].max()
        columns[f"ess_{name}_median"] = grouped[f"ess_{name}"].median()
    columns["variation_median"] = grouped["variation"].median()
    columns["variation_worst"] = grouped["variation"].max()
    table = pd.DataFrame(columns).reset_index()
    known = {name: i for i, name in enumerate([*TITLES, *ORDER])}
    table = table.sort_values(
        ["task", "method"], key=lambda names: names.map(known), ignore_index=True
    )
    table.insert(0, "dataset", dataset)
    return table


def worst_scenes(questions: pd.DataFrame, config: DiagnosticsConfig) -> pd.DataFrame:
    """Return the scenes farthest outside the gates, the worst first.

    How far is the larger one of the worst R-hat above 1 and of the worst variation,
    each relative to its gate; what is unknown is farthest.
    """
    rhat = questions[[f"rhat_{name}" for name in STATISTICS]].max(axis=1, skipna=False)
    of_rhat = (rhat - 1) / (config.max_rhat - 1)
    of_variation = questions["variation"] / config.max_variation
    rows = questions.assign(
        rhat=rhat,
        unmixed=~questions["is_mixed"].astype(bool),
        excess=np.maximum(of_rhat, of_variation).fillna(np.inf),
    )
    found = rows.groupby("scene").agg(
        questions=("unmixed", "size"),
        unmixed=("unmixed", "sum"),
        rhat=("rhat", "max"),
        variation=("variation", "max"),
        excess=("excess", "max"),
    )
    found = found.sort_values("excess", ascending=False, kind="stable").head(N_WORST)
    return found.drop(columns="excess").reset_index()


def diagnostics_markdown(
    summary: pd.DataFrame, worst: pd.DataFrame, config: DiagnosticsConfig
) -> str:
    """Return the page for the one data set of `summary`."""
    dataset = summary["dataset"].iloc[0]
    parts = [f"# Do the chains agree? Data set `{dataset}`", DATA[dataset]]
    parts += [NOTE.format(**asdict(config))]
    for task, title in TITLES.items():
        of_task = summary[summary["task"] == task]
        parts += [f"## {title}", _summary_lines(of_task)]
    parts += [f"## The {len(worst)} scenes farthest from the gates, all methods"]
    parts += [_worst_lines(worst)]
    return "\n\n".join(parts) + "\n"


def _summary_lines(summary: pd.DataFrame) -> str:
    """Return the Markdown table of one task, R-hat as median / worst."""
    rhat = [f"R-hat {NAMES[name]}" for name in STATISTICS]
    ess = [f"ESS {NAMES[name]}" for name in STATISTICS]
    heads = ["method", "questions", "mixed", *rhat, *ess, "variation"]
    lines = [f"| {' | '.join(heads)} |", "|:-|" + "-:|" * (len(heads) - 1)]
    for _, row in summary.iterrows():
        cells = [f"`{row['method']}`", f"{row['questions']}"]
        cells += [_percent(row["share_mixed"])]
        for name in STATISTICS:
            values = row[f"rhat_{name}_median"], row[f"rhat_{name}_worst"]
            cells.append(" / ".join(_digits(value, 3) for value in values))
        cells += [_digits(row[f"ess_{name}_median"], 0) for name in STATISTICS]
        values = row["variation_median"], row["variation_worst"]
        cells.append(" / ".join(_digits(value, 3) for value in values))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join([*lines, "", "R-hat and variation: median / worst; ESS: median."])


def _worst_lines(worst: pd.DataFrame) -> str:
    """Return the Markdown table of the worst scenes."""
    lines = ["| scene | questions | not mixed | worst R-hat | worst variation |"]
    lines += ["|:-|-:|-:|-:|-:|"]
    for _, row in worst.iterrows():
        cells = [f"`{row['scene']}`", f"{row['questions']}", f"{row['unmixed']}"]
        cells += [_digits(row["rhat"], 3), _digits(row["variation"], 3)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _percent(share: float) -> str:
    """Return a share in percent, rounded down: 100 % says every question."""
    return f"{int(1000 * share + 1e-9) / 10:.1f} %"


def _digits(value: float, digits: int) -> str:
    """Return a number, a dash where there is none."""
    return "–" if pd.isna(value) else f"{value:.{digits}f}"

"""The claims of the paper as a Markdown page: what holds in the scenes of a run."""

from collections.abc import Hashable
from typing import Any

import pandas as pd

from placing.tables.averages import N_RESAMPLES
from placing.tables.claims import CONTRADICTED, HOLDS, NOT_RESOLVED, SIMPLE
from placing.tables.report import DATA, row_of

NOTE = (
    "Every sentence in which the paper says that one method does better than another, "
    "tested on these scenes, which are not the paper's. A difference is better minus "
    f"worse, with the 95 % interval of a paired bootstrap over scenes ({N_RESAMPLES:,} "
    "resamples of the scenes, averaged over categories as in `figure6.md`). "
    f"**{HOLDS}**: the interval is below zero. **{CONTRADICTED}**: it is above zero. "
    f"*{NOT_RESOLVED}*: it contains zero, these scenes do not tell. The paper speaks "
    "of location and height; `nll` (the density at the labelled place) and orientation "
    "are added here. No correction is made for the number of comparisons, so that of "
    "differences that are truly nothing about one in twenty is resolved by chance. "
    "With few scenes such intervals are a little too narrow."
)
UNITS = {
    "location_m": ("location", "m", 2),
    "height_m": ("height", "m", 3),
    "nll": ("nll", "nats", 2),
    "orientation_deg": ("orientation", "°", 1),
}
"""Name, unit and digits of each metric."""
VERDICTS = (HOLDS, NOT_RESOLVED, CONTRADICTED)
EMPHASIS = {HOLDS: "**holds**", CONTRADICTED: "**contradicted**"}


def claims_markdown(claims: pd.DataFrame, dataset: str) -> str:
    """Return the page with every claim and what these scenes say of it."""
    title = f"# What the paper says, on data set `{dataset}`"
    parts = [title, DATA[dataset], NOTE]
    if claims.empty:
        return (
            "\n\n".join([*parts, "No claim can be tested with these methods."]) + "\n"
        )
    parts += ["## In short", _counts(claims), _missing(claims), "## Every claim"]
    for sentence, of_claim in claims.groupby("sentence", sort=False):
        parts += [f"### {sentence}", f"{of_claim['source'].iloc[0]}."]
        pairs = of_claim.groupby(["better", "worse"], sort=False)
        parts += ["\n".join(_sentence(rows) for _, rows in pairs)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _counts(claims: pd.DataFrame) -> str:
    """Return how many comparisons of each claim came out how, by metric."""
    heads = ["claim", "source", *(name for name, _, _ in UNITS.values())]
    lines = [row_of(heads), "|:-|:-|" + "-:|" * len(UNITS)]
    for sentence, of_claim in claims.groupby("sentence", sort=False):
        cells = [str(sentence), of_claim["source"].iloc[0]]
        for metric in UNITS:
            verdicts = of_claim.loc[of_claim["metric"] == metric, "verdict"]
            counts = [(verdicts == name).sum() for name in VERDICTS]
            cells.append(" / ".join(map(str, counts)) if len(verdicts) else "–")
        lines.append(row_of(cells))
    return "\n".join([*lines, "", f"Comparisons: {' / '.join(VERDICTS)}."])


def _missing(claims: pd.DataFrame) -> str:
    """Return which methods the scores lack, so that nothing is left out in silence."""
    seen = set(claims["better"]) | set(claims["worse"])
    lacking = [
        m for m in (*SIMPLE, "object", "fmm", "dp", "dp_object") if m not in seen
    ]
    return f"Not in these scores: {', '.join(lacking)}." if lacking else ""


def _sentence(rows: pd.DataFrame) -> str:
    """Return one comparison as one sentence over all metrics."""
    first = rows.iloc[0]
    other = f"`{first['worse']}`"
    if first["worse_task"] != first["task"]:
        other = f"itself in {first['worse_task']} rooms"
    found = [_finding(str(row["metric"]), row) for row in rows.to_dict("records")]
    return f"- `{first['better']}` against {other}: {'; '.join(found)}."


def _finding(metric: str, row: dict[Hashable, Any]) -> str:
    """Return the difference in one metric, its interval and the verdict."""
    name, unit, digits = UNITS[metric]
    shown = [f"{row[key]:+.{digits}f}" for key in ("difference", "low", "high")]
    verdict = str(row["verdict"])
    interval = f"{shown[0]} {unit} [{shown[1]}, {shown[2]}]".replace("-", "−")
    return f"{name} {interval} {EMPHASIS.get(verdict, f'*{verdict}*')}"

"""What a recording says in words: its summary, and why each object is where it is."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.recordings.content import SceneRecording, Term, Use
from placing.recordings.tables import TRACED

Array = NDArray[np.float64]

ABOUT = {
    "rooms": "20 rooms and their labelled arrangements, written for this project by "
    "language models after the protocol of the paper. It is not the data set of the "
    "paper, whose numbers it cannot reproduce digit by digit.",
    "thor": "Rooms drawn by the designers of AI2-THOR for other purposes, with their "
    "own choice of where things lie. It is not the data set of the paper, and nobody "
    "labelled it for this task.",
}
LEGEND = (
    "Orange boxes: predicted places, linked to the labelled ones in white outline. "
    "Grey boxes: given objects. Figures: the people imagined at this sweep, with the "
    "number of objects each explains. Coloured points: the density of one category; "
    "the others can be switched on under `world/density`. Thin figures: who uses an "
    "object most likely, linked to it, and in grey the place it would take otherwise; "
    "those of the other objects are under `world/uses`."
)


def summary(content: SceneRecording) -> str:
    """Return what the recording shows as Markdown."""
    given = len(content.given.names)
    lines = [
        f"# {content.scene}, {content.task} room",
        f"Method **{content.method}**, fold {content.fold}, seed {content.seed}; "
        f"{len(content.predicted.names)} objects placed, {given} given, "
        f"mean error **{_mean(content.errors_m)} m**.",
        "",
        *_diagnosis(content),
        f"Data set `{content.dataset}`. {ABOUT.get(content.dataset, '')}",
        "",
        "| object | error [m] | log density | used by |",
        "|:-|-:|-:|:-|",
    ]
    for i in np.argsort(content.errors_m, kind="stable"):
        name, error = content.predicted.names[i], content.errors_m[i]
        density, used_by = content.log_density[i], _person(content.uses.get(name))
        lines.append(f"| {name} | {error:.2f} | {density:.1f} | {used_by} |")
    return "\n".join([*lines, "", LEGEND])


def reasons(content: SceneRecording) -> str:
    """Return who uses each object and why it is not elsewhere, as Markdown."""
    lines = [
        f"# Why each object is where it is: {content.scene}, {content.task} room",
        "Who uses it most likely, and what speaks for its place and against the best "
        "other one. Terms are logarithms; the decisive one differs most.",
    ]
    for name, use in content.uses.items():
        lines += ["", f"## {name}", f"Used by: {_person(use)}. {_alternative(use)}", ""]
        lines += ["| term | here | there |", "|:-|-:|-:|", *map(_term, use.terms)]
    if not content.uses:
        lines += ["", "Nobody was imagined for these answers."]
    return "\n".join(lines)


def _diagnosis(content: SceneRecording) -> list[str]:
    """Return whether the chains agree: of the one that is shown, then of all."""
    table = content.diagnoses
    if table.empty:
        return []
    is_mixed = table["is_mixed"].astype(bool)
    is_shown = table["question"] == content.question
    lines = [_verdict(row) for row in _rows(table[is_shown])]
    n_good, n = is_mixed.sum(), len(table)
    if n > 1:
        lines.append(f"{n_good} of the {n} questions shown are within the gates.")
    lines += [_verdict(row) for row in _rows(table[~is_mixed & ~is_shown])]
    return [line for text in lines for line in (text, "")]


def _verdict(row: dict[str, object]) -> str:
    """Return the diagnosis of one question, outside the gates in capitals."""
    verdict = "within the gates" if row["is_mixed"] else "OUTSIDE THE GATES"
    values = [
        f"{label} R-hat {row[f'rhat_{name}']:.3f}, ESS {row[f'ess_{name}']:.0f}"
        for name, label in TRACED.items()
    ]
    measured = "; ".join([*values, f"variation between chains {row['variation']:.3f}"])
    return f"Chains of `{row['question']}` are **{verdict}**: {measured}."


def _person(use: Use | None) -> str:
    """Return the kind of person who uses an object and how likely, or a dash."""
    if use is None or not use.kind:
        return "-"
    return f"{use.kind.replace('_', ' ')} {use.share:.0%}"


def _alternative(use: Use) -> str:
    """Return where an object would be otherwise."""
    if np.isnan(use.alternative).any():
        return "There is no other place."
    at = ", ".join(f"{value:.2f}" for value in use.alternative)
    return f"Best other place: {use.area} at ({at}) m."


def _term(term: Term) -> str:
    """Return the row of a term."""
    name = term.name.replace("_", " ")
    name = f"**{name}, decisive**" if term.is_decisive else name
    return f"| {name} | {term.value:.2f} | {term.alternative:.2f} |"


def _rows(table: pd.DataFrame) -> list[dict]:
    """Return the rows of a table by column."""
    return table.to_dict("records")


def _mean(values: Array) -> str:
    """Return the mean with two decimals, or a dash where there is none."""
    return f"{values.mean():.2f}" if len(values) else "-"

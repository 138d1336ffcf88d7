"""What the paper says of its methods, every sentence tested on the scenes of a run.

A claim says that one method has a smaller error than another. It holds where the
interval of the difference is below zero, is contradicted where the interval is above
zero, and is not resolved by these scenes otherwise.

Shapes: c categories, s scenes, b resamples.
"""

from dataclasses import dataclass
from functools import cache

import pandas as pd
from numpy.random import Generator

from placing.tables.averages import Side, difference, resamples
from placing.tables.metrics import tables_by_scene

HOLDS, NOT_RESOLVED, CONTRADICTED = "holds", "not resolved", "contradicted"
METRICS = {
    "location_m": "location",
    "height_m": "height",
    "nll": "nll",
    "orientation_deg": "orientation",
}
"""The metrics of a claim, each with its measure in `placing.tables.metrics`."""
COLUMNS = (
    *("dataset", "task", "better", "worse", "metric", "difference", "low", "high"),
    *("verdict", "source", "worse_task", "categories", "sentence"),
)

SIMPLE = ("chance", "height", "room", "area", "random_human")
"""The baselines that use neither inferred people nor other objects."""
HUMAN = ("fmm", "dp", "dp_object")
"""The methods with inferred people, the last three bars of the paper's Figure 6."""
DESK = ("laptop", "monitor", "keyboard", "mouse")
LOOSE = ("book", "tv", "decoration", "shoe")


@dataclass(frozen=True)
class Claim:
    """One sentence that says which methods have smaller errors than which others."""

    task: str
    betters: tuple[str, ...]
    worses: tuple[str, ...]
    """Each of `betters` against each of these; if empty, itself in another task."""
    sentence: str
    source: str
    """Where in the paper this is said, or from what it follows."""
    categories: tuple[str, ...] = ()
    """The only categories that it is said of; empty for all."""
    worse_task: str = ""
    """Task of the worse side where it is another one."""

    def pairs(self) -> list[tuple[str, str]]:
        """Return the better and the worse method of every comparison."""
        return [(a, b) for a in self.betters for b in self.worses or (a,)]


# ASSUME: the text does not tell all of its six baselines apart; "other baselines" is
# read as every one that is computed here.
CLAIMS = (
    Claim(
        *("filled", ("object",), SIMPLE),
        "Object context beats the other baselines in filled rooms.",
        "Section 4.1",
    ),
    Claim(
        *("filled", ("object",), SIMPLE),
        "It beats them for laptop, monitor, keyboard and mouse in filled rooms.",
        *("Section 4.1", DESK),
    ),
    Claim(
        *("filled", HUMAN, ("object",)),
        "The methods with human context beat object context in filled rooms.",
        "Section 4.1",
    ),
    Claim(
        *("filled", HUMAN, ("object",)),
        "They beat object context for book, TV, decoration and shoe in filled rooms.",
        *("Section 4.1", LOOSE),
    ),
    Claim(
        *("filled", ("dp",), SIMPLE),
        "Human context beats the other baselines in filled rooms.",
        "follows from Section 4.1",
    ),
    Claim(
        *("filled", ("dp_object",), ("object", "fmm", "dp")),
        "Human and object context together do best in filled rooms.",
        "Figure 6a",
    ),
    Claim(
        *("empty", ("height",), ("object",)),
        "Object context is worse than height alone in empty rooms.",
        "Section 4.1",
    ),
    Claim(
        *("empty", ("fmm",), (*SIMPLE, "object")),
        "The finite mixture beats the other baselines in empty rooms.",
        "Section 4.1",
    ),
    Claim(
        *("empty", ("dp", "dp_object"), ("fmm",)),
        "The Dirichlet process methods beat the finite mixture in empty rooms.",
        "Section 4.1",
    ),
    Claim(
        *("empty", ("dp",), (*SIMPLE, "object")),
        "Human context beats the other baselines in empty rooms.",
        "follows from Section 4.1",
    ),
    Claim(
        *("empty", ("dp_object",), ("object", "fmm", "dp")),
        "Human and object context together do best in empty rooms.",
        "Figure 6b",
    ),
    Claim(
        *("filled", HUMAN, ()),
        "The methods with human context do better in filled rooms than in empty ones.",
        *("Section 4.1", (), "empty"),
    ),
)


def check_claims(
    rng: Generator, scores: pd.DataFrame, claims: tuple[Claim, ...] = CLAIMS
) -> pd.DataFrame:
    """Return one row per claim, pair of methods and metric of one data set.

    A comparison for which the scores lack a method or the metric is left out.
    """
    dataset = scores["dataset"].iloc[0]
    tables, categories, scenes = tables_by_scene(scores, ["task", "method"])
    weights = resamples(rng, len(scenes))

    @cache
    def side(key: tuple[str, str], measure: str, chosen: tuple[str, ...]) -> Side:
        is_meant = [not chosen or category in chosen for category in categories]
        return Side.of(tables[key][measure][is_meant], weights)

    rows = []
    for claim in claims:
        worse_task = claim.worse_task or claim.task
        for better, worse in claim.pairs():
            keys = ((claim.task, better), (worse_task, worse))
            if not all(key in tables for key in keys):
                continue
            for metric, measure in METRICS.items():
                sides = [side(key, measure, claim.categories) for key in keys]
                found = difference(*sides)
                named = (dataset, claim.task, better, worse, metric, *found)
                rest = (claim.source, worse_task, " ".join(claim.categories))
                rows.append((*named, verdict(*found[1:]), *rest, claim.sentence))
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    return table.dropna(subset=["difference"]).reset_index(drop=True)


def verdict(low: float, high: float) -> str:
    """Return what the interval of better minus worse says of a claim."""
    if high < 0:
        return HOLDS
    return CONTRADICTED if low > 0 else NOT_RESOLVED

"""Everything that is written about the answers to the questions of a task."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.learning.likelihoods import (
    LIKELIHOOD_COLUMNS,
    ScoringConfig,
    density_key,
    likelihood_rows,
    with_uniform,
)
from placing.methods.answer_tables import (
    PLACEMENT_COLUMNS,
    POSE_COLUMNS,
    TRACE_COLUMNS,
    placement_rows,
    pose_rows,
    trace_rows,
)
from placing.methods.answering import Answer, Asked
from placing.methods.explanation import EXPLANATION_COLUMNS
from placing.methods.inspecting import reasons_of, region_areas_of
from placing.methods.names import METHODS
from placing.people.diagnostics import DIAGNOSTIC_COLUMNS, diagnosis_row
from placing.plans.offering import OPTION_COLUMNS, OfferingConfig, offered_rows

Array = NDArray[np.float64]

EXPLAINED = ("dp", "dp_object")
"""Methods whose placements are explained and whose densities are kept."""
RECORDED = "dp"
"""The method whose sampled poses and sweeps are kept."""
COLUMNS = {
    "arrangements": PLACEMENT_COLUMNS,
    "likelihoods": LIKELIHOOD_COLUMNS,
    "poses": POSE_COLUMNS,
    "traces": TRACE_COLUMNS,
    "diagnoses": DIAGNOSTIC_COLUMNS,
    "explanations": EXPLANATION_COLUMNS,
    "options": OPTION_COLUMNS,
}
"""The tables and their columns."""


class Sheets:
    """The tables of a task, filled question by question."""

    def __init__(self, scoring: ScoringConfig, ranks: Mapping[str, Array]) -> None:
        """Start empty; `ranks` per method calibrate its regions."""
        self._scoring, self._ranks = scoring, ranks
        self._rows: dict[str, list[tuple[object, ...]]] = {n: [] for n in COLUMNS}
        self._tables: dict[str, list[pd.DataFrame]] = {"poses": [], "traces": []}

    def fill(self, task: str, asked: Asked) -> dict[str, Array]:
        """Answer a question with every method; return the densities to keep, (p,)."""
        kept = {}
        for method in METHODS:
            answer = asked.answer(method)
            self._add(task, method, asked, answer)
            if method in EXPLAINED:
                self._rows["explanations"] += reasons_of(asked, answer, task, method)
                for category, density in answer.densities.items():
                    key = density_key(method, asked.question.name, category)
                    kept[key] = density
        return kept

    def offer(self, task: str, asked: Asked, config: OfferingConfig) -> None:
        """Add what the robot may choose among in a question that was answered."""
        self._rows["options"] += offered_rows(task, asked, config)

    def table(self, name: str) -> pd.DataFrame:
        """Return one of the tables of `COLUMNS`."""
        if self._tables.get(name):
            return pd.concat(self._tables[name], ignore_index=True)
        return pd.DataFrame(self._rows[name], columns=list(COLUMNS[name]))

    def n_placed(self) -> int:
        """Return how many objects all methods together have answered."""
        return len(self._rows["arrangements"])

    def _add(self, task: str, method: str, asked: Asked, answer: Answer) -> None:
        """Add what is written about the answers of all methods."""
        question, scene = asked.question, asked.model.scene.scene
        spacing_m = asked.model.settings.candidates.spacing_m
        mixed = {c: with_uniform(d, self._scoring) for c, d in answer.densities.items()}
        areas = region_areas_of(mixed, self._ranks[method], spacing_m)
        args = scene, task, method, question
        self._rows["arrangements"] += placement_rows(*args, answer, areas)
        found = asked.model.nearest, question, mixed, spacing_m
        key = scene, task, method, question.name
        self._rows["likelihoods"] += [(*key, *row) for row in likelihood_rows(*found)]
        people = answer.people
        if people is None or people.diagnosis is None:
            return
        n_objects = len(question.given) + len(question.wanted)
        gates = asked.model.settings.diagnostics
        row = diagnosis_row(key, n_objects, people.diagnosis, gates)
        self._rows["diagnoses"].append(row)
        chains = people.chains
        if method == RECORDED and chains is not None:
            poses = asked.model.poses
            self._tables["poses"].append(pose_rows(*args, chains, poses))
            self._tables["traces"].append(trace_rows(*args, chains))

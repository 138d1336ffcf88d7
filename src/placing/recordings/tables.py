"""The long tables that recordings read beside answers, poses and scores."""

from dataclasses import dataclass

import pandas as pd

TRACED = {
    "n_poses": "poses in use",
    "log_joint": "log joint",
    "p_new": "probability of a new pose",
}
"""What is traced, and its name for people."""


@dataclass(frozen=True)
class Tables:
    """The tables about one scene, task and method."""

    answers: pd.DataFrame
    """`PLACEMENT_COLUMNS` of `placing.methods.answer_tables`."""
    poses: pd.DataFrame
    """`POSE_COLUMNS` of `placing.methods.answer_tables`."""
    scores: pd.DataFrame
    """`SCORE_COLUMNS` of `placing.tables.metrics`."""
    traces: pd.DataFrame
    """`TRACE_COLUMNS` of `placing.methods.answer_tables`."""
    diagnoses: pd.DataFrame
    """`DIAGNOSTIC_COLUMNS` of `placing.people.diagnostics`."""
    explanations: pd.DataFrame
    """`EXPLANATION_COLUMNS` of `placing.methods.explanation`."""

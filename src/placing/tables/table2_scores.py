"""Scores of one scene for Table 2: how far is each object, and is its place right.

The methods `labels` (one labelled arrangement compared with each other one) and
`chance` stand beside the methods, so that every cell follows from this table alone.

Shapes: a arrangements, n objects of the scene.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations

import numpy as np
import pandas as pd
from numpy.random import Generator
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.errors import BadArtifact
from placing.methods.names import LABELS
from placing.scene import Layout, Scene
from placing.tables.correct_places import CorrectPlaces
from placing.tables.judging import Judged, judge
from placing.tables.table2_answers import answers_of, placements_of
from placing.tables.table2_errors import answer_errors, chance_errors, locations

Array = NDArray[np.float64]
Verdicts = Mapping[str, Sequence[Judged]]
"""What the judge says of each method and of each labelled arrangement, by its name."""

CHANCE = "chance"
SCORE_COLUMNS = (
    *("scene", "method", "answer", "labels", "object", "category", "label_of"),
    *("location_error_m", "is_placed", "is_correct", "support", "room", "reason"),
)
"""`answer` is compared with `labels`, and the object with the one of `label_of`."""


def verdicts_of(
    layout: Layout, scene: Scene, joint: pd.DataFrame, table: CorrectPlaces
) -> Verdicts:
    """Return what the judge says of every method and of every labelled arrangement."""
    answers = {
        method: placements_of(rows)
        for method, rows in answers_of(joint, scene.scene, scene.objects)
    }
    answers |= {one.name: one.placements for one in layout.arrangements}
    return {name: judge(layout, placed, table) for name, placed in answers.items()}


def score_scene(
    rng: Generator,
    scene: Scene,
    candidates: Candidates,
    joint: pd.DataFrame,
    verdicts: Verdicts,
    min_overlap: float,
) -> pd.DataFrame:
    """Return one row per method, labelled arrangement and object of a scene."""
    if not scene.arrangements or len(candidates.location) == 0:
        raise BadArtifact(
            f"scene {scene.scene}: {len(scene.arrangements)} labelled arrangements, "
            f"{len(candidates.location)} places; expected some of both"
        )
    labelled = {a.name: locations(a, scene.objects) for a in scene.arrangements}
    chance = {
        name: chance_errors(rng, scene.objects, xy, candidates, min_overlap)
        for name, xy in labelled.items()
    }
    parts = []
    for method, rows in answers_of(joint, scene.scene, scene.objects):
        is_placed = rows["is_placed"].to_numpy(bool)
        xy = np.where(is_placed[:, None], rows[["x_m", "y_m"]].to_numpy(float), np.nan)
        for name in labelled:
            part = _compared(scene, xy, labelled[name], chance[name])
            judged = _judged(scene, is_placed, verdicts[method], rows["reason"])
            parts.append(
                part.assign(method=method, answer=method, labels=name, **judged)
            )
    for name, other in permutations(labelled, 2):
        part = _compared(scene, labelled[other], labelled[name], chance[name])
        every = np.ones(len(scene.objects), np.bool_)
        judged = _judged(scene, every, verdicts[other], [""] * len(every))
        parts.append(part.assign(method=LABELS, answer=other, labels=name, **judged))
    parts += [_chance(scene, name, error) for name, error in chance.items()]
    table = pd.concat(parts, ignore_index=True).assign(scene=scene.scene)
    return table[list(SCORE_COLUMNS)]


def _compared(
    scene: Scene, answer: Array, labelled: Array, chance: Array
) -> pd.DataFrame:
    """Return the objects of an answer (n, 2) with their errors."""
    to, error = answer_errors(answer, labelled, chance, scene.objects)
    names = np.array([item.object_id for item in scene.objects], object)
    return _rows(scene).assign(label_of=names[to], location_error_m=error)


def _judged(
    scene: Scene,
    is_placed: NDArray[np.bool_],
    verdicts: Sequence[Judged],
    reasons: Sequence[str] | pd.Series,
) -> dict[str, object]:
    """Return what the judge says of each object; one not placed is not correct."""
    said = {verdict.object_id: verdict for verdict in verdicts}
    placed = zip(scene.objects, is_placed, strict=True)
    found = [said[item.object_id] if is_there else None for item, is_there in placed]
    return {
        "is_placed": is_placed,
        "is_correct": [one is not None and bool(one.is_correct) for one in found],
        "support": ["" if one is None else one.support for one in found],
        "room": ["" if one is None else one.room for one in found],
        "reason": [reason or "" for reason in reasons],
    }


def _chance(scene: Scene, labels: str, error: Array) -> pd.DataFrame:
    """Return the rows of chance, which has no placements that could be judged."""
    rows = _rows(scene)
    return rows.assign(
        label_of=rows["object"],
        location_error_m=error,
        **{"method": CHANCE, "answer": CHANCE, "labels": labels},
        **{"is_placed": False, "is_correct": False},
        **{"support": "", "room": "", "reason": ""},
    )


def _rows(scene: Scene) -> pd.DataFrame:
    """Return object and category of each object."""
    pairs = [(item.object_id, item.category) for item in scene.objects]
    return pd.DataFrame(pairs, columns=["object", "category"])

"""Scores of one scene's answers against its labelled arrangements.

An answer to a question with given objects is compared with the arrangement these come
from; an answer for the empty room is compared with every arrangement. The method
`labels` is one labelled arrangement compared with another: the spread between people,
which no method can be expected to beat.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import permutations

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial import KDTree

from placing.answer_tables import LOCATION, PLACED
from placing.candidates import Candidates
from placing.metrics import ERRORS, errors
from placing.scene import Arrangement, Scene, resting_point

Array = NDArray[np.float64]

LABELS = "labels"
"""The method that answers with another labelled arrangement."""


COLUMNS = ["method", "labels", "object", "category", "status", *ERRORS, "nll"]


@dataclass(frozen=True)
class ScoringConfig:
    """Settings of the scores; the values live in `config/config.yaml`."""

    uniform_share: float
    """Share of a uniform density mixed into every density before its log is taken."""


def score_scene(
    scene: Scene,
    answers: pd.DataFrame,
    densities: Mapping[str, Array],
    candidates: Candidates,
    spacing_m: float,
    config: ScoringConfig,
) -> pd.DataFrame:
    """Return one row per method, labelled arrangement and object.

    `densities` (p,) per key of `density_key`; nll is in nats, of a density per square
    metre of placing area. An object without a placement has errors NaN.
    """
    nearest = _nearest_places(scene, candidates)
    rows = list(_spread(scene))
    keys = ["method", "question", "category"]
    for key, table in answers.groupby(keys):
        method, question, category = (str(part) for part in key)
        density = densities[density_key(method, question, category)]
        log_density = _log_density(density, spacing_m, config)
        given = table["labels"].iloc[0]
        for labels in [given] if given else list(nearest):
            for name, status, found in _score(table, scene, labels, category):
                nll = -log_density[nearest[labels][name]]
                rows.append((method, labels, name, category, status, *found, nll))
    scores = pd.DataFrame(rows, columns=COLUMNS)
    return scores.assign(scene=scene.scene)


def density_key(method: str, question: str, category: str) -> str:
    """Return the name under which a density is stored."""
    return f"{method}/{question}/{category}"


def _score(
    wanted: pd.DataFrame, scene: Scene, labels: str, category: str
) -> Iterator[tuple[str, str, Array]]:
    """Yield each labelled object of a category, its status and its errors (3,)."""
    labelled = _locations(scene, labels, category)
    status = dict(zip(wanted["object"], wanted["status"], strict=True))
    location = dict(zip(wanted["object"], wanted[LOCATION].to_numpy(), strict=True))
    placed = [name for name in labelled if status[name] == PLACED]
    at = np.array([location[name] for name in placed], float).reshape(-1, 3)
    to = np.array([labelled[name] for name in placed]).reshape(-1, 3)
    found = dict(zip(placed, errors(at, to)[1], strict=True))
    for name in labelled:
        yield name, status[name], found.get(name, np.full(3, np.nan))


def _spread(scene: Scene) -> Iterator[tuple[object, ...]]:
    """Yield the errors of each labelled arrangement against each other one."""
    categories = sorted({item.category for item in scene.objects})
    for one, other in permutations(scene.arrangements, 2):
        for category in categories:
            at = np.array(list(_locations(scene, other.name, category).values()))
            labelled = _locations(scene, one.name, category)
            _, found = errors(at, np.array(list(labelled.values())))
            for name, values in zip(labelled, found, strict=True):
                yield LABELS, one.name, name, category, PLACED, *values, np.nan


def _locations(scene: Scene, labels: str, category: str) -> dict[str, Array]:
    """Return where an arrangement has the objects of a category, by object."""
    ids = {item.object_id for item in scene.objects if item.category == category}
    arrangement = next(a for a in scene.arrangements if a.name == labels)
    placements = sorted(arrangement.placements, key=lambda p: p.object_id)
    return {p.object_id: p.location for p in placements if p.object_id in ids}


def _nearest_places(scene: Scene, candidates: Candidates) -> dict[str, dict[str, int]]:
    """Return the place nearest to where each labelled object rests, by arrangement."""
    items = {item.object_id: item for item in scene.objects}
    places = KDTree(candidates.location)

    def of(arrangement: Arrangement) -> dict[str, int]:
        placements = arrangement.placements
        resting = [resting_point(items[p.object_id], p) for p in placements]
        nearest = places.query(np.array(resting))[1]
        names = [p.object_id for p in placements]
        return dict(zip(names, nearest.tolist(), strict=True))

    return {arrangement.name: of(arrangement) for arrangement in scene.arrangements}


def _log_density(density: Array, spacing_m: float, config: ScoringConfig) -> Array:
    """Return the log of a density per square metre, never -inf, shape (p,)."""
    share = config.uniform_share
    mixed = (1 - share) * density + share / len(density)
    return np.log(mixed / spacing_m**2)

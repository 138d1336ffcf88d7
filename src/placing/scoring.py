"""Scores of one scene's answers against its labelled arrangements.

An answer to a question with given objects is compared with the arrangement these come
from; an answer for the empty room is compared with every arrangement. The method
`labels` is one labelled arrangement compared with another: the spread between people,
which no method can be expected to beat.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.answer_tables import LOCATION, PLACED
from placing.candidates import Candidates
from placing.metrics import errors
from placing.scene import Arrangement, Scene, resting_point

Array = NDArray[np.float64]

LABELS = "labels"
"""The method that answers with another labelled arrangement."""


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
    resting = _resting_points(scene)
    rows = []
    for (method, question), table in answers.groupby(["method", "question"]):
        given = table["labels"].iloc[0]
        for category, wanted in table.groupby("category"):
            density = densities[density_key(method, question, category)]
            log_density = _log_density(density, spacing_m, config)
            for labels in [given] if given else list(resting):
                scored = _score(wanted, scene, labels, category)
                place = _nearest(candidates, resting[labels], scored["object"])
                scored["nll"] = -log_density[place]
                rows.append(scored.assign(method=method, labels=labels))
    table = pd.concat([*rows, *_spread(scene)], ignore_index=True)
    return table.assign(scene=scene.scene)


def density_key(method: str, question: str, category: str) -> str:
    """Return the name under which a density is stored."""
    return f"{method}/{question}/{category}"


def _score(
    wanted: pd.DataFrame, scene: Scene, labels: str, category: str
) -> pd.DataFrame:
    """Return the errors of the objects of one category against one arrangement."""
    labelled = _locations(scene, labels, category)
    placed = wanted[wanted["status"] == PLACED].set_index("object")
    table = pd.DataFrame({"object": list(labelled), "category": category})
    if len(placed) < len(labelled):
        missing = set(labelled) - set(placed.index)
        reason = wanted.set_index("object")["status"]
        status = [reason[o] if o in missing else PLACED for o in labelled]
        placed_names = [o for o in labelled if o not in missing]
        table["status"] = status
        at = placed.loc[placed_names, LOCATION].to_numpy(float)
        to = np.array([labelled[o] for o in placed_names]).reshape(-1, 3)
        found = errors(at, to).assign(object=placed_names).drop(columns="match")
        return table.merge(found, on="object", how="left")
    at = placed.loc[list(labelled), LOCATION].to_numpy(float)
    found = errors(at, np.array(list(labelled.values()))).drop(columns="match")
    return pd.concat([table.assign(status=PLACED), found], axis=1)


def _spread(scene: Scene) -> Iterator[pd.DataFrame]:
    """Yield the errors of each labelled arrangement against each other one."""
    categories = sorted({item.category for item in scene.objects})
    for one in scene.arrangements:
        for other in scene.arrangements:
            for category in categories if one is not other else []:
                at = np.array(list(_locations(scene, other.name, category).values()))
                labelled = _locations(scene, one.name, category)
                found = errors(at, np.array(list(labelled.values())))
                yield found.drop(columns="match").assign(
                    object=list(labelled),
                    category=category,
                    status=PLACED,
                    method=LABELS,
                    labels=one.name,
                    nll=np.nan,
                )


def _locations(scene: Scene, labels: str, category: str) -> dict[str, Array]:
    """Return where an arrangement has the objects of a category, by object."""
    ids = {item.object_id for item in scene.objects if item.category == category}
    arrangement = next(a for a in scene.arrangements if a.name == labels)
    placements = sorted(arrangement.placements, key=lambda p: p.object_id)
    return {p.object_id: p.location for p in placements if p.object_id in ids}


def _resting_points(scene: Scene) -> dict[str, dict[str, Array]]:
    """Return the point each object rests on, by arrangement and object."""
    items = {item.object_id: item for item in scene.objects}

    def of(arrangement: Arrangement) -> dict[str, Array]:
        return {
            p.object_id: resting_point(items[p.object_id], p)
            for p in arrangement.placements
        }

    return {arrangement.name: of(arrangement) for arrangement in scene.arrangements}


def _nearest(
    candidates: Candidates, resting: Mapping[str, Array], objects: pd.Series
) -> list[int]:
    """Return the place nearest to where each labelled object rests."""
    return [
        int(np.argmin(((candidates.location - resting[name]) ** 2).sum(1)))
        for name in objects
    ]


def _log_density(density: Array, spacing_m: float, config: ScoringConfig) -> Array:
    """Return the log of a density per square metre, never -inf, shape (p,)."""
    share = config.uniform_share
    mixed = (1 - share) * density + share / len(density)
    return np.log(mixed / spacing_m**2)

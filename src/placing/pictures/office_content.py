"""What Figures 4 and 5 of the paper show, put together from the artifacts of a room.

Shapes: k people, p places.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.dressing import Meshes, object_meshes
from placing.errors import BadInput, unknown
from placing.learning.likelihoods import density_key
from placing.methods.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.people import skeleton
from placing.people.human import HumanPoses
from placing.pictures.people import Person
from placing.scene import Arrangement, Layout, Placement, Scene
from placing.seeds import generator

Array = NDArray[np.float64]

PEOPLE = 12
"""About so many people are shown at once, those of sweeps far apart."""


@dataclass(frozen=True)
class Figure:
    """What the figures are of, beside the room."""

    dataset: str
    method: str
    category: str
    """The wanted category of Figure 4."""
    seed: int


@dataclass(frozen=True)
class Office:
    """What Figures 4 and 5 show of one room."""

    figure: Figure
    layout: Layout
    labels: str
    """The labelled arrangement whose objects are given in Figure 4."""
    given: Meshes
    """Its objects, without the wanted category."""
    random: tuple[Person, ...]
    """As many people drawn from P0 as are `sampled`."""
    sampled: tuple[Person, ...]
    """The people of some sweeps, given these objects."""
    places: Array
    """(p, 3) of the wanted category [m]."""
    density: Array
    """(p,) over these places, sum 1."""
    placed: Meshes
    """The objects as the method arranges the empty room."""
    users: tuple[Person, ...]
    """The people of the likeliest sweep in the empty room."""


@dataclass(frozen=True)
class Tables:
    """The tables about one scene and method."""

    poses_filled: pd.DataFrame
    """`POSE_COLUMNS` of `placing.methods.answer_tables`, of the task `filled`."""
    poses_empty: pd.DataFrame
    """The same of the task `empty`."""
    answers: pd.DataFrame
    """`PLACEMENT_COLUMNS` of `placing.methods.answer_tables`, of the task `empty`."""


def office_of(
    figure: Figure,
    layout: Layout,
    model: tuple[Scene, Candidates, HumanPoses],
    tables: Tables,
    densities: Mapping[str, Array],
) -> Office:
    """Return what the figures show, of the room that the model sees."""
    scene, candidates, valid = model
    categories = sorted({item.category for item in scene.objects})
    if figure.category not in categories:
        raise unknown(f"category of {scene.scene}", figure.category, categories)
    if scene.scene != layout.scene:
        message = f"scene is {scene.scene!r}, expected {layout.scene!r} as of the room"
        raise BadInput(message)
    if not scene.arrangements:
        raise BadInput(f"{scene.scene}: arrangements: expected at least one to show")
    labelled = scene.arrangements[0]
    question = f"{labelled.name}/{figure.category}"
    of_question = tables.poses_filled[tables.poses_filled["question"] == question]
    sampled = _people(_spread(of_question))
    wanted = {o.object_id for o in scene.objects if o.category == figure.category}
    given = [p for p in labelled.placements if p.object_id not in wanted]
    return Office(
        figure,
        layout,
        labelled.name,
        object_meshes(layout, replace(labelled, placements=tuple(given))),
        _random(generator(figure.seed, "picture_people"), valid, len(sampled)),
        sampled,
        candidates.location,
        densities[density_key(figure.method, question, figure.category)],
        object_meshes(layout, _arrangement(tables.answers)),
        _people(_likeliest(tables.poses_empty)),
    )


def _likeliest(poses: pd.DataFrame) -> pd.DataFrame:
    """Return the poses of the sweep of highest log joint, of several the first."""
    is_highest = poses["log_joint"] == poses["log_joint"].max()
    return poses[poses["sample"] == poses.loc[is_highest, "sample"].min()]


def _spread(poses: pd.DataFrame) -> pd.DataFrame:
    """Return the poses of as many sweeps far apart as hold about `PEOPLE`."""
    if poses.empty:
        return poses
    sweeps = np.unique(poses["sample"].to_numpy())
    n = np.clip(round(PEOPLE * len(sweeps) / len(poses)), 1, len(sweeps))
    rows = np.linspace(0, len(sweeps) - 1, n).round().astype(int)
    return poses[np.isin(poses["sample"].to_numpy(), sweeps[rows])]


def _people(poses: pd.DataFrame) -> tuple[Person, ...]:
    """Return the people of a table of poses."""
    names = ["kind", "x_m", "y_m", "z_m", "yaw_rad", "n_objects"]
    return tuple(
        Person(kind, np.array([x, y, z]), yaw, n)
        for kind, x, y, z, yaw, n in poses[names].itertuples(index=False)
    )


def _random(rng: np.random.Generator, valid: HumanPoses, n: int) -> tuple[Person, ...]:
    """Return people drawn from P0."""
    drawn = rng.choice(len(valid.prior), n, p=valid.prior / valid.prior.sum())
    return tuple(
        Person(skeleton.KINDS[valid.kind[h]], valid.location[h], float(valid.yaw[h]))
        for h in drawn
    )


def _arrangement(answers: pd.DataFrame) -> Arrangement:
    """Return the placed objects of an empty room as an arrangement."""
    placed = answers[answers["status"] == PLACED]
    rows = zip(
        placed["object"],
        placed["area"],
        placed[LOCATION].to_numpy(float),
        placed[ORIENTATION].to_numpy(float),
        strict=True,
    )
    return Arrangement("predicted", "", tuple(Placement(*row) for row in rows))

"""What a recording shows, put together from the artifacts of one scene and task."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.clouds.ply import Cloud
from placing.learning.likelihoods import density_key
from placing.methods.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.people import skeleton
from placing.people.human import HumanPoses
from placing.recordings.content import Boxes, SceneRecording, Term, Use
from placing.recordings.tables import Tables
from placing.scene import Placement, Scene, SceneObject
from placing.tables.metrics import errors

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Job:
    """What a recording is of, beside its scene."""

    dataset: str
    task: str
    method: str
    fold: int
    seed: int


def scene_recording(
    job: Job,
    scene: Scene,
    cloud: Cloud,
    candidates: Candidates,
    valid: HumanPoses,
    densities: Mapping[str, Array],
    tables: Tables,
) -> SceneRecording:
    """Return the recording of one scene, task and method.

    A filled room is shown with the objects of its first labelled arrangement, each
    category taken out in turn.
    """
    labelled = scene.arrangements[0] if scene.arrangements else None
    labels, answers = labelled.name if labelled else "", tables.answers
    is_shown = answers["labels"].isin(["", labels])
    shown = answers[is_shown & (answers["status"] == PLACED)].sort_values("object")
    items = {item.object_id: item for item in scene.objects}
    targets = {p.object_id: p for p in labelled.placements} if labelled else {}
    matched = _matched(shown, targets)
    scores = tables.scores.set_index("object")
    of_object = scores[scores["labels"] == labels].reindex(matched)
    question = _shown_question(shown, items)
    asked = answers.loc[is_shown, "question"].unique()
    explained = tables.explanations["question"].isin(asked)
    return SceneRecording(
        **vars(job),
        scene=scene.scene,
        points=cloud.points,
        point_colors=cloud.colors,
        point_normals=cloud.normals,
        areas=scene.areas,
        valid_poses=_pose_table(valid),
        sampled_poses=_of(tables.poses, question).rename(columns={"sample": "sweep"}),
        question=question,
        trace=_of(tables.traces, question),
        diagnoses=tables.diagnoses[tables.diagnoses["question"].isin(asked)],
        uses=_uses(tables.explanations[explained]),
        given=_boxes(items, targets if job.task == "filled" else {}),
        predicted=_predicted(items, shown),
        labelled=_boxes(items, {n: targets[n] for n in matched if n in targets}),
        errors_m=of_object["location_error_m"].to_numpy(float),
        log_density=-of_object["nll"].to_numpy(float),
        densities=_densities(shown, candidates, densities),
    )


def _matched(shown: pd.DataFrame, targets: Mapping[str, Placement]) -> list[str]:
    """Return the labelled object that each predicted one is scored by, in order."""
    objects, location = shown["object"].tolist(), shown[LOCATION].to_numpy(float)
    matched = np.array(objects, object)
    if not targets:
        return objects
    for rows in shown.groupby("category").indices.values():
        names = [objects[row] for row in rows]
        if len(names) > 1:
            to = np.array([targets[name].location for name in names])
            match, _ = errors(location[rows], to)
            matched[rows[match]] = names
    return matched.tolist()


def _shown_question(shown: pd.DataFrame, items: Mapping[str, SceneObject]) -> str:
    """Return the question whose people are shown: in a filled room that of a category.

    It is the first category with a front, whose use by people is easiest to see.
    """
    if shown.empty:
        return ""
    of_object = dict(zip(shown["object"], shown["question"], strict=True))
    return of_object[min(of_object, key=lambda o: (not items[o].has_front, o))]


def _of(table: pd.DataFrame, question: str) -> pd.DataFrame:
    """Return the rows of one question."""
    return table[table["question"] == question]


def _uses(table: pd.DataFrame) -> dict[str, Use]:
    """Return who uses each object, from one row per object and term."""
    columns = table.to_dict("list")
    names = ("term", "value", "alternative_value", "is_decisive")
    terms = list(zip(*[columns[name] for name in names], strict=True))
    rows_of: dict[str, list[int]] = {}
    for row, name in enumerate(columns["object"]):
        rows_of.setdefault(name, []).append(row)

    def use(rows: list[int]) -> Use:
        row = {name: values[rows[0]] for name, values in columns.items()}
        return Use(
            kind=row["person_kind"] if isinstance(row["person_kind"], str) else "",
            location=np.array([row[f"person_{axis}_m"] for axis in "xyz"], float),
            yaw=row["person_yaw_rad"],
            share=row["person_share"],
            area=row["alternative_area"],
            alternative=np.array([row[f"alternative_{axis}_m"] for axis in "xyz"]),
            terms=tuple(Term(*terms[k]) for k in rows),
        )

    return {name: use(rows) for name, rows in rows_of.items()}


def _pose_table(valid: HumanPoses) -> pd.DataFrame:
    """Return the valid poses as the table that recordings draw."""
    x, y, z = valid.location.T
    kind = np.array(skeleton.KINDS)[valid.kind]
    columns = {"kind": kind, "x_m": x, "y_m": y, "z_m": z, "yaw_rad": valid.yaw}
    return pd.DataFrame(columns)


def _boxes(
    items: Mapping[str, SceneObject], placements: Mapping[str, Placement]
) -> Boxes:
    """Return the boxes of placements by object."""
    locations = [p.location for p in placements.values()]
    orientations = [p.orientation for p in placements.values()]
    return Boxes(
        names=tuple(placements),
        centers=np.array(locations).reshape(-1, 3),
        sizes=np.array([items[name].size_m for name in placements]).reshape(-1, 3),
        quaternions=np.array(orientations).reshape(-1, 4),
    )


def _predicted(items: Mapping[str, SceneObject], shown: pd.DataFrame) -> Boxes:
    """Return the boxes of predicted objects."""
    names = tuple(shown["object"])
    return Boxes(
        names=names,
        centers=shown[LOCATION].to_numpy(float),
        sizes=np.array([items[name].size_m for name in names]).reshape(-1, 3),
        quaternions=shown[ORIENTATION].to_numpy(float),
    )


def _densities(
    shown: pd.DataFrame, candidates: Candidates, densities: Mapping[str, Array]
) -> dict[str, tuple[Array, Array]]:
    """Return the places and the log density of every shown category."""
    found = {}
    keys = shown[["method", "question", "category"]].drop_duplicates()
    for method, question, category in keys.itertuples(index=False):
        density = densities[density_key(method, question, category)]
        fits = np.flatnonzero(density)
        found[category] = candidates.location[fits], np.log(density[fits])
    return found

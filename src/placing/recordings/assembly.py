"""What a recording shows, put together from the artifacts of one scene and task."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing import skeleton
from placing.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.candidates import Candidates
from placing.clouds.ply import Cloud
from placing.human import HumanPoses
from placing.metrics import errors
from placing.recordings.content import Boxes, SceneRecording
from placing.scene import Placement, Scene, SceneObject
from placing.scoring import density_key

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
    answers: pd.DataFrame,
    poses: pd.DataFrame,
    densities: Mapping[str, Array],
    scores: pd.DataFrame,
) -> SceneRecording:
    """Return the recording of one scene, task and method.

    A filled room is shown with the objects of its first labelled arrangement, each
    category taken out in turn.
    """
    labels, method = scene.arrangements[0].name, job.method
    is_shown = answers["labels"].isin(["", labels]) & (answers["method"] == method)
    shown = answers[is_shown & (answers["status"] == PLACED)].sort_values("object")
    items = {item.object_id: item for item in scene.objects}
    targets = {p.object_id: p for p in scene.arrangements[0].placements}
    matched = _matched(shown, targets)
    of_method = scores[(scores["method"] == method) & (scores["labels"] == labels)]
    of_object = of_method.set_index("object").loc[matched]
    chain = _shown_chain(poses, shown, items)
    return SceneRecording(
        **vars(job),
        scene=scene.scene,
        points=cloud.points.astype(float),
        point_colors=cloud.colors,
        point_normals=cloud.normals.astype(float),
        areas=scene.areas,
        valid_poses=_pose_table(valid),
        sampled_poses=chain.rename(columns={"sample": "sweep"}),
        trace=_trace(chain),
        given=_boxes(items, targets if job.task == "filled" else {}),
        predicted=_predicted(items, shown),
        labelled=_boxes(items, {name: targets[name] for name in matched}),
        errors_m=of_object["location_error_m"].to_numpy(float),
        log_density=-of_object["nll"].to_numpy(float),
        densities=_densities(shown, candidates, densities),
    )


def _matched(shown: pd.DataFrame, targets: Mapping[str, Placement]) -> list[str]:
    """Return the labelled object that each predicted one is scored by, in order."""
    matched = pd.Series("", index=shown.index)
    for _, of_category in shown.groupby("category"):
        names = [name for name in of_category["object"] if name in targets]
        to = np.array([targets[name].location for name in names])
        match, _ = errors(of_category[LOCATION].to_numpy(float), to)
        matched[of_category.index[match]] = names
    return matched.tolist()


def _shown_chain(
    poses: pd.DataFrame, shown: pd.DataFrame, items: Mapping[str, SceneObject]
) -> pd.DataFrame:
    """Return the chain of one question: in a filled room that of one category.

    It is the first category with a front, whose use by people is easiest to see.
    """
    names = sorted(shown["object"], key=lambda o: (not items[o].has_front, o))
    of_first = shown[shown["object"] == names[0]] if names else shown
    return poses[poses["question"].isin(of_first["question"])]


def _trace(chain: pd.DataFrame) -> pd.DataFrame:
    """Return the log joint and the number of poses in use per sweep."""
    by_sweep = chain.groupby("sample")
    columns = {
        "log_likelihood": by_sweep["log_joint"].first(),
        "n_poses": by_sweep.size(),
    }
    return pd.DataFrame(columns).rename_axis("sweep").reset_index()


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
        fits = density > 0
        found[category] = candidates.location[fits], np.log(density[fits])
    return found

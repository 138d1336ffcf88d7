"""Answers as long tables: one row per placed object, one row per sampled pose."""

import numpy as np
import pandas as pd

from placing import skeleton
from placing.answering import Answer
from placing.dpmm import Chains
from placing.human import HumanPoses
from placing.tasks import Question

PLACED, NO_PLACE = "placed", "no place fits"
"""The status of a wanted object."""

LOCATION = ["x_m", "y_m", "z_m"]
ORIENTATION = ["qw", "qx", "qy", "qz"]
PLACEMENT_COLUMNS = [
    *("scene", "task", "method", "question", "labels", "object", "category"),
    *("status", "area", *LOCATION, *ORIENTATION),
]
POSE_COLUMNS = [
    *("scene", "task", "method", "question", "sample", "pose", "kind"),
    *("x_m", "y_m", "z_m", "yaw_rad", "n_objects", "log_joint"),
]


def placement_rows(
    scene: str, task: str, method: str, question: Question, answer: Answer
) -> list[tuple[object, ...]]:
    """Return one row per wanted object; an object without a place has no pose."""
    rows: list[tuple[object, ...]] = []
    for item, placement in answer.placements:
        named = (scene, task, method, question.name, question.labels)
        row = (*named, item.object_id, item.category)
        if placement is None:
            rows.append((*row, NO_PLACE, "", *[np.nan] * 7))
        else:
            pose = (*placement.location, *placement.orientation)
            rows.append((*row, PLACED, placement.area, *pose))
    return rows


def pose_rows(
    scene: str,
    task: str,
    method: str,
    question: Question,
    chains: Chains,
    poses: HumanPoses,
) -> pd.DataFrame:
    """Return one row per sample and pose in use, poses numbered by object count.

    The samples are those of the first chain.
    """
    choice, pose, log_joint = chains.choice[0], chains.pose[0], chains.log_joint[0]
    n_samples, n_objects = choice.shape
    sample = np.repeat(np.arange(n_samples), n_objects)
    key = sample * n_objects + choice.ravel()
    _, first, members = np.unique(key, return_index=True, return_counts=True)
    order = np.lexsort((first, -members, sample[first]))
    first, members = first[order], members[order]
    of_sample, h = sample[first], pose.ravel()[first]
    starts = np.searchsorted(of_sample, np.arange(n_samples))
    x, y, z = poses.location[h].T
    columns = [scene, task, method, question.name, of_sample]
    columns += [np.arange(len(h)) - starts[of_sample]]
    columns += [np.array(skeleton.KINDS)[poses.kind[h]], x, y, z, poses.yaw[h]]
    columns += [members, log_joint[of_sample]]
    return pd.DataFrame(dict(zip(POSE_COLUMNS, columns, strict=True)))

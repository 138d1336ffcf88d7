"""Answers as long tables: one row per placed object, one row per sampled pose."""

import numpy as np
import pandas as pd

from placing import skeleton
from placing.answering import Answer
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
) -> pd.DataFrame:
    """Return one row per wanted object; an object without a place has no pose."""
    rows = []
    for item, placement in answer.placements:
        named = (scene, task, method, question.name, question.labels)
        row = [*named, item.object_id, item.category]
        if placement is None:
            row += [NO_PLACE, "", *[np.nan] * 7]
        else:
            pose = [*placement.location, *placement.orientation]
            row += [PLACED, placement.area, *pose]
        rows.append(row)
    return pd.DataFrame(rows, columns=PLACEMENT_COLUMNS)


def pose_rows(
    scene: str,
    task: str,
    method: str,
    question: Question,
    answer: Answer,
    poses: HumanPoses,
) -> pd.DataFrame:
    """Return one row per sample and pose in use, poses numbered by object count."""
    if answer.chain is None:
        return pd.DataFrame(columns=POSE_COLUMNS)
    rows = []
    for sample, (choice, pose) in enumerate(
        zip(answer.chain.choice, answer.chain.pose, strict=True)
    ):
        _, first, n_objects = np.unique(choice, return_index=True, return_counts=True)
        order = np.argsort(-n_objects, kind="stable")
        for number, k in enumerate(order):
            h = pose[first[k]]
            kind = skeleton.KINDS[poses.kind[h]]
            at = [*poses.location[h], poses.yaw[h]]
            log_joint = answer.chain.log_joint[sample]
            rows.append([sample, number, kind, *at, n_objects[k], log_joint])
    table = pd.DataFrame(rows, columns=POSE_COLUMNS[4:])
    named = {"scene": scene, "task": task, "method": method, "question": question.name}
    return pd.concat(
        [pd.DataFrame(named, index=table.index), table], axis=1, copy=False
    )

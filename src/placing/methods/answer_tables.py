"""Answers as long tables: one row per placed object, sampled pose or sweep."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from placing.people import skeleton

if TYPE_CHECKING:
    from placing.methods.answering import Answer
    from placing.people.dpmm import Chains
    from placing.people.human import HumanPoses
    from placing.tasks import Question

PLACED, NO_PLACE = "placed", "no place fits"
"""The status of a wanted object."""

LOCATION = ["x_m", "y_m", "z_m"]
ORIENTATION = ["qw", "qx", "qy", "qz"]
REGION_COLUMNS = ["area_50_m2", "area_80_m2", "area_90_m2"]
PLACEMENT_COLUMNS = [
    *("scene", "task", "method", "question", "labels", "object", "category"),
    *("status", "reason", "area", *LOCATION, *ORIENTATION, *REGION_COLUMNS),
]
POSE_COLUMNS = [
    *("scene", "task", "method", "question", "sample", "pose", "kind"),
    *("x_m", "y_m", "z_m", "yaw_rad", "n_objects", "log_joint"),
]
TRACE_COLUMNS = [
    *("scene", "task", "method", "question", "chain", "sweep"),
    *("n_poses", "log_joint", "p_new"),
]


def placement_rows(
    scene: str,
    task: str,
    method: str,
    question: "Question",
    answer: "Answer",
    region_areas_m2: Mapping[str, list[float]] = MappingProxyType({}),
) -> list[tuple[object, ...]]:
    """Return one row per wanted object; an object without a place has no pose.

    `region_areas_m2` per category, of the regions named in `REGION_COLUMNS`; left out:
    unknown.
    """
    rows: list[tuple[object, ...]] = []
    for chosen in answer.chosen:
        item, placement = chosen.item, chosen.placement
        named = (scene, task, method, question.name, question.labels)
        row = (*named, item.object_id, item.category)
        areas = region_areas_m2.get(item.category, [np.nan] * len(REGION_COLUMNS))
        if placement is None:
            rows.append((*row, NO_PLACE, chosen.reason, "", *[np.nan] * 7, *areas))
        else:
            pose = (*placement.location, *placement.orientation)
            rows.append((*row, PLACED, chosen.reason, placement.area, *pose, *areas))
    return rows


def trace_rows(
    scene: str, task: str, method: str, question: "Question", chains: "Chains"
) -> pd.DataFrame:
    """Return one row per chain and sweep."""
    n_chains, n_samples = chains.n_poses.shape
    chain, sweep = np.indices((n_chains, n_samples)).reshape(2, -1)
    values = [chains.n_poses, chains.log_joint, chains.p_new]
    columns = [scene, task, method, question.name, chain, sweep]
    columns += [value.ravel() for value in values]
    return pd.DataFrame(dict(zip(TRACE_COLUMNS, columns, strict=True)))


def pose_rows(
    scene: str,
    task: str,
    method: str,
    question: "Question",
    chains: "Chains",
    poses: "HumanPoses",
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

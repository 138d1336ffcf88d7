"""What the search for a plan did, as the tables of the robot tell it."""

import numpy as np
import pandas as pd

from placing.errors import BadArtifact
from placing.logs.planning_result import PlanningResult
from placing.methods.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.recordings.plan import Search, Tried
from placing.robot.certificates import Certificate


def search_of(plans: pd.DataFrame, tried: pd.DataFrame) -> Search:
    """Return the search behind the rows of one question under one constraint.

    `plans` has the columns of `placing.plans.robot_plans`, `tried` its `TRIED_COLUMNS`.
    """
    is_placed = (plans["status"] == PLACED).to_numpy()
    placed = plans[is_placed].sort_values("order", kind="stable")
    refused = plans[~is_placed].sort_values("object", kind="stable")
    n_calls = int(plans["n_calls"].max()) if len(plans) else 0
    return Search(
        order=tuple(placed["object"]),
        grasps=dict(zip(placed["object"], placed["grasp"], strict=True)),
        refused=dict(zip(refused["object"], refused["reason"], strict=True)),
        tried=tuple(tried_of(tried)),
        notes=(f"The robot was asked {n_calls} times whether it can put an object.",),
    )


def tried_of(tried: pd.DataFrame) -> list[Tried]:
    """Return the rows of a table as what was tried, numbered per object."""
    columns = [tried[name].tolist() for name in ("object", "reason")]
    numbers = (tried.groupby("object").cumcount() + 1).tolist()
    lists = [
        [tuple(filter(None, names.split("+"))) for names in tried[column]]
        for column in ("blockers", "among")
    ]
    poses = tried[[*ORIENTATION, *LOCATION]].to_numpy(float)
    rows = zip(*columns, numbers, *lists, poses, strict=True)
    return [
        Tried(name, number, reason, blockers, among, T)
        for name, reason, number, blockers, among, T in rows
    ]


def in_order(certificates: list[Certificate], search: Search) -> list[Certificate]:
    """Return the certificates of the placed objects, in the order of the search."""
    found = {certificate.object_id: certificate for certificate in certificates}
    if set(found) != set(search.order):
        raise BadArtifact(
            f"certificates of objects {sorted(found)}; expected one of each object "
            f"that is placed, {sorted(search.order)}"
        )
    return [found[name] for name in search.order]


def rows_about(table: pd.DataFrame, values: dict[str, str]) -> pd.DataFrame:
    """Return the rows of a table that have these values."""
    keep = np.ones(len(table), bool)
    for column, value in values.items():
        keep &= (table[column] == value).to_numpy()
    return table[keep]


def result_of(certificates: list[Certificate], search: Search) -> PlanningResult:
    """Return what became of the objects of a plan, for its log."""
    world = certificates[0].world
    return PlanningResult(
        *(world.dataset, world.scene, world.task, world.constraints),
        order=search.order,
        refused=search.refused,
        targets={c.object_id: c.T_world_object for c in certificates},
    )

"""What became of the objects of a scenario when its plan was carried out."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from placing import rigid
from placing.methods.answer_tables import LOCATION, ORIENTATION
from placing.physics.settling import SettleConfig
from placing.robot.certificates import Certificate
from placing.robot.film import Film

AXES = (*LOCATION, *ORIENTATION)
EXECUTED_COLUMNS = (
    *("scenario", "object", "category", "order", "grasp"),
    *(f"planned_{axis}" for axis in AXES),
    *(f"final_{axis}" for axis in AXES),
    *("error_m", "error_deg", "placed", "reason"),
)
"""One row per object; planned and error are empty where there was no plan."""


def executed(
    planned: pd.DataFrame,
    certificates: Sequence[Certificate],
    film: Film,
    config: SettleConfig,
) -> pd.DataFrame:
    """Return where every object came to rest and how far that is from its plan.

    `planned` holds the rows of `placing.plans.robot_plans` of the scenario.
    """
    orders = {c.object_id: i for i, c in enumerate(certificates)}
    reasons = dict(zip(planned["object"], planned["reason"], strict=True))
    categories = dict(zip(planned["object"], planned["category"], strict=True))
    rows = []
    for i, name in enumerate(film.objects):
        row = {"scenario": planned["scene"].iloc[0], "object": name}
        row |= {"category": categories.get(name, ""), "order": orders.get(name, -1)}
        final = film.T_world_objects[-1, i]
        row |= _pose("final", final)
        if name not in orders:
            reason = reasons.get(name) or "not planned"
            rows.append(row | {"placed": False, "reason": reason})
            continue
        certificate = certificates[orders[name]]
        error_m, error_deg = rigid.difference(final, certificate.T_world_object)
        row |= _pose("planned", certificate.T_world_object)
        row |= {"grasp": certificate.grasp, "error_m": error_m, "error_deg": error_deg}
        reason = ""
        if error_m > config.max_moved_m:
            reason = f"came to rest {error_m * 1e3:.0f} mm from its place"
        elif error_deg > config.max_tilted_deg:
            reason = f"came to rest {error_deg:.0f} deg from its place"
        rows.append(row | {"placed": not reason, "reason": reason})
    table = pd.DataFrame(rows, columns=list(EXECUTED_COLUMNS))
    # What is not placed comes last.
    last = table["order"].replace(-1, len(table))
    return table.iloc[np.argsort(last, kind="stable")].reset_index(drop=True)


def _pose(name: str, T_world_object: np.ndarray) -> dict[str, float]:
    """Return a pose as columns."""
    values = np.roll(T_world_object, 3).tolist()
    return {f"{name}_{axis}": v for axis, v in zip(AXES, values, strict=True)}

"""What the robot does with every wanted object, as a checked table."""

from pathlib import Path

import numpy as np
import pandas as pd

from placing.artifacts.formats import read_table, write_table
from placing.errors import BadArtifact
from placing.methods.answer_tables import LOCATION, ORIENTATION, PLACED
from placing.plans.robot_plans import INSIDE, PLAN_COLUMNS, REFUSED, WITH

ALLOWED = {"constraints": (WITH, INSIDE), "status": (PLACED, REFUSED)}


def write_plans(path: Path, plans: pd.DataFrame) -> None:
    """Write the plans of a fold, rows with the columns of `robot_plans`."""
    write_table(path, plans)


def read_plans(path: Path) -> pd.DataFrame:
    """Read the plans of a fold."""
    plans = read_table(path, PLAN_COLUMNS)
    for name, known in ALLOWED.items():
        for value in sorted(set(plans[name]) - set(known)):
            raise BadArtifact(
                f"{path}: {name}: value {value!r}; expected one of {known}"
            )
    placed = plans[plans["status"] == PLACED]
    poses = placed[[*LOCATION, *ORIENTATION]].to_numpy(float)
    if not np.isfinite(poses).all():
        raise BadArtifact(f"{path}: expected a pose of every object that is placed")
    return plans

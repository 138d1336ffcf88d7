"""The places a robot may choose among, by question, as a checked table."""

from pathlib import Path

import numpy as np
import pandas as pd

from placing.artifacts.formats import read_table
from placing.errors import BadArtifact
from placing.plans.offering import OPTION_COLUMNS

NUMBERS = ("x_m", "y_m", "z_m", "yaw_rad", "log_density", "log_heading")


def read_options(path: Path) -> pd.DataFrame:
    """Read the options of a fold and task, with the columns of `offering`."""
    table = read_table(path, OPTION_COLUMNS)
    for name in NUMBERS if len(table) else ():
        if not np.isfinite(table[name].to_numpy(float)).all():
            raise BadArtifact(f"{path}: {name}: expected finite numbers")
    return table

"""What became of the objects of one plan, in a few words."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlanningResult:
    """What became of the objects of one plan."""

    dataset: str
    scene: str
    task: str
    constraints: str
    order: tuple[str, ...]
    """Objects in the order in which they are placed."""
    refused: Mapping[str, str]
    """Why each of the others is not placed."""
    targets: Mapping[str, Array]
    """(7,) poses `T_world_object` of the placed ones."""

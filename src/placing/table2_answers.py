"""What Table 2 compares: the placements of each method in the joint table."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from placing.answer_tables import LOCATION, ORIENTATION
from placing.errors import BadArtifact
from placing.scene import Placement, SceneObject

LABELS_OF = {
    "object_context": "object context",
    "fmm": "human context (FMM)",
    "dp": "human context (DP)",
    "dp_object_context": "DP + object context",
}
"""The methods of Table 2 in its order, and what they are called there."""
JOINT_COLUMNS = (
    *("scene", "method", "object", "area", "on", "is_placed", "reason"),
    *(*LOCATION, *ORIENTATION),
)
"""What is read of the joint placements."""


def answers_of(
    joint: pd.DataFrame, scene: str, objects: Sequence[SceneObject]
) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield each method with its rows (n) for a scene, in the order of `objects`."""
    names = [item.object_id for item in objects]
    of_scene = joint[joint["scene"] == scene]
    for method in LABELS_OF:
        rows = of_scene[of_scene["method"] == method].set_index("object")
        if sorted(rows.index) != sorted(names):
            raise BadArtifact(
                f"joint placements of {scene} by {method}: objects "
                f"{sorted(rows.index)}; expected each of {sorted(names)} once"
            )
        yield method, rows.loc[names].reset_index()


def placements_of(rows: pd.DataFrame) -> tuple[Placement, ...]:
    """Return the placements of the rows that are placed."""
    placed = rows[rows["is_placed"].astype(bool)]
    poses = placed[[*ORIENTATION, *LOCATION]].to_numpy(float)
    return tuple(
        Placement(name, on or area, np.array(pose[4:]), np.array(pose[:4]))
        for name, on, area, pose in zip(
            placed["object"], placed["on"], placed["area"], poses, strict=True
        )
    )

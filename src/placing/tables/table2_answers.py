"""What Table 2 compares: the placements of each method in the joint table."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import pandas as pd

from placing.errors import BadArtifact
from placing.methods.answer_tables import LOCATION, ORIENTATION
from placing.methods.names import JOINT_METHODS
from placing.scene import Placement, SceneObject

ANSWER_COLUMNS = (
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
    for method in JOINT_METHODS:
        rows = of_scene[of_scene["method"] == method].set_index("object")
        check_objects(rows.index, names, scene, method)
        yield method, rows.loc[names].reset_index()


def check_objects(
    found: Iterable[str], names: Iterable[str], scene: str, method: str
) -> None:
    """Raise `BadArtifact` unless every object has been placed once."""
    if sorted(found) != sorted(names):
        raise BadArtifact(
            f"joint placements of {scene} by {method}: objects {sorted(found)};"
            f" expected each of {sorted(names)} once"
        )


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

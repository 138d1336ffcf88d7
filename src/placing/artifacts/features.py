"""Placement candidates and valid human poses of a scene as arrays."""

from pathlib import Path

from placing.artifacts.formats import read_arrays, write_arrays
from placing.candidates import Candidates
from placing.people.human import HumanPoses


def read_features(path: Path) -> tuple[Candidates, HumanPoses]:
    """Read the placement candidates and the valid human poses of a scene."""
    names = ("location", "area", "features", "kind", "pose_location", "yaw", "prior")
    location, area, features, *poses = read_arrays(path, names).values()
    return Candidates(location, area, features), HumanPoses(*poses)


def write_features(path: Path, candidates: Candidates, poses: HumanPoses) -> None:
    """Write the placement candidates and the valid human poses of a scene."""
    arrays = vars(candidates) | {
        "kind": poses.kind,
        "pose_location": poses.location,
        "yaw": poses.yaw,
        "prior": poses.prior,
    }
    write_arrays(path, arrays)

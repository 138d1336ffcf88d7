"""Record every scene of a fold as each method of the joint placement arranges it."""

import logging
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table
from placing.artifacts.joint_tuning import read_joint_tuning
from placing.artifacts.proposals import read_proposals
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.errors import BadArtifact
from placing.joint.joint import JOINT_COLUMNS
from placing.methods.names import JOINT_METHODS
from placing.recordings.joint import joint_recording, method_density
from placing.recordings.joint_blueprint import write_joint

log = logging.getLogger(__name__)

CHECKED = ["dataset", "scene", "method", "object", "stays", "reason"]


def main(
    dataset: str,
    fold: int,
    clouds: Path,
    scenes: Path,
    features: Path,
    proposals: Path,
    tuning: Path,
    joint: Path,
    recordings: Path,
    spacing_m: float,
    checks: Path | None = None,
) -> None:
    """Record every scene of a fold as each method arranges it.

    Args:
        dataset: Data set of the scenes.
        fold: Fold of the scenes.
        clouds: Directory of the clouds of the fold.
        scenes: Directory of its scenes.
        features: Directory of their places.
        proposals: Directory of the densities over these places.
        tuning: Omega, by which the densities of two contexts are mixed.
        joint: Table of the joint placements.
        recordings: Directory to write, with a directory per method.
        spacing_m: Lattice of the places.
        checks: Table of whether they stay put; left out: unknown.
    """
    weight = read_joint_tuning(tuning).object_weight
    table = read_table(joint, JOINT_COLUMNS)
    settled = None if checks is None else read_checks(checks)
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        cloud = read_ply(clouds / f"{scene.scene}.ply")
        candidates, _ = read_features(features / f"{scene.scene}.npz")
        densities = read_proposals(proposals / f"{scene.scene}.npz").densities
        for method in JOINT_METHODS:
            content = joint_recording(
                (dataset, fold, method),
                *(scene, cloud, candidates, spacing_m),
                method_density(densities, method, weight),
                only(table, dataset, scene.scene, method),
                None
                if settled is None
                else only(settled, dataset, scene.scene, method),
            )
            (recordings / method).mkdir(parents=True, exist_ok=True)
            write_joint(recordings / method / f"{scene.scene}.rrd", content)
    log.info("%s fold %d: joint placements recorded", dataset, fold)


def only(table: pd.DataFrame, dataset: str, scene: str, method: str) -> pd.DataFrame:
    """Return the rows of a scene and method."""
    is_of = (table["dataset"] == dataset) & (table["scene"] == scene)
    return table[is_of & (table["method"] == method)]


def read_checks(path: Path) -> pd.DataFrame:
    """Return the table of checks."""
    try:
        return pd.read_csv(path, usecols=CHECKED, keep_default_na=False)
    except (OSError, ValueError) as error:
        message = f"{path}: {error}; expected a table of settle_joint"
        raise BadArtifact(message) from error


if __name__ == "__main__":
    run(main)

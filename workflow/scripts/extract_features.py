"""Find the valid human poses and the placement candidates of every scene of a fold."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.features import write_features
from placing.artifacts.scenes import read_scene
from placing.candidates import CandidatesConfig
from placing.clouds.ply import read_ply
from placing.people.valid_poses import PosesConfig, valid_poses
from placing.places import find_candidates

log = logging.getLogger(__name__)


def main(
    clouds: Path,
    scenes: Path,
    features: Path,
    candidates: CandidatesConfig,
    poses: PosesConfig,
) -> None:
    """Find the valid human poses and the placement candidates of every scene."""
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        cloud = read_ply(clouds / f"{scene.scene}.ply")
        places = find_candidates(cloud, scene.areas, candidates)
        valid = valid_poses(cloud.points, scene.areas, poses)
        write_features(features / f"{scene.scene}.npz", places, valid)
        counts = f"{len(places.location)} places, {len(valid.kind)} valid poses"
        log.info("%s: %s", scene.scene, counts)


if __name__ == "__main__":
    run(main)

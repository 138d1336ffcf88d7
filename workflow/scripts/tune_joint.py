"""Choose omega of the joint placement, and how often objects stand on their like."""

import logging
from pathlib import Path

import numpy as np
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_json
from placing.artifacts.proposals import read_proposals
from placing.artifacts.scenes import read_scene
from placing.joint.joint_tuning import stack_shares, weight_nll
from placing.learning.likelihoods import ScoringConfig

log = logging.getLogger(__name__)


def main(
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    proposals: tuple[Path, ...],
    tuning: Path,
    spacing_m: float,
    object_weights: tuple[float, ...],
    scoring: ScoringConfig,
) -> None:
    """Choose omega of the joint placement, and how often objects stand on their like.

    Args:
        scenes: Directories of labelled scenes, one per fold.
        features: Directories of their features, in the same order.
        proposals: Directories of what was proposed for them without their fold.
        tuning: File to write.
        spacing_m: Lattice of the places.
        object_weights: Values of omega that are tried.
        scoring: How densities are scored.
    """
    read, nll = [], []
    folders = list(zip(scenes, features, proposals, strict=True))
    for of_scenes, of_features, of_proposals in tqdm(
        folders, unit="fold", disable=None
    ):
        for path in sorted(of_scenes.glob("*.json")):
            scene = read_scene(path)
            if not scene.arrangements:
                continue
            places = read_features(of_features / f"{scene.scene}.npz")[0].location
            found = read_proposals(of_proposals / f"{scene.scene}.npz").densities
            args = object_weights, spacing_m, scoring
            nll.append(weight_nll(scene, places, found, *args))
            read.append(scene)
    mean = np.mean(nll, axis=0)
    best = float(object_weights[int(np.argmin(mean))])
    document = {
        "object_weight": best,
        "nll": {f"{w:g}": float(v) for w, v in zip(object_weights, mean, strict=True)},
        "stack_shares": stack_shares(read),
        "scenes": sorted(scene.scene for scene in read),
    }
    write_json(tuning, document)
    log.info("%d scenes choose omega = %g", len(read), best)


if __name__ == "__main__":
    run(main)

"""Arrange the objects of every empty scene of a fold together, by every context."""

import logging
from pathlib import Path

import numpy as np
import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.joint_tuning import read_joint_tuning
from placing.artifacts.proposals import read_proposals
from placing.artifacts.scenes import read_scene
from placing.joint.assignment_config import AssignmentConfig
from placing.joint.joint import (
    JOINT_COLUMNS,
    JointConfig,
    arrange,
    log_scores,
    stack_pairs,
)
from placing.methods.names import JOINT_METHODS
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: str,
    scenes: Path,
    features: Path,
    proposals: Path,
    tuning: Path,
    joint: Path,
    seed: int,
    placing: JointConfig,
    assignment: AssignmentConfig,
) -> None:
    """Arrange the objects of every empty scene of a fold together.

    Args:
        dataset: Data set of the scenes.
        scenes: Directory of the scenes of the fold.
        features: Directory of their features.
        proposals: Directory of what is proposed for them.
        tuning: Omega, and how often objects stand on their like.
        joint: Table to write.
        seed: Root of all random streams.
        placing: Settings of the joint placement.
        assignment: Settings of the integer program.
    """
    chosen, rows = read_joint_tuning(tuning), []
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        candidates, _ = read_features(features / f"{scene.scene}.npz")
        proposed = read_proposals(proposals / f"{scene.scene}.npz")
        stacks = stack_pairs(scene, proposed.stacks, chosen.stack_shares, placing)
        for method in JOINT_METHODS:
            names = dataset, scene.scene, method
            rng = generator(seed, "arrange_jointly", *names)
            scores = log_scores(proposed.proposals, method, chosen.object_weight)
            args = scene, candidates, proposed.proposals, scores, stacks
            found = arrange(rng, *args, (placing, assignment))
            key = dict(zip(("dataset", "scene", "method"), names, strict=True))
            rows += [key | row for row in found]
    table = pd.DataFrame(rows, columns=list(JOINT_COLUMNS))
    write_table(joint, table)
    n_left = int(np.sum(~table["is_placed"]))
    log.info("%s: %d placed, %d not", dataset, len(table) - n_left, n_left)


if __name__ == "__main__":
    run(main)

"""Arrange the objects of every scene of a fold with every method of a task."""

import logging
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.answer_tables import (
    PLACEMENT_COLUMNS,
    POSE_COLUMNS,
    placement_rows,
    pose_rows,
)
from placing.answering import METHODS, answer
from placing.artifacts.densities import write_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import read_learned
from placing.scene_model import SceneModel, Settings
from placing.scoring import density_key
from placing.seeds import generator
from placing.tasks import questions

log = logging.getLogger(__name__)


def main(
    dataset: str,
    task: str,
    scenes: Path,
    features: Path,
    theta: Path,
    arrangements: Path,
    poses: Path,
    densities: Path,
    seed: int,
    settings: Settings,
) -> None:
    """Arrange the objects of every scene of a fold with every method of a task."""
    learned = read_learned(theta)
    placed, sampled = [], []
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        candidates, valid = read_features(features / f"{scene.scene}.npz")
        model = SceneModel(scene, candidates, valid, learned, settings)
        of_scene = {}
        for question in questions(scene, task):
            for method in METHODS:
                names = (dataset, scene.scene, task, method, question.name)
                rng = generator(seed, "sample_arrangement", *names)
                given = answer(rng, model, question, method)
                row = (scene.scene, task, method, question)
                placed += placement_rows(*row, given)
                if given.chains is not None:
                    sampled.append(pose_rows(*row, given.chains, valid))
                for category, density in given.densities.items():
                    key = density_key(method, question.name, category)
                    of_scene[key] = density
        write_densities(densities / f"{scene.scene}.npz", of_scene)
    write_table(arrangements, pd.DataFrame(placed, columns=PLACEMENT_COLUMNS))
    write_table(poses, pd.concat(sampled or [pd.DataFrame(columns=POSE_COLUMNS)]))
    log.info("%s %s: %d objects placed", dataset, task, len(placed))


if __name__ == "__main__":
    run(main)

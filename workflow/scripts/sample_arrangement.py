"""Arrange the objects of every scene of a fold with every method of a task."""

import logging
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.answer_tables import placement_rows, pose_rows
from placing.answering import METHODS, Answerer, Settings
from placing.artifacts.densities import write_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import read_learned
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
        answerer = Answerer(scene, candidates, valid, learned, settings)
        of_scene = {}
        for question in questions(scene, task):
            for method in METHODS:
                names = (dataset, scene.scene, task, method, question.name)
                rng = generator(seed, "sample_arrangement", *names)
                answer = answerer.answer(rng, question, method)
                row = (scene.scene, task, method, question, answer)
                placed.append(placement_rows(*row))
                sampled.append(pose_rows(*row, valid))
                for category, density in answer.densities.items():
                    key = density_key(method, question.name, category)
                    of_scene[key] = density
        write_densities(densities / f"{scene.scene}.npz", of_scene)
    write_table(arrangements, pd.concat(placed, ignore_index=True))
    write_table(poses, pd.concat([p for p in sampled if len(p)], ignore_index=True))
    log.info("%s %s: %d scenes arranged", dataset, task, len(placed))


if __name__ == "__main__":
    run(main)

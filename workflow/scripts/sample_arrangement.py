"""Arrange the objects of every scene of a fold with every method of a task."""

import logging
from functools import partial
from pathlib import Path

from numpy.random import Generator
from tqdm import tqdm

from command import run
from placing.answer_sheets import Sheets
from placing.answering import Asked
from placing.artifacts.densities import write_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import read_learned
from placing.artifacts.tuning import read_tuning
from placing.likelihoods import ScoringConfig
from placing.scene_model import SceneModel, Settings
from placing.seeds import generator
from placing.tasks import questions

log = logging.getLogger(__name__)


def main(
    dataset: str,
    task: str,
    theta: Path,
    tuning: Path,
    scenes: Path,
    features: Path,
    arrangements: Path,
    likelihoods: Path,
    poses: Path,
    densities: Path,
    traces: Path,
    diagnoses: Path,
    explanations: Path,
    seed: int,
    settings: Settings,
    scoring: ScoringConfig,
) -> None:
    """Arrange the objects of every scene of a fold with every method of a task.

    Args:
        dataset: Data set of the scenes.
        task: filled or empty.
        theta: Directory of what was learned without the fold.
        tuning: What the training scenes chose.
        scenes: Directory of the scenes of the fold.
        features: Directory of their features.
        arrangements: Table to write: where every method puts every object.
        likelihoods: Table to write: how likely it finds the labelled places.
        poses: Table to write: the human poses sampled by `dp`, first chain.
        densities: Directory to write: the densities of `dp` and `dp_object`.
        traces: Table to write: every sweep of every chain of `dp`.
        diagnoses: Table to write: whether the chains of a question agree.
        explanations: Table to write: why `dp` and `dp_object` chose a place.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        scoring: How densities are scored.
    """
    learned = read_learned(theta)
    choices, ranks = read_tuning(tuning, task)
    sheets = Sheets(scoring, ranks[task])
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        candidates, valid = read_features(features / f"{scene.scene}.npz")
        model = SceneModel(scene, candidates, valid, learned, settings)
        kept = {}
        for question in questions(scene, task):
            names = (dataset, scene.scene, task)
            stream = partial(named, seed, names, question.name)
            kept |= sheets.fill(task, Asked(stream, model, question, choices))
        write_densities(densities / f"{scene.scene}.npz", kept)
    write_table(arrangements, sheets.table("arrangements"))
    write_table(likelihoods, sheets.table("likelihoods"))
    write_table(poses, sheets.table("poses"))
    write_table(traces, sheets.table("traces"))
    write_table(diagnoses, sheets.table("diagnoses"))
    write_table(explanations, sheets.table("explanations"))
    log.info("%s %s: %d objects placed", dataset, task, sheets.n_placed())


def named(seed: int, names: tuple[str, ...], question: str, method: str) -> Generator:
    """Return the stream of a method that answers a question."""
    return generator(seed, "sample_arrangement", *names, method, question)


if __name__ == "__main__":
    run(main)

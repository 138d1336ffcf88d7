"""Arrange the objects of every scene of a fold with every method, for both tasks."""

import logging
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from numpy.random import Generator
from tqdm import tqdm

from command import run
from placing.artifacts.densities import write_densities
from placing.artifacts.formats import write_table
from placing.artifacts.models import read_model
from placing.artifacts.theta import read_learned
from placing.artifacts.tuning import read_tuning
from placing.learning.learned import Choices
from placing.learning.likelihoods import ScoringConfig
from placing.methods.answering import Asked
from placing.methods.scene_model import SceneModel, Settings
from placing.plans.offering import OfferingConfig
from placing.seeds import generator
from placing.tables.answer_sheets import COLUMNS, Sheets
from placing.tasks import TASKS, questions

log = logging.getLogger(__name__)


def main(
    dataset: str,
    theta: Path,
    tuning: Path,
    scenes: Path,
    features: Path,
    arrangements: tuple[Path, ...],
    likelihoods: tuple[Path, ...],
    poses: tuple[Path, ...],
    densities: tuple[Path, ...],
    traces: tuple[Path, ...],
    diagnoses: tuple[Path, ...],
    explanations: tuple[Path, ...],
    options: tuple[Path, ...],
    seed: int,
    settings: Settings,
    scoring: ScoringConfig,
    offering: OfferingConfig,
    robot_scenes: tuple[str, ...] = (),
) -> None:
    """Arrange the scenes of a fold with every method; outputs are filled, then empty.

    Args:
        dataset: Data set of the scenes.
        theta: Directory of what was learned without the fold.
        tuning: What the training scenes chose.
        scenes: Directory of the scenes of the fold.
        features: Directory of their features.
        arrangements: Tables to write: where every method puts every object.
        likelihoods: Tables to write: how likely it finds the labelled places.
        poses: Tables to write: the human poses sampled by `dp`, first chain.
        densities: Directories to write: the densities of `dp` and `dp_object`.
        traces: Tables to write: every sweep of every chain of `dp`.
        diagnoses: Tables to write: whether the chains of a question agree.
        explanations: Tables to write: why `dp` and `dp_object` chose a place.
        options: Tables to write: the places that a robot may choose among.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        scoring: How densities are scored.
        offering: Which places a robot may choose among.
        robot_scenes: Scenes in which a robot works.
    """
    learned, offer = read_learned(theta), dict.fromkeys(robot_scenes, offering)
    choices, sheets = blank(tuning, scoring)
    args = sheets, choices, partial(named, seed, dataset), offer, densities
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        fill(read_model(path, features, learned, settings), *args)
    outputs = arrangements, likelihoods, poses, traces, diagnoses, explanations, options
    write(sheets, dict(zip(COLUMNS, outputs, strict=True)))
    log.info("%s: %d objects placed", dataset, sum(s.n_placed() for s in sheets))


def blank(
    tuning: Path, scoring: ScoringConfig
) -> tuple[tuple[Choices, ...], list[Sheets]]:
    """Return what was chosen for each task, and its sheets without answers."""
    choices, ranks = zip(*(read_tuning(tuning, task) for task in TASKS), strict=True)
    pairs = zip(TASKS, ranks, strict=True)
    return choices, [Sheets(scoring, of_task[task]) for task, of_task in pairs]


def fill(
    model: SceneModel,
    sheets: Sequence[Sheets],
    choices: Sequence[Choices],
    stream: partial,
    offer: Mapping[str, OfferingConfig],
    densities: Sequence[Path],
) -> None:
    """Answer all questions of both tasks about a scene; write the densities to keep."""
    scene = model.scene
    for task, sheet, chosen, folder in zip(
        TASKS, sheets, choices, densities, strict=True
    ):
        kept = {}
        for question in questions(scene, task):
            of_question = partial(stream, scene.scene, task, question.name)
            asked = Asked(of_question, model, question, chosen)
            kept |= sheet.fill(task, asked)
            if scene.scene in offer:
                sheet.offer(task, asked, offer[scene.scene])
        write_densities(folder / f"{scene.scene}.npz", kept)


def write(sheets: Sequence[Sheets], outputs: Mapping[str, Sequence[Path]]) -> None:
    """Write every table of every task."""
    for name, paths in outputs.items():
        for of_task, path in zip(sheets, paths, strict=True):
            write_table(path, of_task.table(name))


def named(
    seed: int, dataset: str, scene: str, task: str, question: str, method: str
) -> Generator:
    """Return the stream of a method that answers a question."""
    names = dataset, scene, task, method, question
    return generator(seed, "sample_arrangement", *names)


if __name__ == "__main__":
    run(main)

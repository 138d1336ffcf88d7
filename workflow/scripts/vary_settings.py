"""Arrange the scenes of a fold by `dp` with one setting changed at a time."""

import logging
from functools import partial
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import read_learned
from placing.learning.learned import Choices
from placing.learning.likelihoods import (
    LIKELIHOOD_COLUMNS,
    ScoringConfig,
    likelihood_rows,
    with_uniform,
)
from placing.learning.tuning import asked_of
from placing.learning.variations import (
    SensitivityConfig,
    coarser_places,
    coarser_poses,
    variations,
)
from placing.methods.answer_tables import PLACEMENT_COLUMNS, placement_rows
from placing.methods.answering import Asked
from placing.methods.scene_model import SceneModel, Settings
from placing.seeds import generator
from placing.tables.scoring import score_scene
from placing.tasks import TASKS

log = logging.getLogger(__name__)

METHOD = "dp"
UNUSED = Choices(n_components=1, object_weight=1.0)
"""`dp` looks at neither."""


def main(
    dataset: str,
    theta: Path,
    scenes: Path,
    features: Path,
    scores: Path,
    seed: int,
    settings: Settings,
    sensitivity: SensitivityConfig,
    scoring: ScoringConfig,
) -> None:
    """Arrange the scenes of a fold by `dp` with one setting changed at a time.

    One labelled arrangement of each scene fills it, in turn.

    Args:
        dataset: Data set of the scenes.
        theta: Directory of what was learned without the fold.
        scenes: Directory of the scenes of the fold.
        features: Directory of their features.
        scores: Table to write, with a column that names what was changed.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        sensitivity: What is changed.
        scoring: How densities are scored.
    """
    learned = read_learned(theta)
    tables = []
    paths = sorted(scenes.glob("*.json"))
    for turn, path in enumerate(tqdm(paths, unit="scene", disable=None)):
        scene = read_scene(path)
        candidates, valid = read_features(features / f"{scene.scene}.npz")
        for variation in variations(settings, sensitivity):
            spacing_m = variation.settings.candidates.spacing_m
            places = coarser_places(candidates, spacing_m)
            poses = valid
            if variation.coarsening > 1:
                poses = coarser_poses(valid, variation.coarsening)
            model = SceneModel(scene, places, poses, learned, variation.settings)
            for task in TASKS:
                names = (dataset, scene.scene, task)
                stream = partial(generator, seed, "vary_settings", *names)
                args = model, task, turn, stream, spacing_m, scoring
                scored = scores_of(*args)
                tables.append(scored.assign(variation=variation.name, task=task))
    write_table(scores, pd.concat(tables, ignore_index=True).assign(dataset=dataset))
    log.info("%s: %d scenes varied", dataset, len(paths))


def scores_of(
    model: SceneModel,
    task: str,
    turn: int,
    stream: partial,
    spacing_m: float,
    scoring: ScoringConfig,
) -> pd.DataFrame:
    """Return the scores of one scene and task under one set of settings."""
    rows, likely = [], []
    for question in asked_of(model, task, turn):
        asked = Asked(partial(stream, question.name), model, question, UNUSED)
        given = asked.answer(METHOD)
        rows += placement_rows(model.scene.scene, task, METHOD, question, given, {})
        key = model.scene.scene, task, METHOD, question.name
        mixed = {c: with_uniform(d, scoring) for c, d in given.densities.items()}
        args = model.nearest, question, mixed, spacing_m
        likely += [(*key, *row) for row in likelihood_rows(*args)]
    answers = pd.DataFrame(rows, columns=PLACEMENT_COLUMNS)
    likelihoods = pd.DataFrame(likely, columns=LIKELIHOOD_COLUMNS)
    scored = score_scene(model.scene, answers, likelihoods)
    return scored[scored["method"] == METHOD]


if __name__ == "__main__":
    run(main)

"""Choose K and omega of a fold on its training scenes, and calibrate regions."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_json
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import read_learned
from placing.learning.likelihoods import ScoringConfig
from placing.learning.tuning import (
    COLUMNS,
    TuningConfig,
    asked_of,
    choose,
    try_variants,
)
from placing.methods.scene_model import SceneModel, Settings
from placing.seeds import generator
from placing.tasks import TASKS

log = logging.getLogger(__name__)


def main(
    dataset: str,
    fold: int,
    theta: tuple[Path, ...],
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    tuning_file: Path,
    seed: int,
    settings: Settings,
    tuning: TuningConfig,
    scoring: ScoringConfig,
) -> None:
    """Choose K and omega of a fold on its training scenes, and calibrate regions.

    Args:
        dataset: Data set of the scenes.
        fold: Fold that is held out.
        theta: What was learned without that fold and one more, each.
        scenes: Directories of the scenes of that other fold, same order.
        features: Directories of their features, same order.
        tuning_file: JSON to write.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        tuning: What is tried, and on how much.
        scoring: How densities are scored.
    """
    sampling = replace(
        settings.sampling,
        n_chains=tuning.n_chains,
        n_burn_in=tuning.n_burn_in,
        n_samples=tuning.n_samples,
    )
    settings = replace(settings, sampling=sampling)
    rows = []
    folders = list(zip(theta, scenes, features, strict=True))
    each = -(-tuning.max_scenes // len(folders))
    for i, folder in enumerate(tqdm(folders, unit="fold", disable=None)):
        found = models(*folder, each, i / len(folders), settings)
        for turn, model in enumerate(found):
            for task in TASKS:
                for question in asked_of(model, task, turn):
                    names = (dataset, str(fold), model.scene.scene, task, question.name)
                    stream = partial(generator, seed, "tune_methods", *names)
                    args = stream, model, task, question, tuning, scoring
                    rows += list(try_variants(*args))
    document = choose(pd.DataFrame(rows, columns=COLUMNS))
    write_json(tuning_file, document)
    log.info("%s fold %d: %s", dataset, fold, document["choices"])


def models(
    theta: Path,
    scenes: Path,
    features: Path,
    n_scenes: int,
    start: float,
    settings: Settings,
) -> Iterator[SceneModel]:
    """Yield `n_scenes` labelled scenes of a fold, evenly spread over their names.

    Names sort scenes by kind: folds that begin at another `start` (0 to 1) of a step
    do not all show the same kinds.
    """
    learned = read_learned(theta)
    paths = sorted(scenes.glob("*.json"))
    step = len(paths) / min(n_scenes, len(paths))
    for path in [
        paths[int((k + start) * step)] for k in range(round(len(paths) / step))
    ]:
        scene = read_scene(path)
        candidates, valid = read_features(features / f"{scene.scene}.npz")
        if scene.arrangements and len(candidates.location):
            yield SceneModel(scene, candidates, valid, learned, settings)


if __name__ == "__main__":
    run(main)

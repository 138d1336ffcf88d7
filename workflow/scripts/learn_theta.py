"""Learn Theta and the baselines of one fold from the scenes of the other folds."""

import logging
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_json, write_table
from placing.artifacts.scenes import read_scene
from placing.baselines import FEATURES_OF, BaselinesConfig, learn_histograms
from placing.candidates import Candidates
from placing.dpmm import DpmmConfig
from placing.examples import baseline_values, examples_of
from placing.fitting import FittingConfig
from placing.human import HumanPoses
from placing.learning import LearningConfig, learn_theta
from placing.scene import Scene
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: str,
    fold: int,
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    theta: Path,
    seed: int,
    sampling: DpmmConfig,
    learning: LearningConfig,
    fitting: FittingConfig,
    baselines: BaselinesConfig,
) -> None:
    """Learn Theta and the baselines of one fold from the scenes of the other folds."""
    training = list(read_training(scenes, features))
    names = sorted(scene.scene for scene, _, _ in training)
    for method in FEATURES_OF:
        values = baseline_values([(s, c) for s, c, _ in training], method)
        shares = learn_histograms(values, method, baselines)
        document = {"categories": shares, "training_scenes": names}
        write_json(theta / f"{method}.json", document)
    rng = generator(seed, "learn_theta", dataset, str(fold))
    examples = [examples_of(scene, poses) for scene, _, poses in training]
    thetas, trace = learn_theta(rng, examples, sampling, learning, fitting)
    document = {name: asdict(value) for name, value in thetas.items()}
    log_likelihood = trace["log_likelihood"].iloc[-1]
    write_json(
        theta / "dp.json",
        {
            "categories": document,
            "training_scenes": names,
            "log_likelihood": log_likelihood,
        },
    )
    write_table(theta / "dp.trace.parquet", trace)
    log.info(
        "%s fold %d: %d categories, mean log joint %.2f",
        dataset,
        fold,
        len(thetas),
        log_likelihood,
    )


def read_training(
    scenes: tuple[Path, ...], features: tuple[Path, ...]
) -> Iterator[tuple[Scene, Candidates, HumanPoses]]:
    """Yield the labelled training scenes with their places and valid poses."""
    for scene_folder, feature_folder in zip(scenes, features, strict=True):
        for path in sorted(scene_folder.glob("*.json")):
            scene = read_scene(path)
            candidates, poses = read_features(feature_folder / f"{scene.scene}.npz")
            if scene.arrangements and len(poses.kind):
                yield scene, candidates, poses


if __name__ == "__main__":
    run(main)

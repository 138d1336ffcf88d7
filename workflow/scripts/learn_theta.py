"""Learn what every method needs from the scenes of the folds that are not held out."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_table
from placing.artifacts.scenes import read_scene
from placing.artifacts.theta import write_histograms, write_relations, write_thetas
from placing.candidates import Candidates
from placing.learning.examples import baseline_values, examples_of
from placing.learning.fitting import FittingConfig
from placing.learning.likelihoods import nearest_places
from placing.learning.theta import LearningConfig, learn_theta
from placing.methods.baselines import FEATURES_OF, BaselinesConfig, learn_histograms
from placing.methods.object_context import ObjectContextConfig, learn_relations
from placing.people.dpmm import DpmmConfig
from placing.people.human import HumanPoses
from placing.scene import Scene
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: str,
    held_out: str,
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    theta: Path,
    seed: int,
    n_components: tuple[int, ...],
    sampling: DpmmConfig,
    learning: LearningConfig,
    fitting: FittingConfig,
    baselines: BaselinesConfig,
    object_context: ObjectContextConfig,
) -> None:
    """Learn what every method needs from the scenes of the folds not held out.

    Args:
        dataset: Data set of the scenes.
        held_out: Name of the folds that are not looked at.
        scenes: Directories of the scenes to learn from, one per fold.
        features: Directories of their features, in the same order.
        theta: Directory to write.
        seed: Root of all random streams.
        n_components: Poses K of each finite mixture that is learned for.
        sampling: The sampler.
        learning: Rounds and restarts.
        fitting: Bounds and shrinkage of Theta.
        baselines: Bins of the baselines.
        object_context: Bounds and shrinkage of the object context.
    """
    training = list(read_training(scenes, features))
    names = sorted(scene.scene for scene, _, _ in training)
    placed = [(s, c, nearest_places(s, c.location)) for s, c, _ in training]
    for method in FEATURES_OF:
        values = baseline_values(placed, method)
        shares = learn_histograms(values, method, baselines)
        write_histograms(theta / f"{method}.json", shares, names)
    labelled = [(s, a) for s, _, _ in training for a in s.arrangements]
    relations = learn_relations(labelled, object_context)
    write_relations(theta / "object.json", relations, names)
    examples = [examples_of(scene, poses) for scene, _, poses in training]
    if is_inner(held_out):
        learning = replace(learning, n_restarts=1)
    for k in tqdm((0, *n_components), unit="mixture", disable=None):
        name = f"fmm{k}" if k else "dp"
        rng = generator(seed, "learn_theta", dataset, held_out, name)
        thetas, trace = learn_theta(rng, examples, sampling, learning, fitting, k)
        write_thetas(theta / f"{name}.json", thetas, names)
        write_table(theta / f"{name}.trace.parquet", trace)
    log.info("%s without %s: %d categories", dataset, held_out, len(thetas))


def is_inner(held_out: str) -> bool:
    """Return whether two folds are held out, to choose numbers only."""
    # ASSUME: one start is enough to choose K and omega and to calibrate.
    return len(held_out.split("_")) > 1


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

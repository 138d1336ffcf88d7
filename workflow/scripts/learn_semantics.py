"""Learn on which placing areas objects belong from the folds not held out."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.scenes import read_scene
from placing.artifacts.semantics import write_semantics
from placing.clouds.ply import read_ply
from placing.psi.labelled_areas import label_scene
from placing.psi.object_clouds import LookingConfig
from placing.psi.semantics import LabelledScene, SemanticsConfig, learn_semantics
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: str,
    held_out: str,
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    clouds: tuple[Path, ...],
    model: Path,
    seed: int,
    looking: LookingConfig,
    semantics: SemanticsConfig,
) -> None:
    """Learn on which placing areas objects belong from the folds not held out.

    Args:
        dataset: Data set of the scenes.
        held_out: Name of the folds that are not looked at.
        scenes: Directories of the scenes to learn from, one per fold.
        features: Directories of their features, in the same order.
        clouds: Directories of their clouds, in the same order.
        model: JSON to write.
        seed: Root of all random streams.
        looking: How closely objects and scenes are looked at.
        semantics: How semantics are learned.
    """
    folders = zip(scenes, features, clouds, strict=True)
    paths = [
        (path, of_features / f"{path.stem}.npz", of_clouds / f"{path.stem}.ply")
        for of_scenes, of_features, of_clouds in folders
        for path in sorted(of_scenes.glob("*.json"))
    ]
    labelled = [
        read_labelled(*files, looking.object_spacing_m)
        for files in tqdm(paths, unit="scene", disable=None)
    ]
    rng = generator(seed, "learn_semantics", dataset, held_out)
    learned = learn_semantics(rng, labelled, semantics)
    write_semantics(model, learned, sorted(one.scene for one in labelled))
    log.info("%s without %s: %d scenes", dataset, held_out, len(labelled))


def read_labelled(
    scene: Path, features: Path, cloud: Path, spacing_m: float
) -> LabelledScene:
    """Return what semantics are learned from in a scene."""
    candidates, _ = read_features(features)
    return label_scene(read_scene(scene), read_ply(cloud), candidates, spacing_m)


if __name__ == "__main__":
    run(main)

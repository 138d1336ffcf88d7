"""Tell how often the area that a labeller chose is among the most probable ones."""

import logging
from pathlib import Path

import numpy as np
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import write_csv
from placing.artifacts.scenes import read_scene
from placing.artifacts.semantics import read_semantics
from placing.artifacts.theta import read_histograms
from placing.clouds.ply import read_ply
from placing.methods.baselines import BaselinesConfig
from placing.psi.labelled_areas import label_scene
from placing.psi.object_clouds import LookingConfig
from placing.psi.semantics import log_odds
from placing.tables.semantics_table import height_shares, hit_rows, tabulate_semantics

log = logging.getLogger(__name__)


def main(
    models: tuple[Path, ...],
    theta: tuple[Path, ...],
    scenes: tuple[Path, ...],
    features: tuple[Path, ...],
    clouds: tuple[Path, ...],
    table: Path,
    looking: LookingConfig,
    baselines: BaselinesConfig,
) -> None:
    """Tell how often the area that a labeller chose is among the most probable ones.

    Args:
        models: What was learned of objects and areas without each fold.
        theta: Directories of what else was learned without it, in the same order.
        scenes: Directories of the scenes of the fold, in the same order.
        features: Directories of their features, in the same order.
        clouds: Directories of their clouds, in the same order.
        table: Table to write, a line for each category and method.
        looking: How closely objects and scenes are looked at.
        baselines: Bins of the histograms of heights.
    """
    rows = []
    folds = list(zip(models, theta, scenes, features, clouds, strict=True))
    for fold in tqdm(folds, unit="fold", disable=None):
        of_semantics, of_theta, of_scenes, of_features, of_clouds = fold
        model = read_semantics(of_semantics)
        histograms = read_histograms(of_theta / "height.json")
        spacing_m = looking.object_spacing_m
        for path in sorted(of_scenes.glob("*.json")):
            scene = read_scene(path)
            candidates, _ = read_features(of_features / f"{scene.scene}.npz")
            cloud = read_ply(of_clouds / f"{scene.scene}.ply")
            labelled = label_scene(scene, cloud, candidates, spacing_m)
            odds = log_odds(model, labelled.objects, labelled.areas)
            found = {
                "chance": np.ones_like(odds),
                "height": height_shares(scene, candidates, histograms, baselines),
                "semantics": 1 / (1 + np.exp(-odds)),
            }
            rows += hit_rows(scene, labelled.shares, found)
    found = tabulate_semantics(rows)
    write_csv(table, found)
    log.info("%s", found[found["category"] == "all"].to_string(index=False))


if __name__ == "__main__":
    run(main)

"""Compare the arrangements of a fold and task with the labelled ones."""

import logging
from pathlib import Path

import pandas as pd

from command import run
from placing.answer_tables import PLACEMENT_COLUMNS
from placing.artifacts.densities import read_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table, write_table
from placing.artifacts.scenes import read_scene
from placing.scoring import ScoringConfig, score_scene

log = logging.getLogger(__name__)


def main(
    dataset: str,
    task: str,
    scenes: Path,
    features: Path,
    arrangements: Path,
    densities: Path,
    scores: Path,
    spacing_m: float,
    scoring: ScoringConfig,
) -> None:
    """Compare the arrangements of a fold and task with the labelled ones."""
    answers = read_table(arrangements, PLACEMENT_COLUMNS)
    tables = []
    for path in sorted(scenes.glob("*.json")):
        scene = read_scene(path)
        candidates, _ = read_features(features / f"{scene.scene}.npz")
        of_scene = answers[answers["scene"] == scene.scene]
        density = read_densities(densities / f"{scene.scene}.npz")
        args = (scene, of_scene, density, candidates, spacing_m, scoring)
        tables.append(score_scene(*args))
    table = pd.concat(tables, ignore_index=True)
    write_table(scores, table.assign(dataset=dataset, task=task))
    log.info("%s %s: %d scores", dataset, task, len(table))


if __name__ == "__main__":
    run(main)

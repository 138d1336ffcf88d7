"""Compare the arrangements of a fold and task with the labelled ones."""

import logging
from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_table
from placing.artifacts.scenes import read_scene
from placing.learning.likelihoods import LIKELIHOOD_COLUMNS
from placing.tables.metrics import SCORE_COLUMNS
from placing.tables.scoring import ANSWER_COLUMNS, score_scene

log = logging.getLogger(__name__)


def main(
    dataset: str,
    task: str,
    scenes: Path,
    arrangements: Path,
    likelihoods: Path,
    scores: Path,
) -> None:
    """Compare the arrangements of a fold and task with the labelled ones.

    Args:
        dataset: Data set of the scenes.
        task: filled or empty.
        scenes: Directory of the scenes of the fold.
        arrangements: Where every method puts every object.
        likelihoods: How likely every method finds the labelled places.
        scores: Table to write.
    """
    answers = read_table(arrangements, ANSWER_COLUMNS)
    likely = read_table(likelihoods, LIKELIHOOD_COLUMNS)
    tables = []
    for path in sorted(scenes.glob("*.json")):
        scene = read_scene(path)
        of_scene = (table[table["scene"] == scene.scene] for table in (answers, likely))
        tables.append(score_scene(scene, *of_scene))
    table = pd.concat(tables, ignore_index=True).assign(dataset=dataset, task=task)
    write_table(scores, table[list(SCORE_COLUMNS)])
    log.info("%s %s: %d scores", dataset, task, len(table))


if __name__ == "__main__":
    run(main)

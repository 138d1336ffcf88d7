"""Record every scene of a fold and task: the room, the sampled poses, the objects."""

import logging
from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.densities import read_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.errors import unknown
from placing.methods.answer_tables import PLACEMENT_COLUMNS, POSE_COLUMNS, TRACE_COLUMNS
from placing.methods.explanation import EXPLANATION_COLUMNS
from placing.people.diagnostics import DIAGNOSTIC_COLUMNS
from placing.recordings.assembly import Job, scene_recording
from placing.recordings.content import SceneRecording
from placing.recordings.tables import Tables
from placing.recordings.writer import write_recording
from placing.tables.metrics import SCORE_COLUMNS

log = logging.getLogger(__name__)

COLUMNS = {
    "answers": PLACEMENT_COLUMNS,
    "poses": POSE_COLUMNS,
    "scores": SCORE_COLUMNS,
    "traces": TRACE_COLUMNS,
    "diagnoses": DIAGNOSTIC_COLUMNS,
    "explanations": EXPLANATION_COLUMNS,
}
"""The tables of a recording and their columns."""


def main(
    dataset: str,
    task: str,
    fold: int,
    method: str,
    clouds: Path,
    scenes: Path,
    features: Path,
    arrangements: Path,
    poses: Path,
    densities: Path,
    scores: Path,
    traces: Path,
    diagnostics: Path,
    explanations: Path,
    recordings: Path,
    seed: int,
) -> None:
    """Record every scene of a fold and task.

    Args:
        dataset: Data set of the scenes.
        task: Task that was answered.
        fold: Fold of the scenes.
        method: Method whose answers are recorded.
        clouds: Directory of the clouds of the fold.
        scenes: Directory of its scenes.
        features: Directory of their places and valid human poses.
        arrangements: Table of placements.
        poses: Table of sampled human poses.
        densities: Directory of the densities of the placements.
        scores: Table of errors.
        traces: Table of the chains, sweep by sweep.
        diagnostics: Table of how far the chains agree.
        explanations: Table of reasons for each placement.
        recordings: Directory to write.
        seed: Seed of the study, named in the recordings.
    """
    job = Job(dataset, task, method, fold, seed)
    paths = arrangements, poses, scores, traces, diagnostics, explanations
    tables = _tables(paths, method)
    recordings.mkdir(parents=True, exist_ok=True)
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        content = _content(job, path, (clouds, features, densities), tables(path.stem))
        write_recording(recordings / f"{path.stem}.rrd", content)
    log.info("%s fold %d %s: recorded", dataset, fold, task)


def _content(
    job: Job, path: Path, folders: tuple[Path, Path, Path], tables: Tables
) -> SceneRecording:
    """Return what is recorded of a scene, of which clouds and so on are in folders."""
    clouds, features, densities = folders
    cloud = read_ply(clouds / f"{path.stem}.ply")
    model = read_scene(path), cloud, *read_features(features / f"{path.stem}.npz")
    dense = read_densities(densities / f"{path.stem}.npz")
    return scene_recording(job, *model, dense, tables)


def _tables(paths: Sequence[Path], method: str) -> Callable[[str], Tables]:
    """Return the function from a scene to its tables, the first being the answers."""
    methods = sorted(read_table(paths[0], ["method"])["method"].unique())
    if method not in methods:
        raise unknown(f"method of {paths[0]}", method, methods)
    read = {
        name: _of_scenes(path, columns, method)
        for (name, columns), path in zip(COLUMNS.items(), paths, strict=True)
    }
    return lambda scene: Tables(**{name: rows(scene) for name, rows in read.items()})


def _of_scenes(
    path: Path, columns: Sequence[str], method: str
) -> Callable[[str], pd.DataFrame]:
    """Return the function from a scene to its rows of a table, of one method."""
    table = read_table(path, columns)
    rows = dict(iter(table[table["method"] == method].groupby("scene")))
    return lambda scene: rows.get(scene, table.iloc[:0])


if __name__ == "__main__":
    run(main)

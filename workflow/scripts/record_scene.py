"""Record every scene of a fold and task: the room, the sampled poses, the objects."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.answer_tables import PLACEMENT_COLUMNS, POSE_COLUMNS
from placing.answering import METHODS
from placing.artifacts.densities import read_densities
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.errors import unknown
from placing.metrics import SCORE_COLUMNS
from placing.recordings.assembly import Job, scene_recording
from placing.recordings.writer import write_recording

log = logging.getLogger(__name__)


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
    recordings: Path,
    seed: int,
) -> None:
    """Record every scene of a fold and task."""
    if method not in METHODS:
        raise unknown("method", method, list(METHODS))
    job = Job(dataset, task, method, fold, seed)
    tables = [
        read_table(arrangements, PLACEMENT_COLUMNS),
        read_table(poses, POSE_COLUMNS),
        read_table(scores, SCORE_COLUMNS),
    ]
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        answers, sampled, scored = (t[t["scene"] == scene.scene] for t in tables)
        content = scene_recording(
            job,
            scene,
            read_ply(clouds / f"{scene.scene}.ply"),
            *read_features(features / f"{scene.scene}.npz"),
            answers,
            sampled[sampled["method"] == method],
            read_densities(densities / f"{scene.scene}.npz"),
            scored,
        )
        recordings.mkdir(parents=True, exist_ok=True)
        write_recording(recordings / f"{scene.scene}.rrd", content)
    log.info("%s fold %d %s: recorded", dataset, fold, task)


if __name__ == "__main__":
    run(main)

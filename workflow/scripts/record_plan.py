"""Record and log every plan of a fold: what the robot does in its empty scenes."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.certificates import read_certificates
from placing.artifacts.films import read_film
from placing.artifacts.formats import read_table
from placing.artifacts.plans import read_plans
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.joint_log import write_log
from placing.recordings.plan import plan_recording
from placing.recordings.plan_blueprint import write_plan
from placing.recordings.plan_tables import in_order, result_of, rows_about, search_of
from placing.robot.film import PlaybackConfig, film
from placing.robot.model import load_robot
from placing.robot.settings import read_robot
from placing.robot_plans import TRIED_COLUMNS
from placing.rooms.file import read_yaml

log = logging.getLogger(__name__)


def main(
    fold: int,
    task: str,
    constraints: str,
    clouds: Path,
    scenes: Path,
    plans: Path,
    tried: Path,
    certificates: Path,
    robot: Path,
    robot_schema: Path,
    recordings: Path,
    logs: Path,
    playback: PlaybackConfig,
    films: Path | None = None,
) -> None:
    """Record and log every plan of a fold, for one task and constraint.

    Args:
        fold: Fold of the scenes.
        task: Task whose plans are recorded.
        constraints: How the robot was looked at.
        clouds: Directory of the clouds of the fold.
        scenes: Directory of its scenes.
        plans: Table of what the robot does.
        tried: Table of what it was asked.
        certificates: Directory of its motions.
        robot: Robot that moves.
        robot_schema: Schema of such files.
        recordings: Directory of recordings to write.
        logs: Directory of MCAP files to write.
        playback: Settings of the playback.
        films: Directory of what was seen when plans were carried out; left out: the
            plans themselves are shown.
    """
    kind = {"task": task, "constraints": constraints}
    planned = rows_about(read_plans(plans), kind)
    asked = rows_about(read_table(tried, TRIED_COLUMNS), kind)
    model = load_robot(read_robot(robot, read_yaml(robot_schema)))
    moved = [
        one
        for one in read_certificates(certificates).certificates
        if (one.world.task, one.world.constraints) == (task, constraints)
    ]
    for folder in (recordings, logs):
        folder.mkdir(parents=True, exist_ok=True)
    for name in tqdm(sorted(set(planned["scene"])), unit="scene", disable=None):
        rows = (rows_about(table, {"scene": name}) for table in (planned, asked))
        search = search_of(*rows)
        shown = in_order([c for c in moved if c.world.scene == name], search)
        if not shown:
            log.info("%s: the robot places nothing, there is nothing to record", name)
            continue
        scene = read_scene(scenes / f"{name}.json")
        cloud = read_ply(clouds / f"{name}.ply")
        planned_film = film(shown, model, playback)
        seen = planned_film if films is None else read_film(films / f"{name}.npz")
        about = (fold, scene, cloud, model, shown, search, playback, seen)
        content = plan_recording(*about)
        write_plan(recordings / f"{name}.rrd", content)
        result = result_of(shown, search)
        write_log(logs / f"{name}.mcap", model, result, content.plan, planned_film)
    log.info("fold %d %s %s: plans recorded", fold, task, constraints)


if __name__ == "__main__":
    run(main)

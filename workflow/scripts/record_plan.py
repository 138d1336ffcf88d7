"""Record and log every plan of a fold: what the robot does in its empty scenes."""

import logging
from collections.abc import Iterator
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.certificates import read_certificates
from placing.artifacts.films import read_film
from placing.artifacts.formats import read_table
from placing.artifacts.plans import read_plans
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.logs.joint_log import write_log
from placing.plans.robot_plans import TRIED_COLUMNS
from placing.recordings.plan import Search, plan_recording
from placing.recordings.plan_blueprint import write_plan
from placing.recordings.plan_tables import in_order, result_of, rows_about, search_of
from placing.robot.certificates import Certificate
from placing.robot.film import PlaybackConfig, film
from placing.robot.model import load_robot
from placing.robot.settings import read_robot
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
    model = load_robot(read_robot(robot, read_yaml(robot_schema)))
    for folder in (recordings, logs):
        folder.mkdir(parents=True, exist_ok=True)
    kind = {"task": task, "constraints": constraints}
    found = list(_searches(plans, tried, certificates, kind))
    for name, search, shown in tqdm(found, unit="scene", disable=None):
        seen = read_scene(scenes / f"{name}.json"), read_ply(clouds / f"{name}.ply")
        planned = film(shown, model, playback)
        done = planned if films is None else read_film(films / f"{name}.npz")
        content = plan_recording(fold, *seen, model, shown, search, playback, done)
        write_plan(recordings / f"{name}.rrd", content)
        result = result_of(shown, search)
        write_log(logs / f"{name}.mcap", model, result, content.plan, planned)
    log.info("fold %d %s %s: plans recorded", fold, task, constraints)


def _searches(
    plans: Path, tried: Path, certificates: Path, kind: dict[str, str]
) -> Iterator[tuple[str, Search, list[Certificate]]]:
    """Yield each scene of a kind, what was searched there and what is moved."""
    tables = read_plans(plans), read_table(tried, TRIED_COLUMNS)
    moved = read_certificates(certificates).certificates
    for name in sorted(set(rows_about(tables[0], kind)["scene"])):
        key = kind | {"scene": name}
        search = search_of(*(rows_about(table, key) for table in tables))
        mine = [one for one in moved if key.items() <= vars(one.world).items()]
        if shown := in_order(mine, search):
            yield name, search, shown
        else:
            log.info("%s: the robot places nothing, there is nothing to record", name)


if __name__ == "__main__":
    run(main)

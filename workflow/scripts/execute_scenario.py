"""Carry out the plan of a scenario in simulation, with physics."""

import logging
from pathlib import Path

from command import run
from placing.artifacts.certificates import read_certificates
from placing.artifacts.films import write_film
from placing.artifacts.formats import read_table, write_table
from placing.physics.cutting import bodies_of, fixed_of
from placing.physics.settling import SettleConfig
from placing.plans.robot_plans import PLAN_COLUMNS
from placing.robot.executing import ExecutionConfig, execute
from placing.robot.film import PlaybackConfig
from placing.robot.settings import read_robot
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader
from placing.tables.scenario_tables import executed

log = logging.getLogger(__name__)


def main(
    scene: str,
    certificates: Path,
    plans: Path,
    rooms: Path,
    catalogue: Path,
    schemas: Path,
    robot: Path,
    film: Path,
    placed: Path,
    executing: ExecutionConfig,
    playback: PlaybackConfig,
    settling: SettleConfig,
) -> None:
    """Carry out the plan of a scenario in simulation, with physics.

    Args:
        scene: Name of the scenario.
        certificates: Directory of the certificates of all scenarios.
        plans: Table of what was planned.
        rooms: Directory of room files.
        catalogue: Table of objects.
        schemas: Directory of the JSON Schemas of room and robot files.
        robot: Robot file.
        film: File of frames to write.
        placed: Table to write: where objects came to rest.
        executing: How plans are carried out.
        playback: How fast.
        settling: How the simulator is run, and what counts as staying put.
    """
    layout = layout_reader(rooms, schemas / "room.schema.yaml", catalogue)(scene)
    settings = read_robot(robot, read_yaml(schemas / "robot.schema.yaml"))
    found = read_certificates(certificates).certificates
    plan = [certificate for certificate in found if certificate.world.scene == scene]
    (start,) = layout.arrangements
    bodies = bodies_of(layout.objects, settling.margin_m)
    objects = {
        p.object_id: (bodies[p.object_id], p.T_world_object) for p in start.placements
    }
    fixed = fixed_of(layout, settling.margin_m)
    seen = execute(plan, settings, fixed, objects, (executing, playback, settling))
    write_film(film, seen)
    planned = read_table(plans, PLAN_COLUMNS)
    table = executed(planned[planned["scene"] == scene], plan, seen, settling)
    write_table(placed, table)
    n_placed = int(table["placed"].sum())
    log.info("%s: %d of %d objects placed", scene, n_placed, len(table))


if __name__ == "__main__":
    run(main)

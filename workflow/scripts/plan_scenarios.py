"""Plan how a robot fetches the objects of every scenario and arranges them."""

import logging
from functools import partial
from pathlib import Path

import numpy as np
from tqdm import tqdm

from command import run
from placing.artifacts.certificates import write_certificates
from placing.artifacts.formats import write_table
from placing.artifacts.models import read_model
from placing.artifacts.theta import read_learned
from placing.clouds.ply import read_ply
from placing.methods.scene_model import Settings
from placing.plans.robot_plans import plan_table, rows_of, tried_rows, tried_table
from placing.plans.scenarios import ScenarioConfig, asked_about, plan_scenario, world_of
from placing.robot.grasps import read_grasps
from placing.robot.model import load_robot
from placing.robot.settings import read_robot
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    theta: Path,
    clouds: Path,
    scenes: Path,
    features: Path,
    rooms: Path,
    catalogue: Path,
    schemas: Path,
    robot: Path,
    grasps: Path,
    plans: Path,
    tried: Path,
    certificates: Path,
    seed: int,
    settings: Settings,
    planning: ScenarioConfig,
) -> None:
    """Plan how a robot fetches the objects of every scenario and arranges them.

    Args:
        theta: Directory of what all rooms teach.
        clouds: Directory of the clouds of the scenarios.
        scenes: Directory of their scenes.
        features: Directory of their features.
        rooms: Directory of their room files.
        catalogue: Table of their objects.
        schemas: Directory of the JSON Schemas of room files, robots and grasps.
        robot: Robot file.
        grasps: Sheet of grasps.
        plans: Table to write: what the robot puts where, or why not.
        tried: Table to write: all that was tried.
        certificates: Directory of certificates to write.
        seed: Root of all random streams.
        settings: Sections of the configuration that answering looks at.
        planning: Sections of the configuration that planning looks at.
    """
    robot_schema = read_yaml(schemas / "robot.schema.yaml")
    learned, model = read_learned(theta), load_robot(read_robot(robot, robot_schema))
    sheet = read_grasps(grasps, read_yaml(schemas / "grasps.schema.yaml"))
    read = layout_reader(rooms, schemas / "room.schema.yaml", catalogue)
    rows, asked_for, found = [], [], []
    for path in tqdm(sorted(scenes.glob("*.json")), unit="scene", disable=None):
        name = path.stem
        scene_model = read_model(path, features, learned, settings)
        asked = asked_about(scene_model, partial(generator, seed, "plan_scenarios"))
        points = np.asarray(read_ply(clouds / f"{name}.ply").points, float)
        args = asked, read(name), points, (model, sheet), planning, seed
        robotic, some, failed = plan_scenario(*args)
        found += some
        rows += rows_of(world_of(name), asked.question, robotic)
        asked_for += tried_rows(world_of(name), asked.question, robotic)
        for item, reason in sorted({**robotic.refused, **failed}.items()):
            log.warning("%s: %s is not placed: %s", name, item, reason)
    write_table(plans, plan_table(rows))
    write_table(tried, tried_table(asked_for))
    arm = model.settings.urdf, model.settings.chain
    write_certificates(certificates, robot, *arm, found)
    log.info("%d objects are placed", len(found))


if __name__ == "__main__":
    run(main)

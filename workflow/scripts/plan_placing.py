"""Plan how the robot places the objects of a fold, under both kinds of constraints."""

import logging
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.bodies import read_solids
from placing.artifacts.certificates import write_certificates
from placing.artifacts.formats import write_table
from placing.artifacts.options import read_options
from placing.artifacts.plans import write_plans
from placing.artifacts.scenes import read_scene
from placing.clouds.ply import read_ply
from placing.errors import NoFloor
from placing.freed_memory import give_back_freed_memory
from placing.plans.robot_arranging import NOWHERE, RobotPlacingConfig
from placing.plans.robot_plans import Planned
from placing.plans.robot_scene import RobotConfig, placer_in, robot_of
from placing.robot.grasps import GraspSheet, read_grasps
from placing.robot.model import RobotModel, load_robot
from placing.robot.settings import RobotSettings, read_robot
from placing.rooms.file import read_yaml

log = logging.getLogger(__name__)


def main(
    dataset: str,
    scenes: Path,
    clouds: Path,
    options: tuple[Path, ...],
    robot_scenes: tuple[str, ...],
    bodies: Path,
    robot: tuple[Path, Path],
    grasps: tuple[Path, Path],
    plans: Path,
    tried: Path,
    certificates: Path,
    seed: int,
    min_distance_m: float,
    robot_placing: RobotPlacingConfig,
    settings: RobotConfig,
) -> None:
    """Plan how the robot places the objects of a fold, under both constraints.

    Args:
        dataset: Data set of the scenes.
        scenes: Directory of the scenes of the fold.
        clouds: Directory of their clouds.
        options: What the robot may choose among, by task.
        robot_scenes: Scenes in which the robot works.
        bodies: Directory of what is really in them, cut into solids.
        robot: Settings of the robot and their schema.
        grasps: How objects are grasped and the schema of that.
        plans: Table to write: where and in which order every object is put.
        tried: Table to write: every placement that was tried.
        certificates: Directory to write: the motion of every placement.
        seed: Root of all random streams.
        min_distance_m: Between two objects of one category.
        robot_placing: How placements and their order are searched.
        settings: Sections of the configuration that a robot in a scene looks at.
    """
    body, sheet = read_both(robot, grasps)
    model, every = load_robot(body), pd.concat(map(read_options, options))
    made = Planned(dataset, every, min_distance_m, robot_placing)
    del every  # it is kept by question
    for name in tqdm(sorted(robot_scenes), unit="scene", disable=None):
        files = scenes / f"{name}.json", clouds / f"{name}.ply", bodies / f"{name}.npz"
        add_scene(made, *files, (model, sheet, settings, seed))
        give_back_freed_memory()
    write_plans(plans, made.plans())
    write_table(tried, made.tried())
    write_certificates(certificates, robot[0], body.urdf, body.chain, made.certificates)
    log.info("%s: %d placements planned", dataset, len(made.certificates))


def add_scene(
    made: Planned,
    scene: Path,
    cloud: Path,
    bodies: Path,
    robot: tuple[RobotModel, GraspSheet, RobotConfig, int],
) -> None:
    """Plan the objects of a scene; nothing of it is kept but what is planned."""
    asked, solids = read_scene(scene), read_solids(bodies)
    try:
        with placer_in(asked, read_ply(cloud).points, solids, *robot) as placer:
            made.add(asked, robot_of(placer))
    except NoFloor as error:
        log.warning("%s", error)
        made.add(asked, NOWHERE)


def read_both(
    robot: tuple[Path, Path], grasps: tuple[Path, Path]
) -> tuple[RobotSettings, GraspSheet]:
    """Return the settings of the robot and how it grasps."""
    body = read_robot(robot[0], read_yaml(robot[1]))
    return body, read_grasps(grasps[0], read_yaml(grasps[1]))


if __name__ == "__main__":
    run(main)

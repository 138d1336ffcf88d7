"""Cut what is in the robot's scenes into the solids that a simulator takes."""

import logging
from pathlib import Path
from typing import Literal

from tqdm import tqdm

from command import run
from placing.artifacts.bodies import write_solids
from placing.artifacts.scenes import read_scene
from placing.errors import unknown
from placing.layouts import layout_reader
from placing.physics.cutting import solids_of

log = logging.getLogger(__name__)


def main(
    dataset: Literal["rooms", "thor"],
    scenes: tuple[Path, ...],
    robot_scenes: tuple[str, ...],
    layouts: tuple[Path, Path, Path, Path],
    bodies: Path,
    margin_m: float,
) -> None:
    """Cut what is in the robot's scenes into the solids that a simulator takes.

    Args:
        dataset: Data set of the scenes.
        scenes: Directories of the scenes of all folds.
        robot_scenes: Scenes in which the robot works.
        layouts: Directory and schema of rooms, catalogue, types of designers' things.
        bodies: Directory to write.
        margin_m: Shell that the simulator keeps around convex pieces.
    """
    read_layout = layout_reader(dataset, *layouts)
    paths = {path.stem: path for folder in scenes for path in folder.glob("*.json")}
    for name in tqdm(sorted(robot_scenes), unit="scene", disable=None):
        if name not in paths:
            raise unknown("robot scene", name, sorted(paths))
        objects = read_scene(paths[name]).objects
        solids = solids_of(read_layout(name), objects, margin_m)
        write_solids(bodies / f"{name}.npz", solids)
        n_pieces = sum(len(body.pieces) for body in solids.bodies.values())
        log.info("%s: %d objects, %d pieces", name, len(solids.bodies), n_pieces)


if __name__ == "__main__":
    run(main)

"""Find the placing areas in the clouds of a fold."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.areas.finder import AreaConfig, find_areas
from placing.artifacts.scenes import read_scene, write_scene
from placing.clouds.ply import read_ply
from placing.scene import with_areas

log = logging.getLogger(__name__)


def main(clouds: Path, scenes: Path, areas: AreaConfig) -> None:
    """Find the placing areas in the clouds of a fold."""
    for path in tqdm(sorted(clouds.glob("*.json")), unit="scene", disable=None):
        scene = read_scene(path)
        found = find_areas(read_ply(path.with_suffix(".ply")), areas)
        write_scene(scenes / path.name, with_areas(scene, found))
        log.info("%s: %d placing areas", scene.scene, len(found))


if __name__ == "__main__":
    run(main)

"""Scan the scenes of a fold and clean their clouds."""

import logging
from pathlib import Path
from typing import Literal

from tqdm import tqdm

from command import run
from placing.artifacts.scenes import write_scene
from placing.camera import CameraConfig, scan_depth
from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import write_ply
from placing.dressing import meshes_of
from placing.layouts import layout_reader, softness_of
from placing.scene import Scene
from placing.seeds import generator

log = logging.getLogger(__name__)


def main(
    dataset: Literal["rooms", "scans", "scenarios", "thor"],
    scenes: tuple[str, ...],
    rooms: Path,
    schema: Path,
    catalogue: Path,
    types: Path,
    clouds: Path,
    seed: int,
    spacing_m: float,
    camera: CameraConfig,
    cloud: CloudConfig,
) -> None:
    """Scan the scenes of a fold and clean their clouds."""
    read = layout_reader(dataset, rooms, schema, catalogue, types)
    for scene in tqdm(scenes, unit="scene", disable=None):
        layout = read(scene)
        rng = generator(seed, "preprocess_cloud", dataset, scene)
        meshes, softness = meshes_of(layout), softness_of(layout)
        pieces, soft = list(meshes.values()), [softness[name] for name in meshes]
        if dataset == "scans":
            scanned = scan_depth(rng, layout, pieces, soft, camera)
        else:
            scanned = sample_cloud(rng, pieces, spacing_m, soft)
        clean = preprocess(scanned, cloud)
        write_ply(clouds / f"{scene}.ply", clean)
        bare = Scene(scene, layout.kind, (), layout.objects, layout.arrangements)
        write_scene(clouds / f"{scene}.json", bare)
        log.info("%s: %d of %d points", scene, len(clean), len(scanned))


if __name__ == "__main__":
    run(main)

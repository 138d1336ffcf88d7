"""Compare the features of placements with plain numpy, in placements a second.

Run it with `./run python benchmarks/placing_features.py`. All figures come from one run
on one machine; ratios are what carries over.
"""

import json
import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import trimesh
import tyro
from clock import seconds_of
from numpy.typing import NDArray
from plain_contacts import Plain
from tqdm import tqdm

from placing import rigid
from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import Cloud, read_ply
from placing.psi.contacts import PlacingField, rest_heights, stability_features
from placing.psi.object_clouds import object_cloud
from placing.rooms.file import read_yaml
from placing.scene import SceneObject
from placing.seeds import generator
from placing.shapes.furniture import furniture_shape

Array = NDArray[np.float64]

CONFIG = Path(__file__).parents[1] / "config" / "config.yaml"
CELL_M, SPACING_M, STEP_M, N_HEADINGS = 0.01, 0.01, 0.1, 8
OBJECTS = {
    "pen": (0.14, 0.01, 0.01),
    "mug": (0.08, 0.11, 0.1),
    "bottle": (0.07, 0.07, 0.25),
    "plate": (0.24, 0.24, 0.022),
    "book": (0.15, 0.22, 0.03),
    "box": (0.3, 0.2, 0.2),
    "monitor": (0.2, 0.5, 0.45),
}
KINDS = {
    "table": (0.8, 1.6, 0.72),
    "desk": (0.8, 1.6, 0.74),
    "bookcase": (0.35, 0.9, 1.9),
    "counter": (0.6, 1.8, 0.9),
    "open_shelf": (0.3, 0.9, 1.2),
    "couch": (0.9, 2.0, 0.8),
}


def main(
    output: Path = Path("results/benchmarks_placing_features.json"),
    cloud: Path | None = None,
    n_plain: int = 20,
) -> None:
    """Measure the features; print a table and write it as JSON.

    Args:
        output: File to write.
        cloud: Cloud of a real scene (results/.../clouds/.../x.ply) in place of ours;
            the objects are put where the furniture of ours would be.
        n_plain: Placements that plain numpy looks at, per object.
    """
    scene, places = full_scene()
    scene = scene if cloud is None else read_ply(cloud)
    built, n_bytes = build(scene)
    rows = [compare(built, name, places, n_plain) for name in tqdm(OBJECTS)]
    table = pd.DataFrame(rows)
    print(f"{len(scene)} points, {n_bytes / 1e6:.0f} MB")
    print(table.to_string(index=False, float_format=lambda x: f"{x:.4g}"))
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(rows, indent=1) + "\n")


def full_scene() -> tuple[Cloud, Array]:
    """Return a room of 6 m x 6 m x 2.5 m, and places on its furniture, (p, 3) [m]."""
    rng = generator(0, "benchmark")
    room = trimesh.creation.box((6, 6, 2.5)).apply_translation((0, 0, 1.25))
    room.invert()
    room.visual.face_colors = [200, 200, 200, 255]
    meshes, places = [room], []
    for k, (kind, size) in enumerate(list(KINDS.items()) * 3):
        T = rigid.from_yaw(k * np.pi / 2, (1.8 * (k % 3 - 1), k // 3 - 2.5, 0))
        shape = furniture_shape(kind, size)
        meshes.append(shape.mesh.copy().apply_transform(rigid.homogeneous(T)))
        for support in shape.supports:
            low, high = support.polygon_m.min(0), support.polygon_m.max(0)
            axes = [np.arange(*ends, STEP_M) for ends in zip(low, high, strict=True)]
            xy = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 2)
            places.append(rigid.apply(T, np.insert(xy, 2, support.height_m, axis=1)))
    config = read_yaml(CONFIG)
    raw = sample_cloud(rng, meshes, config["scan"]["spacing_m"])
    return preprocess(raw, CloudConfig(**config["cloud"])), np.concatenate(places)


def build(scene: Cloud) -> tuple[PlacingField, int]:
    """Return the field of a scene after timing it, and its size [bytes]."""

    def make() -> PlacingField:
        field = PlacingField(scene, CELL_M)
        assert len(field.points.points)
        assert len(field.levels.surfaces)
        return field

    print(f"field built in {seconds_of(make):.2f} s")
    field = make()
    tables = (field.levels.start, field.levels.surfaces, *field.points[1:])
    return field, sum(table.nbytes for table in tables)


def compare(
    field: PlacingField, name: str, places: Array, n_plain: int
) -> dict[str, Any]:
    """Return placements a second of ours and of plain numpy for one object."""
    start = time.process_time()
    item = SceneObject(name, name, name, OBJECTS[name], 1.0, True, True)
    cloud = object_cloud(item, SPACING_M)
    yaws = 2 * np.pi * np.arange(N_HEADINGS) / N_HEADINGS
    turns = np.array([rigid.yaw_quaternion(yaw) for yaw in yaws])
    q = np.tile(turns, (len(places), 1))
    at = np.repeat(places, N_HEADINGS, axis=0)
    z = rest_heights(field, cloud, q, at[:, :2], at[:, 2])
    T = np.concatenate([q, at[:, :2], z[:, None]], axis=1)
    stability_features(field, cloud, T[:1], at[:1, 2])
    prepared = time.process_time() - start
    lower = seconds_of(lambda: rest_heights(field, cloud, q, at[:, :2], at[:, 2]))
    measure = seconds_of(lambda: stability_features(field, cloud, T, at[:, 2]))
    plain = Plain(field, cloud)
    few = np.linspace(0, len(T) - 1, n_plain).astype(int)
    slow = seconds_of(lambda: [plain.features(T[c], at[c, 2]) for c in few])
    rate, slow_rate = len(T) / measure, n_plain / slow
    return {
        "object": name,
        "placements": len(T),
        "prepared_s": prepared,
        "lowered_per_s": len(T) / lower,
        "features_per_s": rate,
        "both_per_s": len(T) / (lower + measure),
        "plain_features_per_s": slow_rate,
        "ratio": rate / slow_rate,
    }


if __name__ == "__main__":
    tyro.cli(main)

"""Compare the way from a cloud to its placing areas with plain numpy and scipy.

Run it with `./run python benchmarks/areas.py`. All figures come from one run on one
machine; ratios are what carries over. Times are those of the processor, on one core.
"""

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tyro
from clock import seconds_of
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from tqdm import tqdm

from placing.areas.columns import sort_columns
from placing.areas.finder import AreaConfig, find_areas
from placing.areas.scans import find_in_scan
from placing.clouds.cloud import (
    CloudConfig,
    drop_outliers,
    preprocess,
    sample_cloud,
    thin,
)
from placing.clouds.planes import fit_planes
from placing.clouds.ply import Cloud, read_ply
from placing.dressing import meshes_of
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import read_layout
from placing.seeds import generator

Table = list[dict[str, Any]]
ROOT = Path(__file__).parents[1]
ROOM = "office4"


def main(
    output: Path = Path("results/benchmarks_areas.json"),
    cloud: Path | None = None,
    n_points: int = 1_000_000,
) -> None:
    """Measure the search for placing areas; print tables and write them as JSON.

    Args:
        output: File to write.
        cloud: A user's cloud (PLY) in place of a sampled room of the study.
        n_points: Points of that room.
    """
    document = read_yaml(ROOT / "config" / "config.yaml")
    settings = CloudConfig(**document["cloud"]), AreaConfig(**document["areas"])
    raw = room(n_points) if cloud is None else read_ply(cloud)
    stages: dict[str, Callable[[], Table]] = {
        "whole way": lambda: ways(raw, *settings),
        "steps": lambda: steps(raw, *settings),
        "growth": lambda: growth(n_points, *settings),
    }
    tables: dict[str, Table] = {}
    with tqdm(stages, unit="table") as bar:
        for name in bar:
            tables[name] = stages[name]()
            shown = pd.DataFrame(tables[name]).to_string(
                index=False, na_rep="-", float_format="{:.4g}".format
            )
            tqdm.write(f"\n{name}\n{shown}\n")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(tables, indent=1) + "\n")


def room(n_points: int) -> Cloud:
    """Return a scan with true normals of a room of the study, of about so many points.

    A scanner sees no side of a wall that faces away from the room; these count as well.
    """
    catalogue = read_catalogue(ROOT / "config" / "objects.csv")
    rules = read_yaml(ROOT / "workflow" / "schemas" / "room.schema.yaml")
    layout = read_layout(ROOT / "resources/rooms" / f"{ROOM}.yaml", catalogue, rules)
    meshes = list(meshes_of(layout).values())
    spacing = np.sqrt(sum(mesh.area for mesh in meshes) / n_points)
    return sample_cloud(generator(0, "benchmark"), meshes, spacing)


def bare(cloud: Cloud) -> Cloud:
    """Return the cloud without normals, as most scanners give it."""
    return replace(cloud, normals=np.zeros_like(cloud.normals))


def ways(raw: Cloud, cloud: CloudConfig, areas: AreaConfig) -> Table:
    """Measure everything from points to areas, with normals given and estimated."""
    table = []
    for name, points in (("given", raw), ("estimated", bare(raw))):
        clean = preprocess(points, cloud)
        first = seconds_of(lambda points=points: preprocess(points, cloud))
        second = seconds_of(lambda clean=clean: find_areas(clean, areas))
        suited = seconds_of(lambda points=points: find_in_scan(points, cloud, areas))
        table.append(
            {
                "normals": name,
                "points": len(points),
                "kept": len(clean),
                "areas": len(find_areas(clean, areas)),
                "preprocess [s]": first,
                "find_areas [s]": second,
                "both [s]": first + second,
                "million/s": len(points) / (first + second) / 1e6,
                "with settings [s]": suited,
            }
        )
    return table


def steps(raw: Cloud, cloud: CloudConfig, areas: AreaConfig) -> Table:
    """Compare the dominant steps with plain numpy and scipy."""
    thinned = thin(bare(raw), cloud.voxel_m)
    points, voxel_m = raw.points.astype(float), cloud.voxel_m
    kept, k = thinned.points, cloud.normal_neighbors
    pairs = {
        "thin": (lambda: thin(raw, voxel_m), lambda: plain_thin(raw, points, voxel_m)),
        "outliers": (
            lambda: drop_outliers(thinned, cloud),
            lambda: plain_outliers(kept, cloud),
        ),
        "normals": (lambda: fit_planes(kept, k), lambda: plain_planes(kept, k)),
        "columns": (
            lambda: sort_columns(thinned, areas.cell_m),
            lambda: plain_columns(kept, areas.cell_m),
        ),
    }
    table = []
    for name, (ours, plain) in pairs.items():
        fast, start = seconds_of(ours), time.process_time()
        plain()
        slow = time.process_time() - start
        table.append(
            {"step": name, "ours [s]": fast, "plain [s]": slow, "ratio": slow / fast}
        )
    total = {key: sum(row[key] for row in table) for key in ("ours [s]", "plain [s]")}
    ratio = total["plain [s]"] / total["ours [s]"]
    return [*table, {"step": "all", **total, "ratio": ratio}]


def growth(n_points: int, cloud: CloudConfig, areas: AreaConfig) -> Table:
    """Measure rooms of more and more points, normals estimated."""
    table = []
    for n in (n_points // 8, n_points // 4, n_points // 2, n_points):
        raw = bare(room(n))
        taken = seconds_of(lambda raw=raw: steps_of(raw, cloud, areas))
        row = {"points": len(raw), "seconds": taken}
        table.append(row | {"us a point": 1e6 * taken / len(raw)})
    return table


def steps_of(raw: Cloud, cloud: CloudConfig, areas: AreaConfig) -> None:
    """Go the whole way from points to areas."""
    find_areas(preprocess(raw, cloud), areas)


def plain_thin(raw: Cloud, points: NDArray, voxel_m: float) -> NDArray:
    """Return the means of the points and normals of each voxel and side, (m, 6)."""
    cells = np.floor((points - points.min(axis=0)) / voxel_m).astype(np.int64)
    axis = np.abs(raw.normals).argmax(axis=1)
    side = 2 * axis + (raw.normals[np.arange(len(axis)), axis] > 0)
    shape = cells.max(axis=0) + 1
    keys = np.ravel_multi_index(tuple(cells.T), tuple(shape)) * 6 + side
    _, inverse, count = np.unique(keys, return_inverse=True, return_counts=True)
    columns = np.concatenate([points, raw.normals], axis=1).T
    total = np.stack([np.bincount(inverse, column) for column in columns], axis=1)
    return total / count[:, None]


def plain_outliers(points: NDArray, cloud: CloudConfig) -> NDArray:
    """Return which points have enough others in a box around them, (n,)."""
    tree = cKDTree(points)
    reach = 1.5 * cloud.outlier_cell_m
    n = tree.query_ball_point(points, reach, p=np.inf, return_length=True)
    return n > cloud.outlier_neighbors


def plain_planes(points: NDArray, k: int) -> NDArray:
    """Return the normals of planes through the nearest neighbours, (n, 3)."""
    around = points[cKDTree(points).query(points, k)[1]].astype(float)
    around -= around.mean(axis=1, keepdims=True)
    spread = np.einsum("nki,nkj->nij", around, around)
    return np.linalg.eigh(spread)[1][:, :, 0]


def plain_columns(points: NDArray, cell_m: float) -> NDArray:
    """Return the points sorted by cell of the floor plan, then by height, (n,)."""
    cells = np.floor((points[:, :2] - points[:, :2].min(axis=0)) / cell_m)
    order = np.lexsort((points[:, 2], cells[:, 1], cells[:, 0]))
    return points[order]


if __name__ == "__main__":
    tyro.cli(main)

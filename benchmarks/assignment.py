"""Compare the joint placement with a greedy one, with exhaustion, and over sizes.

Run it with `./run python benchmarks/assignment.py`. Objects crowd at a few spots of
three tables. All figures come from one run on one machine; ratios carry over.
"""

import json
import time
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tyro
from numpy.random import Generator
from numpy.typing import NDArray
from tqdm import tqdm

from placing.joint.assignment import AssignmentConfig, assign
from placing.joint.incumbent import build
from placing.joint.joint_columns import Columns, conflicts, make_columns, standing_boxes
from placing.joint.options import Options, thin_options
from placing.joint.stacking import StackPair, find_arcs
from placing.rooms.file import read_yaml

Array = NDArray[np.float64]

TABLES = ((0.0, 0.0, 0.75, 9.0), (3.0, 0.0, 0.45, 9.0), (0.0, 3.0, 1.2, 0.3))
"""x, y, height and clearance."""
SPOTS = ((0.8, 0.1), (3.8, 0.4), (0.8, 3.4), (3.3, 0.2))
BOOK, LARGE = (0.24, 0.17, 0.03), (0.305, 0.32, 0.215)


def main(
    output: Path = Path("results/benchmarks_assignment.json"),
    sizes: tuple[int, ...] = (4, 8, 14, 21),
    n_options: int = 300,
    n_seeds: int = 2,
) -> None:
    """Measure the joint placement; print tables and write them as JSON.

    Args:
        output: File to write.
        sizes: Objects to place.
        n_options: Options of each object.
        n_seeds: Made-up scenes of each size, with and without stacks.
    """
    section = read_yaml(Path("config/config.yaml"))["assignment"]
    config = AssignmentConfig(**section)
    assign(*crowd(np.random.default_rng(0), 4, 30, 4), config)  # compiles the kernels
    cases = list(product(sizes, (0, 4), range(n_seeds)))
    rows = [
        against_greedy(seed, n, n_options, min(n_stacked, n), config)
        for n, n_stacked, seed in tqdm(cases, unit="scene", disable=None)
    ]
    tables = {"sizes": rows, "exhaustion": [against_exhaustion(config)]}
    for name, table in tables.items():
        form = "{:.3g}".format
        text = pd.DataFrame(table).to_string(index=False, float_format=form)
        print(f"\n{name}\n{text}")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(tables, indent=1) + "\n")


def crowd(
    rng: Generator, n: int, n_options: int, n_stacked: int
) -> tuple[list[Options], list[StackPair]]:
    """Return objects that want the same spots; the first ones may be stacked."""
    x, y = np.meshgrid(np.arange(0, 1.6, 0.05), np.arange(0, 0.8, 0.05))
    flat = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    location = np.concatenate([flat + table[:3] for table in TABLES])
    area = np.repeat(np.arange(len(TABLES)), len(flat))
    objects = []
    for i in range(n):
        low, high = (0.05, 0.05, 0.02), LARGE
        size = np.array(BOOK) if i < n_stacked else rng.uniform(low, high)
        spot = SPOTS[0 if i < 9 else i % len(SPOTS)] + rng.normal(0, 0.05, 2)
        away = np.linalg.norm(location[:, :2] - spot, axis=1)
        score = np.logaddexp(-away / 0.15, -8) + 0.3 * rng.standard_normal(len(away))
        options = all_headings(rng, location, area, size, score)
        best, rest = n_options * 2 // 3, n_options - n_options * 2 // 3
        objects.append(options.only(thin_options(options, best, rest)))
    who = [(i, j) for i, j in product(range(n_stacked), repeat=2) if i != j]
    return objects, [StackPair(i, j, -1.0 + 0.1 * i) for i, j in who]


def all_headings(
    rng: Generator, location: Array, area: NDArray, size: Array, score: Array
) -> Options:
    """Return the options of an object at all places and eight headings."""
    place = np.repeat(np.arange(len(location)), 8)
    yaw = np.tile(np.arange(8) * np.pi / 4, len(location))
    centre = location[place] + [0, 0, size[2] / 2]
    clearance = np.array(TABLES)[area[place], 3]
    log_score = score[place] + np.tile(rng.normal(0, 1, 8), len(location))
    sizes = np.tile(size, (len(place), 1))
    at, on = place.astype(np.int32), area[place].astype(np.int32)
    return Options(centre, sizes, yaw, on, at, clearance, log_score)


def against_greedy(
    seed: int, n: int, n_options: int, n_stacked: int, config: AssignmentConfig
) -> dict[str, Any]:
    """Return seconds and gap of a scene, and what greedy placement loses."""
    objects, pairs = crowd(np.random.default_rng(seed), n, n_options, n_stacked)
    start = time.process_time()
    found = assign(objects, pairs, config)
    seconds = time.process_time() - start
    arcs = find_arcs(objects, pairs, config.max_levels, config.max_overhang)
    columns = make_columns(objects, arcs, config.unplaced_penalty)
    wide = standing_boxes(objects, columns, config.margin_m)
    conflict, margin = conflicts(columns, wide), config.margin_m
    greedy = build(objects, columns, conflict, columns.value, margin)
    most = sum(options.log_score.max() for options in objects)
    return {
        "objects": n,
        "stackable": n_stacked,
        "seconds": seconds,
        "loss": most - found.objective,
        "gap": found.gap,
        "nodes": found.n_nodes,
        "rounds": found.n_rounds,
        "levels": int(found.level.max()) + 1,
        "left out": int((found.choice < 0).sum()),
        "loss of greedy": most - float(columns.value[greedy].sum()),
    }


def against_exhaustion(config: AssignmentConfig) -> dict[str, Any]:
    """Return how much faster the search is than looking at every combination."""
    objects, _ = crowd(np.random.default_rng(0), 4, 24, 0)
    exact = replace(config, mip_rel_gap=0.0)
    start = time.process_time()
    found = assign(objects, [], exact)
    middle = time.process_time()
    columns = make_columns(objects, find_arcs(objects, [], 1, 0.0), 100.0)
    best = exhaust(columns, conflicts(columns, standing_boxes(objects, columns, 0.005)))
    slow, fast = time.process_time() - middle, middle - start
    same = bool(np.isclose(best, found.objective))
    return {"search s": fast, "exhaustion s": slow, "ratio": slow / fast, "same": same}


def exhaust(columns: Columns, conflict: NDArray[np.bool_]) -> float:
    """Return the best sum over four objects, all of them placed."""
    of = [np.flatnonzero(columns.owner[: columns.n_standing] == i) for i in range(4)]
    best = -np.inf
    for choice in product(*of):
        at = np.array(choice)
        if conflict[np.ix_(at, at)].sum() == len(at):  # each with itself alone
            best = max(best, float(columns.value[at].sum()))
    return best


if __name__ == "__main__":
    tyro.cli(main)

"""Compare the planner's collision checks with exact ones, on random configurations.

Run it with `./run python benchmarks/checker.py`. It prints how many configurations are
called free although they collide (none should be), and what share of the free ones is
lost, with and without a held object, and for the robot alone.
"""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tyro
from numpy.typing import NDArray
from shapely import Polygon, contains_xy
from simulated import Simulated
from tqdm import tqdm

from placing import rigid
from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import Cloud
from placing.dressing import meshes_of
from placing.physics.cutting import bodies_of, fixed_of
from placing.physics.settling import SettleConfig
from placing.robot.checker import CheckerConfig, Held, SceneChecker, held
from placing.robot.distance_field import distance_field
from placing.robot.model import RobotModel, load_robot
from placing.robot.settings import read_robot
from placing.robot.truth import Truth
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import read_layout
from placing.scene import Layout
from placing.seeds import generator

Row = dict[str, Any]
ROOT = Path(__file__).parents[1]
ROOMS = ("kitchen3", "kitchen6", "livingroom1", "livingroom4", "office2")
SPACING_M = 0.01
"""Between the points of the scan, which the stage of the study then thins."""


def main(
    output: Path = Path("results/benchmarks_checker.json"),
    rooms: tuple[str, ...] = ROOMS,
    n: int = 20_000,
    n_exact: int = 2_000,
    n_held: int = 1_000,
) -> None:
    """Compare all checks; print a table and write it as JSON.

    Args:
        output: File to write.
        rooms: Rooms of the study.
        n: Random configurations of each room.
        n_exact: Those that are checked exactly even if they are called colliding.
        n_held: Those of them that are checked with a held object as well.
    """
    config, settling, scan = settings()
    model = robot()
    rows = []
    for name in tqdm(rooms, unit="room", disable=None):
        layout = room(name)
        field = distance_field(scanned(layout, scan).points, config)
        checker = SceneChecker(model, field, config)
        configurations = anywhere(generator(0, "checker", name), layout, model, n)
        with Simulated(
            model, fixed_of(layout, settling.margin_m), config, settling
        ) as t:
            rows.append({"room": name, **compare(checker, t, configurations, n_exact)})
            some = configurations[:n_held]
            rows.append({"room": name, **with_object(checker, t, layout, some)})
    print(pd.DataFrame(rows).to_string(index=False))
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(rows, indent=1) + "\n")


def settings() -> tuple[CheckerConfig, SettleConfig, CloudConfig]:
    """Return the sections of the configuration that are needed."""
    document = read_yaml(ROOT / "config" / "config.yaml")
    return (
        CheckerConfig(**document["checking"]),
        SettleConfig(**document["settling"]),
        CloudConfig(**document["cloud"]),
    )


def robot(name: str = "pr2") -> RobotModel:
    """Return a robot of the study."""
    rules = read_yaml(ROOT / "workflow" / "schemas" / "robot.schema.yaml")
    return load_robot(read_robot(ROOT / "config" / "robots" / f"{name}.yaml", rules))


def room(name: str) -> Layout:
    """Return a room of the study."""
    catalogue = read_catalogue(ROOT / "config" / "objects.csv")
    rules = read_yaml(ROOT / "workflow" / "schemas" / "room.schema.yaml")
    return read_layout(ROOT / "resources" / "rooms" / f"{name}.yaml", catalogue, rules)


def scanned(layout: Layout, config: CloudConfig) -> Cloud:
    """Return the cloud of a room as the stages of the study see it."""
    meshes = list(meshes_of(layout).values())
    rng = generator(0, "checker", layout.scene)
    return preprocess(sample_cloud(rng, meshes, SPACING_M), config)


def anywhere(
    rng: np.random.Generator, layout: Layout, model: RobotModel, n: int
) -> NDArray[np.float64]:
    """Return random configurations with the base on the floor, (n, 4 + a)."""
    low = np.where(np.isfinite(model.lower), model.lower, -np.pi)
    high = np.where(np.isfinite(model.upper), model.upper, np.pi)
    room = Polygon(layout.outline_m)
    low[:2], high[:2] = room.bounds[:2], room.bounds[2:]
    rows = rng.uniform(low, high, (4 * n, len(low)))
    return rows[contains_xy(room, rows[:, :2])][:n]


def compare(
    checker: SceneChecker,
    truth: Truth,
    configurations: NDArray[np.float64],
    n_exact: int,
    item: Held | None = None,
) -> Row:
    """Return the numbers of wrong answers on configurations (t, 4 + a).

    What is lost, and collisions with itself, are those of the first `n_exact`.
    """
    links = set(checker.model.links) | ({item.object_id} if item else set())
    held_id, T = (item.object_id, item.T_tool_object) if item else (None, None)
    found = [checker.hits(q, item) for q in configurations]
    ours = np.array([(hits.scene, hits.self) for hits in found])
    # The exact check is slow: what both call colliding matters for no false free one.
    some = np.flatnonzero((np.arange(len(ours)) < n_exact) | ~ours[:, 0])
    truly = np.zeros_like(ours)  # scene, robot itself
    for i in tqdm(some, leave=False, disable=None):
        for hit in truth.hits(configurations[i], held_id, T):
            truly[i, int(links.issuperset(hit.split("/")))] = True
    false_free = (truly & ~ours)[some]
    called = checker.are_free(configurations, item)
    truly, ours, first = truly[:n_exact], ours[:n_exact], called[:n_exact]
    is_free = ~truly.any(axis=1)
    return {
        "held": held_id or "",
        "n": len(configurations),
        "called free": int(called.sum()),
        "false free": int((false_free.any(axis=1) & called[some]).sum()),
        "false free, scene": int(false_free[:, 0].sum()),
        "false free, self": int(false_free[:, 1].sum()),
        "lost [%]": share(~first & is_free, is_free),
        "lost to scene [%]": share(ours[:, 0] & ~truly[:, 0], ~truly[:, 0]),
        "lost to self [%]": share(ours[:, 1] & ~truly[:, 1], ~truly[:, 1]),
    }


def share(part: NDArray[np.bool_], whole: NDArray[np.bool_] | np.bool_) -> float:
    """Return one count as a share of the other [%]."""
    return round(100 * float(part.sum()) / max(int(whole.sum()), 1), 2)


def with_object(
    checker: SceneChecker,
    truth: Truth,
    layout: Layout,
    configurations: NDArray[np.float64],
) -> Row:
    """Return the numbers with the largest object that fits into the gripper."""
    width = checker.model.settings.max_opening_m
    fitting = [o for o in layout.objects if o.is_movable and min(o.size_m) < width]
    chosen = max(fitting, key=lambda o: float(np.prod(o.size_m)))
    item = replace(chosen, object_id=f"held {chosen.category}")
    # Held in the middle, a little before the finger tips.
    T = rigid.from_yaw(0.0, (chosen.size_m[0] / 2, 0.0, 0.0))
    bodies = bodies_of([item], 0.001)
    truth.put(item.object_id, bodies[item.object_id], T)
    holding = held(item.object_id, item.size_m, T)
    row = compare(checker, truth, configurations, len(configurations), holding)
    truth.remove(item.object_id)
    return row


if __name__ == "__main__":
    tyro.cli(main)

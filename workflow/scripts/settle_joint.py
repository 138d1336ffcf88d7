"""Let physics settle every joint arrangement among the true furniture of its scene."""

import logging
from dataclasses import asdict
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.joint.joint import JOINT_COLUMNS
from placing.physics.cutting import bodies_of, fixed_of
from placing.physics.joint_check import check_joint
from placing.physics.settling import SettleConfig
from placing.rooms.reader import layout_reader
from placing.tables.table2_answers import placements_of

log = logging.getLogger(__name__)

COLUMNS = ["dataset", "scene", "method", "object", "is_placed", "penetration_m"]
COLUMNS += ["moved_m", "tilted_deg", "support", "stays", "reason"]


def main(
    dataset: Literal["rooms", "scans"],
    joint: tuple[Path, ...],
    rooms: Path,
    schema: Path,
    catalogue: Path,
    checks: Path,
    reach_m: float,
    settling: SettleConfig,
) -> None:
    """Let physics settle every joint arrangement among the true furniture.

    Args:
        dataset: Data set of the scenes.
        joint: Tables of joint arrangements.
        rooms: Directory of room files.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        checks: Table to write.
        reach_m: How far an object is moved up or down until it touches.
        settling: What counts as staying put.
    """
    table = pd.concat([read_table(path, JOINT_COLUMNS) for path in joint])
    read = layout_reader(rooms, schema, catalogue)
    layouts = {scene: read(scene) for scene in sorted(table["scene"].unique())}
    used = {o.object_id: o for layout in layouts.values() for o in layout.objects}
    bodies = bodies_of(used.values(), settling.margin_m)
    rows = []
    grouped = table.groupby("scene", sort=True)
    for scene, of_scene in tqdm(grouped, unit="scene", disable=None):
        layout = layouts[str(scene)]
        fixed = fixed_of(layout, settling.margin_m)
        for method, chosen in of_scene.groupby("method", sort=False):
            args = list(placements_of(chosen)), fixed, bodies, settling, reach_m
            found = {c.object: asdict(c) for c in check_joint(layout, *args)}
            for name, is_placed in zip(
                chosen["object"], chosen["is_placed"], strict=True
            ):
                key = {"dataset": dataset, "scene": scene, "method": method}
                rows.append(key | {"object": name, "is_placed": is_placed})
                rows[-1] |= found.get(name, {"stays": False, "reason": "not placed"})
    checked = pd.DataFrame(rows, columns=COLUMNS)
    write_csv(checks, checked)
    share = np.mean(checked.loc[checked["is_placed"], "stays"])
    log.info("%s: %.1f %% of what is placed stays put", dataset, 100 * share)


if __name__ == "__main__":
    run(main)

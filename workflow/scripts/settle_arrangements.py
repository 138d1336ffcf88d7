"""Check that every labelled arrangement is possible and stays put when let go."""

import logging
from dataclasses import asdict, fields
from pathlib import Path
from typing import Literal

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.formats import write_csv
from placing.errors import BadInput
from placing.physics.arrangements import (
    PlacementCheck,
    check_arrangements,
    complaints_about,
    lacks,
)
from placing.physics.cutting import bodies_of
from placing.physics.settling import SettleConfig
from placing.rooms.reader import layout_reader

log = logging.getLogger(__name__)
MOST_LINES = 20


def main(
    dataset: Literal["rooms", "scans"],
    rooms: Path,
    scenes: tuple[str, ...],
    schema: Path,
    catalogue: Path,
    checks: Path,
    settling: SettleConfig,
) -> None:
    """Settle the labelled arrangements of rooms and write a line for each placement.

    Args:
        dataset: Data set of the scenes; each kind of `rooms` needs its objects.
        rooms: Directory of room files.
        scenes: Rooms to check.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        checks: Table to write.
        settling: What counts as staying put.
    """
    read = layout_reader(rooms, schema, catalogue)
    layouts = [read(scene) for scene in scenes]
    used = {item.object_id: item for layout in layouts for item in layout.objects}
    bodies = bodies_of(used.values(), settling.margin_m)
    found, failures = [], []
    for layout in tqdm(layouts, unit="room", disable=None):
        found += check_arrangements(layout, bodies, settling)
        failures += complaints_about(layout, settling)
        failures += lacks(layout) if dataset == "rooms" else []
    columns = [field.name for field in fields(PlacementCheck)]
    table = pd.DataFrame([asdict(row) for row in found], columns=columns)
    write_csv(checks, table)
    failures += [line_of(row) for row in found if not row.stays]
    log.info("%d placements in %d rooms settled", len(found), len(layouts))
    if failures:
        raise BadInput("\n".join([*failures[:MOST_LINES], f"{len(failures)} failures"]))


def line_of(row: PlacementCheck) -> str:
    """Return a line of the table of failures."""
    return f"{row.scene:12} {row.labeller:12} {row.object:14} {row.reason}"


if __name__ == "__main__":
    run(main)

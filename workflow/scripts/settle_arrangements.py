"""Check that every labelled arrangement is possible and stays put when let go."""

import logging
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, cast

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.atomic import replacing
from placing.errors import BadInput, unknown
from placing.physics.arrangements import (
    PlacementCheck,
    bodies_of,
    check_arrangements,
    complaints_about,
)
from placing.physics.settling import SettleConfig
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import read_layout

log = logging.getLogger(__name__)
MOST_LINES = 20
SCHEMA = Path(__file__).parents[1] / "schemas" / "room.schema.yaml"


def main(
    rooms: Path,
    catalogue: Path,
    checks: Path,
    scenes: tuple[str, ...] = (),
    schema: Path = SCHEMA,
    settling: SettleConfig = SettleConfig(),  # noqa: B008  frozen
) -> None:
    """Settle the labelled arrangements of rooms and write a line for each placement.

    Args:
        rooms: Directory of room files.
        catalogue: Table of objects.
        checks: Table to write.
        scenes: Rooms to check; all of the directory if left out.
        schema: JSON Schema of room files.
        settling: What counts as staying put.
    """
    objects, rules = read_catalogue(catalogue), cast(dict[str, Any], read_yaml(schema))
    paths = [path_of(rooms, scene) for scene in scenes] or sorted(rooms.glob("*.yaml"))
    layouts = [read_layout(path, objects, rules) for path in paths]
    used = {item.object_id: item for layout in layouts for item in layout.objects}
    bodies = bodies_of(used.values(), settling.margin_m)
    found, failures = [], []
    for layout in tqdm(layouts, unit="room", disable=None):
        found += check_arrangements(layout, bodies, settling)
        failures += complaints_about(layout, settling)
    columns = [field.name for field in fields(PlacementCheck)]
    table = pd.DataFrame([asdict(row) for row in found], columns=columns)
    with replacing(checks) as part:
        table.to_csv(part, index=False)
    failures += [line_of(row) for row in found if not row.stays]
    log.info("%d placements in %d rooms settled", len(found), len(layouts))
    if failures:
        raise BadInput("\n".join([*failures[:MOST_LINES], f"{len(failures)} failures"]))


def path_of(rooms: Path, scene: str) -> Path:
    """Return the file of a room that exists."""
    known = {path.stem: path for path in rooms.glob("*.yaml")}
    if scene not in known:
        raise unknown(f"scene of {rooms}", scene, list(known))
    return known[scene]


def line_of(row: PlacementCheck) -> str:
    """Return a line of the table of failures."""
    return f"{row.scene:12} {row.labeller:12} {row.object:14} {row.reason}"


if __name__ == "__main__":
    run(main)

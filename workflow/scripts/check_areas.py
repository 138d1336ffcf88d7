"""Compare the placing areas found in the clouds with the supports of the furniture."""

import logging
from pathlib import Path
from typing import Literal

from tqdm import tqdm

from command import run
from placing.areas.coverage import compare, solids_of, tabulate, true_areas
from placing.artifacts.formats import write_csv
from placing.artifacts.scenes import read_scene
from placing.layouts import layout_reader

log = logging.getLogger(__name__)


def main(
    dataset: Literal["rooms", "scans", "thor"],
    rooms: Path,
    schema: Path,
    catalogue: Path,
    types: Path,
    scenes: tuple[Path, ...],
    min_clearance_m: float,
    max_height_m: float,
    tolerance_m: float,
    table: Path,
) -> None:
    """Compare the placing areas found in the clouds with the supports of furniture.

    Args:
        dataset: Where the layouts come from.
        rooms: Directory of the room files.
        schema: Schema of the room files.
        catalogue: Table of the objects.
        types: Table of what becomes of each type of thing in designers' rooms.
        scenes: Directories with the scenes of all folds.
        min_clearance_m: Free height that a true area has.
        max_height_m: Height of the highest true area.
        tolerance_m: Difference in height of areas that agree.
        table: Table to write, one line for each kind of furniture.
    """
    read = layout_reader(dataset, rooms, schema, catalogue, types)
    paths = sorted(path for folder in scenes for path in folder.glob("*.json"))
    tables = []
    for path in tqdm(paths, unit="scene", disable=None):
        solids = solids_of(read(path.stem))
        truth = true_areas(solids, min_clearance_m, max_height_m)
        tables.append(compare(read_scene(path).areas, truth, solids, tolerance_m))
    total = tabulate(tables)
    write_csv(table, total)
    overall = total.iloc[-1]
    log.info("recall %.3f, precision %.3f", overall.recall, overall.precision)


if __name__ == "__main__":
    run(main)

"""Check that what designers put into their rooms rests on a found placing area."""

from collections import Counter
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from shapely import Polygon

from command import run
from placing.artifacts.formats import write_csv
from placing.artifacts.scenes import read_scene
from placing.scene import Scene
from placing.thor.data import find_data, read_data
from placing.thor.reader import fate, read_items, read_layout
from placing.thor.support import Patch, check_layout
from placing.thor.types import read_types


def main(scenes: tuple[Path, ...], types: Path, support: Path, left_out: Path) -> None:
    """Write one line for each object of the designers' rooms, and what is left out.

    Args:
        scenes: Directories with the scenes of all folds.
        types: Table of what becomes of each type of thing.
        support: Table to write: what is below each object.
        left_out: Table to write: what became of the things of each type, counted.
    """
    data, kinds = read_data(find_data()), read_types(types)
    rows, fates = [], Counter()
    for path in sorted(path for folder in scenes for path in folder.glob("*.json")):
        scene = read_scene(path)
        layout = read_layout(data, scene.scene, kinds)
        items = read_items(data, scene.scene, kinds)
        fates.update((item.type, fate(item, kinds)) for item in items)
        checks = check_layout(layout, patches_of(scene))
        rows += [{"scene": scene.scene, **asdict(check)} for check in checks]
    columns = {"object_id": "object", "below": "parent_type"}
    table = pd.DataFrame(rows).rename(columns=columns)
    table["parent_type"] = table["parent_type"].str.replace(r"\d.*", "", regex=True)
    write_csv(support, table.round({"gap_m": 4}))
    counts = [(*key, count) for key, count in sorted(fates.items())]
    write_csv(left_out, pd.DataFrame(counts, columns=["object_type", "fate", "count"]))


def patches_of(scene: Scene) -> list[Patch]:
    """Return the placing areas of a scene as outlines and heights."""
    return [(Polygon(area.polygon_m), area.height_m) for area in scene.areas]


if __name__ == "__main__":
    run(main)

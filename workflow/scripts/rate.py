"""Make the page on which people rate arrangements, and the key to it."""

import logging
from pathlib import Path

from tqdm import tqdm

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.rating.blinding import blinded, key_table
from placing.rating.page import entries_of, page_of
from placing.rooms.reader import layout_reader
from placing.tables.report import write_text
from placing.tables.table2_answers import ANSWER_COLUMNS

log = logging.getLogger(__name__)


def main(
    joint: Path,
    rooms: Path,
    scenes: tuple[str, ...],
    schema: Path,
    catalogue: Path,
    template: Path,
    page: Path,
    key: Path,
    seed: int,
) -> None:
    """Make the page on which people rate arrangements, and the key to it.

    Args:
        joint: Where every method puts every object (parquet).
        rooms: Directory of room files of the data set.
        scenes: Scenes to rate.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        template: The page without arrangements.
        page: The page to write (HTML).
        key: Which scene and method each arrangement of the page is, to write (CSV).
        seed: Root of all random streams, also of the order.
    """
    read = layout_reader(rooms, schema, catalogue)
    layouts = {scene: read(scene) for scene in scenes}
    objects = {scene: layout.objects for scene, layout in layouts.items()}
    arrangements = blinded(read_table(joint, ANSWER_COLUMNS), objects, seed)
    entries = entries_of(arrangements, layouts)
    shown = tqdm(entries, total=len(arrangements), unit="arrangement", disable=None)
    text = page_of(template.read_text(), shown)
    write_text(page, text)
    write_csv(key, key_table(arrangements))
    log.info("%d arrangements, %.1f MB", len(arrangements), len(text) / 1e6)


if __name__ == "__main__":
    run(main)

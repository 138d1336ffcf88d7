"""List where the objects of all scenarios came to rest, beside their plans."""

import logging
from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.tables.scenario_tables import EXECUTED_COLUMNS

log = logging.getLogger(__name__)


def main(placed: tuple[Path, ...], table: Path) -> None:
    """List where the objects of all scenarios came to rest, beside their plans.

    Args:
        placed: Table of each scenario.
        table: Table to write.
    """
    rows = pd.concat([read_table(path, EXECUTED_COLUMNS) for path in placed])
    write_csv(table, rows)
    log.info("%d of %d objects placed", int(rows["placed"].sum()), len(rows))


if __name__ == "__main__":
    run(main)

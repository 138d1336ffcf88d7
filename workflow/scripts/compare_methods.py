"""Test what the paper says of its methods on the scenes of a data set."""

import logging
from pathlib import Path

import pandas as pd

from command import run
from placing.artifacts.formats import read_table, write_csv
from placing.seeds import generator
from placing.tables.claims import check_claims
from placing.tables.claims_table import claims_markdown
from placing.tables.metrics import SCORE_COLUMNS
from placing.tables.report import write_text

log = logging.getLogger(__name__)


def main(scores: tuple[Path, ...], seed: int, table: Path, markdown: Path) -> None:
    """Test what the paper says of its methods on the scenes of a data set.

    Args:
        scores: Scores of one data set, every task and fold.
        seed: Root of the random streams.
        table: Table to write (CSV).
        markdown: The same for people.
    """
    tables = [read_table(path, SCORE_COLUMNS) for path in scores]
    found = pd.concat(tables, ignore_index=True)
    dataset = found["dataset"].iloc[0]
    claims = check_claims(generator(seed, "compare_methods", dataset), found)
    write_csv(table, claims)
    write_text(markdown, claims_markdown(claims, dataset))
    counts = claims["verdict"].value_counts().to_dict()
    log.info("%s: %d comparisons, %s", dataset, len(claims), counts)


if __name__ == "__main__":
    run(main)

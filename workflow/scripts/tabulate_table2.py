"""Tabulate Table 2: correct places and scores, measured, published and rated."""

import logging
from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from command import run
from placing.artifacts.features import read_features
from placing.artifacts.formats import read_table, write_csv
from placing.artifacts.scenes import read_scene
from placing.rating.agreement import agreement
from placing.rating.answers import rated_cells, read_ratings
from placing.rating.blinding import blinded
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader
from placing.scene import Layout, Scene
from placing.seeds import generator
from placing.tables.correct_places import CorrectPlaces, read_correct_places
from placing.tables.report import write_text
from placing.tables.table2 import cells, table2
from placing.tables.table2_answers import ANSWER_COLUMNS
from placing.tables.table2_page import table2_markdown
from placing.tables.table2_scores import score_scene, verdicts_of

log = logging.getLogger(__name__)


def main(
    joint: Path,
    rooms: Path,
    schema: Path,
    catalogue: Path,
    scenes: Path,
    features: Path,
    correct_places: Path,
    supports: Path,
    paper: Path,
    ratings_schema: Path,
    scores: Path,
    table: Path,
    rated: Path,
    markdown: Path,
    seed: int,
    min_overlap: float,
    ratings: tuple[Path, ...] = (),
) -> None:
    """Tabulate Table 2: correct places and scores, measured, published and rated.

    Args:
        joint: Where every method puts every object (parquet).
        rooms: Directory of room files of the data set.
        schema: JSON Schema of room files.
        catalogue: Table of objects.
        scenes: Directory of the scenes.
        features: Directory of the placement candidates.
        correct_places: What the judge finds correct.
        supports: Which kind of surface furniture offers, for the judge.
        paper: Numbers of the paper.
        ratings_schema: JSON Schema of a row of ratings.
        scores: Every object with its error and its verdict, to write (CSV).
        table: Table 2 to write (CSV).
        rated: The same by raters (CSV), without rows where there are none.
        markdown: The same as a page.
        seed: Root of all random streams.
        min_overlap: Share of an object's half-width that is on its area.
        ratings: Files of raters.
    """
    answers = read_table(joint, ANSWER_COLUMNS)
    categories = {item.category for item in read_catalogue(catalogue).values()}
    places = read_correct_places(correct_places, supports, sorted(categories))
    read = [read_scene(path) for path in sorted(scenes.glob("*.json"))]
    args = layout_reader(rooms, schema, catalogue), features, seed
    every = _scored(read, (answers, places, min_overlap), *args)
    known = blinded(answers, {scene.scene: scene.objects for scene in read}, seed)
    given = read_ratings(ratings, read_yaml(ratings_schema), known)
    _write(every, given, pd.read_csv(paper), (scores, table, rated, markdown))
    log.info("%d scenes, %d files of raters", len(read), len(ratings))


def _write(
    every: pd.DataFrame,
    given: pd.DataFrame,
    paper: pd.DataFrame,
    outputs: tuple[Path, Path, Path, Path],
) -> None:
    """Write scores, Table 2, the same by raters, and a page with the paper's."""
    scores, table, rated, markdown = outputs
    of_cells = cells(every)
    measured = table2(of_cells)
    by_raters = table2(rated_cells(given)) if len(given) else measured.iloc[:0]
    write_csv(scores, every)
    write_csv(table, measured)
    write_csv(rated, by_raters)
    page = table2_markdown(of_cells, measured, paper, by_raters, agreement(given))
    write_text(markdown, page)


def _scored(
    read: Sequence[Scene],
    judged_by: tuple[pd.DataFrame, CorrectPlaces, float],
    read_layout: Callable[[str], Layout],
    features: Path,
    seed: int,
) -> pd.DataFrame:
    """Return the errors and verdicts of all scenes.

    They are judged by the answers, the correct places and the least overlap.
    """
    (answers, places, min_overlap), found = judged_by, []
    for scene in tqdm(read, unit="scene", disable=None):
        candidates, _ = read_features(features / f"{scene.scene}.npz")
        verdicts = verdicts_of(read_layout(scene.scene), scene, answers, places)
        rng = generator(seed, "tabulate_table2", scene.scene)
        args = scene, candidates, answers, verdicts, min_overlap
        found.append(score_scene(rng, *args))
    return pd.concat(found, ignore_index=True)


if __name__ == "__main__":
    run(main)

"""Answers of raters: CSV files that their browsers saved, checked line by line.

A file holds whole arrangements only: yes or no for each object that was placed, and a
score for the whole. What cannot be right is a `BadInput` of one line.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from placing.errors import BadInput
from placing.rating.blinding import Blinded
from placing.sheets import Row, read_sheet

MAX_BYTES = 1_000_000
"""Guards the reader: 20 arrangements have about 10,000."""
WHOLE = "whole"
"""The question about the arrangement as a whole."""
RATING_COLUMNS = (
    *("rater", "scene", "method", "arrangement", "object", "answer", "is_asked"),
)
"""Nobody is asked about an object that was not placed."""


def read_ratings(
    files: Iterable[Path], schema: dict[str, Any], arrangements: Iterable[Blinded]
) -> pd.DataFrame:
    """Return every answer, one row each: 0 or 1 for an object, 0 to 5 for `whole`.

    An object that was not placed has the answer 0 of everybody.
    """
    known = {one.name: one for one in arrangements}
    rows: list[tuple[object, ...]] = []
    file_of: dict[str, Path] = {}
    for path in sorted(files):
        rater, answers = _read(path, schema, known)
        if rater in file_of:
            raise BadInput(
                f"{path}: rater: value {rater!r} is that of {file_of[rater]} too; "
                "expected one file of each rater"
            )
        file_of[rater] = path
        for arrangement, given in answers.items():
            one = known[arrangement]
            keys = (rater, one.scene, one.method, arrangement)
            rows += [(*keys, name, value, True) for name, value in given.items()]
            rows += [(*keys, item, 0.0, False) for item in one.unplaced]
    return pd.DataFrame(rows, columns=list(RATING_COLUMNS))


def rated_cells(ratings: pd.DataFrame) -> pd.DataFrame:
    """Return `co` and `sc` by scene and method, the mean over raters."""
    is_whole = ratings["object"] == WHOLE
    keys = ["scene", "method", "rater"]
    co = 100 * ratings[~is_whole].groupby(keys)["answer"].mean()
    sc = ratings[is_whole].groupby(keys)["answer"].mean()
    table = pd.concat({"co": co, "sc": sc}, axis=1)
    return table.groupby(["scene", "method"]).mean().reset_index()


def _read(
    path: Path, schema: dict[str, Any], known: Mapping[str, Blinded]
) -> tuple[str, dict[str, dict[str, float]]]:
    """Return the rater of a file and the answers by arrangement and question."""
    try:
        size = path.stat().st_size
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    if size > MAX_BYTES:
        raise BadInput(f"{path}: {size} bytes; expected at most {MAX_BYTES}")
    rows = read_sheet(path, schema, ("arrangement", "question"))
    raters = sorted({row["rater"] for row in rows})
    if len(raters) > 1:
        raise BadInput(f"{path}: rater: values {raters[:3]}; expected a single one")
    answers: dict[str, dict[str, float]] = {}
    for row in rows:
        value = _answer(path, row, known)
        answers.setdefault(row["arrangement"], {})[row["question"]] = value
    for name, given in answers.items():
        _check_whole(path, known[name], given)
    return raters[0], answers


def _answer(path: Path, row: Row, known: Mapping[str, Blinded]) -> float:
    """Return an answer as a number, if arrangement and question exist."""
    name, question, answer = row["arrangement"], row["question"], row["answer"]
    if name not in known:
        raise BadInput(
            f"{path}: arrangement: value {name!r}; expected one of the page that the "
            "present results give, `./run snakemake rate`"
        )
    questions = questions_of(known[name])
    if question not in questions:
        raise BadInput(
            f"{path}: arrangement {name}: question: value {question!r}; "
            f"expected one of {', '.join(questions)}"
        )
    is_word = answer in ("yes", "no")
    if is_word == (question == WHOLE):
        wanted = "a number from 0 to 5" if question == WHOLE else "yes or no"
        raise BadInput(
            f"{path}: arrangement {name}: {question}: value {answer!r}; "
            f"expected {wanted}"
        )
    return float(answer == "yes") if is_word else float(answer)


def _check_whole(path: Path, one: Blinded, given: Mapping[str, float]) -> None:
    """Refuse an arrangement of which some questions have no answer."""
    missing = [name for name in questions_of(one) if name not in given]
    if missing:
        raise BadInput(
            f"{path}: arrangement {one.name}: no answer for {missing[0]!r}; expected "
            f"all {len(questions_of(one))} answers or none"
        )


def questions_of(one: Blinded) -> list[str]:
    """Return the questions about an arrangement: its placed objects, then the whole."""
    return [*(placement.object_id for placement in one.placements), WHOLE]

"""The catalogue of objects: what each one is, how large, how heavy, who may move it."""

import csv
from math import isfinite
from pathlib import Path

from placing.errors import BadInput
from placing.scene import SceneObject
from placing.shapes.objects import OBJECTS

COLUMNS = (
    "object",
    "category",
    "shape",
    "depth_m",
    "width_m",
    "height_m",
    "mass_kg",
    "has_front",
    "movable",
)
# SOURCE: sizes and masses in `config/objects.csv` are those of everyday things, not of
# particular products; what is movable is Table 1 of the paper.
TRUTHS = {"True": True, "False": False}


def read_catalogue(path: Path) -> dict[str, SceneObject]:
    """Read the table of objects, in its order, by object id."""
    catalogue: dict[str, SceneObject] = {}
    for line, row in _rows(path):
        where = f"{path}, line {line}"
        item = _object_of(row, where)
        if item.object_id in catalogue:
            raise _bad(where, "object", item.object_id, "an id that is not used above")
        catalogue[item.object_id] = item
    if not catalogue:
        raise BadInput(f"{path}: holds 0 objects; expected at least one line of them")
    return catalogue


def _rows(path: Path) -> list[tuple[int, dict[str, str]]]:
    """Return the lines of the table with their numbers in the file."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, cells) for cells in reader if cells]
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read ({error}); expected a CSV") from error
    header = lines[0][1] if lines else []
    if tuple(header) != COLUMNS:
        raise _bad(f"{path}, line 1", "header", ",".join(header), ",".join(COLUMNS))
    for line, cells in lines[1:]:
        if len(cells) != len(COLUMNS):
            where, n = f"{path}, line {line}", len(COLUMNS)
            raise BadInput(f"{where}: has {len(cells)} columns; expected {n}")
    return [(line, dict(zip(COLUMNS, cells, strict=True))) for line, cells in lines[1:]]


def _object_of(row: dict[str, str], where: str) -> SceneObject:
    """Return the object that a line describes."""
    for column in ("object", "category"):
        if not row[column].isidentifier():
            raise _bad(where, column, row[column], "a word of letters, digits and _")
    if row["shape"] not in OBJECTS:
        raise _bad(where, "shape", row["shape"], f"one of {', '.join(sorted(OBJECTS))}")
    depth, width, height, mass = (
        _positive(row, column, where)
        for column in ("depth_m", "width_m", "height_m", "mass_kg")
    )
    return SceneObject(
        object_id=row["object"],
        category=row["category"],
        shape=row["shape"],
        size_m=(depth, width, height),
        mass_kg=mass,
        has_front=_truth(row, "has_front", where),
        is_movable=_truth(row, "movable", where),
    )


def _positive(row: dict[str, str], column: str, where: str) -> float:
    """Return the number in `column`, which has to be finite and above 0."""
    try:
        number = float(row[column])
    except ValueError:
        number = -1.0
    if not (isfinite(number) and number > 0):
        raise _bad(where, column, row[column], "a finite number above 0")
    return number


def _truth(row: dict[str, str], column: str, where: str) -> bool:
    """Return the truth value in `column`."""
    if row[column] not in TRUTHS:
        raise _bad(where, column, row[column], "True or False")
    return TRUTHS[row[column]]


def _bad(where: str, column: str, value: str, expected: str) -> BadInput:
    """Return the error for one cell of the table."""
    return BadInput(f"{where}: {column} is {value!r}; expected {expected}")

"""The catalogue of objects: what each one is, how large, how heavy, who may move it."""

from math import isfinite
from pathlib import Path

from placing.errors import BadInput
from placing.scene import SceneObject
from placing.shapes.objects import OBJECTS
from placing.sheets import read_lines

COLUMNS = [
    "object",
    "category",
    "shape",
    "depth_m",
    "width_m",
    "height_m",
    "mass_kg",
    "has_front",
    "movable",
]
# SOURCE: sizes and masses in `config/objects.csv` are those of everyday things, not of
# particular products; what is movable is Table 1 of the paper.
TRUTHS = {"True": True, "False": False}


def read_catalogue(path: Path) -> dict[str, SceneObject]:
    """Read the table of objects, in its order, by object id."""
    catalogue: dict[str, SceneObject] = {}
    for line, row in read_lines(path, COLUMNS):
        where = f"{path}: line {line}"
        item = _object_of(row, where)
        if item.object_id in catalogue:
            raise _bad(where, "object", item.object_id, "an id that is not used above")
        catalogue[item.object_id] = item
    if not catalogue:
        raise BadInput(f"{path}: no rows; expected at least one")
    return catalogue


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
    return BadInput(f"{where}: {column}: value {value!r}; expected {expected}")

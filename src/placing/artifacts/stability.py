"""The model of stability as JSON: numbers only, and checked when read."""

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_json, write_json
from placing.errors import BadInput
from placing.psi.stability import LEAF, StabilityModel

NUMBERS = ("start", "slope", "intercept")
WHOLE = ("cut", "left", "right")
REAL = ("threshold", "value")
MAX_NUMBER = 1e9
MAX_CELLS = 10_000_000
"""Guards against damage: larger than any model that is learned here."""


def write_stability(path: Path, model: StabilityModel) -> None:
    """Write the model of stability."""
    write_json(path, asdict(model))


def read_stability(path: Path) -> StabilityModel:
    """Read the model of stability after checking every number."""
    if not path.is_file():
        raise BadInput(f"{path}: file is missing, expected a model of learn_stability")
    try:
        document = read_json(path)
    except RecursionError:
        raise BadInput(f"{path}: lists too deep, expected a model") from None
    names = [field.name for field in fields(StabilityModel)]
    if not isinstance(document, dict) or sorted(document) != sorted(names):
        found = sorted(document) if isinstance(document, dict) else repr(document)
        raise _bad(path, "fields", found, ", ".join(sorted(names)))
    features = document["features"]
    if not _are_names(features):
        raise _bad(path, "features", features, "a list of different names")
    if _number(path, "slope", document["slope"]) <= 0:
        raise _bad(path, "slope", document["slope"], "a number above 0")
    values: dict[str, Any] = {"features": tuple(features)}
    values |= {name: _number(path, name, document[name]) for name in NUMBERS}
    values |= {name: _array(path, name, document[name]) for name in REAL}
    values |= {name: _whole(path, name, document[name]) for name in WHOLE}
    model = StabilityModel(**values)
    _check_trees(path, model)
    return model


def _are_names(value: object) -> bool:
    """Return whether a value is a list of different words, at least one."""
    return (
        isinstance(value, list)
        and 0 < len(value) < 10_000
        and all(isinstance(name, str) and name.isidentifier() for name in value)
        and len(set(value)) == len(value)
    )


def _number(path: Path, place: str, value: Any) -> float:  # noqa: ANN401 (JSON)
    """Return a finite number."""
    if type(value) in (int, float) and abs(value) <= MAX_NUMBER:  # false for NaN
        return float(value)
    raise _bad(path, place, value, f"a finite number up to {MAX_NUMBER:.0e}")


def _array(path: Path, place: str, value: Any) -> NDArray[np.float64]:  # noqa: ANN401
    """Return rows of finite numbers, shape (t, k)."""
    rows = value if isinstance(value, list) else []
    lengths = {len(row) if isinstance(row, list) else 0 for row in rows}
    if len(lengths) != 1 or not 0 < len(rows) * max(lengths) <= MAX_CELLS:
        raise _bad(path, place, value, "rows of one length")
    for row in rows:
        for number in row:
            _number(path, place, number)
    return np.array(rows, np.float64)


def _whole(path: Path, place: str, value: Any) -> NDArray[np.int64]:  # noqa: ANN401
    """Return rows of whole numbers, shape (t, k)."""
    array = _array(path, place, value)
    if np.any(array != np.round(array)):
        fraction = array[array != np.round(array)][0]
        raise _bad(path, place, float(fraction), "whole numbers")
    return array.astype(np.int64)


def _check_trees(path: Path, model: StabilityModel) -> None:
    """Refuse trees of different shapes, and those on which a walk does not end."""
    n_nodes = model.cut.shape[1]
    for name in (*WHOLE, *REAL):
        shape = getattr(model, name).shape
        if shape != model.cut.shape:
            raise _bad(path, name, f"of shape {shape}", f"shape {model.cut.shape}")
    if model.cut.min() < LEAF or model.cut.max() >= len(model.features):
        most = len(model.features) - 1
        raise _bad(path, "cut", int(model.cut.max()), f"{LEAF} to {most}")
    # A child comes after its parent, so that every walk ends.
    for name in ("left", "right"):
        child = getattr(model, name)
        wrong = (model.cut >= 0) & ((child <= np.arange(n_nodes)) | (child >= n_nodes))
        if wrong.any():
            raise _bad(path, name, int(child[wrong][0]), "a node after its parent")


def _bad(path: Path, place: str, value: object, expected: str) -> BadInput:
    """Return the error for a value, in one line."""
    shown = " ".join(repr(value).split())
    shown = shown if len(shown) <= 60 else f"{shown[:57]}..."
    return BadInput(f"{path}: {place}: value {shown}; expected {expected}")

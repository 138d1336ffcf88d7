"""What was seen of a robot that carried out its plans, as arrays."""

from pathlib import Path
from typing import Any

import numpy as np

from placing.artifacts.formats import read_arrays, write_arrays
from placing.errors import BadArtifact
from placing.robot.film import Film

SHAPES = {
    "time_s": "t",
    "q": "tq",
    "opening_m": "t",
    "objects": "n",
    "T_world_objects": "tn7",
    "held": "t",
    "phase": "t",
    "moving": "t",
}
"""The axes of each array: t frames, n objects, q columns of a way-point."""
KINDS = {"objects": "U", "phase": "U", "held": "i", "moving": "i"}
"""Kinds of the arrays that do not hold real numbers."""


def write_film(path: Path, film: Film) -> None:
    """Write a film."""
    arrays = {name: np.asarray(getattr(film, name)) for name in SHAPES}
    for name in ("held", "moving"):
        arrays[name] = arrays[name].astype(np.int64)
    write_arrays(path, arrays)


def read_film(path: Path) -> Film:
    """Read a film, checked; poses may be NaN while an object is nowhere."""
    arrays = read_arrays(path, tuple(SHAPES))
    lengths: dict[str, int] = {"7": 7}
    for name, axes in SHAPES.items():
        array, kind = arrays[name], KINDS.get(name, "f")
        known = len(array.shape) == len(axes) and all(
            lengths.setdefault(axis, n) == n
            for axis, n in zip(axes, array.shape, strict=True)
        )
        if not known or array.dtype.kind != kind:
            expected = f"axes {axes} of kind {kind}, where {lengths}"
            raise BadArtifact(
                f"{path}: {name}: {array.dtype} {array.shape}; expected {expected}"
            )
    for name in ("time_s", "q", "opening_m"):
        if not np.isfinite(arrays[name]).all():
            raise BadArtifact(f"{path}: {name}: expected finite numbers")
    for name in ("held", "moving"):
        if not ((arrays[name] >= -1) & (arrays[name] < lengths["n"])).all():
            expected = f"numbers from -1 to {lengths['n'] - 1}"
            raise BadArtifact(f"{path}: {name}: expected {expected}")
    if np.any(np.diff(arrays["time_s"]) <= 0):
        raise BadArtifact(f"{path}: time_s: expected times that increase")
    values: dict[str, Any] = dict(arrays)
    values |= {name: tuple(arrays[name].tolist()) for name in ("objects", "phase")}
    return Film(**values)

"""Densities of the answers about a scene as arrays."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_arrays, write_arrays

Array = NDArray[np.float64]


def read_densities(path: Path) -> dict[str, Array]:
    """Read the densities of a scene by key, each (p,)."""
    arrays = read_arrays(path, ("keys", "densities"))
    densities = arrays["densities"].astype(float)
    return dict(zip(arrays["keys"].tolist(), densities, strict=True))


def write_densities(path: Path, densities: Mapping[str, Array]) -> None:
    """Write the densities of a scene by key, as single-precision numbers."""
    keys = np.array(sorted(densities), dtype=np.str_)
    stacked = np.array([densities[key] for key in keys], np.float32)
    write_arrays(path, {"keys": keys, "densities": stacked})

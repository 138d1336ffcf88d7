"""What a fold has learned as JSON: Theta and the histograms of the baselines.

What is read is checked: a number that is missing or not finite is a `BadArtifact` that
names the file, the category and the parameter.
"""

import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from placing.artifacts.formats import read_json
from placing.baselines import FEATURES_OF
from placing.errors import BadArtifact
from placing.potential import Theta
from placing.scene_model import Learned


def read_learned(folder: Path) -> Learned:
    """Read what a fold has learned: Theta and the histograms of the baselines."""
    thetas = _categories(folder / "dp.json")
    histograms = {
        method: {
            name: np.array(shares, float)
            for name, shares in _categories(folder / f"{method}.json").items()
        }
        for method in FEATURES_OF
    }
    path = folder / "dp.json"
    return Learned({n: _theta(path, n, v) for n, v in thetas.items()}, histograms)


def _categories(path: Path) -> dict[str, Any]:
    """Return the part per category of a file of learn_theta."""
    document = read_json(path)
    try:
        return dict(document["categories"])
    except (KeyError, TypeError, ValueError) as error:
        message = f"{path}: categories: {error}; expected a file of learn_theta"
        raise BadArtifact(message) from error


def _theta(path: Path, category: str, values: dict[str, Any]) -> Theta:
    """Return the Theta of a category after checking every value."""
    for field in fields(Theta):
        value = values.get(field.name)
        if not _is_finite(value):
            place = f"{path}: categories.{category}.{field.name}"
            raise BadArtifact(f"{place}: value {value!r}; expected a finite number")
    return Theta(**{field.name: values[field.name] for field in fields(Theta)})


def _is_finite(value: object) -> bool:
    """Return whether a value of a JSON document is a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return math.isfinite(value)

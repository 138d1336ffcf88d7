"""What a fold has learned as JSON: Theta, histograms of baselines, object context.

A folder holds `dp.json` and a `fmm<K>.json` per K with a Theta per category, a file of
histograms per baseline, and `object.json`. A category without a training example is in
none of them. What is read is checked: anything out of place is a `BadArtifact` that
names the file, the category, the field, its value and what was expected.
"""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_json, write_json
from placing.errors import BadArtifact
from placing.learning.learned import Learned
from placing.methods.baselines import FEATURES_OF
from placing.methods.object_context import Relations
from placing.people.potential import Theta

Array = NDArray[np.float64]

ANGLE = (-2 * math.pi, 2 * math.pi)
RANGES = {
    "log_distance_mean": (-5.0, 5.0),
    "log_distance_sigma": (0.001, 10.0),
    "bearing_mean_rad": ANGLE,
    "bearing_kappa": (0.0, 1e4),
    "height_mean_m": (-10.0, 10.0),
    "height_sigma_m": (0.001, 10.0),
    "orientation_mean_rad": ANGLE,
    "orientation_kappa": (0.0, 1e4),
}
"""Least and greatest value of each parameter that a file may hold."""


def read_learned(folder: Path) -> Learned:
    """Read what a fold has learned."""
    mixtures = [p for p in folder.glob("fmm*.json") if re.fullmatch(r"fmm\d+", p.stem)]
    paths = [folder / "dp.json", *sorted(mixtures, key=lambda p: int(p.stem[3:]))]
    return Learned(
        thetas={path.stem: read_thetas(path) for path in paths},
        histograms={
            method: read_histograms(folder / f"{method}.json") for method in FEATURES_OF
        },
        relations=read_relations(folder / "object.json"),
    )


def write_thetas(
    path: Path, thetas: Mapping[str, Theta], training_scenes: Sequence[str]
) -> None:
    """Write the Theta of each category."""
    categories = {name: asdict(theta) for name, theta in thetas.items()}
    _write(path, training_scenes, categories=categories)


def read_thetas(path: Path) -> dict[str, Theta]:
    """Read the Theta of each category."""
    categories = _mapping(path, "categories", _document(path).get("categories"))
    return {
        name: _theta(path, f"categories.{name}", values)
        for name, values in categories.items()
    }


def write_histograms(
    path: Path, histograms: Mapping[str, Array], training_scenes: Sequence[str]
) -> None:
    """Write the histogram of each category under one baseline."""
    _write(path, training_scenes, categories=dict(histograms))


def read_histograms(path: Path) -> dict[str, Array]:
    """Read the histogram of each category under the baseline that names the file."""
    categories = _mapping(path, "categories", _document(path).get("categories"))
    n_features = len(FEATURES_OF[path.stem])
    return {
        name: _histogram(path, f"categories.{name}", shares, n_features)
        for name, shares in categories.items()
    }


def write_relations(
    path: Path, relations: Relations, training_scenes: Sequence[str]
) -> None:
    """Write the object context."""
    _write(
        path,
        training_scenes,
        categories={
            wanted: {given: asdict(theta) for given, theta in by_given.items()}
            for wanted, by_given in relations.pairs.items()
        },
        common=asdict(relations.common),
        sharpness=relations.sharpness,
    )


def read_relations(path: Path) -> Relations:
    """Read the object context."""
    document = _document(path)
    categories = _mapping(path, "categories", document.get("categories"))
    pairs = {}
    for wanted, by_given in categories.items():
        place = f"categories.{wanted}"
        pairs[wanted] = {
            given: _theta(path, f"{place}.{given}", values)
            for given, values in _mapping(path, place, by_given).items()
        }
    common = _theta(path, "common", document.get("common"))
    sharpness = _number(path, "sharpness", document.get("sharpness"), (0.0, 100.0))
    return Relations(common, pairs, sharpness)


def _write(path: Path, training_scenes: Sequence[str], **parts: object) -> None:
    """Write parts of what was learned and the scenes it was learned from."""
    write_json(path, {"training_scenes": list(training_scenes), **parts})


def _document(path: Path) -> Mapping[str, Any]:
    """Return the contents of a file of learn_theta."""
    return _mapping(path, "the document", read_json(path))


def _mapping(path: Path, place: str, value: object) -> Mapping[str, Any]:
    """Return `value` if it is a JSON object."""
    if not isinstance(value, dict):
        raise _bad(path, place, repr(value), "an object, as learn_theta writes")
    return value


def _theta(path: Path, place: str, values: object) -> Theta:
    """Return a Theta after checking every value."""
    checked = _mapping(path, place, values)
    return Theta(
        **{
            name: _number(path, f"{place}.{name}", checked.get(name), RANGES[name])
            for name in (field.name for field in fields(Theta))
        }
    )


def _number(
    path: Path,
    place: str,
    value: Any,  # noqa: ANN401 (a JSON value can be anything)
    limits: tuple[float, float],
) -> float:
    """Return a finite number within its limits."""
    low, high = limits
    if type(value) in (int, float) and low <= value <= high:  # false for NaN
        return float(value)
    expected = f"a finite number from {low:.4g} to {high:.4g}"
    raise _bad(path, place, repr(value), expected)


def _histogram(path: Path, place: str, value: object, n_features: int) -> Array:
    """Return the shares of the bins, one axis per feature."""
    for share in _leaves(value):
        _number(path, place, share, (0.0, 1.0))
    try:
        shares = np.array(value, float)
    except (TypeError, ValueError):
        raise _bad(path, place, repr(value), "rows of one length") from None
    if shares.ndim != n_features or shares.size == 0:
        expected = f"shares along {n_features} axes, one per feature"
        raise _bad(path, place, f"of shape {shares.shape}", expected)
    # Shares are written with nine digits; a thousand bins round to 1e-6 together.
    if abs(shares.sum() - 1) > 1e-3:
        raise _bad(path, place, f"sum {shares.sum():.6g}", "shares that sum to 1")
    return shares


def _leaves(value: object) -> Iterator[object]:
    """Yield what nested lists hold."""
    if isinstance(value, list):
        for item in value:
            yield from _leaves(item)
    else:
        yield value


def _bad(path: Path, place: str, value: str, expected: str) -> BadArtifact:
    """Return the error for a value, in one line."""
    shown = value if len(value) <= 60 else f"{value[:57]}..."
    line = f"{place}: value {shown}; expected {expected}"
    return BadArtifact(f"{path}: {' '.join(line.splitlines())}")

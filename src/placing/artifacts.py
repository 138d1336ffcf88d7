"""Readers and writers of the artifacts that link the stages.

What is read is checked: a missing field or a number that is not finite is a
`BadArtifact` that names the file and the field.
"""

from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.answering import Learned
from placing.baselines import FEATURES_OF
from placing.candidates import Candidates
from placing.errors import BadArtifact
from placing.files import read_arrays, read_json, write_arrays, write_json
from placing.human import HumanPoses
from placing.potential import Theta
from placing.scene import Arrangement, Placement, PlacingArea, Scene, SceneObject

Array = NDArray[np.float64]


def read_scene(path: Path) -> Scene:
    """Read a scene: its placing areas, objects and labelled arrangements."""
    document = read_json(path)
    try:
        return Scene(
            scene=document["scene"],
            kind=document["kind"],
            areas=tuple(_area(area) for area in document["areas"]),
            objects=tuple(_object(item) for item in document["objects"]),
            arrangements=tuple(_arrangement(a) for a in document["arrangements"]),
        )
    except (KeyError, TypeError) as error:
        message = f"{path}: not a scene: {error}; expected a file of find_areas"
        raise BadArtifact(message) from error


def write_scene(path: Path, scene: Scene) -> None:
    """Write a scene as indented JSON with sorted keys."""
    write_json(path, asdict(scene))


def read_features(path: Path) -> tuple[Candidates, HumanPoses]:
    """Read the placement candidates and the valid human poses of a scene."""
    names = ("location", "area", "features", "kind", "pose_location", "yaw", "prior")
    location, area, features, *poses = read_arrays(path, names).values()
    return Candidates(location, area, features), HumanPoses(*poses)


def write_features(path: Path, candidates: Candidates, poses: HumanPoses) -> None:
    """Write the placement candidates and the valid human poses of a scene."""
    arrays = vars(candidates) | {
        "kind": poses.kind,
        "pose_location": poses.location,
        "yaw": poses.yaw,
        "prior": poses.prior,
    }
    write_arrays(path, arrays)


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
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not np.isfinite(value):
            place = f"{path}: categories.{category}.{field.name}"
            raise BadArtifact(f"{place}: value {value!r}; expected a finite number")
    return Theta(**{field.name: values[field.name] for field in fields(Theta)})


def _area(document: dict[str, Any]) -> PlacingArea:
    clearance = document["clearance_m"]
    return PlacingArea(
        **document
        | {
            "polygon_m": np.array(document["polygon_m"], float),
            "clearance_m": np.inf if clearance is None else clearance,
        }
    )


def _object(document: dict[str, Any]) -> SceneObject:
    return SceneObject(**document | {"size_m": tuple(document["size_m"])})


def _arrangement(document: dict[str, Any]) -> Arrangement:
    placements = tuple(_placement(item) for item in document["placements"])
    return Arrangement(**document | {"placements": placements})


def _placement(document: dict[str, Any]) -> Placement:
    arrays = {
        name: np.array(document[name], float) for name in ("location", "orientation")
    }
    return Placement(**document | arrays)

"""A scene as JSON: placing areas, objects and labelled arrangements."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from placing.artifacts.formats import read_json, write_json
from placing.errors import BadArtifact
from placing.scene import Arrangement, Placement, PlacingArea, Scene, SceneObject


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


def _area(document: dict[str, Any]) -> PlacingArea:
    clearance = document["clearance_m"]
    values: dict[str, Any] = {
        "polygon_m": np.array(document["polygon_m"], float),
        "clearance_m": np.inf if clearance is None else clearance,
    }
    return PlacingArea(**document | values)


def _object(document: dict[str, Any]) -> SceneObject:
    values: dict[str, Any] = {"size_m": tuple(document["size_m"])}
    return SceneObject(**document | values)


def _arrangement(document: dict[str, Any]) -> Arrangement:
    placements = tuple(_placement(item) for item in document["placements"])
    values: dict[str, Any] = {"placements": placements}
    return Arrangement(**document | values)


def _placement(document: dict[str, Any]) -> Placement:
    names = ("location", "orientation")
    values: dict[str, Any] = {name: np.array(document[name], float) for name in names}
    return Placement(**document | values)

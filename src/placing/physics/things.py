"""Objects that are tried: those of the catalogue, and glasses on a stem."""

from collections.abc import Mapping
from dataclasses import dataclass

from placing.psi.object_clouds import ObjectCloud, object_cloud
from placing.psi.orientations import (
    Orientation,
    OrientationsConfig,
    drop_of,
    orientations,
)
from placing.scene import SceneObject

# SOURCE: sizes of common glasses; they are in no scene and only tried here.
GLASSES = (
    ("wine_glass1", "wine_glass", (0.085, 0.085, 0.21), 0.18),
    ("wine_glass2", "wine_glass", (0.07, 0.07, 0.17), 0.13),
    ("martini_glass1", "martini_glass", (0.11, 0.11, 0.18), 0.2),
    ("martini_glass2", "martini_glass", (0.095, 0.095, 0.15), 0.16),
)


@dataclass(frozen=True)
class Thing:
    """An object that is tried, with all that is derived from its shape."""

    item: SceneObject
    cloud: ObjectCloud
    ways: tuple[Orientation, ...]
    drops_m: tuple[float, ...]
    """How far below its area each orientation reaches."""


def trial_objects(catalogue: Mapping[str, SceneObject]) -> dict[str, SceneObject]:
    """Return the objects of the catalogue and stemmed glasses, by id."""
    glasses = {
        name: SceneObject(name, "dishware", shape, size_m, mass_kg, False, True)
        for name, shape, size_m, mass_kg in GLASSES
    }
    return {**catalogue, **glasses}


def things_of(
    catalogue: Mapping[str, SceneObject],
    spacing_m: float,
    config: OrientationsConfig,
) -> dict[str, Thing]:
    """Return what is tried, by id."""
    items = trial_objects(catalogue)
    return {name: thing_of(item, spacing_m, config) for name, item in items.items()}


def thing_of(item: SceneObject, spacing_m: float, config: OrientationsConfig) -> Thing:
    """Return an object with its cloud and its orientations."""
    cloud = object_cloud(item, spacing_m)
    ways = orientations(cloud, config)
    return Thing(item, cloud, ways, tuple(drop_of(cloud, w, config) for w in ways))

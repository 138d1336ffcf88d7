"""Where labellers put objects: which placing area carries each of them.

Shapes: n objects, m areas.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.candidates import Candidates
from placing.clouds.ply import Cloud
from placing.psi.area_descriptors import describe_areas
from placing.psi.object_descriptors import describe_objects
from placing.psi.semantics import LabelledScene
from placing.scene import (
    NEAR_M,
    Arrangement,
    Placement,
    Scene,
    SceneObject,
    resting_point,
)

Array = NDArray[np.float64]


def label_scene(
    scene: Scene, cloud: Cloud, candidates: Candidates, spacing_m: float
) -> LabelledScene:
    """Return what semantics are learned from in a scene."""
    return LabelledScene(
        scene=scene.scene,
        objects=describe_objects(scene.objects, spacing_m),
        areas=describe_areas(cloud, scene.areas, candidates),
        shares=label_shares(scene),
    )


def label_shares(scene: Scene) -> Array:
    """Return the share of the labels of each object that are on each area, (n, m).

    The row of an object that no labeller put on an area is 0.
    """
    rows = {item.object_id: i for i, item in enumerate(scene.objects)}
    columns = {area.area: k for k, area in enumerate(scene.areas)}
    counts = np.zeros((len(rows), len(columns)))
    for arrangement in scene.arrangements:
        for name, area in carrying_areas(scene, arrangement).items():
            if area in columns:
                counts[rows[name], columns[area]] += 1
    return counts / np.maximum(counts.sum(1, keepdims=True), 1)


def carrying_areas(scene: Scene, arrangement: Arrangement) -> dict[str, str]:
    """Return the area that carries each object in the end, "" where none does."""
    items = {item.object_id: item for item in scene.objects}
    # From below: whatever carries an object has been looked at before it.
    placements = sorted(
        arrangement.placements, key=lambda p: resting_point(items[p.object_id], p)[2]
    )
    areas: dict[str, str] = {}
    for i, placement in enumerate(placements):
        if not (area := placement.area):
            carrier = _carrier(items, placement, placements[:i])
            area = areas[carrier] if carrier else ""
        areas[placement.object_id] = area
    return areas


def _carrier(
    items: Mapping[str, SceneObject], placement: Placement, lower: list[Placement]
) -> str:
    """Return the highest object in or on whose box another rests, "" if there is none.

    Things rest inside cups and bowls, too.
    """
    point = resting_point(items[placement.object_id], placement)
    for other in reversed(lower):
        rotation = rigid.matrix(other.orientation)
        local = (point - other.location) @ rotation  # In the frame of the other.
        half = np.array(items[other.object_id].size_m) / 2
        if (np.abs(local) <= half + NEAR_M).all():
            return other.object_id
    return ""

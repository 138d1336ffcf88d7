"""Features of a placement from two clouds alone: the scene's and the object's.

What holds an object where it is: what it stands on, what surrounds it, what it would
cut. All of it is read off the points of the two clouds, in compiled loops over
placements; `stability` learns from these features whether an object stays put.

Letters for shapes: c placements, f features.
"""

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.psi.contact_kernels import PLACED_FEATURES, measure, rest
from placing.psi.object_clouds import ObjectCloud
from placing.psi.object_grids import (
    SHAPE_FEATURES,
    object_grid,
    shape_features,
    spread_points,
)
from placing.psi.placing_field import PlacingField

__all__ = ["STABILITY_FEATURES", "PlacingField", "rest_heights", "stability_features"]

Array = NDArray[np.float64]

STABILITY_FEATURES: tuple[str, ...] = PLACED_FEATURES + SHAPE_FEATURES
"""Columns of `stability_features`."""


def rest_heights(
    field: PlacingField,
    object_cloud: ObjectCloud,
    orientation: Array,
    xy: Array,
    start_height_m: Array,
) -> Array:
    """Return the height of the object's frame when it is lowered on an area, (c,) [m].

    The object's lowest point comes straight down from 3 cm above the area at
    `start_height_m`, or from 2 cm where something hangs above, to the first contact
    with what faces up, and never below the area.
    """
    points, normals = spread_points(object_cloud)
    return rest(
        field.levels,
        points,
        normals,
        np.ascontiguousarray(orientation, float),
        np.ascontiguousarray(xy, float),
        np.ascontiguousarray(start_height_m, float),
    )


def stability_features(
    field: PlacingField,
    object_cloud: ObjectCloud,
    Ts_world_object: Array,
    area_height_m: Array,
) -> NDArray[np.float32]:
    """Return what two clouds say of placements (c, 7) on areas, shape (c, f)."""
    T = np.ascontiguousarray(Ts_world_object, float)
    points, normals = spread_points(object_cloud)
    placed = measure(
        (field.levels, field.points, object_grid(object_cloud)),
        points,
        normals,
        object_cloud.mass_centre,
        T,
        np.ascontiguousarray(area_height_m, float),
    )
    own = shape_features(object_cloud, rigid.upward(T[:, :4]))
    return np.concatenate([placed, own], axis=1).astype(np.float32)

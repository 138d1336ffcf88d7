"""Placement candidates: where an object could be put down in a scene.

Places on a lattice over every placing area (see `places`), each with the features that
the later stages use; headings come from a fixed set. Which places fit an object is
decided per object from its size and from the objects that already stand there.

Shapes: p places, n objects.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.scene import SceneObject

Array = NDArray[np.float64]

OPEN_M = 9.0
"""Free height of a place with nothing above it."""
FEATURES = ("height_m", "clearance_m", "edge_distance_m", "wall_distance_m")


@dataclass(frozen=True)
class CandidatesConfig:
    """Which places are tried; the values live in `config/config.yaml`."""

    spacing_m: float
    """Lattice of the places."""
    n_headings: int
    min_overlap: float
    """Share of an object's shorter half-width that must lie inside the area's edge."""
    wall_cell_m: float
    """Grid on which the distance to the walls is measured."""


@dataclass(frozen=True)
class Candidates:
    """The places of a scene, ordered by area, then x, then y."""

    location: Array
    """(p, 3) points on the placing areas [m]."""
    area: NDArray[np.int32]
    """(p,) index of the placing area."""
    features: Array
    """(p, f) one column per name of `FEATURES`."""

    def feature(self, name: str) -> Array:
        """Return one feature, shape (p,)."""
        return self.features[:, FEATURES.index(name)]


def fits(
    candidates: Candidates, item: SceneObject, min_overlap: float
) -> NDArray[np.bool_]:
    """Return at which places the object fits below what is above and on the area."""
    # ASSUME: an object may overhang the edge of its area by a part of its own width;
    # whether it then stands is a matter of stability (Section 3.1).
    half_width = min(item.size_m[:2]) / 2
    is_on_area = candidates.feature("edge_distance_m") >= min_overlap * half_width
    return is_on_area & (candidates.feature("clearance_m") >= item.size_m[2])


def is_unoccupied(
    candidates: Candidates, item: SceneObject, boxes: Array
) -> NDArray[np.bool_]:
    """Return at which places the object is clear of objects that stand there already.

    `boxes` (n, 7) = centre, size and yaw of the given objects.
    """
    reach = min(item.size_m[:2]) / 2
    return _is_clear(candidates.location, boxes, reach, item.size_m[2])


@njit(cache=True)
def _is_clear(places, boxes, reach, height):  # noqa: ANN001, ANN202
    """Return at which places a cylinder of this radius and height hits no box, (p,)."""
    free = np.ones(len(places), np.bool_)
    for box in boxes:
        cos, sin = np.cos(box[6]), np.sin(box[6])
        bottom, top = box[2] - box[5] / 2, box[2] + box[5] / 2
        for p in range(len(places)):
            dx, dy, z = places[p, 0] - box[0], places[p, 1] - box[1], places[p, 2]
            overlaps = abs(cos * dx + sin * dy) < box[3] / 2 + reach
            overlaps &= abs(cos * dy - sin * dx) < box[4] / 2 + reach
            free[p] &= not (overlaps and z < top and z + height > bottom)
    return free

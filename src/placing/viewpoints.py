"""Where somebody with a camera stands in a scene: on free floor, all over it.

Shapes: p places, v viewpoints.
"""

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from placing.clouds.raycaster import Raycaster
from placing.errors import BadInput
from placing.scene import Layout

LATTICE_M = 0.1
"""Between the places on the floor that are tried."""
LOW_M = 0.05
"""What is lower, such as a rug, is floor."""


class Standing(NamedTuple):
    """How somebody stands with a camera."""

    eye_m: float
    """Height of the camera."""
    free_m: float
    """Nothing is nearer to the vertical below the camera."""
    spacing_m: float
    """Every free place is so near to a viewpoint, unless they are too many."""
    n_most: int
    """Most viewpoints."""


def find_viewpoints(
    layout: Layout, caster: Raycaster, standing: Standing
) -> NDArray[np.float64]:
    """Return where the eye is at the viewpoints of a scene, shape (v, 3) [m]."""
    places = _lattice(layout)
    places = places[_is_floor(caster, places, layout.height_m)]
    room = _room(caster, places, standing)
    is_free = room >= standing.free_m
    if not is_free.any():
        raise BadInput(
            f"scene {layout.scene}: field furniture leaves no place to stand, expected"
            f" one with {standing.free_m:g} m free around it up to"
            f" {standing.eye_m:g} m"
        )
    chosen = _spread(places[is_free], room[is_free], standing)
    return np.insert(chosen, 2, standing.eye_m, axis=1)


def _lattice(layout: Layout) -> NDArray[np.float64]:
    """Return the places of a lattice that are inside the walls, shape (p, 2) [m]."""
    low, high = layout.outline_m.min(axis=0), layout.outline_m.max(axis=0)
    axes = [
        np.arange(a + LATTICE_M, b, LATTICE_M) for a, b in zip(low, high, strict=True)
    ]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    return places[shapely.contains_xy(Polygon(layout.outline_m), places)]


def _is_floor(
    caster: Raycaster, places: NDArray[np.float64], height_m: float
) -> NDArray[np.bool_]:
    """Tell above which places there is nothing, whatever its height, shape (p,)."""
    top = height_m + 1.0
    down = np.broadcast_to([0.0, 0.0, -1.0], (len(places), 3))
    hits = caster.cast(np.insert(places, 2, top, axis=1), down)
    return hits.is_hit & (top - hits.t < LOW_M)


def _room(
    caster: Raycaster, places: NDArray[np.float64], standing: Standing
) -> NDArray[np.float64]:
    """Return the distance from each place, at any height, to the rest, (p,) [m]."""
    levels = np.arange(standing.free_m + LOW_M, standing.eye_m, standing.free_m)
    room = np.full(len(places), np.inf)
    for level in [*levels, standing.eye_m]:
        distance = caster.distance(np.insert(places, 2, level, axis=1))
        room = np.minimum(room, distance)
    return room


def _spread(
    places: NDArray[np.float64], room: NDArray[np.float64], standing: Standing
) -> NDArray[np.float64]:
    """Return the roomiest place, then each time the farthest of all, shape (v, 2)."""
    chosen = [int(np.argmax(room))]
    gap = np.linalg.norm(places - places[chosen[0]], axis=1)
    while gap.max() > standing.spacing_m and len(chosen) < standing.n_most:
        chosen.append(int(np.argmax(gap)))
        gap = np.minimum(gap, np.linalg.norm(places - places[chosen[-1]], axis=1))
    return places[chosen]

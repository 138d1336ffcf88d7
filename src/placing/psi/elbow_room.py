"""Whether an object has room where it would stand: beside it and below all of it.

What a scan shows beside an object is a centimetre or two off, and on the floor it stops
where something stands: an object needs a little room around its box, and a floor that
was seen below all of it.

Shapes: o boxes, n points.
"""

import numpy as np
import shapely
from numba import njit
from numpy.typing import NDArray

from placing.areas.outlines import heal
from placing.joint.stacking import footprints
from placing.psi.placing_field import Points
from placing.scene import PlacingArea

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def has_room(
    points: Points,
    areas: tuple[PlacingArea, ...],
    boxes: Array,
    area: NDArray[np.integer],
    room_m: float,
    lift_m: float,
) -> Mask:
    """Return which boxes (o, 7) on areas (o,) have room, shape (o,).

    No point lies within `room_m` beside a box, from `lift_m` above its bottom to its
    top, or `room_m` further where it is flat; on the floor its footprint is where the
    floor was seen.
    """
    free = ~_is_cut(*points.plan, points.start, points.points, boxes, room_m, lift_m)
    for k, of in enumerate(areas):
        at = np.flatnonzero(free & (area == k)) if of.is_floor else np.empty(0, int)
        if len(at):
            seen = heal(of.polygon_m).buffer(room_m)
            shapely.prepare(seen)
            free[at] = shapely.covers(seen, footprints(boxes[at]))
    return free


@njit(cache=True)
def _is_cut(x_m, y_m, cell_m, per_m, n_x, n_y, start, points, boxes, room_m, lift_m):  # noqa: ANN001, ANN202
    """Return which boxes, grown sideways, hold a point of a cloud in columns, (o,)."""
    cut = np.zeros(len(boxes), np.bool_)
    for o in range(len(boxes)):
        cos, sin = np.cos(boxes[o, 6]), np.sin(boxes[o, 6])
        half_x, half_y = boxes[o, 3] / 2 + room_m, boxes[o, 4] / 2 + room_m
        bottom = boxes[o, 2] - boxes[o, 5] / 2 + lift_m
        # What is flatter than its lift has walls beside it all the same.
        top = max(boxes[o, 2] + boxes[o, 5] / 2, bottom + room_m)
        wide_x = abs(cos) * half_x + abs(sin) * half_y
        wide_y = abs(sin) * half_x + abs(cos) * half_y
        first_i = max(int((boxes[o, 0] - wide_x - x_m) * per_m), 0)
        last_i = min(int((boxes[o, 0] + wide_x - x_m) * per_m), n_x - 1)
        first_j = max(int((boxes[o, 1] - wide_y - y_m) * per_m), 0)
        last_j = min(int((boxes[o, 1] + wide_y - y_m) * per_m), n_y - 1)
        for i in range(first_i, last_i + 1):
            for p in range(start[i * n_y + first_j], start[i * n_y + last_j + 1]):
                z = points[p, 2]
                if z <= bottom or z >= top:
                    continue
                dx, dy = points[p, 0] - boxes[o, 0], points[p, 1] - boxes[o, 1]
                along, across = cos * dx + sin * dy, cos * dy - sin * dx
                if abs(along) < half_x and abs(across) < half_y:
                    cut[o] = True
                    break
            if cut[o]:
                break
    return cut

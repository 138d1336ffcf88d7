"""What JSON Schema cannot say about a room file: geometry and names that must agree.

Each check raises `BadInput` whose one line names field, value and expectation; the
reader puts the name of the file in front.
"""

from collections.abc import Iterable

import numpy as np
from shapely import Polygon
from shapely.geometry import box

from placing import rigid
from placing.errors import BadInput
from placing.scene import Array, Furniture, Layout, Opening, SceneObject

TOLERANCE_M = 0.02
"""How far furniture may reach into a wall."""


def check_outline(outline_m: Array) -> None:
    """Refuse an outline that crosses itself, is clockwise or has no area."""
    value = outline_m.tolist()
    if not Polygon(outline_m).is_valid:
        raise BadInput(f"outline_m is {value}, expected a polygon that is simple")
    if not Polygon(outline_m).exterior.is_ccw:
        raise BadInput(f"outline_m is {value}, expected corners counter-clockwise")
    edges_m = np.linalg.norm(np.roll(outline_m, -1, axis=0) - outline_m, axis=1)
    if edges_m.min() < TOLERANCE_M:
        raise BadInput(f"outline_m is {value}, expected corners that differ")


def check_openings(layout: Layout) -> None:
    """Refuse doors and windows that leave their wall or overlap."""
    corners = layout.outline_m
    for i, opening in enumerate(layout.openings):
        if opening.wall >= len(corners):
            raise BadInput(
                f"openings[{i}].wall is {opening.wall}, "
                f"expected one of the walls 0 to {len(corners) - 1}"
            )
        start, end = corners[opening.wall], corners[(opening.wall + 1) % len(corners)]
        wall = box(0, 0, float(np.linalg.norm(end - start)), layout.height_m)
        if not wall.buffer(1e-9).covers(opening_box(opening)):
            raise BadInput(
                f"openings[{i}] is {opening}, expected it within its wall of "
                f"{wall.bounds[2]:.3f} m by {layout.height_m} m"
            )
        if opening.kind == "door" and opening.sill_m > 0:
            raise BadInput(f"openings[{i}].sill_m is {opening.sill_m}, expected 0")
        for j, other in enumerate(layout.openings[:i]):
            same_wall = other.wall == opening.wall
            if same_wall and opening_box(opening).intersects(opening_box(other)):
                raise BadInput(f"openings[{i}] overlaps openings[{j}], expected a gap")


def opening_box(opening: Opening) -> Polygon:
    """Return an opening as a rectangle of its wall: offset by height [m]."""
    near, low = opening.offset_m, opening.sill_m
    return box(near, low, near + opening.width_m, low + opening.height_m)


def footprint(size_m: Array | tuple[float, ...], T_world_box: Array) -> Polygon:
    """Return the outline of a box seen from above [m]."""
    x, y = size_m[0] / 2, size_m[1] / 2
    corners = np.array([[x, y, 0], [-x, y, 0], [-x, -y, 0], [x, -y, 0]])
    return Polygon(rigid.apply(T_world_box, corners)[:, :2])


def check_furniture(layout: Layout) -> None:
    """Refuse furniture that stands outside the room."""
    inside = Polygon(layout.outline_m).buffer(TOLERANCE_M, join_style="mitre")
    for piece in layout.furniture:
        x, y, z = piece.T_world_furniture[4:].round(3).tolist()
        name = f"furniture[{piece.furniture_id}].position_m is {[x, y, z]}"
        if not inside.covers(footprint(piece.size_m, piece.T_world_furniture)):
            raise BadInput(f"{name}, expected its footprint inside the outline")
        if z < 0 or z + piece.size_m[2] > layout.height_m + TOLERANCE_M:
            raise BadInput(f"{name}, expected it between floor and ceiling")


def check_names(
    furniture: Iterable[Furniture],
    objects: list[str],
    catalogue: dict[str, SceneObject],
) -> None:
    """Refuse ids that are repeated or unknown."""
    pieces = [piece.furniture_id for piece in furniture]
    taken = ["floor", *pieces, *objects]
    repeated = sorted({name for name in taken if taken.count(name) > 1})
    if repeated:
        raise BadInput(f"id {repeated[0]!r} is given twice, expected unique ids")
    unknown = [name for name in objects if name not in catalogue]
    if unknown:
        raise BadInput(
            f"objects has {unknown[0]!r}, expected one of {', '.join(catalogue)}"
        )


def check_listed(name: str, placed: Iterable[str], listed: list[str]) -> None:
    """Refuse an arrangement that does not place each listed object."""
    surplus, missing = set(placed) - set(listed), set(listed) - set(placed)
    for objects, said in ((surplus, "not listed"), (missing, "not placed")):
        if objects:
            raise BadInput(
                f"{name}.placements: {min(objects)!r} is {said}, "
                "expected the ids of `objects`, each once"
            )

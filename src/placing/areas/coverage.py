"""How well the placing areas found in a cloud agree with those of the furniture.

The truth is where furniture says that things can stand, less what other furniture
stands on or hangs closely above. Found and true areas agree where they overlap and are
equally high, and are compared by their size.

Letters for shapes: v corners.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import shapely
import trimesh
from manifold3d import Manifold, Mesh
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from placing.areas.outlines import heal
from placing.dressing import standing_shape
from placing.scene import Layout, PlacingArea
from placing.shapes.building import walls_shape
from placing.shapes.shape import Shape

CONTACT_M = 0.002
"""What another solid reaches into the free height by is contact, not cover."""
SMALLEST_M = 0.15
"""True areas that hold no square of this width are not asked for."""

COLUMNS = ["kind", "n_supports", "true_m2", "found_m2", "recall", "precision"]


@dataclass(frozen=True)
class TrueArea:
    """A level patch of furniture in the world that things can stand on."""

    kind: str
    """Of its furniture, or `floor`."""
    outline: BaseGeometry
    """Free of what else stands there; may be empty or in several parts."""
    height_m: float


@dataclass(frozen=True)
class Solid:
    """A piece of furniture, or the building, in the world."""

    kind: str
    shape: Shape
    """Mesh and supports in the world."""
    manifold: Manifold


def solids_of(layout: Layout) -> list[Solid]:
    """Return building and furniture of a layout in the world, the building first."""
    solids = [Solid("floor", walls := walls_shape(layout), _manifold(walls.mesh))]
    for furniture in layout.furniture:
        shape = standing_shape(furniture)
        solids.append(Solid(furniture.kind, shape, _manifold(shape.mesh)))
    return solids


def true_areas(
    solids: Sequence[Solid], min_clearance_m: float, max_height_m: float
) -> list[TrueArea]:
    """Return where things can stand, up to a height and with some free height."""
    found = []
    for solid in solids:
        for support in solid.shape.supports:
            if support.height_m > max_height_m or support.clearance_m < min_clearance_m:
                continue
            outline = Polygon(support.polygon_m)
            low, high = support.height_m + CONTACT_M, support.height_m + min_clearance_m
            covers = [
                _silhouette(other.manifold, low, high)
                for other in solids
                if other is not solid and _is_near(other, outline, low, high)
            ]
            free = outline.difference(shapely.union_all(covers))
            found.append(TrueArea(solid.kind, free, support.height_m))
    return found


def compare(
    areas: Iterable[PlacingArea],
    truth: Sequence[TrueArea],
    solids: Sequence[Solid],
    tolerance_m: float,
) -> pd.DataFrame:
    """Return number, size and overlap of true and found areas of each kind.

    Columns: kind, n_supports, true_m2, recalled_m2, found_m2, correct_m2. What is found
    but not true is counted with the kind of the furniture that it is in or above.
    """
    found = [(heal(area.polygon_m), area.height_m) for area in areas]
    rows = []
    for true in truth:
        level = [p for p, height in found if abs(height - true.height_m) <= tolerance_m]
        if true.outline.buffer(-SMALLEST_M / 2).is_empty:
            continue
        overlap = true.outline.intersection(shapely.union_all(level)).area
        row = {"n_supports": 1, "true_m2": true.outline.area, "recalled_m2": overlap}
        rows.append({"kind": true.kind, **row})
    for polygon, height in found:
        level = [t for t in truth if abs(height - t.height_m) <= tolerance_m]
        for true in level:
            overlap = polygon.intersection(true.outline).area
            rows.append({"kind": true.kind, "found_m2": overlap, "correct_m2": overlap})
        wrong = polygon.difference(shapely.union_all([t.outline for t in level]))
        kind = _kind_below(wrong, height, solids)
        rows.append({"kind": kind, "found_m2": wrong.area})
    names = ["n_supports", "true_m2", "recalled_m2", "found_m2", "correct_m2"]
    table = pd.DataFrame(rows, columns=["kind", *names]).fillna(0.0)
    return table.groupby("kind", as_index=False)[names].sum()


def tabulate(tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return recall and precision of each kind over all scenes, `all` in the end."""
    total = pd.concat(tables).groupby("kind", as_index=False).sum()
    everything = total.drop(columns="kind").sum().to_frame().T.assign(kind="all")
    total = pd.concat([total, everything], ignore_index=True)
    total["recall"] = total["recalled_m2"] / total["true_m2"].where(
        total["true_m2"] > 0
    )
    total["precision"] = total["correct_m2"] / total["found_m2"].where(
        total["found_m2"] > 0
    )
    total["n_supports"] = total["n_supports"].astype(int)
    return total[COLUMNS]


def _manifold(mesh: trimesh.Trimesh) -> Manifold:
    """Return the solid that a closed mesh bounds."""
    merged = trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)
    return Manifold(
        Mesh(
            merged.vertices.astype(np.float32),
            merged.faces.astype(np.uint32),
        )
    )


def _silhouette(solid: Manifold, low: float, high: float) -> BaseGeometry:
    """Return the outline from above of what of a solid is between two heights."""
    slab = solid.trim_by_plane((0, 0, 1), low).trim_by_plane((0, 0, -1), -high)
    rings = [Polygon(ring) for ring in slab.project().to_polygons()]
    outline = Polygon()
    for ring in rings:  # Rings inside others are holes.
        outline = outline.symmetric_difference(ring)
    return outline


def _is_near(solid: Solid, outline: BaseGeometry, low: float, high: float) -> bool:
    """Tell whether the box around a solid meets a slab above an outline."""
    lower, upper = solid.shape.mesh.bounds
    is_level = lower[2] < high and upper[2] > low
    return is_level and outline.intersects(shapely.box(*lower[:2], *upper[:2]))


def _kind_below(outline: BaseGeometry, height_m: float, solids: Sequence[Solid]) -> str:
    """Return the kind of the nearest furniture at or below an outline."""
    best, kind = 0.0, "floor"
    for solid in solids[1:]:
        lower, upper = solid.shape.mesh.bounds
        if lower[2] > height_m + CONTACT_M or upper[2] < height_m - SMALLEST_M:
            continue
        overlap = outline.intersection(shapely.box(*lower[:2], *upper[:2])).area
        if overlap > best:
            best, kind = overlap, solid.kind
    return kind

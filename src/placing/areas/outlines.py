"""Outlines of areas: from a set of cells to simple polygons with true edges.

The border of the cells is simplified to straight edges, which are then moved to the
outermost points. Holes are opened to the outside by a slit, since the polygon of a
placing area is simple: `heal` closes the slit again where it matters.

Letters for shapes: t cells, n points, v corners.
"""

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from placing.areas.borders import cover
from placing.areas.edges import fit_ring
from placing.areas.masks import close, erode, keep_wide

SLIT_M = 0.001
"""Width of the slit between a hole and the outside."""


def outlines(
    cells: NDArray[np.int64],
    points_m: NDArray[np.float64],
    origin_m: NDArray[np.float64],
    cell_m: float,
    min_width_m: float,
) -> list[Polygon]:
    """Return the outline of each connected part that holds a square of a width.

    `points_m` (n, 2) are the points in the `cells` (t, 2), and holes narrower than the
    width are closed.
    """
    n_cells = int(np.ceil(min_width_m / cell_m - 1e-6))
    border = n_cells + 1  # Wide enough for the outside to hold a square as well.
    first = cells.min(axis=0) - border
    mask = np.zeros(cells.max(axis=0) - first + border + 1, bool)
    mask[tuple((cells - first).T)] = True
    mask = close(mask)
    mask = ~keep_wide(~mask, n_cells)
    parts, n_parts = ndimage.label(keep_wide(mask, n_cells))
    low = origin_m + first * cell_m
    is_inner = erode(mask, 5)
    at = ((points_m - low) / cell_m).astype(np.int64)
    rim = points_m[~is_inner[tuple(at.T)]]
    found = []
    for number in range(1, n_parts + 1):
        rough = shapely.transform(cover(parts == number), lambda c: low + c * cell_m)
        fine = fit_edges(rough, rim, cell_m)
        # A strip covers parts of more cells than its width would fill.
        if not fine.buffer(cell_m / 4 - min_width_m / 2).is_empty:
            found.append(fine)
    return found


def fit_edges(rough: Polygon, rim_m: NDArray, cell_m: float) -> Polygon:
    """Return the polygon with straight edges through the outermost points near it."""
    # A cell counts when a part of it is covered, so they are too large.
    inset = rough.buffer(-0.3 * cell_m, join_style="mitre")
    inset = max(shapely.get_parts(inset), key=lambda part: part.area)
    inset = shapely.geometry.polygon.orient(inset)
    rings = [
        fit_ring(np.asarray(ring.coords), rim_m, cell_m)
        for ring in (inset.exterior, *inset.interiors)
    ]
    fine = Polygon(rings[0], rings[1:])
    # Rings that were fitted one by one may cross.
    return fine if fine.is_valid else inset


def open_holes(polygon: Polygon) -> Polygon:
    """Return the polygon with a slit from each hole to the outside."""
    while polygon.interiors:
        rings = list(polygon.interiors)
        outside = polygon.exterior
        nearest = min(rings, key=outside.distance)
        slit = shapely.shortest_line(outside, nearest)
        a, b = np.asarray(slit.coords)
        length = float(np.hypot(*(b - a)))
        # A hole may touch the outside in a point; any direction opens it.
        ahead = SLIT_M * ((b - a) / length if length > 0 else np.array([1.0, 0.0]))
        cut = shapely.LineString([a - ahead, b + ahead]).buffer(
            SLIT_M / 2, cap_style="flat"
        )
        opened = polygon.difference(cut)
        polygon = max(shapely.get_parts(opened), key=lambda part: part.area)
    return polygon


def heal(polygon_m: NDArray[np.float64]) -> BaseGeometry:
    """Return the polygon of a placing area with the slits to its holes closed."""
    grown = Polygon(polygon_m).buffer(SLIT_M, join_style="mitre")
    return grown.buffer(-SLIT_M, join_style="mitre")

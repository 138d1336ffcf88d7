"""What a placing area is like, as numbers from the scene's cloud: no names go in.

Shapes: m areas, e numbers, p places, c cells, r directions.
"""

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from placing.areas.outlines import heal
from placing.candidates import OPEN_M, Candidates
from placing.clouds.ply import Cloud
from placing.psi.object_descriptors import appearance
from placing.scene import PlacingArea

Array = NDArray[np.float64]

AREA_DESCRIPTORS = (
    "height_m",
    "log_extent_m2",
    "log_width_m",
    "log_clearance_m",
    "enclosure",
    "wall_distance_m",
    "is_floor",
    "covered_above",
    "covered_below",
    "height_rank",
    "extent_rank",
    "slope_rad",
    "saturation",
    "brightness",
    "softness",
    "is_softness_known",
)
"""Names of the numbers that describe a placing area, in order."""
NEAR_M = 0.5
"""What is nearer around a spot encloses it."""
SLAB_M = (0.05, 0.3)
"""Heights above an area at which things enclose it."""
N_DIRECTIONS = 16
N_SPOTS = 40
"""Most spots of an area that are looked at."""
CELL_M = 0.05
LEVEL_M = (-0.03, 0.03)
"""Heights above an area between which points of the cloud belong to it."""
MAX_POINTS = 2000
"""Most points of an area that tell its colour and slope."""


def describe_areas(
    cloud: Cloud, areas: tuple[PlacingArea, ...], candidates: Candidates
) -> Array:
    """Return what the placing areas of a scene are like, shape (m, e)."""
    outlines = [heal(area.polygon_m) for area in areas]
    cloud = cloud.take(np.argsort(cloud.points[:, 2], kind="stable"))
    heights = np.array([area.height_m for area in areas])
    extents = np.array([outline.area for outline in outlines])
    table = np.empty((len(areas), len(AREA_DESCRIPTORS)))
    for k, area in enumerate(areas):
        spots = _spots(candidates, k, outlines[k])
        values = {
            "height_m": area.height_m,
            "log_clearance_m": np.log(np.clip(area.clearance_m, 0.02, OPEN_M)),
            "wall_distance_m": _wall_distance(candidates, spots),
            "is_floor": float(area.is_floor),
            "height_rank": np.mean(heights < area.height_m),
            "extent_rank": np.mean(extents < extents[k]),
            "softness": 0.0 if area.softness is None else area.softness,
            "is_softness_known": float(area.softness is not None),
        }
        values |= _size(outlines[k])
        values["enclosure"] = _enclosure(_slab(cloud, area.height_m, *SLAB_M), spots)
        values |= _stack(spots, k, heights, outlines)
        values |= _surface(_slab(cloud, area.height_m, *LEVEL_M), outlines[k])
        table[k] = [values[name] for name in AREA_DESCRIPTORS]
    return table


def without_softness(areas: Array) -> Array:
    """Return descriptors (m, e) as they were if nobody knew what is soft."""
    unknown = areas.copy()
    for name in ("softness", "is_softness_known"):
        unknown[:, AREA_DESCRIPTORS.index(name)] = 0
    return unknown


def _slab(cloud: Cloud, height_m: float, above_m: float, below_m: float) -> Cloud:
    """Return the points between two heights above another, of a cloud sorted by z."""
    z = cloud.points[:, 2]
    first, last = np.searchsorted(z, [height_m + above_m, height_m + below_m])
    return cloud.take(np.arange(first, last))


def _spots(candidates: Candidates, number: int, outline: BaseGeometry) -> Array:
    """Return evenly chosen spots of an area, shape (s, 2) [m]."""
    xy = candidates.location[candidates.area == number, :2]
    if len(xy) == 0:  # An area between the lattice's rows has one spot.
        return shapely.get_coordinates(outline.representative_point())
    chosen = np.linspace(0, len(xy) - 1, min(len(xy), N_SPOTS)).round().astype(int)
    return xy[chosen]


def _size(outline: BaseGeometry) -> dict[str, float]:
    """Return extent and width of an area."""
    (radius,) = shapely.length(shapely.maximum_inscribed_circle([outline], [0.01]))
    width_m = max(2 * float(radius), 0.01)
    extent_m2 = max(float(outline.area), 1e-4)  # Guards the logarithm.
    return {
        "log_extent_m2": np.log(extent_m2),
        "log_width_m": np.log(width_m),
    }


def _enclosure(slab: Cloud, spots: Array) -> float:
    """Return the share of the directions around with something near, over all spots.

    Shelves and drawers have walls around every spot, a table at a wall around some.
    """
    xy = slab.points[:, :2]
    first, last = spots.min(0) - NEAR_M, spots.max(0) + NEAR_M
    inside = ((xy > first) & (xy < last)).all(1)
    corner = np.floor((xy[inside] - first) / CELL_M).astype(np.int64)
    n_columns = int((last - first)[1] / CELL_M) + 2
    keys = np.unique(corner @ [n_columns, 1])
    cells = (np.column_stack([keys // n_columns, keys % n_columns]) + 0.5) * CELL_M
    x, y = ((cells + first)[:, None] - spots).T  # (s, c) each
    angle = np.arctan2(y, x) / (2 * np.pi) + 0.5
    direction = (angle * N_DIRECTIONS).astype(int) % N_DIRECTIONS
    spot, cell = np.nonzero(x**2 + y**2 < NEAR_M**2)
    seen = np.zeros((len(spots), N_DIRECTIONS), bool)
    seen[spot, direction[spot, cell]] = True
    return float(seen.mean())


def _stack(
    spots: Array, number: int, heights: Array, outlines: list[BaseGeometry]
) -> dict[str, float]:
    """Return the shares of an area that lie below and above another area.

    The middle level of a shelf has both; the floor below everything does not count.
    """
    points = shapely.points(spots)
    above, below = np.zeros(len(spots), bool), np.zeros(len(spots), bool)
    for height_m, outline in zip(heights, outlines, strict=True):
        gap_m = height_m - heights[number]
        if gap_m > LEVEL_M[1]:
            above |= shapely.covers(outline, points)
        elif gap_m < LEVEL_M[0] and height_m > LEVEL_M[1]:
            below |= shapely.covers(outline, points)
    return {"covered_above": above.mean(), "covered_below": below.mean()}


def _surface(slab: Cloud, outline: BaseGeometry) -> dict[str, float]:
    """Return mean slope, saturation and brightness of the points of an area."""
    x0, y0, x1, y1 = outline.bounds
    x, y, _ = slab.points.T.astype(float)
    near = (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1) & (slab.normals[:, 2] > 0.5)
    rows = np.flatnonzero(near)
    rows = rows[:: max(len(rows) // MAX_POINTS, 1)]
    rows = rows[shapely.contains_xy(outline, x[rows], y[rows])]
    if len(rows) == 0:  # Neither slope nor colour is known.
        return {"slope_rad": 0.0, "saturation": 0.0, "brightness": 0.5}
    slope = np.arccos(np.clip(slab.normals[rows, 2], -1, 1)).mean()
    saturation, brightness = appearance(slab.colors[rows])
    return {"slope_rad": slope, "saturation": saturation, "brightness": brightness}


def _wall_distance(candidates: Candidates, spots: Array) -> float:
    """Return the mean distance of the spots of an area to the walls [m]."""
    if len(candidates.location) == 0:
        return 0.0
    nearest = cKDTree(candidates.location[:, :2]).query(spots)[1]
    return float(candidates.feature("wall_distance_m")[nearest].mean())

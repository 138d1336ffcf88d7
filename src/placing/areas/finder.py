"""Placing areas of a scene, found in its cloud alone.

A placing area E_j is a level patch that objects can stand on: the floor, the top of a
table, each board of a shelf. It is a group of tiles (see `placing.areas.tiles`) at one
height, with one free height above it, and its outline is a simple polygon.

Letters for shapes: t tiles, v corners, q queries.
"""

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from placing.areas.columns import (
    MARGIN_M,
    Columns,
    points_at,
    sort_columns,
)
from placing.areas.outlines import open_holes, outlines
from placing.areas.tiles import (
    Tiles,
    find_tiles,
    group,
    pair_neighbors,
    smooth_clearance,
)
from placing.clouds.ply import Cloud
from placing.scene import PlacingArea

# ASSUME: a pin of this radius stands for an object whose size is not yet known.
PIN_RADIUS_M = 0.02
# ASSUME: a patch of less than two by two smallest squares is no place of its own, such
# as the piece of a table that is above one chair pushed under it.
SCRAP = 4


@dataclass(frozen=True)
class AreaConfig:
    """Settings of the search; the values live in `config/config.yaml`."""

    cell_m: float
    """Edge of the cells of the floor plan."""
    max_tilt_rad: float
    """Largest angle between the normal of a point and the vertical."""
    max_height_m: float
    """Nothing is put down higher."""
    merge_m: float
    """Points and patches closer in height are one level."""
    min_width_m: float
    """An area holds a square of this width."""
    min_clearance_m: float
    """An area has so much free height."""
    clearance_step_m: float
    """Where the free height changes more, one area ends and another begins."""
    clearance_quantile: float
    """Part of an area whose free height may be below the one it is given."""


def find_areas(cloud: Cloud, config: AreaConfig) -> tuple[PlacingArea, ...]:
    """Return the placing areas of a level cloud, the floor first, then by height."""
    columns = sort_columns(cloud, config.cell_m)
    tiles = find_tiles(
        columns, config.max_tilt_rad, config.max_height_m, config.merge_m
    )
    if len(tiles.cell) == 0:
        return ()
    pairs = pair_neighbors(tiles, config.merge_m)
    tiles = replace(tiles, clearance_m=smooth_clearance(tiles, pairs))
    is_free = tiles.clearance_m >= config.min_clearance_m
    tiles = tiles.take(is_free)
    position = np.cumsum(is_free) - 1
    pairs = position[pairs[is_free[pairs].all(axis=1)]]
    labels = group(tiles, pairs, config.clearance_step_m)
    labels = _flatten(tiles, labels, config.merge_m)
    n_fewest = (config.min_width_m / config.cell_m) ** 2
    labels = _absorb(tiles, pairs, labels, SCRAP * n_fewest)
    areas = [
        area
        for members in _members(labels)
        if len(members) >= n_fewest  # Smaller groups cannot hold an area.
        for area in _areas(columns, tiles.take(members), config)
    ]
    return _name(_without_ghosts(areas), config.merge_m)


def _flatten(tiles: Tiles, labels: NDArray, merge_m: float) -> NDArray[np.int64]:
    """Return labels with groups that are not level cut into level bands, shape (t,)."""
    labels = labels.copy()
    lowest, highest = np.full((2, labels.max() + 1), [[np.inf], [-np.inf]])
    np.minimum.at(lowest, labels, tiles.height_m)
    np.maximum.at(highest, labels, tiles.height_m)
    for number in np.flatnonzero(highest - lowest > 2 * merge_m):
        members = np.flatnonzero(labels == number)
        height = tiles.height_m[members]
        rest = np.arange(len(members))
        while len(rest):
            band = ((height[rest] - height[rest].min()) / merge_m).astype(np.intp)
            fullest = np.bincount(band).argmax()
            peak = np.median(height[rest][band == fullest])
            is_level = np.abs(height[rest] - peak) <= merge_m
            labels[members[rest[is_level]]] = labels.max() + 1
            rest = rest[~is_level]
    return labels


def _absorb(
    tiles: Tiles, pairs: NDArray, labels: NDArray, n_fewest: float
) -> NDArray[np.int64]:
    """Return labels with groups of too few tiles joined to a large neighbour.

    A lamp above a desk lowers the free height on a patch that is still desk.
    """
    size = np.bincount(labels)
    is_small = size < n_fewest
    crossing = pairs[~tiles.is_border[pairs].any(axis=1)]
    small, large = labels[np.concatenate([crossing, crossing[:, ::-1]])].T
    is_useful = is_small[small] & ~is_small[large]
    joined, count = np.unique(
        np.stack([small[is_useful], large[is_useful]], axis=1),
        axis=0,
        return_counts=True,
    )
    target = np.arange(len(size))
    for k in np.argsort(count, kind="stable"):  # The longest common border comes last.
        target[joined[k, 0]] = joined[k, 1]
    return target[labels]


def _members(labels: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Return the tiles of each group."""
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(labels[order])) + 1)


def _areas(columns: Columns, tiles: Tiles, config: AreaConfig) -> list[PlacingArea]:
    """Return the areas of one group of tiles, without names."""
    height = float(np.median(tiles.height_m))
    rows = _level_points(columns, tiles, config)
    points = columns.points[rows, :2].astype(float)
    polygons = outlines(
        tiles.cell, points, columns.origin_m, columns.cell_m, config.min_width_m
    )
    clearance = float(
        np.quantile(tiles.clearance_m, config.clearance_quantile, method="lower")
    )
    soft = None if columns.softness is None else columns.softness[rows]
    return [
        PlacingArea(
            "",
            _corners(polygon),
            height,
            clearance,
            False,
            _mean(soft, points, polygon),
        )
        for polygon in polygons
    ]


def _mean(
    softness: NDArray[np.float32] | None, points: NDArray, polygon: shapely.Polygon
) -> float | None:
    """Return the mean softness of the points in a polygon, None where unknown."""
    if softness is None:
        return None
    is_known = ~np.isnan(softness) & shapely.contains_xy(polygon, points)
    return round(float(softness[is_known].mean()), 3) if is_known.any() else None


def _level_points(columns: Columns, tiles: Tiles, config: AreaConfig) -> NDArray:
    """Return which points made the tiles, shape (n,)."""
    column = tiles.cell[:, 0] * columns.shape[1] + tiles.cell[:, 1]
    least_rise = np.cos(config.max_tilt_rad)
    return points_at(columns, column, tiles.height_m, config.merge_m, least_rise)


def _corners(polygon: shapely.Polygon) -> NDArray[np.float64]:
    """Return the corners of a polygon with its holes opened, counter-clockwise."""
    simple = shapely.geometry.polygon.orient(open_holes(polygon))
    return np.asarray(simple.exterior.coords)[:-1]


def _without_ghosts(areas: list[PlacingArea]) -> list[PlacingArea]:
    """Return the areas without those that mostly repeat a larger one.

    Images whose poses disagree show one board twice, one close above the other.
    """
    polygons = [shapely.make_valid(shapely.Polygon(a.polygon_m)) for a in areas]
    height = np.array([area.height_m for area in areas])
    size = np.array([polygon.area for polygon in polygons])
    kept = []
    for k, area in enumerate(areas):
        near = np.flatnonzero(
            (np.abs(height - height[k]) < MARGIN_M) & (size > size[k])
        )
        over = sum(polygons[k].intersection(polygons[n]).area for n in near)
        if over <= size[k] / 2:
            kept.append(area)
    return kept


def _name(areas: list[PlacingArea], merge_m: float) -> tuple[PlacingArea, ...]:
    """Return the areas with names: the floor first, then by height, x and y."""

    def key(area: PlacingArea) -> tuple[float, ...]:
        """Return height, then position, in whole centimetres against noise."""
        low = area.polygon_m.min(axis=0)
        return (round(area.height_m, 2), *np.round(low, 2), area.height_m)

    areas = [
        replace(area, is_floor=abs(area.height_m) <= merge_m)
        for area in sorted(areas, key=key)
    ]
    floors = [k for k, area in enumerate(areas) if area.is_floor]
    if floors:
        sizes = [shapely.Polygon(areas[k].polygon_m).area for k in floors]
        areas.insert(0, areas.pop(floors[int(np.argmax(sizes))]))
    first = 0 if floors else 1
    names = [f"area{k}" for k in range(first, first + len(areas))]
    if floors:
        names[0] = "floor"
    return tuple(
        replace(area, area=name) for area, name in zip(areas, names, strict=True)
    )

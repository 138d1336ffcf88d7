"""A scan and its placing areas: seen from above, in perspective, and as a table.

Walls between camera and room are left out, as are the ceiling and what hangs from it:
their points face away from the camera.

Shapes: n points, v corners.
"""

from itertools import product

import matplotlib as mpl
import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import NDArray

from placing.areas.outlines import heal
from placing.areas.scans import ScanAreas
from placing.clouds.ply import Cloud
from placing.pictures.cameras import Camera, framing
from placing.pictures.rooms import CORNERS_DEG
from placing.scene import PlacingArea
from placing.tables.figures import STYLE

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

SIZE_INCH, PIXELS = (13.0, 6.2), (1100, 1000)
ELEVATION_DEG, FOV_DEG = 48.0, 32.0
PALE, PAPER = 0.6, 255
"""White in the points below areas, and the colour behind them."""
MOST_ROWS, APART, AROUND_M = 26, 0.028, 0.6
"""Rows of the table, the least distance of numbers as a share of the picture, and how
much is drawn around all areas."""
STEP_M, FLAT, RIM_M = 0.2, 0.7, 2.2
"""How far ahead of a face inside and outside are told apart, the height of normals of
flat faces, and above which such a face is the top of a wall [m]."""
MOST_PX = 5
"""Largest half-width of a point in the picture."""


def draw_areas(found: ScanAreas, title: str) -> Figure:
    """Return a scan from above and in perspective with its areas, and their table."""
    heights = [area.height_m for area in found.areas]
    scale = Normalize(min([*heights, 0.0]), max([*heights, 0.5]))
    colours = ScalarMappable(scale, mpl.colormaps["viridis"])
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=SIZE_INCH, layout="constrained")
        plan, view, table = figure.subplots(1, 3, width_ratios=[5, 5, 2.9])
        _draw_plan(plan, found, colours)
        _draw_view(view, found, colours)
        _write_table(table, found)
        figure.colorbar(
            colours,
            ax=[plan, view],
            location="bottom",
            label="height of the area above the floor [m]",
            shrink=0.5,
            aspect=50,
        )
        figure.suptitle(title, fontsize=10)
    return figure


def without_outside(cloud: Cloud, areas: tuple[PlacingArea, ...]) -> Cloud:
    """Return the cloud without what faces away from all areas, such as outer walls."""
    outlines = shapely.MultiPoint(np.concatenate([a.polygon_m for a in areas]))
    inside = outlines.convex_hull
    shapely.prepare(inside)
    xy, rise = cloud.points[:, :2], cloud.normals[:, 2]
    ahead = xy + STEP_M * cloud.normals[:, :2]
    now, then = (shapely.distance(inside, shapely.points(p)) for p in (xy, ahead))
    is_outer = (np.abs(rise) < FLAT) & (then > now + STEP_M / 4)
    is_rim = (rise >= FLAT) & (cloud.points[:, 2] > RIM_M)
    return cloud.take(~(is_outer | is_rim))


def seen_from(cloud: Cloud, eye: Array) -> NDArray[np.bool_]:
    """Return which points face a camera, or have no normal, shape (n,)."""
    towards = eye - cloud.points
    facing = np.einsum("nk,nk->n", cloud.normals, towards)
    return (facing > 0) | ~cloud.normals.any(axis=1)


def splat(
    points: Array,
    colors: Picture,
    camera: Camera,
    size: tuple[int, int],
    width_m: float,
) -> Picture:
    """Return the points as squares of a width, the nearer over the farther."""
    right_down = camera.project(points, size)
    depth = (points - np.array(camera.eye)) @ camera.axes()[2]
    focal = size[0] / 2 / np.tan(np.radians(camera.fov_deg) / 2)
    half = np.clip(np.round(width_m * focal / depth / 2), 1, MOST_PX).astype(int)
    order = np.argsort(-depth, kind="stable")
    at, half = np.floor(right_down[order]).astype(int), half[order]
    colors = colors[order]
    picture = np.full((size[1], size[0], 3), PAPER, np.uint8)
    nearest = np.full((size[1], size[0]), -1)
    for step in product(range(-MOST_PX, MOST_PX + 1), repeat=2):
        u, v = (at + step).T
        inside = (u >= 0) & (u < size[0]) & (v >= 0) & (v < size[1])
        rows = np.flatnonzero(inside & (max(map(abs, step)) <= half))
        np.maximum.at(nearest, (v[rows], u[rows]), rows)
    picture[nearest >= 0] = colors[nearest[nearest >= 0]]
    return picture


def _draw_plan(axes: Axes, found: ScanAreas, colours: ScalarMappable) -> None:
    """Draw points and areas from above, in metres."""
    cloud = found.cloud.take(np.flatnonzero(found.cloud.normals[:, 2] > -0.5))
    low, high = _bounds(found)
    highest = found.area_config.max_height_m
    cloud = cloud.take(np.flatnonzero(cloud.points[:, 2] < highest))
    order = np.argsort(cloud.points[:, 2], kind="stable")
    shade = (PALE * 255 + (1 - PALE) * cloud.colors[order]) / 255
    x, y = cloud.points[order, :2].T
    area = max(0.3, (found.spacing_m / np.ptp([low, high], 0)[:2].max() * 350) ** 2)
    axes.scatter(x, y, s=area, c=shade, linewidths=0, rasterized=True)
    for area in found.areas:
        _draw_area(axes, area.polygon_m, area, colours)
    _name(axes, {a.area: _middle(a)[:2] for a in found.areas}, low[:2], high[:2])
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.set(xlabel="x [m]", ylabel="y [m]", title="from above")


def _draw_view(axes: Axes, found: ScanAreas, colours: ScalarMappable) -> None:
    """Draw points and areas in perspective."""
    cloud = found.cloud
    low, high = _bounds(found)
    inside = ((cloud.points >= low) & (cloud.points <= high)).all(axis=1)
    cloud = without_outside(cloud.take(np.flatnonzero(inside)), found.areas)
    points = cloud.points[:: max(1, len(cloud) // 5000)].astype(float)
    cameras = [framing(points, a, ELEVATION_DEG, PIXELS, FOV_DEG) for a in CORNERS_DEG]
    seen = [seen_from(cloud, np.array(camera.eye)) for camera in cameras]
    best = int(np.argmax([s.sum() for s in seen]))
    camera, cloud = cameras[best], cloud.take(seen[best])
    points = cloud.points.astype(float)
    axes.imshow(splat(points, cloud.colors, camera, PIXELS, 1.2 * found.spacing_m))
    for area in found.areas:
        corners = np.insert(area.polygon_m, 2, area.height_m, axis=1)
        _draw_area(axes, camera.project(corners, PIXELS), area, colours)
    middles = camera.project(np.array([_middle(a) for a in found.areas]), PIXELS)
    names = [area.area for area in found.areas]
    at = dict(zip(names, middles, strict=True))
    _name(axes, at, np.zeros(2), np.array(PIXELS))
    axes.set(xlim=(0, PIXELS[0]), ylim=(PIXELS[1], 0), title="from a corner")
    axes.set_axis_off()


def _draw_area(
    axes: Axes, corners: Array, area: PlacingArea, colours: ScalarMappable
) -> None:
    """Draw the outline of an area, hatched where it is the floor."""
    colour = colours.to_rgba(np.array([area.height_m]))[0]
    outline = Outline(np.concatenate([corners, corners[:1]]), closed=True)
    fill = {"facecolor": (*colour[:3], 0.2 if area.is_floor else 0.5)}
    axes.add_patch(PathPatch(outline, edgecolor=colour[:3], linewidth=1.3, **fill))


def _name(axes: Axes, at: dict[str, Array], low: Array, high: Array) -> None:
    """Write the numbers of areas, the highest first, where no other number is near."""
    paper = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "0.4", "lw": 0.5}
    taken: list[Array] = []
    for area in ["floor"] * ("floor" in at) + [a for a in reversed(at) if a != "floor"]:
        place = (at[area] - low) / (high - low)
        if all(np.abs(place - other).max() > APART for other in taken):
            taken.append(place)
            text = area.removeprefix("area")
            u, v = at[area]
            axes.text(u, v, text, ha="center", va="center", size=7, bbox=paper)


def _middle(area: PlacingArea) -> Array:
    """Return the middle of the largest circle in an area, shape (3,) [m]."""
    outlines = np.array([heal(area.polygon_m)])
    middle = shapely.get_coordinates(shapely.maximum_inscribed_circle(outlines))[0]
    return np.array([*middle, area.height_m])


def _bounds(found: ScanAreas) -> tuple[Array, Array]:
    """Return the corners of the box around all areas and a little, (3,) each [m]."""
    low, high = np.quantile(found.cloud.points, [0.002, 0.998], axis=0)
    corners = np.concatenate([area.polygon_m for area in found.areas])
    low[:2] = np.maximum(low[:2], corners.min(axis=0) - AROUND_M)
    high[:2] = np.minimum(high[:2], corners.max(axis=0) + AROUND_M)
    return low - 0.1, high + 0.1


def _write_table(axes: Axes, found: ScanAreas) -> None:
    """Write height, size and free height of the largest areas."""
    sizes = {a.area: heal(a.polygon_m).area for a in found.areas}
    largest = sorted(found.areas, key=lambda a: -sizes[a.area])[:MOST_ROWS]
    lines = ["area   height   size   free", "          m       m²     m"]
    for area in (a for a in found.areas if a in largest):
        free = "open" if np.isinf(area.clearance_m) else f"{area.clearance_m:.2f}"
        name = area.area.removeprefix("area")
        height = f"{area.height_m + 0.0:.2f}"
        lines.append(f"{name:<6} {height:>5} {sizes[area.area]:7.2f} {free:>6}")
    if left := len(found.areas) - len(largest):
        lines.append(f"and {left} smaller")
    text = "\n".join(lines)
    axes.text(0, 1, text, va="top", family="monospace", fontsize=8, linespacing=1.35)
    axes.set_axis_off()

"""The entities of a joint arrangement that are seen at every step.

The room, its areas, the arranged objects and the stacks. The numbers here only steer
how things look and how large files get.
"""

from collections.abc import Mapping

import numpy as np
import rerun as rr
from matplotlib.colors import hsv_to_rgb
from numpy.typing import NDArray
from rerun.components import PointShading
from trimesh import Trimesh

from placing.clouds.ply import Cloud
from placing.recordings.blueprint import Eye, is_in_front
from placing.recordings.entities import (
    AMBIENT,
    AREA,
    CLOUD_FILL,
    CLOUD_POINTS,
    LIGHT,
)
from placing.recordings.joint import Chosen, JointRecording
from placing.recordings.joint_words import height, stacks_of, summary
from placing.recordings.strips import strips
from placing.recordings.thinning import voxel_means
from placing.scene import PlacingArea

Array = NDArray[np.float64]
Color = tuple[int, int, int]

LIFT_M = 0.006
"""What is drawn on an area is so far above it."""
BRACKET_M, UNDER_M = 0.05, 0.1
"""Brackets stand so far beside their stacks; their words are so far below."""
STACK = (255, 214, 102)
LEVELS = 12
"""Shades of a colour: few let the faces of a mesh share corners."""
CATEGORIES = (
    *("book", "clean_tool", "cushion", "decoration", "desk_light", "dishware", "food"),
    *("keyboard", "laptop", "monitor", "mouse", "pan", "pen", "phone", "remote"),
    *("shoe", "trash_bin", "tv", "utensil"),
)
HUE_STEP, SATURATION, VALUES = 0.381966, 0.72, (0.98, 0.72)
"""Hues of categories are far from those of their neighbours, and rooms are pale."""


def category_color(category: str) -> Color:
    """Return the colour of the objects of a category."""
    number = CATEGORIES.index(category) if category in CATEGORIES else len(CATEGORIES)
    hue, value = number * HUE_STEP % 1, VALUES[number % len(VALUES)]
    r, g, b = (round(255 * part) for part in hsv_to_rgb((hue, SATURATION, value)))
    return r, g, b


def log_static(stream: rr.RecordingStream, content: JointRecording, eye: Eye) -> None:
    """Log what does not change with the step."""
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    log_cloud(stream, content.cloud, eye)
    log_areas(stream, content.areas)
    for chosen in content.placed:
        color = category_color(chosen.item.category)
        mesh = shaded_mesh(chosen.mesh, color)
        stream.log(f"world/objects/{chosen.item.object_id}", mesh, static=True)
    _log_stacks(stream, content, eye)
    document = rr.TextDocument(summary(content), media_type=rr.MediaType.MARKDOWN)
    stream.log("summary", document, static=True)


def shaded_mesh(mesh: Trimesh | None, color: Color) -> rr.Mesh3D:
    """Return a mesh in one colour, shaded as if lit from above."""
    if mesh is None:
        return rr.Mesh3D(vertex_positions=np.zeros((0, 3)))
    level = np.round(_lit(mesh.face_normals) * LEVELS).astype(np.int64)  # (f,)
    # A corner is shared by the faces around it that have the same shade.
    keys = mesh.faces * (LEVELS + 1) + level[:, None]  # (f, 3)
    corners, triangles = np.unique(keys.ravel(), return_inverse=True)
    shades = (corners % (LEVELS + 1)) / LEVELS
    return rr.Mesh3D(
        vertex_positions=mesh.vertices[corners // (LEVELS + 1)],
        triangle_indices=triangles.reshape(-1, 3),
        vertex_colors=(shades[:, None] * np.array(color)).astype(np.uint8),
    )


def log_cloud(stream: rr.RecordingStream, cloud: Cloud, eye: Eye) -> None:
    """Log the cloud as seen, cut open towards the eye."""
    is_known = cloud.normals.any(axis=1)
    lit = np.where(is_known, _lit(cloud.normals), 1.0)
    colors = cloud.colors.astype(np.float64) * lit[:, None]
    values = np.column_stack([colors, cloud.normals.astype(np.float64)])
    points, values, spacing = voxel_means(cloud.points, values, CLOUD_POINTS)
    colors, normals = values[:, :3].astype(np.uint8), values[:, 3:]
    is_cut, radius = is_in_front(points, eye), CLOUD_FILL * spacing
    # Balls on a surface would hide what is flat: they touch it from within.
    inner = points - radius * normals
    for name, part in {"room": ~is_cut, "front": is_cut}.items():
        balls = rr.Points3D(
            inner[part],
            colors=colors[part],
            radii=radius,
            point_shading=PointShading.Flat,
        )
        stream.log(f"world/cloud/{name}", balls, static=True)


def _lit(normals: NDArray[np.floating]) -> Array:
    """Return how bright surfaces of these normals are, shape (n,), 0 to 1."""
    light = np.array(LIGHT) / np.linalg.norm(LIGHT)
    return AMBIENT + (1 - AMBIENT) * np.abs(normals @ light)


def outline(area: PlacingArea) -> Array:
    """Return the closed outline of an area, a little above it, shape (v + 1, 3) [m]."""
    closed = np.concatenate([area.polygon_m, area.polygon_m[:1]])
    return np.insert(closed, 2, area.height_m + LIFT_M, axis=1)


def area_title(area: PlacingArea) -> str:
    """Return the name of an area and its height."""
    return f"{area.area}, {height(area)} m"


def log_areas(stream: rr.RecordingStream, areas: tuple[PlacingArea, ...]) -> None:
    """Log the outlines of the areas, and their names with their heights."""
    outlines = [outline(area) for area in areas]
    lines = rr.LineStrips3D(strips(outlines), colors=AREA, radii=0.004)
    stream.log("world/areas/outlines", lines, static=True)
    middles = [line[:-1].mean(axis=0) for line in outlines]
    titles = rr.Points3D(
        np.array(middles).reshape(-1, 3),
        labels=[area_title(area) for area in areas],
        colors=AREA,
        radii=0.001,
        show_labels=True,
    )
    stream.log("world/areas/names", titles, static=True)


def _reach(chosen: Chosen, direction: Array) -> float:
    """Return how far the sides of an object's box along the axes are that way [m]."""
    slopes = np.maximum(np.abs(direction[:2]), 1e-9)  # guards a side never reached
    return float((chosen.half_extents[:2] / slopes).min())


def _log_stacks(stream: rr.RecordingStream, content: JointRecording, eye: Eye) -> None:
    """Log a bracket from each object to the one it stands on, with its level."""
    by_name = {chosen.item.object_id: chosen for chosen in content.placed}
    pairs = [(c, by_name[c.on]) for c in content.placed if c.on in by_name]
    back = eye.position - eye.target
    right = np.array([-back[1], back[0], 0.0]) / np.linalg.norm(back[:2])
    lines, arrows = [], []
    for upper, lower in pairs:
        top, bottom = upper.T_world_object[4:], lower.T_world_object[4:]
        reach = [_reach(c, right) for c in (upper, lower)]
        beside = top + (max(reach) + BRACKET_M * (1 + upper.level)) * right
        corner = np.array([*beside[:2], bottom[2]])
        lines.append(np.array([top + reach[0] * right, beside, corner]))
        arrows.append((corner, bottom + reach[1] * right - corner))
    style = {"colors": STACK, "radii": 0.003}
    stream.log("world/stack/from", rr.LineStrips3D(strips(lines), **style), static=True)
    tips = np.array(arrows).reshape(-1, 2, 3)
    onto = rr.Arrows3D(origins=tips[:, 0], vectors=tips[:, 1], **style)
    stream.log("world/stack/onto", onto, static=True)
    _log_levels(stream, by_name)


def _log_levels(stream: rr.RecordingStream, placed: Mapping[str, Chosen]) -> None:
    """Log below each stack what stands on which level."""
    stacks = stacks_of([*placed.values()])
    bases = [placed[stack[0]] for stack in stacks]
    under = np.array([c.T_world_object[4:] for c in bases]).reshape(-1, 3)
    under[:, 2] -= [c.half_extents[2] + UNDER_M for c in bases]
    levels = rr.Points3D(
        under,
        labels=[
            ", ".join(f"level {level} {name}" for level, name in enumerate(stack))
            for stack in stacks
        ],
        colors=STACK,
        radii=0.001,
        show_labels=True,
    )
    stream.log("world/stack/levels", levels, static=True)

"""The entities of a recording but its people: what is drawn where, in which colour.

All is static but the diagnostics, which are on the timeline `sweep`. The numbers here
only steer how things look and how large files get.
"""

from collections.abc import Mapping

import matplotlib as mpl
import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.components import FillMode, InterpolationMode, PointShading

from placing.recordings.blueprint import Eye, is_in_front
from placing.recordings.content import Boxes, Mesh, SceneRecording, summary
from placing.recordings.pose_entities import KIND_COLORS
from placing.recordings.thinning import thin, voxel_means

Array = NDArray[np.float64]

CLOUD_POINTS = 60_000
DENSITY_POINTS = 1500
"""At most so many of each are kept; a recording is for looking at."""
CLOUD_FILL = 0.7
"""Radius of a point over the spacing of the points: no gaps, little overlap."""
LIGHT = (0.35, 0.25, 0.9)
AMBIENT = 0.62
"""A cloud is shaded as if lit from above; `AMBIENT` is the share without direction."""
READABLE_M = 0.5
"""Errors below this are only in the summary: their labels would hide the objects."""
COLD = 0.02
"""Candidates below this share of the highest density are not drawn."""
GIVEN = (128, 142, 158)
PREDICTED = (246, 136, 52)
LABELLED = (235, 238, 242)
AREA = (110, 150, 190)


def log_room(stream: rr.RecordingStream, content: SceneRecording, eye: Eye) -> None:
    """Log the cloud, cut open towards the eye, and the outlines of the areas."""
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    points, colors, spacing = voxel_means(content.points, shaded(content), CLOUD_POINTS)
    is_cut = is_in_front(points, eye)
    for name, part in {"room": ~is_cut, "front": is_cut}.items():
        cloud = rr.Points3D(
            points[part],
            colors=colors[part].astype(np.uint8),
            radii=CLOUD_FILL * spacing,
            point_shading=PointShading.Flat,
        )
        stream.log(f"world/cloud/{name}", cloud, static=True)
    outlines = [
        np.column_stack([polygon, np.full(len(polygon), area.height_m + 0.005)])
        for area in content.areas
        if not area.is_floor
        for polygon in [np.concatenate([area.polygon_m, area.polygon_m[:1]])]
    ]
    stream.log(
        "world/areas", rr.LineStrips3D(outlines, colors=AREA, radii=0.006), static=True
    )


def log_objects(stream: rr.RecordingStream, content: SceneRecording) -> None:
    """Log given, predicted and labelled objects, and the error between the last two."""
    fill = FillMode.MajorWireframe if content.meshes else FillMode.Solid
    drawn = {
        "given": boxes(content.given, GIVEN, fill, False),
        "predicted": boxes(content.predicted, PREDICTED, fill, True),
        "labelled": boxes(content.labelled, LABELLED, FillMode.MajorWireframe, False),
        "errors": links(content),
    }
    for name, archetype in drawn.items():
        stream.log(f"world/objects/{name}", archetype, static=True)
    for mesh in content.meshes:
        stream.log(f"world/meshes/{mesh.name}", triangles(mesh), static=True)


def log_densities(
    stream: rr.RecordingStream, densities: Mapping[str, tuple[Array, Array]]
) -> None:
    """Log the density of each category on its candidate points."""
    for category, (points, log_density) in densities.items():
        relative = np.exp(log_density - log_density.max())
        warm = np.flatnonzero(relative > COLD)
        kept = warm[thin(len(warm), DENSITY_POINTS)]
        colors = mpl.colormaps["turbo"](relative[kept], bytes=True)
        heat = rr.Points3D(
            points[kept], colors=colors, radii=0.01 + 0.012 * relative[kept]
        )
        stream.log(f"world/density/{category}", heat, static=True)


def log_diagnostics(stream: rr.RecordingStream, content: SceneRecording) -> None:
    """Log the chain's diagnostics as series and the summary as text."""
    time = [rr.TimeColumn("sweep", sequence=content.trace["sweep"].to_numpy())]
    series = {
        "log_likelihood": (
            "log likelihood",
            "sitting_upright",
            InterpolationMode.Linear,
        ),
        "n_poses": ("poses in use", "reaching", InterpolationMode.StepAfter),
    }
    for column, (name, kind, mode) in series.items():
        path, color = f"diagnostics/{column}", KIND_COLORS[kind]
        style = rr.SeriesLines(
            names=name, colors=color, widths=1.5, interpolation_mode=mode
        )
        scalars = content.trace[column].to_numpy(float)
        stream.log(path, style, static=True)
        stream.send_columns(path, time, rr.Scalars.columns(scalars=scalars))
    text = rr.TextDocument(summary(content), media_type=rr.MediaType.MARKDOWN)
    stream.log("summary", text, static=True)


def shaded(content: SceneRecording) -> Array:
    """Return the colours of the cloud, darker where it faces away from the light."""
    if not len(content.point_normals):
        return content.point_colors.astype(float)
    lit = np.abs(content.point_normals @ (np.array(LIGHT) / np.linalg.norm(LIGHT)))
    return content.point_colors * (AMBIENT + (1 - AMBIENT) * lit[:, None])


def boxes(
    objects: Boxes, color: tuple[int, int, int], fill: FillMode, is_named: bool
) -> rr.Boxes3D:
    """Return the boxes of objects, labelled with their names."""
    return rr.Boxes3D(
        centers=objects.centers,
        half_sizes=objects.sizes / 2,
        quaternions=objects.quaternions[:, [1, 2, 3, 0]],  # rerun wants xyzw
        labels=list(objects.names),
        colors=color,
        fill_mode=fill,
        show_labels=is_named,
    )


def links(content: SceneRecording) -> rr.LineStrips3D:
    """Return a line from each predicted to its labelled place, with the error."""
    return rr.LineStrips3D(
        list(zip(content.predicted.centers, content.labelled.centers, strict=True)),
        labels=[f"{e:.2f} m" if e > READABLE_M else "" for e in content.errors_m],
        colors=LABELLED,
        radii=0.004,
    )


def triangles(mesh: Mesh) -> rr.Mesh3D:
    """Return a mesh whose faces keep their own colours."""
    corners = mesh.vertices[mesh.faces]  # (f, 3, 3)
    return rr.Mesh3D(
        vertex_positions=corners.reshape(-1, 3),
        triangle_indices=np.arange(3 * len(corners)).reshape(-1, 3),
        vertex_colors=np.repeat(mesh.face_colors, 3, axis=0),
    )

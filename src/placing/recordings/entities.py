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
from placing.recordings.content import Boxes, Mesh, SceneRecording
from placing.recordings.strips import strips
from placing.recordings.thinning import thin, voxel_means
from placing.recordings.words import reasons, summary

Array = NDArray[np.float64]

CLOUD_POINTS = 60_000
DENSITY_POINTS = 1500
"""At most so many of each are kept; a recording is for looking at."""
CLOUD_FILL = 0.7
"""Radius of a point over the spacing of the points: no gaps, little overlap."""
LIGHT = (0.35, 0.25, 0.9)
AMBIENT = 0.62
"""A cloud is shaded as if lit from above; `AMBIENT` is the share without direction."""
CHAINS = tuple(
    (*colour,) for colour in (np.array(mpl.color_sequences["tab10"]) * 255).astype(int)
)
"""Colours of the chains."""
MODES = {
    "n_poses": InterpolationMode.StepAfter,
    "log_joint": InterpolationMode.Linear,
    "p_new": InterpolationMode.Linear,
}
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
    lines = rr.LineStrips3D(strips(outlines), colors=AREA, radii=0.006)
    stream.log("world/areas", lines, static=True)


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
    """Log the trace of every chain as series, and what there is to read."""
    n_chains = content.trace["chain"].nunique()
    trace = content.trace.sort_values(["sweep", "chain"])
    sweeps, counts = np.unique(trace["sweep"].to_numpy(), return_counts=True)
    time = [rr.TimeColumn("sweep", sequence=sweeps)]
    for name, mode in MODES.items():
        path = f"diagnostics/{name}"
        style = rr.SeriesLines(
            names=[f"chain {chain + 1}" for chain in range(n_chains)],
            colors=CHAINS[:n_chains],
            widths=[1.2] * n_chains,
            interpolation_mode=mode,
        )
        stream.log(path, style, static=True)
        series = rr.Scalars.columns(scalars=trace[name].to_numpy(float))
        stream.send_columns(path, time, series.partition(counts))
    for path, text in {
        "summary": summary(content),
        "reasons": reasons(content),
    }.items():
        document = rr.TextDocument(text, media_type=rr.MediaType.MARKDOWN)
        stream.log(path, document, static=True)


def shaded(content: SceneRecording) -> NDArray[np.floating]:
    """Return the colours of the cloud, darker where it faces away from the light."""
    if not len(content.point_normals):
        return content.point_colors.astype(np.float32)
    light = (np.array(LIGHT) / np.linalg.norm(LIGHT)).astype(
        content.point_normals.dtype
    )
    lit = AMBIENT + (1 - AMBIENT) * np.abs(content.point_normals @ light)
    return content.point_colors * lit[:, None]


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
    ends = np.stack([content.predicted.centers, content.labelled.centers], axis=1)
    return rr.LineStrips3D(
        strips(ends),
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

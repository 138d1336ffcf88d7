"""What the recording of a scene holds, and its summary in words; nothing of rerun."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.scene import PlacingArea

Array = NDArray[np.float64]

ABOUT = {
    "rooms": "20 rooms and their labelled arrangements, written for this project after "
    "the protocol of the paper. It is not the data set of the paper, whose numbers it "
    "cannot reproduce digit by digit.",
    "thor": "Rooms drawn by the designers of AI2-THOR for other purposes, with their "
    "own choice of where things lie. It is not the data set of the paper, and nobody "
    "labelled it for this task.",
}
LEGEND = (
    "Orange boxes: predicted places, linked to the labelled ones in white outline. "
    "Grey boxes: given objects. Figures: the people imagined at this sweep, with the "
    "number of objects each explains. Coloured points: the density of one category; "
    "the others can be switched on under `world/density`."
)


@dataclass(frozen=True)
class Boxes:
    """The bounding boxes of n objects in the world."""

    names: tuple[str, ...]
    centers: Array
    """(n, 3) [m]."""
    sizes: Array
    """(n, 3) depth, width, height [m]."""
    quaternions: Array
    """(n, 4) wxyz, object to world."""


@dataclass(frozen=True)
class Mesh:
    """A coloured mesh in the world, drawn in place of its object's box."""

    name: str
    vertices: Array
    """(v, 3) [m]."""
    faces: NDArray[np.int64]
    """(f, 3) indices of vertices."""
    face_colors: NDArray[np.uint8]
    """(f, 3) or (f, 4)."""


@dataclass(frozen=True)
class SceneRecording:
    """All that one recording shows: one scene, one task, one method."""

    dataset: str
    scene: str
    task: str
    method: str
    fold: int
    seed: int
    points: Array
    """(n, 3) point cloud of the room [m]."""
    point_colors: NDArray[np.uint8]
    """(n, 3)."""
    point_normals: Array
    """(n, 3) unit, or (0, 3) where they are unknown; they only shade the cloud."""
    areas: tuple[PlacingArea, ...]
    valid_poses: pd.DataFrame
    """kind, x_m, y_m, z_m, yaw_rad: where a person could be."""
    sampled_poses: pd.DataFrame
    """sweep, pose, kind, x_m, y_m, z_m, yaw_rad, n_objects: where the chain was."""
    trace: pd.DataFrame
    """sweep, log_likelihood, n_poses."""
    given: Boxes
    """Objects that stand in the room from the start; none in an empty room."""
    predicted: Boxes
    labelled: Boxes
    """Of each predicted object, in that order, the labelled place it is scored by."""
    errors_m: Array
    """(n_predicted,) distance from the predicted to the labelled location."""
    log_density: Array
    """(n_predicted,) log density of the method at the labelled place."""
    densities: Mapping[str, tuple[Array, Array]] = field(default_factory=dict)
    """Of each category: candidate points (c, 3) [m] and their log density (c,)."""
    meshes: tuple[Mesh, ...] = ()


def summary(content: SceneRecording) -> str:
    """Return what the recording shows as Markdown."""
    given = len(content.given.names)
    lines = [
        f"# {content.scene}, {content.task} room",
        f"Method **{content.method}**, fold {content.fold}, seed {content.seed}; "
        f"{len(content.predicted.names)} objects placed, {given} given, "
        f"mean error **{_mean(content.errors_m)} m**.",
        "",
        f"Data set `{content.dataset}`. {ABOUT.get(content.dataset, '')}",
        "",
        "| object | error [m] | log density |",
        "|:-|-:|-:|",
    ]
    for i in np.argsort(content.errors_m, kind="stable"):
        name, error = content.predicted.names[i], content.errors_m[i]
        lines.append(f"| {name} | {error:.2f} | {content.log_density[i]:.1f} |")
    return "\n".join([*lines, "", LEGEND])


def _mean(values: Array) -> str:
    """Return the mean with two decimals, or a dash where there is none."""
    return f"{values.mean():.2f}" if len(values) else "-"

"""What the recording of a scene holds; nothing of rerun."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from placing.scene import PlacingArea

Array = NDArray[np.float64]


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
class Term:
    """What speaks for a place, as a logarithm, here and at the other place."""

    name: str
    value: float
    alternative: float
    is_decisive: bool


@dataclass(frozen=True)
class Use:
    """Who uses an object most likely, and where it would be otherwise."""

    kind: str
    """Kind of person; empty where there is nobody."""
    location: Array
    """(3,) of the person."""
    yaw: float
    share: float
    """Probability of this person."""
    area: str
    alternative: Array
    """(3,) best other place, on `area`; NaN where there is none."""
    terms: tuple[Term, ...]


@dataclass(frozen=True)
class SceneRecording:
    """All that one recording shows: one scene, one task, one method."""

    dataset: str
    scene: str
    task: str
    method: str
    fold: int
    seed: int
    points: NDArray[np.floating]
    """(n, 3) point cloud of the room [m]."""
    point_colors: NDArray[np.uint8]
    """(n, 3)."""
    point_normals: NDArray[np.floating]
    """(n, 3) unit, or (0, 3) where they are unknown; they only shade the cloud."""
    areas: tuple[PlacingArea, ...]
    valid_poses: pd.DataFrame
    """kind, x_m, y_m, z_m, yaw_rad: where a person could be."""
    sampled_poses: pd.DataFrame
    """sweep, pose, kind, x_m, y_m, z_m, yaw_rad, n_objects: where the chain was."""
    question: str
    """The question whose chains are shown; empty where there are none."""
    trace: pd.DataFrame
    """chain, sweep, log_joint, n_poses, p_new of that question."""
    diagnoses: pd.DataFrame
    """`DIAGNOSTIC_COLUMNS` of every question that is shown."""
    uses: Mapping[str, Use]
    """By predicted object, none of a method without people."""
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

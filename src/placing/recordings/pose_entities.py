"""The people of a recording: valid poses as arrows, the chain's poses as figures.

The figures are on the timeline `sweep`. The numbers here only steer how things look and
how large files get.
"""

import numpy as np
import pandas as pd
import pyarrow as pa
import rerun as rr
from numpy.typing import NDArray

from placing import rigid
from placing.people import skeleton
from placing.recordings.strips import packed
from placing.recordings.thinning import evenly, thin

Array = NDArray[np.float64]

VALID_POSES = 200
SWEEPS = 40
"""At most so many of each are kept; a recording is for looking at."""
HEAD_RADIUS_M, LIMB_RADIUS_M = 0.095, 0.028
FIGURE = (
    (0, 1, 2),
    (7, 5, 3, 1, 4, 6, 8),
    (13, 11, 9, 2, 10, 12, 14),
)
"""Joints along head and trunk, both arms, both legs: three lines as thick as limbs."""

# SOURCE: Paul Tol, "Colour schemes", bright, which colour-blind people tell apart too;
# lighter here, to be read on a dark ground.
KIND_COLORS = {
    "sitting_upright": (110, 166, 250),
    "sitting_reclined": (86, 214, 222),
    "sitting_forward": (117, 199, 92),
    "reaching": (218, 120, 200),
    "standing": (255, 122, 134),
    "leaning_forward": (226, 206, 92),
}


def log_kinds(stream: rr.RecordingStream) -> None:
    """Log name, colour and bones of the kinds of human pose."""
    classes = [
        rr.ClassDescription(
            info=rr.AnnotationInfo(i, kind.replace("_", " "), KIND_COLORS[kind]),
            keypoint_annotations=[
                rr.AnnotationInfo(j, name.replace("_", " "), KIND_COLORS[kind])
                for j, name in enumerate(skeleton.JOINTS)
            ],
            keypoint_connections=list(skeleton.BONES),
        )
        for i, kind in enumerate(skeleton.KINDS)
    ]
    stream.log("world/poses", rr.AnnotationContext(classes), static=True)


def log_valid_poses(stream: rr.RecordingStream, valid: pd.DataFrame) -> None:
    """Log some of the valid poses as arrows that point where the person looks."""
    valid = valid.iloc[thin(len(valid), VALID_POSES)]
    yaw = valid["yaw_rad"].to_numpy()
    arrows = rr.Arrows3D(
        origins=valid[["x_m", "y_m", "z_m"]].to_numpy(),
        vectors=0.15 * np.column_stack([np.cos(yaw), np.sin(yaw), 0 * yaw]),
        class_ids=class_ids(valid),
        radii=0.004,
    )
    stream.log("world/poses/valid", arrows, static=True)


def log_people(stream: rr.RecordingStream, poses: pd.DataFrame) -> None:
    """Log the chain's poses as figures over sweeps, named after kind and objects."""
    sweeps = evenly(np.unique(poses["sweep"].to_numpy()), SWEEPS)
    poses = poses[np.isin(poses["sweep"].to_numpy(), sweeps)]
    poses = poses.sort_values(["sweep", "pose"])
    counts = np.unique(poses["sweep"].to_numpy(), return_counts=True)[1]
    time = [rr.TimeColumn("sweep", sequence=sweeps)]
    ids, joints = class_ids(poses), skeletons(poses)  # (k,), (k, 15, 3)
    plain = rr.LineStrips3D.from_fields(show_labels=False)
    stream.log("world/poses/limbs", plain, static=True)
    parts = {
        "joints": points_of_joints(ids, joints).partition(15 * counts),
        "limbs": lines_of_limbs(ids, joints).partition(len(FIGURE) * counts),
        "names": names_over_heads(ids, joints, poses).partition(counts),
    }
    for name, columns in parts.items():
        stream.send_columns(f"world/poses/{name}", time, columns)


def points_of_joints(ids: NDArray[np.uint16], joints: Array) -> rr.ComponentColumnList:
    """Return the joints of people as points that know which joints they are."""
    k = len(ids)
    return rr.Points3D.columns(
        positions=joints.reshape(-1, 3),
        class_ids=np.repeat(ids, 15),
        keypoint_ids=np.tile(np.arange(15), k),
        radii=np.tile([HEAD_RADIUS_M, *[LIMB_RADIUS_M] * 14], k),
    )


def lines_of_limbs(ids: NDArray[np.uint16], joints: Array) -> rr.ComponentColumnList:
    """Return the limbs of people as thick lines."""
    return rr.LineStrips3D.columns(
        strips=limbs(joints),
        class_ids=np.repeat(ids, len(FIGURE)),
        radii=np.full(len(FIGURE) * len(ids), LIMB_RADIUS_M),
    )


def limbs(joints: Array) -> pa.ListArray:
    """Return the lines of figures (k, 15, 3), one after the other."""
    through = np.concatenate(FIGURE)
    points = joints[:, through].reshape(-1, 3)
    ends = np.cumsum([0, *[len(line) for line in FIGURE] * len(joints)])
    return packed(points, ends)


def names_over_heads(
    ids: NDArray[np.uint16], joints: Array, poses: pd.DataFrame
) -> rr.ComponentColumnList:
    """Return the kinds of people and their numbers of objects, written over heads."""
    return rr.Points3D.columns(
        positions=joints[:, 0] + [0, 0, 0.2],
        class_ids=ids,
        radii=np.full(len(ids), 0.001),
        labels=[
            f"{kind.replace('_', ' ')}: {n}"
            for kind, n in zip(poses["kind"], poses["n_objects"], strict=True)
        ],
    )


def skeletons(poses: pd.DataFrame) -> Array:
    """Return the joints of poses of any kind in the world, shape (k, 15, 3) [m]."""
    upright = np.stack([skeleton.joints(kind) for kind in skeleton.KINDS])
    yaw = poses["yaw_rad"].to_numpy()[:, None]
    turned = rigid.turn_about_z(yaw, upright[class_ids(poses)])
    return turned + poses[["x_m", "y_m", "z_m"]].to_numpy()[:, None]


def class_ids(poses: pd.DataFrame) -> NDArray[np.uint16]:
    """Return the class of each pose's kind, shape (k,)."""
    return np.array([skeleton.KINDS.index(kind) for kind in poses["kind"]], np.uint16)

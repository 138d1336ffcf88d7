"""Who uses an object and where it would be otherwise: one entity per object.

The numbers here only steer how things look.
"""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from placing.people import skeleton
from placing.recordings.content import SceneRecording, Use
from placing.recordings.pose_entities import FIGURE, KIND_COLORS
from placing.recordings.strips import strips

Array = NDArray[np.float64]

FAINT = (132, 136, 144)
HEAD_RADIUS_M, LIMB_RADIUS_M, LINK_RADIUS_M = 0.06, 0.012, 0.006
PLACE_RADIUS_M = 0.025
N_DASHES = 12
TORSO = skeleton.JOINTS.index("torso")


def log_uses(stream: rr.RecordingStream, content: SceneRecording) -> None:
    """Log the user and the best other place of each predicted object."""
    centers = dict(zip(content.predicted.names, content.predicted.centers, strict=True))
    for name, use in content.uses.items():
        if name in centers:
            drawn = drawing(name, use, centers[name])
            stream.log(f"world/uses/{name}", *drawn, static=True)


def drawing(name: str, use: Use, center: Array) -> list[rr.AsComponents]:
    """Return the lines and the points of one object."""
    lines, points = [], []  # with colour and radius each
    if use.kind:
        figure, color = person(use), KIND_COLORS[use.kind]
        lines += [(figure[list(line)], color, LIMB_RADIUS_M) for line in FIGURE]
        lines.append((np.stack([figure[TORSO], center]), color, LINK_RADIUS_M))
        label = f"{name}: {use.kind.replace('_', ' ')} {use.share:.0%}"
        points.append((figure[0], color, HEAD_RADIUS_M, label))
    if not np.isnan(use.alternative).any():
        dashed = dashes(center, use.alternative)
        lines += [(dash, FAINT, LINK_RADIUS_M / 2) for dash in dashed]
        label = f"{name}, otherwise"
        points.append((use.alternative, FAINT, PLACE_RADIUS_M, label))
    if not points:
        return [rr.Clear(recursive=False)]
    paths, colors, radii = zip(*lines, strict=True)
    at, dots, sizes, labels = zip(*points, strict=True)
    return [
        rr.LineStrips3D(strips(paths), colors=np.array(colors), radii=radii),
        rr.Points3D(
            np.array(at),
            colors=np.array(dots),
            radii=sizes,
            labels=labels,
            show_labels=False,
        ),
    ]


def person(use: Use) -> Array:
    """Return the joints of the person who uses an object, shape (15, 3) [m]."""
    return skeleton.place(use.kind, use.location[None], np.array([use.yaw]))[0]


def dashes(start: Array, end: Array) -> Array:
    """Return the dashes of a line, shape (N_DASHES, 2, 3)."""
    share = np.linspace(0, 1, 2 * N_DASHES).reshape(-1, 2, 1)
    return start + share * (end - start)

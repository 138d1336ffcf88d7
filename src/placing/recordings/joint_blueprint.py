"""What is seen when the recording of a joint arrangement is opened, and its writer."""

from pathlib import Path

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

from placing.artifacts.atomic import replacing
from placing.recordings.blueprint import BACKGROUND, Eye, eye_of_room, room
from placing.recordings.joint import JointRecording
from placing.recordings.joint_entities import log_static, outline
from placing.recordings.joint_steps import TIMELINE, log_steps
from placing.recordings.joint_words import label_of
from placing.recordings.stream import recording_stream

CLOSE_M, NEAR_DEG = 1.5, 30.0
"""Distance and elevation of the near eye, which looks below shelves."""
ELEVATION_DEG, LOWERED_M = 52.0, 0.35
"""Scans are of large rooms, of rooms behind rooms, and without ceilings: the eye is
higher than that of other recordings, and looks at what is lower."""
HIDDEN = ("world/cloud/front", "world/areas/names")
WHOLE = ("$origin/**", "- $origin/names/near", "- $origin/stack/levels")
NEAR = ("$origin/**", "- $origin/names/all")


def write_joint(path: Path, content: JointRecording) -> None:
    """Write the recording of a joint arrangement, whole or not at all."""
    names = (content.dataset, content.scene, "joint", content.method)
    stream = recording_stream([*names, f"fold{content.fold}"])
    eye = eye_of(content)
    with replacing(path) as part:
        stream.save(part)
        stream.send_recording_name(f"{content.scene}, {label_of(content.method)}")
        log_static(stream, content, eye)
        log_steps(stream, content, eye)
        stream.send_blueprint(layout(content, eye), make_active=True, make_default=True)
        stream.flush()
        stream.disconnect()


def eye_of(content: JointRecording) -> Eye:
    """Return the eye of a scene, the same whatever is put where."""
    outlines = [
        outline(area).mean(axis=0) for area in content.areas if not area.is_floor
    ]
    eye = eye_of_room(content.cloud.points, np.array(outlines).reshape(-1, 3))
    target = eye.target - np.array([0, 0, LOWERED_M])
    distance = float(np.linalg.norm(eye.position - eye.target))
    return Eye(target + distance * _towards(eye, ELEVATION_DEG), target)


def _towards(eye: Eye, elevation_deg: float) -> NDArray[np.float64]:
    """Return the unit vector towards an eye, at another elevation, shape (3,)."""
    flat = (eye.position - eye.target)[:2]
    elevation = np.deg2rad(elevation_deg)
    back = flat / np.linalg.norm(flat) * np.cos(elevation)
    return np.array([*back, np.sin(elevation)])


def layout(content: JointRecording, eye: Eye) -> rrb.Blueprint:
    """Return the views: the room, the object of the step from near, and the words."""
    side = rrb.Vertical(
        rrb.TextDocumentView(origin="now", name="Object of this step"),
        _near(eye),
        rrb.TextDocumentView(origin="summary", name="Summary"),
        row_shares=[2, 3, 4.5],
    )
    title = f"{content.scene}: {label_of(content.method)}"
    whole = room(eye, HIDDEN, title, WHOLE)
    return rrb.Blueprint(
        rrb.Horizontal(whole, side, column_shares=[2, 1]),
        rrb.TimePanel(
            state="collapsed", timeline=TIMELINE, play_state="paused", fps=0.4
        ),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


def _near(eye: Eye) -> rrb.Spatial3DView:
    """Return a view that keeps close to the object of the step."""
    behaviour = rrb.EntityBehavior(visible=False)
    return rrb.Spatial3DView(
        origin="world",
        name="From near",
        contents=list(NEAR),
        overrides=dict.fromkeys(HIDDEN, behaviour),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=eye.target + CLOSE_M * _towards(eye, NEAR_DEG),
            look_target=eye.target,
            eye_up=(0, 0, 1),
            tracking_entity="world/chosen/box",
        ),
        background=BACKGROUND,
        line_grid=False,
    )

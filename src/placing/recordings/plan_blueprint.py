"""What is seen when the recording of a plan is opened, and its writer."""

from pathlib import Path

import rerun.blueprint as rrb

from placing.artifacts.atomic import replacing
from placing.recordings.blueprint import BACKGROUND, Eye, eye_of_room, room
from placing.recordings.plan import PlanRecording
from placing.recordings.plan_entities import EYE, TIMELINE, log_plan
from placing.recordings.stream import recording_stream

HIDDEN = ("world/cloud/front", "world/areas/names")
WHOLE = ("$origin/**", f"- /{EYE}/**")
SPEED = 2.0
"""A plan is played so many times faster than a robot would move."""


def write_plan(path: Path, content: PlanRecording) -> None:
    """Write the recording of a plan, whole or not at all."""
    names = (content.dataset, content.scene, "plan", content.task, content.constraints)
    stream = recording_stream([*names, f"fold{content.fold}"])
    ends = content.film.T_world_objects[-1, :, 4:]
    eye = eye_of_room(content.cloud.points, ends)
    with replacing(path) as part:
        stream.save(part)
        stream.send_recording_name(f"{content.scene}, plan of the robot")
        log_plan(stream, content, eye)
        stream.send_blueprint(layout(content, eye), make_active=True, make_default=True)
        stream.flush()
        stream.disconnect()


def layout(content: PlanRecording, eye: Eye) -> rrb.Blueprint:
    """Return the views: the room, the gripper from near, and the words."""
    side = rrb.Vertical(
        rrb.TextDocumentView(origin="now", name="Now"),
        _near(),
        rrb.TextDocumentView(origin="search", name="Search"),
        row_shares=[1, 3, 4],
    )
    title = f"{content.scene}: plan of the robot"
    return rrb.Blueprint(
        rrb.Horizontal(room(eye, HIDDEN, title, WHOLE), side, column_shares=[2, 1]),
        rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            play_state="playing",
            playback_speed=SPEED,
            loop_mode="all",
        ),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )


def _near() -> rrb.Spatial3DView:
    """Return the view of the hand from the robot's head."""
    return rrb.Spatial3DView(
        origin="world",
        name="From the head of the robot",
        contents=["$origin/**"],
        overrides=dict.fromkeys(HIDDEN, rrb.EntityBehavior(visible=False)),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            eye_up=(0, 0, 1),
            tracking_entity=EYE,
        ),
        background=BACKGROUND,
        line_grid=False,
    )

"""One scene as a rerun recording: the room, the hallucinated people and the objects.

`content` says what a recording holds, `entities` and `pose_entities` turn it into
components of rerun, `blueprint` arranges what is seen when the file is opened. Only
the last three and this file import rerun.
"""

from pathlib import Path

import rerun as rr

from placing.artifacts.atomic import replacing
from placing.recordings import blueprint, entities, pose_entities, use_entities
from placing.recordings.content import SceneRecording
from placing.recordings.stream import recording_stream


def write_recording(path: Path, content: SceneRecording) -> None:
    """Write the recording of a scene with its blueprint, whole or not at all."""
    names = (content.dataset, content.scene, content.task, content.method)
    stream = recording_stream([*names, f"fold{content.fold}", f"seed{content.seed}"])
    with replacing(path) as part:
        stream.save(part)
        _log(stream, content)
        stream.flush()
        stream.disconnect()


def _log(stream: rr.RecordingStream, content: SceneRecording) -> None:
    """Send everything a recording holds."""
    eye = blueprint.eye_of_room(content.points, content.predicted.centers)
    stream.send_recording_name(
        f"{content.scene}, {content.task} room, {content.method}, fold {content.fold}"
    )
    entities.log_room(stream, content, eye)
    pose_entities.log_kinds(stream)
    pose_entities.log_valid_poses(stream, content.valid_poses)
    pose_entities.log_people(stream, content.sampled_poses)
    entities.log_objects(stream, content)
    use_entities.log_uses(stream, content)
    entities.log_densities(stream, content.densities)
    entities.log_diagnostics(stream, content)
    stream.send_blueprint(
        blueprint.layout(content, eye), make_active=True, make_default=True
    )

"""Plans as MCAP: a time-stamped log in ROS 2 encoding that robot tools replay.

Every message has a log time that the plan gives, and the file names no version of a
library: the same plan gives the same bytes. Definitions of messages are in the file, so
that it is read without ROS. This is the only module that knows MCAP.

| topic | type | holds |
|-|-|-|
| /robot_description | std_msgs/String | URDF of boxes that needs no other file |
| /tf_static, /tf | tf2_msgs/TFMessage | map to base_footprint, links, moved objects |
| /joint_states | sensor_msgs/JointState | torso, arm and fingers |
| /placement/<object> | geometry_msgs/PoseStamped | where it is to stand |
| /planned_trajectory | trajectory_msgs/JointTrajectory | one per segment |
| /planning_result | placing_msgs/PlanningResult | order, and the reasons of the rest |

Shapes: t frames.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from mcap.well_known import SchemaEncoding
from mcap.writer import CompressionType, Writer
from mcap_ros2._dynamic import serialize_dynamic
from numpy.typing import NDArray

from placing.artifacts.atomic import replacing
from placing.logs.joint_encoding import transforms
from placing.logs.joint_messages import DEFINITIONS
from placing.logs.planning_result import PlanningResult
from placing.robot.box_urdf import box_urdf
from placing.robot.film import Film, Stretch
from placing.robot.model import RobotModel
from placing.robot.posing import (
    base_poses,
    joint_poses,
    joint_values,
    moving_joints,
    vectors,
)

Array = NDArray[np.float64]
Message = dict[str, Any]
Timed = tuple[float, str, str, Message | bytes]
"""Time [s], topic, type and content, which may be encoded already."""

LIBRARY = "placing"
"""Named in the file in place of versions, which would change its bytes."""
WORLD, BASE = "map", "base_footprint"
PLANAR = ("world_joint/x", "world_joint/y", "world_joint/theta")
"""The base as three joints, named as motion planners for ROS do."""


def write_log(
    path: Path,
    model: RobotModel,
    result: PlanningResult,
    plan: Sequence[Stretch],
    film: Film,
) -> None:
    """Write a plan as MCAP, whole or not at all."""
    messages = [
        *_fixed(model, result),
        *_trajectories(model, plan),
        *_frames(model, film),
    ]
    messages.sort(key=lambda message: message[0])  # stable: topics in the order above
    with replacing(path) as part, part.open("wb") as file:
        log = _Log(file)
        for time_s, topic, kind, message in messages:
            log.write(round(time_s * 1e9), topic, kind, message)
        log.finish()


class _Log:
    """A file that messages are written to by topic."""

    def __init__(self, file: Any) -> None:  # noqa: ANN401 (the writer takes any stream)
        """Start the file."""
        self._writer = Writer(file, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library=LIBRARY)
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._encoders: dict[str, Any] = {}

    def write(
        self, time_ns: int, topic: str, kind: str, message: Message | bytes
    ) -> None:
        """Write one message."""
        if kind not in self._schemas:
            text = DEFINITIONS[kind]
            self._encoders[kind] = serialize_dynamic(kind, text)[kind]
            self._schemas[kind] = self._writer.register_schema(
                kind, SchemaEncoding.ROS2, text.encode()
            )
        if topic not in self._channels:
            self._channels[topic] = self._writer.register_channel(
                topic, "cdr", self._schemas[kind]
            )
        is_encoded = isinstance(message, bytes)
        data = message if is_encoded else self._encoders[kind](message)
        channel = self._channels[topic]
        self._writer.add_message(channel, time_ns, data, publish_time=time_ns)

    def finish(self) -> None:
        """End the file."""
        self._writer.finish()


def _fixed(model: RobotModel, result: PlanningResult) -> Iterator[Timed]:
    """Yield what is said once, at the start."""
    text = {"data": box_urdf(model)}
    yield 0.0, "/robot_description", "std_msgs/msg/String", text
    moving, values = moving_joints(model.settings), _still(model)
    links = [
        _transform(0.0, joint.parent, joint.child, *_first(joint_poses(joint, values)))
        for joint in model.description.joints.values()
        if joint.name not in moving
    ]
    yield 0.0, "/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": links}
    for name, T in sorted(result.targets.items()):
        pose = {"position": _xyz(T[4:]), "orientation": _xyzw(T[[1, 2, 3, 0]])}
        message = {"header": _header(0.0, WORLD), "pose": pose}
        yield 0.0, f"/placement/{name}", "geometry_msgs/msg/PoseStamped", message
    outcome = {
        **{k: getattr(result, k) for k in ("dataset", "scene", "task", "constraints")},
        "header": _header(0.0, WORLD),
        "order": list(result.order),
        "refused": list(result.refused),
        "reasons": list(result.refused.values()),
    }
    yield 0.0, "/planning_result", "placing_msgs/msg/PlanningResult", outcome


def _still(model: RobotModel) -> dict[str, Array]:
    """Return the values of the joints that stand still."""
    return joint_values(model, np.zeros((1, 4 + model.n_arm)), np.zeros(1))


def _trajectories(model: RobotModel, plan: Sequence[Stretch]) -> Iterator[Timed]:
    """Yield each segment of a plan at its start, its way-points timed from there."""
    names = [*PLANAR, model.settings.torso, *model.settings.chain]
    for stretch in plan:
        start = float(stretch.time_s[0])
        points = [
            {"positions": row.tolist(), "time_from_start": _stamp(float(time) - start)}
            for time, row in zip(stretch.time_s, stretch.q, strict=True)
        ]
        message = {
            "header": _header(start, WORLD),
            "joint_names": names,
            "points": points,
        }
        kind = "trajectory_msgs/msg/JointTrajectory"
        yield start, "/planned_trajectory", kind, message


def _frames(model: RobotModel, film: Film) -> Iterator[Timed]:
    """Yield where the robot and the objects are, frame by frame."""
    settings, joints = model.settings, model.description.joints
    values = joint_values(model, film.q, film.opening_m)
    moving = moving_joints(settings)
    links = [(joints[name].parent, joints[name].child) for name in moving]
    chain = [base_poses(film.q), *(joint_poses(joints[n], values) for n in moving)]
    poses = np.stack([np.hstack(vectors(T)) for T in chain], axis=1)  # (t, links, 7)
    things = film.T_world_objects[:, :, [4, 5, 6, 1, 2, 3, 0]]
    edges = ((WORLD, BASE), *links)
    positions = np.column_stack([values[name] for name in moving])
    is_news = _news(film)
    for i, time in enumerate(film.time_s.tolist()):
        told = np.flatnonzero(is_news[i]).tolist()
        named = (*edges, *((WORLD, f"object/{film.objects[k]}") for k in told))
        rows = np.concatenate([poses[i], things[i, told]])
        data = transforms(named, round(time * 1e9), rows)
        yield time, "/tf", "tf2_msgs/msg/TFMessage", data
        state = {
            "header": _header(time, ""),
            "name": list(moving),
            "position": positions[i].tolist(),
        }
        yield time, "/joint_states", "sensor_msgs/msg/JointState", state


def _news(film: Film) -> NDArray[np.bool_]:
    """Return when the pose of which object is said, shape (t, n).

    That is where it has moved, and for all at the start of each phase.
    """
    poses = film.T_world_objects
    has_moved = np.ones(poses.shape[:2], bool)
    has_moved[1:] = (poses[1:] != poses[:-1]).any(axis=2)
    phase = np.array(film.phase)
    begins = np.append(True, phase[1:] != phase[:-1])
    return (has_moved | begins[:, None]) & np.isfinite(poses).all(axis=2)


def _first(T: Array) -> tuple[Array, Array]:
    """Return translation (3,) [m] and quaternion xyzw (4,) of the first of poses."""
    xyz, xyzw = vectors(T[:1])
    return xyz[0], xyzw[0]


def _transform(
    time: float, parent: str, child: str, xyz: Array, xyzw: Array
) -> Message:
    """Return a geometry_msgs/TransformStamped."""
    transform = {"translation": _xyz(xyz), "rotation": _xyzw(xyzw)}
    header = _header(time, parent)
    return {"header": header, "child_frame_id": child, "transform": transform}


def _header(time: float, frame: str) -> Message:
    """Return a std_msgs/Header."""
    return {"stamp": _stamp(time), "frame_id": frame}


def _stamp(time: float) -> Message:
    """Return a time or duration in whole seconds and nanoseconds."""
    sec, nanosec = divmod(round(time * 1e9), 10**9)
    return {"sec": sec, "nanosec": nanosec}


def _xyz(v: Array) -> Message:
    """Return a vector or point by axis."""
    return dict(zip("xyz", v.tolist(), strict=True))


def _xyzw(v: Array) -> Message:
    """Return a quaternion xyzw by axis."""
    return dict(zip("xyzw", v.tolist(), strict=True))

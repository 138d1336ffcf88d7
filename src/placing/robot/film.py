"""A plan over time: when the robot is where, and where each object is then.

Plans are paths without times. For whoever watches or replays them, each axis moves at
no more than a constant speed, and the gripper moves while the rest stands still.

Shapes: t frames, k rows of a path, n objects, a arm joints.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.robot.certificates import Certificate
from placing.robot.model import RobotModel, tool_pose

Array = NDArray[np.float64]

GRIPPER = "gripper"
"""Phase in which only the gripper moves."""
TURN, TORSO = 2, 3
"""Columns of a configuration."""


@dataclass(frozen=True)
class PlaybackConfig:
    """How fast plans are played back."""

    base_m_s: float
    turn_rad_s: float
    torso_m_s: float
    arm_rad_s: float
    gripper_m_s: float
    pause_s: float
    """Between two objects: the next one is handed over."""
    frame_s: float
    """Between two frames."""


@dataclass(frozen=True)
class Stretch:
    """A path with times: one segment of a plan, or a movement of the gripper."""

    phase: str
    moving: int
    """Number of the object that this is about."""
    is_holding: bool
    time_s: Array
    """(k,) strictly increasing."""
    q: Array
    """(k, 4 + a)."""
    opening_m: Array
    """(k,)."""


@dataclass(frozen=True)
class Film:
    """What is seen of a robot and its objects, frame by frame."""

    time_s: Array
    """(t,) strictly increasing."""
    q: Array
    """(t, 4 + a)."""
    opening_m: Array
    """(t,)."""
    objects: tuple[str, ...]
    T_world_objects: Array
    """(t, n, 7), NaN while an object is nowhere."""
    held: NDArray[np.int64]
    """(t,) number of the object in the gripper, -1 for none."""
    phase: tuple[str, ...]
    """(t,) what the robot does."""
    moving: NDArray[np.int64]
    """(t,) number of the object that this is about, -1 for none."""


def stretches(
    certificates: Sequence[Certificate], config: PlaybackConfig
) -> tuple[Stretch, ...]:
    """Return all segments of a plan with times, the gripper's movements between."""
    found: list[Stretch] = []
    now = 0.0
    for number, certificate in enumerate(certificates):
        opening = certificate.segments[0].opening_m
        for segment in certificate.segments:
            path, wide = _moved(segment.path), segment.opening_m
            if wide != opening:
                wait = now + abs(wide - opening) / config.gripper_m_s
                time, still = np.array([now, wait]), path[[0, 0]]
                widths = np.array([opening, wide])
                found.append(Stretch(GRIPPER, number, False, time, still, widths))
                now, opening = wait, wide
            if len(path) < 2:
                continue
            time = now + np.append(0.0, np.cumsum(durations(path, config)))
            widths = np.full(len(path), wide)
            is_held = segment.is_holding
            found.append(Stretch(segment.name, number, is_held, time, path, widths))
            now = float(time[-1])
        now += config.pause_s
    return tuple(found)


def _moved(path: Array) -> Array:
    """Return the rows of a path that differ from the one before, the first kept."""
    step = np.abs(np.diff(path, axis=0)).max(axis=1, initial=0)
    return path[np.append(True, step > 1e-9)]  # guards times that do not increase


def durations(path: Array, config: PlaybackConfig) -> Array:
    """Return how long each step between rows takes, shape (k - 1,) [s].

    The slowest axis of a step moves at its constant speed.
    """
    # ASSUME: the paper tells no speeds; accelerations are left out.
    step = np.abs(np.diff(path, axis=0))
    turn = step[:, TURN] / config.turn_rad_s
    base = np.hypot(step[:, 0], step[:, 1]) / config.base_m_s
    arm = step[:, 4:].max(axis=1, initial=0) / config.arm_rad_s
    return np.maximum.reduce([base, turn, step[:, TORSO] / config.torso_m_s, arm])


def film(
    certificates: Sequence[Certificate], model: RobotModel, config: PlaybackConfig
) -> Film:
    """Return a plan frame by frame, from the first stretch to the end of the last.

    Between two objects the robot stands still, then starts where the next is handed
    over; the last moment of each stretch is a frame.
    """
    plan = stretches(certificates, config)
    ends = [-1.0, *[stretch.time_s[-1] for stretch in plan]]
    parts = [
        _frames(stretch, config.frame_s, is_first=stretch.time_s[0] > end)
        for stretch, end in zip(plan, ends, strict=False)
    ]
    lengths = [len(time) for time, _, _ in parts]
    number = np.repeat(np.arange(len(plan)), lengths)  # (t,) of the stretch
    q = np.concatenate([rows for _, rows, _ in parts])
    moving = np.array([stretch.moving for stretch in plan])[number]
    is_held = np.array([stretch.is_holding for stretch in plan])[number]
    tool = np.array([tool_pose(model, row) for row in q])
    return Film(
        time_s=np.concatenate([time for time, _, _ in parts]),
        q=q,
        opening_m=np.concatenate([widths for _, _, widths in parts]),
        objects=tuple(certificate.object_id for certificate in certificates),
        T_world_objects=np.stack(
            [_poses(c, moving - i, is_held, tool) for i, c in enumerate(certificates)],
            axis=1,
        ),
        held=np.where(is_held, moving, -1),
        phase=tuple(plan[i].phase for i in number),
        moving=moving,
    )


def _frames(
    stretch: Stretch, frame_s: float, is_first: bool
) -> tuple[Array, Array, Array]:
    """Return times, configurations and openings of the frames of a stretch.

    They are evenly spaced; its start is a frame only where no other stretch ends.
    """
    start, end = stretch.time_s[[0, -1]]
    n = max(int(np.ceil((end - start) / frame_s - 1e-9)), 1)
    time = np.linspace(start, end, n + 1)[0 if is_first else 1 :]
    q = np.column_stack([np.interp(time, stretch.time_s, c) for c in stretch.q.T])
    return time, q, np.interp(time, stretch.time_s, stretch.opening_m)


def _poses(
    certificate: Certificate,
    turn: NDArray[np.int64],
    is_held: NDArray[np.bool_],
    tool: Array,
) -> Array:
    """Return where one object is in every frame, shape (t, 7).

    `turn` is 0 while it is its turn, less before; `tool` is (t, 7).
    """
    start = certificate.T_world_start
    poses = np.tile(np.full(7, np.nan) if start is None else start, (len(tool), 1))
    carried = np.flatnonzero((turn == 0) & is_held)
    for i in carried:
        poses[i] = rigid.compose(tool[i], certificate.T_tool_object)
    poses[carried[-1] + 1 :] = certificate.T_world_object
    return poses

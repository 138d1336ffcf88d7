"""Certificates: what was planned, so that it can be judged without who planned it.

A certificate holds the whole motion that places one object, as way-points, and the
world that it was made for. `placing.artifacts.certificates` reads and writes them.

Shapes: t way-points of a path, a arm joints; a way-point is base x, y [m], base yaw
[rad], torso lift [m] and the arm joints [rad].
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.robot.planning import Motion, Segment

Array = NDArray[np.float64]

BASE_AND_TORSO = ("x_m", "y_m", "yaw_rad", "torso_m")
"""The first columns of a way-point; the arm's joints follow."""


@dataclass(frozen=True)
class World:
    """The world that a motion was planned for; what stands in it comes beside it."""

    dataset: str
    scene: str
    task: str
    question: str
    constraints: str
    """How the robot was looked at, as in Table 1."""


@dataclass(frozen=True)
class Certificate:
    """How one object was placed."""

    world: World
    object_id: str
    grasp: str
    T_tool_object: Array
    """(7,) pose of the object in the gripper."""
    T_world_start: Array | None
    """(7,) where it was picked up; None where it was handed over."""
    T_world_object: Array
    """(7,) where it ends."""
    standing: Mapping[str, Array]
    """(7,) poses `T_world_object` of all other objects that stood there, by id."""
    segments: tuple[Segment, ...]

    @property
    def name(self) -> str:
        """All that tells it from the others of its folder."""
        world = self.world
        parts = world.scene, world.task, world.question, world.constraints
        return "/".join([*filter(None, parts), self.object_id])


@dataclass(frozen=True)
class Certificates:
    """Certificates of one robot."""

    robot: str
    """Stem of the robot's file."""
    urdf_sha256: str
    joints: tuple[str, ...]
    """Names of the columns of a way-point."""
    certificates: tuple[Certificate, ...]


def certificate_of(
    world: World, motions: Sequence[Motion], standing: Mapping[str, Array]
) -> Certificate:
    """Return the certificate of putting an object, or of picking and putting it.

    `standing` holds the poses of all other objects, (7,) by id.
    """
    end = motions[-1]
    names = ("pick", "put")[-len(motions) :]
    return Certificate(
        world=world,
        object_id=end.object_id,
        grasp=end.grasp,
        T_tool_object=np.asarray(end.T_tool_object, float),
        T_world_start=None if len(motions) == 1 else motions[0].T_world_object,
        T_world_object=np.asarray(end.T_world_object, float),
        standing={name: np.asarray(T, float) for name, T in sorted(standing.items())},
        segments=tuple(
            Segment(
                f"{name} {s.name}", np.asarray(s.path, float), s.is_holding, s.opening_m
            )
            for name, motion in zip(names, motions, strict=True)
            for s in motion.segments
        ),
    )

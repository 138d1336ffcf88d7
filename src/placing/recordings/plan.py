"""What the recording of a plan holds, put together; nothing of rerun.

Shapes: t frames.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from trimesh import Trimesh

from placing import rigid
from placing.clouds.ply import Cloud
from placing.object_meshes import object_mesh
from placing.pictures.robot import part_meshes
from placing.robot.certificates import Certificate
from placing.robot.film import Film, PlaybackConfig, Stretch, film, stretches
from placing.robot.model import RobotModel
from placing.robot.posing import link_poses_over
from placing.scene import PlacingArea, Scene, SceneObject

Array = NDArray[np.float64]


OVER_M, AHEAD_M = 0.35, 0.22
"""Where an eye is over the highest link of the robot."""


@dataclass(frozen=True)
class Tried:
    """A placement that was tried."""

    object_id: str
    number: int
    """How many placements of its object had been tried before, and 1."""
    reason: str
    """Why it was rejected; empty if the robot can do it."""
    blockers: tuple[str, ...]
    """Objects that were in the way."""
    among: tuple[str, ...]
    """Objects that stood there already."""
    T_world_object: Array
    """(7,)."""


@dataclass(frozen=True)
class Search:
    """What the search for an order of the objects did."""

    order: tuple[str, ...]
    """Objects in the order in which they are placed."""
    grasps: Mapping[str, str]
    """Of each placed object."""
    refused: Mapping[str, str]
    """Why each of the others is not placed."""
    tried: tuple[Tried, ...]
    notes: tuple[str, ...]
    """What else is to be read, such as the effort."""


@dataclass(frozen=True)
class PlanRecording:
    """All that one recording shows: how a robot places the objects of one scene."""

    dataset: str
    scene: str
    task: str
    constraints: str
    fold: int
    cloud: Cloud
    areas: tuple[PlacingArea, ...]
    items: Mapping[str, SceneObject]
    standing: Mapping[str, Array]
    """(7,) poses of the objects that nobody moves."""
    search: Search
    plan: tuple[Stretch, ...]
    film: Film
    parts: Mapping[str, Trimesh]
    """What the robot looks like, by the first link of each part that moves as one."""
    poses: Mapping[str, Array]
    """(t, 4, 4) of these parts in the world."""
    gaze: tuple[Array, Array]
    """(t, 3) eye over the robot, and the tool that it looks at [m]."""


def plan_recording(
    fold: int,
    scene: Scene,
    cloud: Cloud,
    model: RobotModel,
    certificates: Sequence[Certificate],
    search: Search,
    config: PlaybackConfig,
    seen: Film | None = None,
) -> PlanRecording:
    """Return the recording of a plan, or of what was seen when it was carried out.

    The certificates are those of the placed objects, in the order of the search.
    """
    world = certificates[0].world
    shown = film(certificates, model, config) if seen is None else seen
    parts = part_meshes(model)
    poses = link_poses_over(model, shown.q, shown.opening_m)
    moved, standing = shown.objects, certificates[0].standing
    return PlanRecording(
        *(world.dataset, scene.scene, world.task, world.constraints, fold),
        *(cloud, scene.areas),
        items={item.object_id: item for item in scene.objects},
        standing={name: T for name, T in standing.items() if name not in moved},
        search=search,
        plan=stretches(certificates, config),
        film=shown,
        parts=parts,
        poses={part: poses[part] for part in parts},
        gaze=(_over(poses), poses[model.settings.tool_frame][:, :3, 3]),
    )


def _over(poses: Mapping[str, Array]) -> Array:
    """Return a point over the highest link and ahead of the base, shape (t, 3) [m]."""
    base = next(iter(poses.values()))  # the first link carries all others
    top = np.max([T[:, 2, 3] for T in poses.values()], axis=0)
    at = base[:, :3, 3] + AHEAD_M * base[:, :3, 0]
    return np.column_stack([at[:, :2], top + OVER_M])


def mesh_of(item: SceneObject) -> Trimesh:
    """Return the mesh of an object in its own frame."""
    return object_mesh(item.shape, item.size_m)


def turns(film: Film) -> list[tuple[str, slice]]:
    """Return the objects in the order of their turns, each with its frames."""
    starts = np.flatnonzero(np.diff(film.moving, prepend=-2)).tolist()
    frames = [slice(*ends) for ends in pairwise([*starts, len(film.moving)])]
    names = [(int(film.moving[part.start]), part) for part in frames]
    return [(film.objects[k], part) for k, part in names if k >= 0]


def phases(film: Film) -> list[tuple[float, int, str]]:
    """Return each phase with its start [s] and the number of its object."""
    found: list[tuple[float, int, str]] = []
    rows = zip(film.time_s.tolist(), film.moving.tolist(), film.phase, strict=True)
    for time, moving, phase in rows:
        if not found or found[-1][1:] != (moving, phase):
            found.append((time, moving, phase))
    return found


def half_height(item: SceneObject, T_world_object: Array) -> float:
    """Return how far the top of an object's box is above its centre [m]."""
    return float(np.abs(rigid.matrix(T_world_object[:4]))[2] @ item.size_m) / 2

"""The entities of a plan: the robot, what it moves, what was tried, where it drove.

All that changes is on the timeline `plan_time`. The numbers here only steer how things
look and how large files get.
"""

from collections.abc import Iterable

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from rerun.components import FillMode
from scipy.spatial.transform import Rotation
from trimesh import Trimesh

from placing.pictures.shading import face_colours
from placing.recordings.blueprint import Eye
from placing.recordings.entities import AMBIENT, LIGHT
from placing.recordings.joint_entities import (
    category_color,
    log_areas,
    log_cloud,
    shaded_mesh,
)
from placing.recordings.plan import (
    PlanRecording,
    Tried,
    half_height,
    mesh_of,
    turns,
)
from placing.recordings.plan_words import POSSIBLE, colour_of, moments, story
from placing.recordings.strips import strips
from placing.robot.posing import vectors

Array = NDArray[np.float64]

TIMELINE = "plan_time"
EYE = "world/eye"
"""What looks from the robot's head at its hand."""
EYE_DEG = 60.0
"""Its angle of view."""
STILL_M = 1e-6
"""What moves less between two frames stands still."""
WAYS, WAY = (120, 128, 140), (255, 214, 102)
"""Ways of the base: all, and that of this object."""
FLOOR_M = 0.015
"""Ways are drawn so far above the floor."""
DOT_M = 0.018
"""Dots on top of placements are seen from afar, small objects are not."""
N_TRIED = 40
"""At most so many rejected placements of an object are drawn, the best ones."""


def log_plan(stream: rr.RecordingStream, content: PlanRecording, eye: Eye) -> None:
    """Log everything a plan holds."""
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    log_cloud(stream, content.cloud, eye)
    log_areas(stream, content.areas)
    log_robot(stream, content)
    log_eye(stream, content)
    log_objects(stream, content)
    log_tried(stream, content)
    log_ways(stream, content)
    text = rr.TextDocument(story(content), media_type=rr.MediaType.MARKDOWN)
    stream.log("search", text, static=True)
    for time, now in moments(content):
        stream.set_time(TIMELINE, duration=time)
        stream.log("now", rr.TextDocument(now, media_type=rr.MediaType.MARKDOWN))
    stream.reset_time()


def log_robot(stream: rr.RecordingStream, content: PlanRecording) -> None:
    """Log the robot's parts, each with its own way through the world."""
    for part, mesh in content.parts.items():
        path = f"world/robot/{part}"
        stream.log(path, lit_mesh(mesh), static=True)
        xyz, xyzw = vectors(content.poses[part])
        send_poses(stream, path, content.film.time_s, xyz, xyzw)


def log_eye(stream: rr.RecordingStream, content: PlanRecording) -> None:
    """Log a camera over the robot's head that always looks at what the hand does."""
    angle = np.deg2rad(EYE_DEG)
    lens = rr.Pinhole(fov_y=angle, aspect_ratio=1.8, image_plane_distance=0.001)
    stream.log(EYE, lens, static=True)
    at, target = content.gaze
    ahead = target - at
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    turn = np.stack([right, np.cross(ahead, right), ahead], axis=2)  # (t, 3, 3)
    xyzw = Rotation.from_matrix(turn).as_quat()
    send_poses(stream, EYE, content.film.time_s, at, xyzw)


def log_objects(stream: rr.RecordingStream, content: PlanRecording) -> None:
    """Log each object from when it is somewhere, and those that nobody moves."""
    film = content.film
    for k, name in enumerate(film.objects):
        path, T = f"world/objects/{name}", film.T_world_objects[:, k]
        there = np.flatnonzero(np.isfinite(T[:, 0]))
        stream.set_time(TIMELINE, duration=float(film.time_s[there[0]]))
        stream.log(path, _object_mesh(content, name))
        T, time = T[there], film.time_s[there]
        send_poses(stream, path, time, T[:, 4:], T[:, [1, 2, 3, 0]])
    stream.reset_time()
    for name, T in content.standing.items():
        path = f"world/standing/{name}"
        stream.log(path, _object_mesh(content, name), static=True)
        turn = rr.Quaternion(xyzw=T[[1, 2, 3, 0]])
        at = rr.Transform3D(translation=T[4:], quaternion=turn)
        stream.log(path, at, static=True)


def _object_mesh(content: PlanRecording, name: str) -> rr.Mesh3D:
    """Return an object in the colour of its category, in its own frame."""
    item = content.items[name]
    return shaded_mesh(mesh_of(item), category_color(item.category))


def send_poses(
    stream: rr.RecordingStream, path: str, time_s: Array, xyz: Array, xyzw: Array
) -> None:
    """Send the poses of an entity, without those that equal the one before."""
    rows = np.concatenate([xyz, xyzw], axis=1)
    changes = np.abs(np.diff(rows, axis=0)).max(axis=1, initial=0) > STILL_M
    kept = np.flatnonzero(np.append(True, changes))
    columns = rr.Transform3D.columns(translation=xyz[kept], quaternion=xyzw[kept])
    stream.send_columns(path, [rr.TimeColumn(TIMELINE, duration=time_s[kept])], columns)


def log_tried(stream: rr.RecordingStream, content: PlanRecording) -> None:
    """Log what was tried of each object in its turn, of those refused at the end."""
    film, search = content.film, content.search
    for name, part in turns(film):
        tried = [one for one in search.tried if one.object_id == name]
        _log_boxes(stream, content, float(film.time_s[part][0]), tried)
    refused = [one for one in search.tried if one.object_id in search.refused]
    _log_boxes(stream, content, float(film.time_s[-1]), refused)


def _log_boxes(
    stream: rr.RecordingStream,
    content: PlanRecording,
    time_s: float,
    tried: Iterable[Tried],
) -> None:
    """Log placements as boxes coloured by why they were rejected, from a time on."""
    shown = [one for one in tried if one.number <= N_TRIED]
    poses = np.array([one.T_world_object for one in shown]).reshape(-1, 7)
    sizes = [content.items[one.object_id].size_m for one in shown]
    colours = np.array([colour_of(one.reason) for one in shown], np.uint8)
    boxes = rr.Boxes3D(
        centers=poses[:, 4:],
        half_sizes=np.array(sizes).reshape(-1, 3) / 2,
        quaternions=poses[:, [1, 2, 3, 0]],
        colors=colours,
        labels=[f"{one.object_id}: {one.reason or POSSIBLE}" for one in shown],
        show_labels=False,
        fill_mode=FillMode.MajorWireframe,
        radii=0.003,
    )
    stream.set_time(TIMELINE, duration=time_s)
    stream.log("world/tried/boxes", boxes)
    above = poses[:, 4:] + np.array([0, 0, 1]) * np.array(
        [half_height(content.items[o.object_id], o.T_world_object) for o in shown]
    ).reshape(-1, 1)
    dots = rr.Points3D(above, colors=colours, radii=DOT_M)
    stream.log("world/tried/dots", dots)
    stream.reset_time()


def log_ways(stream: rr.RecordingStream, content: PlanRecording) -> None:
    """Log the ways of the base on the floor, and that of each object in its turn."""
    film, floor = content.film, _floor_m(content)
    ways = []
    for _, part in turns(film):
        ways.append(np.insert(film.q[part, :2], 2, floor + FLOOR_M, axis=1))
        line = rr.LineStrips3D(strips(ways[-1:]), colors=WAY, radii=0.012)
        stream.set_time(TIMELINE, duration=float(film.time_s[part][0]))
        stream.log("world/ways/now", line)
    stream.reset_time()
    lines = rr.LineStrips3D(strips(ways), colors=WAYS, radii=0.005)
    stream.log("world/ways/all", lines, static=True)


def _floor_m(content: PlanRecording) -> float:
    """Return the height of the floor."""
    heights = [area.height_m for area in content.areas if area.is_floor]
    return min(heights, default=0.0)


def lit_mesh(mesh: Trimesh) -> rr.Mesh3D:
    """Return a mesh whose faces keep their colours, shaded as if lit from above."""
    light = np.array(LIGHT) / np.linalg.norm(LIGHT)
    shade = AMBIENT + (1 - AMBIENT) * np.abs(mesh.face_normals @ light)
    colours = (face_colours(mesh)[:, :3] * shade[:, None]).astype(np.uint8)
    # Corners are shared by the faces around them that have the same colour.
    packed = colours.astype(np.int64) @ [1 << 16, 1 << 8, 1]
    keys = mesh.faces.astype(np.int64) * (1 << 24) + packed[:, None]
    corners, triangles = np.unique(keys.ravel(), return_inverse=True)
    shown = corners % (1 << 24)
    return rr.Mesh3D(
        vertex_positions=mesh.vertices[corners >> 24],
        triangle_indices=triangles.reshape(-1, 3),
        vertex_colors=np.column_stack([shown >> 16, shown >> 8 & 255, shown & 255]),
    )

"""How a room is seen in a picture: from which corner, and with which walls.

The walls between camera and room are left out, and the room is seen from the corner
that hides least.
"""

import numpy as np
import trimesh
from manifold3d import CrossSection, JoinType, Manifold
from numpy.typing import NDArray

from placing import rigid
from placing.dressing import WALLS, Meshes, meshes_of
from placing.pictures.cameras import Camera, corners_of, framing
from placing.pictures.shading import face_colours, joined
from placing.scene import Furniture, Layout
from placing.shapes.building import WALL_M
from placing.shapes.solids import mesh_of, painted

Array = NDArray[np.float64]

BESIDE_M = 0.3
"""Faces this close to the line of a wall belong to it."""
ON_WALLS = ("picture", "whiteboard")
"""Furniture that is drawn only with the wall that it hangs on."""
PALE, PLATE_M = 0.45, 0.05
"""White in the floor of pictures, and thickness of the plate below walls left out."""
CORNERS_DEG = (50.0, 130.0, 230.0, 310.0)
"""Headings from which a room can be seen."""
ELEVATION_DEG = 52.0
"""How far above the floor of the room its camera is."""


def room_camera(layout: Layout, size: tuple[int, int]) -> Camera:
    """Return the camera that sees the room from the corner that hides least."""
    low, high = np.min(layout.outline_m, axis=0), np.max(layout.outline_m, axis=0)
    corners = corners_of(np.append(low, 0.0), np.append(high, layout.height_m))
    cameras = [framing(corners, a, ELEVATION_DEG, size, 34.0) for a in CORNERS_DEG]
    hidden = [_hidden(layout, camera) for camera in cameras]
    best = cameras[int(np.argmin(hidden))]

    eye = np.asarray(best.eye)
    near = [_is_near(layout.outline_m, k, eye) for k in range(len(layout.outline_m))]
    drawn = [c for c in corners if c[2] == 0 or not _on_near(layout, near, c[:2])]
    azimuth = CORNERS_DEG[int(np.argmin(hidden))]
    return framing(np.array(drawn), azimuth, ELEVATION_DEG, size, 34.0, 0.04)


def seen_meshes(
    layout: Layout, camera: Camera, meshes: Meshes | None = None
) -> list[trimesh.Trimesh]:
    """Return walls, cut open towards the camera, and the furniture that it sees.

    `meshes` of the layout may be given, so that several views share them.
    """
    found = meshes_of(layout) if meshes is None else meshes
    walls = cut_away(found[WALLS], layout.outline_m, np.array(camera.eye))
    return [walls, *(found[name] for name in seen_furniture(layout, camera))]


def _hidden(layout: Layout, camera: Camera) -> float:
    """Return how much furniture stands with its back to the camera."""
    axis = np.subtract(camera.eye, camera.target)[:2]
    axis /= np.linalg.norm(axis)
    facing = [_weight(item) * float(_front(item) @ axis) for item in layout.furniture]
    return -sum(facing)


def _weight(item: Furniture) -> float:
    """Return the area of the back of a piece of furniture, more where it hangs [m2]."""
    lift = 1.0 + 2.0 * min(float(item.T_world_furniture[6]), 1.0)
    return item.size_m[1] * item.size_m[2] * lift


def _front(item: Furniture) -> Array:
    """Return the direction that furniture faces on the floor, shape (2,)."""
    return rigid.matrix(item.T_world_furniture[:4])[:2, 0]


def _on_near(layout: Layout, near: list[bool], corner: Array) -> bool:
    """Return whether only near walls meet at a corner of the box around the outline."""
    distance = np.linalg.norm(layout.outline_m - corner, axis=1)
    k = int(np.argmin(distance))
    return distance[k] < 1e-9 and near[k] and near[k - 1]


def _is_near(outline_m: Array, wall: int, eye: Array) -> bool:
    """Return whether the camera is on the outer side of a wall."""
    start, end = outline_m[wall], outline_m[(wall + 1) % len(outline_m)]
    along, to_eye = end - start, eye[:2] - start
    return bool(along[0] * to_eye[1] - along[1] * to_eye[0] < 0)


def cut_away(walls: trimesh.Trimesh, outline_m: Array, eye: Array) -> trimesh.Trimesh:
    """Return the walls without those between the camera and the room."""
    centre = walls.triangles_center
    distance = np.stack(
        [
            _distance(centre[:, :2], start, end)
            for start, end in zip(
                outline_m, np.roll(outline_m, -1, axis=0), strict=True
            )
        ],
        axis=1,
    )  # (t, walls)
    near = np.array([_is_near(outline_m, k, eye) for k in range(len(outline_m))])
    is_wall = (walls.triangles[:, :, 2].max(axis=1) > 1e-6) & (
        distance.min(1) < BESIDE_M
    )
    keep = ~(is_wall & near[distance.argmin(axis=1)])
    colours = face_colours(walls).copy()
    is_floor = walls.triangles[:, :, 2].max(axis=1) < 1e-6
    colours[is_floor, :3] = PALE * 255 + (1 - PALE) * colours[is_floor, :3]
    rest = trimesh.Trimesh(
        walls.vertices, walls.faces[keep], face_colors=colours[keep], process=False
    )
    return joined([rest, _ground_plan(outline_m)])


def _ground_plan(outline_m: Array) -> trimesh.Trimesh:
    """Return a thin plate below floor and walls: it shows where walls are left out."""
    outer = CrossSection([outline_m]).offset(WALL_M, JoinType.Miter, 10.0)
    plate = painted(Manifold.extrude(outer, PLATE_M), "#cfc9be")
    low, high = np.reshape(plate.manifold.bounding_box(), (2, 3))
    mesh = mesh_of(plate, tuple(high - low))
    mesh.apply_translation([*(low + high)[:2] / 2, -PLATE_M / 2 - 1e-3])
    return mesh


def anchor_of(mesh: trimesh.Trimesh) -> Array:
    """Return the point of a mesh nearest to the middle of its top, shape (3,) [m]."""
    low, high = mesh.bounds
    top = np.append((low + high)[:2] / 2, high[2])
    points = np.concatenate([mesh.triangles_center, mesh.vertices])
    return points[np.argmin(np.linalg.norm(points - top, axis=1))]


def seen_furniture(layout: Layout, camera: Camera) -> list[str]:
    """Return the ids of furniture without pictures on walls that are left out."""
    eye, outline = np.asarray(camera.eye), layout.outline_m
    ends = list(zip(outline, np.roll(outline, -1, axis=0), strict=True))
    seen = []
    for item in layout.furniture:
        place = item.T_world_furniture[None, 4:6]
        wall = int(np.argmin([_distance(place, *end)[0] for end in ends]))
        if item.kind not in ON_WALLS or not _is_near(outline, wall, eye):
            seen.append(item.furniture_id)
    return seen


def _distance(points: Array, start: Array, end: Array) -> Array:
    """Return the distance of points to a segment, shape (n,) [m]."""
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - start - share[:, None] * along, axis=1)

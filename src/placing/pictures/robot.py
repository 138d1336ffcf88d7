"""What a robot looks like: the meshes of its description, in quiet colours.

Shapes: t frames.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh import Trimesh

from placing.pictures.shading import joined
from placing.robot.model import RobotModel
from placing.robot.posing import link_poses_over, part_of
from placing.robot.settings import RobotSettings
from placing.robot.urdf import Shape, read_visuals

Array = NDArray[np.float64]

SMALLEST_M = 0.03
"""Boxes and cylinders below this size only mark where a frame is."""
BODY, JOINT, DARK, TIP = (226, 228, 230), (176, 182, 189), (86, 92, 100), (40, 44, 50)
"""White covers, grey joints, dark wheels and grippers."""
COLOURS = {
    "wheel": TIP,
    "caster": DARK,
    "finger": TIP,
    "gripper": DARK,
    "elbow": JOINT,
    "wrist": JOINT,
    "shoulder_pan": JOINT,
    "shoulder_lift": JOINT,
    "roll": JOINT,
    "laser": DARK,
    "stereo": DARK,
}
"""By a part of a link's name, the first that is found."""


def part_meshes(model: RobotModel) -> dict[str, Trimesh]:
    """Return the mesh of each part that moves as one, in the frame of its first link.

    Links whose meshes are of a kind that cannot be read show their collision shapes.
    """
    at_rest = np.zeros((1, 4 + model.n_arm))
    poses = {
        link: T[0] for link, T in link_poses_over(model, at_rest, np.zeros(1)).items()
    }
    first, meshes = part_of(model), link_meshes(model)
    found: dict[str, list[Trimesh]] = {}
    for link, mesh in meshes.items():
        part = first[link]
        T_part_link = np.linalg.inv(poses[part]) @ poses[link]
        found.setdefault(part, []).append(mesh.copy().apply_transform(T_part_link))
    return {part: joined(pieces) for part, pieces in found.items()}


def link_meshes(model: RobotModel) -> dict[str, Trimesh]:
    """Return the mesh of each link that has one, in the frame of the link."""
    seen = read_visuals(model.settings.urdf, _folder(model.settings))
    shapes = [shape for shape in seen if _is_readable(shape)]
    covered = {shape.link for shape in shapes}
    shapes += [s for s in model.description.shapes if s.link not in covered]
    found: dict[str, list[Trimesh]] = {}
    for shape in shapes:
        if shape.mesh is not None or max(shape.size) >= SMALLEST_M:
            found.setdefault(shape.link, []).append(_mesh(shape))
    return {link: joined(pieces) for link, pieces in found.items()}


def posed(parts: Mapping[str, Trimesh], poses: Mapping[str, Array]) -> list[Trimesh]:
    """Return parts in the world; poses are (4, 4) by the part's first link."""
    return [mesh.copy().apply_transform(poses[part]) for part, mesh in parts.items()]


def _folder(settings: RobotSettings) -> Path:
    """Return the folder that holds all of one robot."""
    return settings.folder / settings.urdf.relative_to(settings.folder).parts[0]


def _is_readable(shape: Shape) -> bool:
    """Return whether a shape is no mesh, or one whose format is read."""
    return shape.mesh is None or shape.mesh.suffix.lower() == ".stl"


def _mesh(shape: Shape) -> Trimesh:
    """Return a shape as a coloured mesh in the frame of its link."""
    if shape.mesh is not None:
        mesh = trimesh.load_mesh(shape.mesh)
        mesh.merge_vertices()  # a file of triangles: shading needs shared corners
        mesh.apply_scale(shape.size)
    elif shape.kind == "box":
        mesh = trimesh.creation.box(shape.size)
    elif shape.kind == "cylinder":
        mesh = trimesh.creation.cylinder(shape.size[0], shape.size[1])
    else:
        mesh = trimesh.creation.icosphere(2, shape.size[0])
    colours = [colour for key, colour in COLOURS.items() if key in shape.link]
    colour = (*(colours or [BODY])[0], 255)
    painted = np.tile(np.array(colour, np.uint8), (len(mesh.faces), 1))
    plain = Trimesh(mesh.vertices, mesh.faces, face_colors=painted, process=False)
    return plain.apply_transform(shape.T_link_shape)

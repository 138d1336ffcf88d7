"""A robot as a URDF of boxes around its links, which needs no meshes and no package."""

import xml.etree.ElementTree as ET

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from placing.robot.meshes import hull_of
from placing.robot.model import RobotModel
from placing.robot.urdf import Joint

Array = NDArray[np.float64]


def box_urdf(model: RobotModel) -> str:
    """Return the text of a URDF with one box per collision shape."""
    root = ET.Element("robot", name=model.settings.robot)
    links = {name: ET.SubElement(root, "link", name=name) for name in model.links}
    for shape in model.description.shapes:
        points = hull_of(shape).points_m
        low, high = points.min(axis=0), points.max(axis=0)
        for tag in ("visual", "collision"):
            element = ET.SubElement(links[shape.link], tag)
            ET.SubElement(element, "origin", xyz=_words((low + high) / 2))
            geometry = ET.SubElement(element, "geometry")
            ET.SubElement(geometry, "box", size=_words(high - low))
    for joint in model.description.joints.values():
        _add_joint(root, joint)
    ET.indent(root, " ")
    return ET.tostring(root, encoding="unicode") + "\n"


def _add_joint(root: ET.Element, joint: Joint) -> None:
    """Add a joint with the limits that plans keep."""
    element = ET.SubElement(root, "joint", name=joint.name, type=joint.kind)
    rpy = Rotation.from_matrix(joint.T_parent_joint[:3, :3]).as_euler("xyz")
    xyz = _words(joint.T_parent_joint[:3, 3])
    ET.SubElement(element, "origin", xyz=xyz, rpy=_words(rpy))
    ET.SubElement(element, "parent", link=joint.parent)
    ET.SubElement(element, "child", link=joint.child)
    if joint.kind == "fixed":
        return
    ET.SubElement(element, "axis", xyz=_words(joint.axis))
    if joint.kind != "continuous":
        limits = {"lower": f"{joint.lower:.9g}", "upper": f"{joint.upper:.9g}"}
        # The description's efforts and speeds play no part in a plan.
        ET.SubElement(element, "limit", limits, effort="0", velocity="0")


def _words(numbers: Array) -> str:
    """Return numbers as they stand in a URDF, minus zero as zero."""
    return " ".join(f"{round(float(n), 9) + 0.0:.9g}" for n in numbers)

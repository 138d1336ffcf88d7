"""Robot descriptions (URDF, SRDF) as plain dataclasses, and nothing they can do.

A description is XML that somebody else wrote: it is refused if it is large, declares a
document type or an entity, or names a mesh outside the folder of its robot.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from placing.errors import BadInput

Array = NDArray[np.float64]

MAX_BYTES = 4_000_000
"""Guards the parser: the largest description in use has 0.2 MB."""


@dataclass(frozen=True)
class Joint:
    """What connects two links."""

    name: str
    kind: str
    """`fixed`, `revolute`, `continuous` or `prismatic`."""
    parent: str
    child: str
    T_parent_joint: Array
    """Frame of the joint at value 0, (4, 4)."""
    axis: Array
    """Unit vector in the frame of the joint, (3,)."""
    lower: float
    upper: float
    """Soft limits where the description has them [rad or m], infinite if none."""


@dataclass(frozen=True)
class Shape:
    """One shape of a link, for collisions or to be seen."""

    link: str
    kind: str
    """`mesh`, `box`, `cylinder` (along z) or `sphere`."""
    size: tuple[float, ...]
    """Scale of the mesh, edges of the box, radius and length, or radius [m]."""
    mesh: Path | None
    T_link_shape: Array
    """(4, 4)."""


@dataclass(frozen=True)
class Description:
    """The tree of links and joints of a robot."""

    file: Path
    links: tuple[str, ...]
    joints: dict[str, Joint]
    shapes: tuple[Shape, ...]


def read_urdf(path: Path, folder: Path) -> Description:
    """Return the description of a robot whose meshes lie inside `folder`."""
    root = _parse(path)
    links = tuple(_get(path, link, "name") for link in root.findall("link"))
    joints = [_joint(path, joint) for joint in root.findall("joint")]
    for joint in joints:
        for link in (joint.parent, joint.child):
            if link not in links:
                raise BadInput(
                    f"{path}: joint {joint.name!r}: unknown link {link!r}; "
                    f"expected one of {', '.join(links)}"
                )
    shapes = [shape for link in root.findall("link") for shape in _shapes(path, link)]
    shapes = [_inside(path, shape, folder) for shape in shapes]
    return Description(path, links, {j.name: j for j in joints}, tuple(shapes))


def read_visuals(path: Path, folder: Path) -> tuple[Shape, ...]:
    """Return what the links of a robot look like; meshes lie inside `folder`."""
    found = [
        shape
        for link in _parse(path).findall("link")
        for shape in _shapes(path, link, "visual")
    ]
    return tuple(_inside(path, shape, folder) for shape in found)


def read_srdf(path: Path) -> frozenset[frozenset[str]]:
    """Return the pairs of links whose collisions are not checked."""
    return frozenset(
        frozenset((_get(path, line, "link1"), _get(path, line, "link2")))
        for line in _parse(path).findall("disable_collisions")
    )


def _parse(path: Path) -> ET.Element:
    """Return the root of an XML file without declarations of its own."""
    try:
        with path.open("rb") as file:
            text = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    if len(text) > MAX_BYTES:
        raise BadInput(f"{path}: is too large, expected at most {MAX_BYTES} bytes")
    # Other encodings could hide a declaration from the search below.
    if b"\0" in text or b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise BadInput(
            f"{path}: declares a document type or entities; expected plain UTF-8 XML"
        )
    try:
        return ET.fromstring(text.decode())
    except (ET.ParseError, UnicodeDecodeError, ValueError) as error:
        raise BadInput(f"{path}: {error}; expected plain UTF-8 XML") from error


def _joint(path: Path, element: ET.Element) -> Joint:
    """Return one joint."""
    name, kind = _get(path, element, "name"), _get(path, element, "type")
    if kind not in ("fixed", "revolute", "continuous", "prismatic"):
        raise BadInput(
            f"{path}: joint {name!r}: type {kind!r}; expected fixed, revolute, "
            "continuous or prismatic"
        )
    ends = [_get(path, _child(path, element, tag), "link") for tag in _ENDS]
    axis = _numbers(path, element.find("axis"), "xyz", (1.0, 0.0, 0.0))
    length = float(np.linalg.norm(axis))
    if kind != "fixed" and length < 1e-9:
        raise BadInput(f"{path}: joint {name!r}: axis 0 0 0; expected a direction")
    lower, upper = _limits(path, element, kind)
    frame, unit = _origin(path, element), np.array(axis) / max(length, 1e-9)
    return Joint(name, kind, ends[0], ends[1], frame, unit, lower, upper)


_ENDS = ("parent", "child")


def _limits(path: Path, element: ET.Element, kind: str) -> tuple[float, float]:
    """Return the narrower of hard and soft limits, infinite for a continuous joint."""
    if kind not in ("revolute", "prismatic"):
        return -np.inf, np.inf
    hard, soft = element.find("limit"), element.find("safety_controller")
    lower = [_numbers(path, hard, "lower", (0.0,))[0]]
    upper = [_numbers(path, hard, "upper", (0.0,))[0]]
    lower += _numbers(path, soft, "soft_lower_limit", ())
    upper += _numbers(path, soft, "soft_upper_limit", ())
    return max(lower), min(upper)


def _shapes(path: Path, link: ET.Element, tag: str = "collision") -> Iterator[Shape]:
    """Yield the shapes of a link, of those for collisions or of those to be seen."""
    name = _get(path, link, "name")
    for collision in link.findall(tag):
        kinds = list(_child(path, collision, "geometry"))
        kind, element = kinds[0].tag if kinds else "", kinds[0] if kinds else None
        if kind not in _SIZES:
            raise BadInput(
                f"{path}: link {name!r}: {tag} shape {kind!r}; expected one of "
                f"{', '.join(_SIZES)}"
            )
        size = [n for key in _SIZES[kind] for n in _numbers(path, element, key, _ONES)]
        mesh = Path(_get(path, kinds[0], "filename")) if kind == "mesh" else None
        yield Shape(name, kind, tuple(size), mesh, _origin(path, collision))


_ONES = (1.0, 1.0, 1.0)
_SIZES = {
    "mesh": ("scale",),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
}


def _inside(path: Path, shape: Shape, folder: Path) -> Shape:
    """Return the shape with the path of its mesh, which lies inside `folder`."""
    if shape.mesh is None:
        return shape
    name = str(shape.mesh).removeprefix("package:/").lstrip("/")
    # A package holds `<package>/robots/<robot>/...`: the folder of the robot is known,
    # so that only what follows its name is looked up.
    _, found, inner = name.partition(f"{folder.name}/")
    mesh = (folder / inner).resolve()
    if not found or not mesh.is_relative_to(folder.resolve()):
        raise BadInput(
            f"{path}: link {shape.link!r}: mesh {str(shape.mesh)!r}; expected a file "
            f"inside {folder.name}/"
        )
    if not mesh.is_file():
        raise BadInput(f"{path}: link {shape.link!r}: mesh {mesh} does not exist")
    return Shape(shape.link, shape.kind, shape.size, mesh, shape.T_link_shape)


def _origin(path: Path, element: ET.Element) -> Array:
    """Return the frame that an element gives itself, (4, 4)."""
    origin, T = element.find("origin"), np.eye(4)
    rpy = _numbers(path, origin, "rpy", (0.0, 0.0, 0.0))
    T[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()
    T[:3, 3] = _numbers(path, origin, "xyz", (0.0, 0.0, 0.0))
    return T


def _numbers(
    path: Path, element: ET.Element | None, key: str, default: tuple[float, ...]
) -> list[float]:
    """Return the numbers of an attribute, or the default if it is not given."""
    text = None if element is None else element.get(key)
    if text is None:
        return list(default)
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if not numbers or not np.isfinite(numbers).all() or len(numbers) not in (1, 3):
        raise BadInput(f"{path}: {key}={text[:60]!r}; expected 1 or 3 finite numbers")
    return numbers


def _child(path: Path, element: ET.Element, tag: str) -> ET.Element:
    """Return the first child of that name."""
    child = element.find(tag)
    if child is None:
        raise BadInput(
            f"{path}: <{element.tag} name={element.get('name')!r}>: <{tag}> is missing"
        )
    return child


def _get(path: Path, element: ET.Element, key: str) -> str:
    """Return an attribute that must be there."""
    value = element.get(key)
    if value is None:
        raise BadInput(f"{path}: <{element.tag}>: attribute {key!r} is missing")
    return value

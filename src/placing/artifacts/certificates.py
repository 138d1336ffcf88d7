"""Certificates of placed objects as JSON, their way-points as an npz file.

A folder holds those of many objects: what people read in `certificates.json`, the
way-points in `paths.npz`. What is read is checked: anything out of place is a
`BadArtifact` that names the file, the place, its value and what was expected.
"""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.formats import read_arrays, read_json, write_arrays, write_json
from placing.errors import BadArtifact
from placing.robot.certificates import (
    BASE_AND_TORSO,
    Certificate,
    Certificates,
    World,
)
from placing.robot.planning import Segment

Array = NDArray[np.float64]

DOCUMENT, PATHS = "certificates.json", "paths.npz"
LARGEST = 1e3
"""No length [m] or angle [rad] in a file is larger."""
MAX_ROWS = 10_000_000
"""Guards against damage: more way-points than any run has."""


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_certificates(
    folder: Path,
    robot: Path,
    urdf: Path,
    arm: Sequence[str],
    certificates: Sequence[Certificate],
) -> None:
    """Write certificates of the robot of a file, with its URDF and its arm's joints."""
    joints = [*BASE_AND_TORSO, *arm]
    paths = [s.path for c in certificates for s in c.segments]
    write_arrays(
        folder / PATHS, {"q": np.concatenate([np.zeros((0, len(joints))), *paths])}
    )
    document = {
        "robot": robot.stem,
        "urdf_sha256": digest_of(urdf),
        "joints": joints,
        "certificates": [_plain(certificate) for certificate in certificates],
    }
    write_json(folder / DOCUMENT, document)


def _plain(certificate: Certificate) -> dict[str, Any]:
    """Return a certificate as JSON holds it: way-points are counted."""
    segments = [
        {
            "name": segment.name,
            "n_rows": len(segment.path),
            "is_holding": bool(segment.is_holding),
            "opening_m": float(segment.opening_m),
        }
        for segment in certificate.segments
    ]
    fields = vars(certificate) | {"world": vars(certificate.world)}
    return fields | {"standing": dict(certificate.standing), "segments": segments}


def read_certificates(folder: Path) -> Certificates:
    """Read certificates, checked."""
    path = folder / DOCUMENT
    document = _mapping(path, "the document", read_json(path))
    joints = tuple(_names(path, "joints", document.get("joints")))
    if joints[:4] != BASE_AND_TORSO or len(joints) < 5:
        raise _bad(path, "joints", joints, f"{BASE_AND_TORSO} and the arm's")
    q = _rows(folder / PATHS, len(joints))
    found, n_before = [], 0
    for i, entry in enumerate(
        _list(path, "certificates", document.get("certificates"))
    ):
        certificate, n_before = _certificate(
            path, f"certificates[{i}]", entry, q, n_before
        )
        found.append(certificate)
    if n_before != len(q):
        raise _bad(folder / PATHS, "q", f"{len(q)} rows", f"{n_before} rows")
    sha = _name(path, "urdf_sha256", document.get("urdf_sha256"))
    return Certificates(
        _name(path, "robot", document.get("robot")), sha, joints, tuple(found)
    )


def _rows(path: Path, n_columns: int) -> Array:
    """Return all way-points of a folder, shape (rows, 4 + a)."""
    q = read_arrays(path, ("q",))["q"]
    if (
        q.dtype != np.float64
        or q.ndim != 2
        or q.shape[1] != n_columns
        or len(q) > MAX_ROWS
    ):
        raise _bad(path, "q", f"{q.dtype} {q.shape}", f"float64 of {n_columns} columns")
    wrong = np.argwhere(~(np.abs(q) <= LARGEST))  # true for NaN
    if len(wrong):
        i, j = wrong[0].tolist()
        raise _bad(path, f"q[{i}, {j}]", q[i, j], f"a number up to {LARGEST:g}")
    return q


def _certificate(
    path: Path, place: str, value: object, q: Array, n_before: int
) -> tuple[Certificate, int]:
    """Return a certificate and how many rows are used with it."""
    entry = _mapping(path, place, value)
    world = _mapping(path, f"{place}.world", entry.get("world"))
    fields = {k: _name(path, f"{place}.world.{k}", world.get(k)) for k in _WORLD}
    segments = []
    parts = _list(path, f"{place}.segments", entry.get("segments"))
    for i, part in enumerate(parts):
        segment, n_before = _segment(path, f"{place}.segments[{i}]", part, q, n_before)
        segments.append(segment)
    if not segments:
        raise _bad(path, f"{place}.segments", parts, "at least one")
    standing = _mapping(path, f"{place}.standing", entry.get("standing"))
    start = entry.get("T_world_start")
    return Certificate(
        World(**fields),
        _name(path, f"{place}.object_id", entry.get("object_id")),
        _name(path, f"{place}.grasp", entry.get("grasp")),
        _pose(path, f"{place}.T_tool_object", entry.get("T_tool_object")),
        None if start is None else _pose(path, f"{place}.T_world_start", start),
        _pose(path, f"{place}.T_world_object", entry.get("T_world_object")),
        {
            _name(path, f"{place}.standing", name): _pose(
                path, f"{place}.standing.{name}", T
            )
            for name, T in standing.items()
        },
        tuple(segments),
    ), n_before


_WORLD = tuple(World.__dataclass_fields__)


def _segment(
    path: Path, place: str, value: object, q: Array, n_before: int
) -> tuple[Segment, int]:
    """Return a segment and how many rows are used with it."""
    part = _mapping(path, place, value)
    n_rows: Any = part.get("n_rows")
    if type(n_rows) is not int or not 0 < n_rows <= len(q) - n_before:
        expected = f"a number from 1 to the {len(q) - n_before} rows that are left"
        raise _bad(path, f"{place}.n_rows", n_rows, expected)
    if type(part.get("is_holding")) is not bool:
        raise _bad(path, f"{place}.is_holding", part.get("is_holding"), "true or false")
    opening_m: Any = part.get("opening_m")
    if not (type(opening_m) in (int, float) and 0 <= opening_m <= 1):
        raise _bad(path, f"{place}.opening_m", opening_m, "a number from 0 to 1")
    end = n_before + n_rows
    name = _name(path, f"{place}.name", part.get("name"))
    return Segment(name, q[n_before:end], part["is_holding"], float(opening_m)), end


def _mapping(path: Path, place: str, value: object) -> Mapping[str, Any]:
    """Return `value` if it is a JSON object."""
    if isinstance(value, dict):
        return value
    raise _bad(path, place, value, "an object")


def _list(path: Path, place: str, value: object) -> list[Any]:
    """Return `value` if it is a list."""
    if isinstance(value, list):
        return value
    raise _bad(path, place, value, "a list")


def _names(path: Path, place: str, value: object) -> list[str]:
    """Return a list of names that differ."""
    names = [_name(path, place, name) for name in _list(path, place, value)]
    if len(set(names)) < len(names):
        raise _bad(path, place, value, "names that differ")
    return names


def _name(path: Path, place: str, value: object) -> str:
    """Return `value` if it is a short line."""
    if isinstance(value, str) and len(value) <= 200 and (value.isprintable()):
        return value
    raise _bad(path, place, value, "a short line of text")


def _pose(path: Path, place: str, value: object) -> Array:
    """Return a pose, shape (7,)."""
    is_pose = (
        isinstance(value, list)
        and len(value) == 7
        and all(type(v) in (int, float) and abs(v) <= LARGEST for v in value)
    )
    if is_pose and abs(np.linalg.norm(value[:4]) - 1) < 1e-6:  # type: ignore[index]
        pose = np.array(value, float)
        pose[:4] /= np.linalg.norm(pose[:4])
        return pose
    raise _bad(path, place, value, "a pose: unit quaternion wxyz and xyz")


def _bad(path: Path, place: str, value: object, expected: str) -> BadArtifact:
    """Return the error for a value, in one line."""
    text = " ".join(repr(value).split())
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    return BadArtifact(f"{path}: {place}: value {shown}; expected {expected}")

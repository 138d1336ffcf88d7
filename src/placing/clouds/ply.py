"""Point clouds as PLY files: a strict reader and an atomic writer.

Files of this project are binary and little-endian, with float x y z nx ny nz and
uchar red green blue. Ascii, big-endian, other number types, further properties and
faces, as other programs write them, are read too. Where normals are missing they are
0, where colours are missing they are grey. How soft points are is a further property,
float softness from 0 to 1 or NaN, which only some clouds have.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placing.artifacts.atomic import replacing
from placing.clouds.ply_header import Element, Header, read_header
from placing.errors import BadInput

POINT, NORMAL, COLOR = ("x", "y", "z"), ("nx", "ny", "nz"), ("red", "green", "blue")
SOFTNESS = "softness"
ROW = np.dtype([(n, "<f4") for n in POINT + NORMAL] + [(n, "u1") for n in COLOR])
MAX_COORDINATE_M = 1e4
"""Guards against files in millimetres and against damage; no room is that large."""
MAX_ASCII_BYTES = 2_000_000_000
"""Guards the memory: text takes ten times its size while it is read."""
GREY = 128


@dataclass(frozen=True)
class Cloud:
    """Points of a scanned scene."""

    points: NDArray[np.float32]
    """(n, 3) [m]."""
    normals: NDArray[np.float32]
    """(n, 3) unit vectors that point to free space; 0 where unknown."""
    colors: NDArray[np.uint8]
    """(n, 3) red, green, blue."""
    softness: NDArray[np.float32] | None = None
    """(n,) 0 hard to 1 soft, NaN where unknown; None where nothing is known of it."""

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self.points)

    def take(self, chosen: NDArray) -> "Cloud":
        """Return the points `chosen` by mask or by index."""
        rows = np.flatnonzero(chosen) if chosen.dtype == bool else chosen
        return Cloud(
            self.points.take(rows, axis=0),
            self.normals.take(rows, axis=0),
            self.colors.take(rows, axis=0),
            None if self.softness is None else self.softness.take(rows),
        )


def read_ply(path: Path) -> Cloud:
    """Return the checked point cloud of a PLY file."""
    try:
        if not path.is_file():
            what = "is no file" if path.exists() else "file is missing"
            raise BadInput(f"{path}: {what}, expected a point cloud in PLY")
        header = read_header(path)
        read = _read_ascii if header.order == "=" else _read_binary
        rows = read(path, header)
    except OSError as error:
        raise BadInput(
            f"{path}: cannot be read ({error.strerror}), expected a point cloud in PLY"
        ) from error
    return Cloud(
        _points(path, rows),
        _normals(path, rows),
        _colors(path, rows),
        _softness(path, rows),
    )


def write_ply(path: Path, cloud: Cloud) -> None:
    """Write the point cloud as binary PLY, whole or not at all."""
    soft = [] if cloud.softness is None else [(SOFTNESS, "<f4")]
    rows = np.empty(len(cloud), np.dtype(ROW.descr + soft))
    for names, values in zip(
        (POINT, NORMAL, COLOR), (cloud.points, cloud.normals, cloud.colors), strict=True
    ):
        for k, name in enumerate(names):
            rows[name] = values[:, k]
    kinds = [f"property float {name}\n" for name in POINT + NORMAL]
    kinds += [f"property uchar {name}\n" for name in COLOR]
    if cloud.softness is not None:
        rows[SOFTNESS] = cloud.softness
        kinds.append(f"property float {SOFTNESS}\n")
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
    with replacing(path) as part, part.open("wb") as file:
        file.write((head + "".join(kinds) + "end_header\n").encode())
        file.write(rows.tobytes())


def _read_binary(path: Path, header: Header) -> NDArray:
    """Return the rows of the vertices after comparing all sizes with the file."""
    position, n_bytes, rows_at = header.n_bytes, path.stat().st_size, 0
    for element in header.elements:
        row = element.row_type(header.order)
        if element.name == "vertex":
            rows_at = position
        end = position + element.n_rows * row.itemsize
        if end > n_bytes:
            raise BadInput(
                f"{path}: element {element.name} promises {element.n_rows} rows of at"
                f" least {row.itemsize} bytes, expected no more than the"
                f" {n_bytes - position} bytes left"
            )
        if element.has_lists:
            position = _skip_lists(path, header.order, element, position)
        else:
            position = end
    if position != n_bytes:
        raise BadInput(
            f"{path}: field size is {n_bytes} bytes, expected {position} by its header"
        )
    vertex = next(e for e in header.elements if e.name == "vertex")
    row = vertex.row_type(header.order)
    return np.fromfile(path, row, vertex.n_rows, offset=rows_at)


def _skip_lists(path: Path, order: str, element: Element, position: int) -> int:
    """Return where the rows of an element with lists end."""
    data = np.fromfile(path, np.uint8, offset=position)
    sizes = [
        (
            np.dtype(order + (p.length_type or p.item_type)),
            np.dtype(p.item_type).itemsize,
        )
        for p in element.properties
    ]
    is_list = [p.length_type is not None for p in element.properties]
    at = 0
    for k in range(element.n_rows):
        for (head, item_bytes), has_items in zip(sizes, is_list, strict=True):
            length = data[at : at + head.itemsize]
            at += head.itemsize
            if has_items and len(length) == head.itemsize:
                n_items = int(length.view(head)[0])
                at += max(n_items, 0) * item_bytes
                at = at if n_items >= 0 else len(data) + 1
        if at > len(data):
            raise BadInput(
                f"{path}: element {element.name} row {k} reaches beyond the file,"
                f" expected {element.n_rows} rows in {len(data)} bytes"
            )
    return position + at


def _read_ascii(path: Path, header: Header) -> NDArray:
    """Return the rows of the vertices of a PLY file in ascii."""
    if (n_bytes := path.stat().st_size) > MAX_ASCII_BYTES:
        raise BadInput(
            f"{path}: field size is {n_bytes} bytes of ascii, expected at most"
            f" {MAX_ASCII_BYTES}; binary files may be larger"
        )
    with path.open("rb") as file:
        file.seek(header.n_bytes)
        lines = file.read().splitlines()
    n_lines = sum(e.n_rows for e in header.elements)
    while len(lines) > n_lines and not lines[-1].strip():
        lines.pop()
    if len(lines) != n_lines:
        raise BadInput(
            f"{path}: field lines is {len(lines)}, expected {n_lines} of data"
        )
    names = [e.name for e in header.elements]
    vertex = header.elements[names.index("vertex")]
    first = sum(e.n_rows for e in header.elements[: names.index("vertex")])
    words = b" ".join(lines[first : first + vertex.n_rows]).split()
    try:
        table = np.array(words, float).reshape(vertex.n_rows, len(vertex.properties))
    except ValueError:
        raise BadInput(
            f"{path}: element vertex has other than numbers or rows of another length,"
            f" expected {len(vertex.properties)} numbers a line"
        ) from None
    rows = np.empty(vertex.n_rows, [(p.name, "f8") for p in vertex.properties])
    for k, p in enumerate(vertex.properties):
        rows[p.name] = table[:, k]
    return rows


def _points(path: Path, rows: NDArray) -> NDArray[np.float32]:
    """Return the checked coordinates, shape (n, 3) [m]."""
    if missing := [name for name in POINT if name not in (rows.dtype.names or ())]:
        raise BadInput(f"{path}: property {missing[0]} is missing, expected x, y and z")
    return _columns(path, rows, POINT, -MAX_COORDINATE_M, MAX_COORDINATE_M)


def _normals(path: Path, rows: NDArray) -> NDArray[np.float32]:
    """Return the normals, 0 where the file has none, shape (n, 3)."""
    if not set(NORMAL) <= set(rows.dtype.names or ()):
        return np.zeros((len(rows), 3), np.float32)
    return _columns(path, rows, NORMAL, -1.01, 1.01)


def _colors(path: Path, rows: NDArray) -> NDArray[np.uint8]:
    """Return the colours, grey where the file has none, shape (n, 3)."""
    if not set(COLOR) <= set(rows.dtype.names or ()):
        return np.full((len(rows), 3), GREY, np.uint8)
    return _columns(path, rows, COLOR, 0.0, 255.0).astype(np.uint8)


def _softness(path: Path, rows: NDArray) -> NDArray[np.float32] | None:
    """Return the softness, NaN where unknown, None without the property, shape (n,)."""
    if SOFTNESS not in (rows.dtype.names or ()):
        return None
    known = np.where(np.isnan(rows[SOFTNESS]), 0, rows[SOFTNESS])
    checked = _columns(path, {SOFTNESS: known}, (SOFTNESS,), 0.0, 1.0)[:, 0]
    return np.where(np.isnan(rows[SOFTNESS]), np.float32(np.nan), checked)


def _columns(
    path: Path,
    rows: NDArray | dict[str, NDArray],
    names: tuple[str, ...],
    low: float,
    high: float,
) -> NDArray[np.float32]:
    """Return columns side by side, all from `low` to `high`, shape (n, columns)."""
    table = np.empty((len(rows[names[0]]), len(names)), np.float32)
    for k, name in enumerate(names):
        column = rows[name]
        is_bad = ~((column >= low) & (column <= high))  # NaN compares as False.
        if is_bad.any():
            row = int(is_bad.argmax())
            raise BadInput(
                f"{path}: property {name} of vertex {row} is {column[row]},"
                f" expected a number from {low:g} to {high:g}"
            )
        table[:, k] = column
    return table

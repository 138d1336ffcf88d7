"""Header of a PLY file: parsed and checked before a single byte of data is read.

Libraries trust the header: one that promises ten million vertices above ten of them
gets ten million, uninitialised. Here every count is compared with the bytes there are.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placing.errors import BadInput

MAX_HEADER_BYTES = 1 << 16
MAX_POINTS = 50_000_000
"""Guards against headers that promise more than memory holds."""

FORMATS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": "="}
TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2"},
    **{"int": "i4", "uint": "u4", "float": "f4", "double": "f8"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"},
    **{"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"},
}
LENGTHS = {name: kind for name, kind in TYPES.items() if kind[0] in "iu"}
"""Types that can count the items of a list."""


@dataclass(frozen=True)
class Property:
    """One property of an element."""

    name: str
    item_type: str
    """numpy name of the type without byte order, such as `f4`."""
    length_type: str | None
    """Type of the length in front of a list; None for a plain number."""


@dataclass
class Element:
    """One element, such as `vertex`, and the properties of its rows."""

    name: str
    n_rows: int
    properties: list[Property]

    @property
    def has_lists(self) -> bool:
        """Tell whether rows differ in length."""
        return any(p.length_type for p in self.properties)

    def row_type(self, order: str) -> np.dtype:
        """Return the type of a row; of a list only its length counts."""
        kinds = [
            (p.name, order + (p.length_type or p.item_type)) for p in self.properties
        ]
        return np.dtype(kinds)


@dataclass(frozen=True)
class Header:
    """What the header of a PLY file promises."""

    order: str
    """Byte order in the notation of numpy; `=` for ascii."""
    elements: list[Element]
    n_bytes: int
    """Length of the header, where the data begin."""


def read_header(path: Path) -> Header:
    """Return the checked header of a PLY file."""
    with path.open("rb") as file:
        start = file.read(MAX_HEADER_BYTES)
    if not start.startswith((b"ply\n", b"ply\r\n")):
        raise BadInput(
            f"{path}: field magic is {start[:4]!r}, expected 'ply' and a line"
        )
    end = start.find(b"end_header")
    newline = start.find(b"\n", end)
    if end < 0 or newline < 0:
        raise BadInput(
            f"{path}: field header has no end_header in {len(start)} bytes,"
            f" expected one in the first {MAX_HEADER_BYTES}"
        )
    lines = start[:end].decode("ascii", "replace").splitlines()[1:]
    order, elements = _parse(path, lines)
    _check(path, elements)
    return Header(order, elements, newline + 1)


def _parse(path: Path, lines: list[str]) -> tuple[str, list[Element]]:
    """Return byte order and elements the lines of a header speak of."""
    order, elements = "", []
    for line in lines:
        match line.split():
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", name, "1.0"] if name in FORMATS and not order:
                order = FORMATS[name]
            case ["element", name, count] if count.isascii() and count.isdigit():
                elements.append(Element(name, int(count[:20]), []))
            case ["property", "list", n, t, name] if n in LENGTHS and t in TYPES:
                _add(path, elements, Property(name, TYPES[t], TYPES[n]))
            case ["property", t, name] if t in TYPES:
                _add(path, elements, Property(name, TYPES[t], None))
            case _:
                raise BadInput(
                    f"{path}: header line {line[:60]!r} is not understood,"
                    " expected format, element, property or comment"
                )
    if not order:
        raise BadInput(
            f"{path}: field format is missing, expected {', '.join(FORMATS)}"
        )
    return order, elements


def _add(path: Path, elements: list[Element], new: Property) -> None:
    """Append a property to the last element."""
    if not elements or new.name in [p.name for p in elements[-1].properties]:
        raise BadInput(
            f"{path}: property {new.name[:60]!r} stands before an element or twice,"
            " expected once below its element"
        )
    elements[-1].properties.append(new)


def _check(path: Path, elements: list[Element]) -> None:
    """Refuse headers without vertices, or with too many."""
    names = [e.name for e in elements]
    if names.count("vertex") != 1:
        raise BadInput(f"{path}: field element is {names}, expected one named vertex")
    vertex = elements[names.index("vertex")]
    if not 0 < vertex.n_rows <= MAX_POINTS:
        raise BadInput(
            f"{path}: element vertex is {vertex.n_rows}, expected 1 to {MAX_POINTS}"
        )
    if vertex.has_lists or any(e.has_lists for e in elements[: names.index("vertex")]):
        raise BadInput(
            f"{path}: element vertex holds or follows a list property,"
            " expected plain numbers"
        )
    if empty := [e.name for e in elements if not e.properties]:
        raise BadInput(
            f"{path}: element {empty[0]} has no property, expected at least 1"
        )

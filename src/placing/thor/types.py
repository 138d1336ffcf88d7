"""What becomes of each type of thing that designers put into their rooms."""

from dataclasses import dataclass
from pathlib import Path

from placing.errors import BadInput
from placing.sheets import read_lines

COLUMNS = ["object_type", "role", "shape_kind", "category", "has_front", "note"]
ROLES = ("furniture", "object", "part", "left_out")


@dataclass(frozen=True)
class ThorType:
    """What becomes of the things of one type."""

    role: str
    """furniture, object, part (of other furniture) or left_out."""
    shape: str
    category: str
    has_front: bool


def read_types(path: Path) -> dict[str, ThorType]:
    """Return what becomes of each type of thing."""
    lines = read_lines(path, COLUMNS)
    for line, row in lines:
        if row["role"] not in ROLES:
            what = f"{path}: line {line}: role: value {row['role']!r}"
            raise BadInput(f"{what}; expected one of {', '.join(ROLES)}")
    return {
        row["object_type"]: ThorType(
            row["role"], row["shape_kind"], row["category"], row["has_front"] == "True"
        )
        for _, row in lines
    }

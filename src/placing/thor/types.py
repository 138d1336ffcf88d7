"""What becomes of each type of thing that designers put into their rooms."""

import csv
from dataclasses import dataclass
from pathlib import Path

from placing.errors import BadInput

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
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}; expected a table") from None
    missing = {"object_type", "role", "shape_kind", "category", "has_front"}
    missing -= set(rows[0] if rows else ())
    if missing:
        raise BadInput(f"{path}: lacks {', '.join(sorted(missing))}; expected columns")
    for row in rows:
        if row["role"] not in ROLES:
            what = f"{path}: role of {row['object_type']} is {row['role']!r}"
            raise BadInput(f"{what}; expected one of {', '.join(ROLES)}")
    return {
        row["object_type"]: ThorType(
            row["role"], row["shape_kind"], row["category"], row["has_front"] == "True"
        )
        for row in rows
    }

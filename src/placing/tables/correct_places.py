"""The table of correct places: what may stand on which kind of surface in which room.

Two sheets that people wrote: one groups what furniture offers into kinds of surface,
the other says of each category where it belongs. No method reads either of them.
"""

from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import product
from math import inf
from pathlib import Path
from typing import Any

from placing.errors import BadInput, unknown
from placing.shapes.furniture import FURNITURE
from placing.sheets import read_sheet

ROOMS = ("office", "kitchen", "livingroom", "bedroom", "apartment")
# ASSUME: an apartment is a kind of room of its own: all of its parts count, and its
# furniture (stove, bed, couch) tells them apart.
FLOOR, HUNG = "floor", "hung"
"""What is no furniture but carries, and what hangs in furniture without a patch."""
ANY, NOTHING = "any", "nothing"
TEXT = {"type": "string", "minLength": 1}


@dataclass(frozen=True)
class SupportRule:
    """Which kind of surface a patch of furniture is, below a height."""

    furniture: str
    patch: str
    """Name of a support of the shape; `*` stands for any letters."""
    below_m: float
    """Upper end of the heights in the world that the rule is for; may be `inf`."""
    support: str


@dataclass(frozen=True)
class PlaceRow:
    """One decision with its source."""

    category: str
    support: str
    room: str
    is_correct: bool
    source: str


@dataclass(frozen=True)
class CorrectPlaces:
    """The whole table."""

    rules: tuple[SupportRule, ...]
    rows: dict[tuple[str, str, str], PlaceRow]
    """By category, support and room."""

    def support(self, furniture: str, patch: str, height_m: float) -> str:
        """Return the kind of surface a patch is: the first rule that fits."""
        for rule in self.rules:
            is_patch = rule.furniture == furniture and fnmatchcase(patch, rule.patch)
            if is_patch and height_m < rule.below_m:
                return rule.support
        raise BadInput(
            f"supports: no row for patch {patch!r} of {furniture!r} at"
            f" {height_m:.2f} m; expected one"
        )

    def decision(self, category: str, support: str, room: str) -> PlaceRow:
        """Return the row that decides; the kind of surface counts before the room."""
        if room not in ROOMS:
            raise unknown("room", room, list(ROOMS))
        if support == NOTHING:
            source = "stands on no furniture and not on the floor"
            return PlaceRow(category, NOTHING, room, False, source)
        for key in product((category,), (support, ANY), (room, ANY)):
            if key in self.rows:
                return self.rows[key]
        raise BadInput(
            f"no row for category {category!r}, support {support!r}, room {room!r};"
            f" expected one, or one for {ANY!r}"
        )


def read_correct_places(
    places: Path, supports: Path, categories: list[str]
) -> CorrectPlaces:
    """Return the table of both sheets, in which every combination is decided."""
    rules = _read_rules(supports)
    groups = list(dict.fromkeys(rule.support for rule in rules))
    columns = {
        "category": {"enum": categories},
        "support": {"enum": [ANY, *groups]},
        "room": {"enum": [ANY, *ROOMS]},
        "is_correct": {"enum": ["True", "False"]},
        "source": TEXT,
    }
    key = ("category", "support", "room")
    rows = {}
    for row in read_sheet(places, _row_of(columns), key):
        truth = row["is_correct"] == "True"
        at = row["category"], row["support"], row["room"]
        rows[at] = PlaceRow(*at, truth, row["source"])
    table = CorrectPlaces(rules, rows)
    for combination in product(categories, groups, ROOMS):
        try:
            table.decision(*combination)
        except BadInput as error:
            raise BadInput(f"{places}: {error}") from error
    return table


def _read_rules(path: Path) -> tuple[SupportRule, ...]:
    """Return the rules of the sheet of supports, in its order."""
    columns = {
        "furniture": {"enum": [FLOOR, *FURNITURE]},
        "patch": TEXT,
        "below_m": {"type": "string", "pattern": r"^([0-9]+(\.[0-9]+)?)?$"},
        "support": TEXT,
    }
    rows = read_sheet(path, _row_of(columns), ("furniture", "patch", "below_m"))
    return tuple(
        SupportRule(
            row["furniture"], row["patch"], float(row["below_m"] or inf), row["support"]
        )
        for row in rows
    )


def _row_of(columns: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON Schema of a row with these columns."""
    return {"type": "object", "required": list(columns), "properties": columns}

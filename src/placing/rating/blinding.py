"""The arrangements that people rate, under names that do not tell the method.

The name of an arrangement depends on where its objects are: answers about other
placements, from an earlier run, are found out and refused.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hashlib import blake2b

import pandas as pd

from placing.scene import Placement, SceneObject
from placing.seeds import generator
from placing.tables.table2_answers import answers_of, placements_of


@dataclass(frozen=True)
class Blinded:
    """An arrangement of one scene by one method, and its name for raters."""

    name: str
    """Eight hexadecimal digits."""
    scene: str
    method: str
    placements: tuple[Placement, ...]
    unplaced: tuple[str, ...]
    """Ids of the objects that were not placed."""


def blinded(
    joint: pd.DataFrame, objects: Mapping[str, tuple[SceneObject, ...]], seed: int
) -> tuple[Blinded, ...]:
    """Return the arrangements of all scenes, shuffled; `objects` is by scene."""
    found = []
    for scene in sorted(objects):
        for method, rows in answers_of(joint, scene, objects[scene]):
            placements = placements_of(rows)
            name = _name(seed, scene, method, placements)
            unplaced = rows.loc[~rows["is_placed"].astype(bool), "object"]
            one = Blinded(name, scene, method, placements, tuple(unplaced))
            found.append(one)
    order = generator(seed, "rate").permutation(len(found))
    return tuple(found[k] for k in order)


def key_table(arrangements: Iterable[Blinded]) -> pd.DataFrame:
    """Return which scene and method each name stands for."""
    rows = [(one.name, one.scene, one.method) for one in arrangements]
    return pd.DataFrame(rows, columns=["arrangement", "scene", "method"])


def _name(seed: int, scene: str, method: str, placements: Iterable[Placement]) -> str:
    """Return the name of an arrangement, made of its placements in millimetres."""
    placed = [
        (p.object_id, *(round(1000 * float(x)) for x in (*p.location, *p.orientation)))
        for p in placements
    ]
    text = repr((seed, scene, method, placed))
    return blake2b(text.encode(), digest_size=4).hexdigest()

"""Layouts of every data set that starts from meshes, behind one function."""

from collections.abc import Callable
from pathlib import Path

from placing.dressing import WALLS, standing_shape
from placing.rooms import reader as rooms
from placing.scene import Layout
from placing.thor import reader as thor
from placing.thor.data import find_data, read_data
from placing.thor.types import read_types


def layout_reader(
    dataset: str, folder: Path, schema: Path, catalogue: Path, types: Path
) -> Callable[[str], Layout]:
    """Return the function from the name of a scene to its layout.

    `rooms`, `scans` and `scenarios` are files of `folder` checked by `schema`, with
    objects of `catalogue`; `thor` are scenes of the installed designers' rooms, mapped
    by `types`.
    """
    if dataset in ("rooms", "scans", "scenarios"):
        return rooms.layout_reader(folder, schema, catalogue)
    data, thor_types = read_data(find_data()), read_types(types)
    return lambda name: thor.read_layout(data, name, thor_types)


def softness_of(layout: Layout) -> dict[str, float]:
    """Return how soft each mesh of a layout is by name, 0 hard to 1 soft."""
    # ASSUME: whoever scans a scene, or a classifier of appearance, tells what is
    # upholstered: all of a piece is as soft as the softest place it offers.
    soft = {WALLS: 0.0}
    for piece in layout.furniture:
        supports = standing_shape(piece).supports
        soft[piece.furniture_id] = max((s.softness for s in supports), default=0.0)
    return soft

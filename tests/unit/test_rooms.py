"""Rooms are read as written, refused in one line, and fit to be lived in."""

from collections import Counter
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import room_plan
import yaml
from likeness import likeness

from placing import rigid
from placing.errors import BadInput
from placing.rooms.catalogue import read_catalogue
from placing.rooms.reader import read_layout
from placing.scene import Layout, SceneObject
from placing.shapes.furniture import furniture_shape

ROOT = Path(__file__).parents[2]
ROOMS = sorted((ROOT / "resources/rooms").glob("*.yaml"))
SCHEMA = yaml.safe_load((ROOT / "workflow/schemas/room.schema.yaml").read_text())
CATALOGUE = read_catalogue(ROOT / "config/objects.csv")

ROOM = """
scene: den
kind: office
outline_m: [[0, 0], [4, 0], [4, 3], [0, 3]]
height_m: 2.5
openings:
  - {kind: door, wall: 0, offset_m: 3, width_m: 0.9, sill_m: 0, height_m: 2.05}
furniture:
  - {id: desk1, kind: desk, size_m: [0.8, 1.6, 0.74],
    position_m: [2, 2.5], yaw_deg: -90}
  - {id: case1, kind: bookcase, size_m: [0.3, 0.9, 1.9],
    position_m: [0.2, 1], yaw_deg: 0}
objects: [book1, mug1, plate1, book2]
arrangements:
  - labeller: ada
    habit: tidy
    placements:
      book1: {on: desk1, position_m: [2, 2.5], yaw_deg: -90}
      mug1: {on: book1, position_m: [2.02, 2.5], yaw_deg: 30}
      plate1: {on: floor, position_m: [3, 1], yaw_deg: 0}
      book2: {on: case1, level: 2, position_m: [0.2, 1], yaw_deg: 90, stance: edge}
"""


def read(tmp_path: Path, text: str = ROOM) -> Layout:
    """Return the layout of a room file with this text."""
    path = tmp_path / "den.yaml"
    path.write_text(text)
    return read_layout(path, CATALOGUE, SCHEMA)


@pytest.fixture(scope="module")
def layouts() -> list[Layout]:
    """Return all rooms of the study."""
    return [read_layout(path, CATALOGUE, SCHEMA) for path in ROOMS]


def test_height_follows_from_what_carries_an_object(tmp_path: Path) -> None:
    placed = {p.object_id: p for p in read(tmp_path).arrangements[0].placements}
    book, mug = CATALOGUE["book1"].size_m[2], CATALOGUE["mug1"].size_m[2]
    assert placed["book1"].location == pytest.approx([2, 2.5, 0.74 + book / 2])
    assert placed["mug1"].location == pytest.approx([2.02, 2.5, 0.74 + book + mug / 2])
    assert placed["plate1"].location[2] == CATALOGUE["plate1"].size_m[2] / 2
    assert [p.area for p in placed.values()] == ["desk1", "book1", "floor", "case1"]


def test_a_book_on_edge_is_as_high_as_it_is_deep(tmp_path: Path) -> None:
    layout = read(tmp_path)
    placement = layout.arrangements[0].placements[3]
    shelf = furniture_shape("bookcase", (0.3, 0.9, 1.9)).supports
    boards = sorted({support.height_m for support in shelf})
    half_depth = CATALOGUE["book2"].size_m[0] / 2
    assert placement.location[2] == pytest.approx(boards[1] + half_depth)
    up = rigid.matrix(placement.orientation) @ [1, 0, 0]
    assert up == pytest.approx([0, 0, 1])


def test_an_object_without_level_is_on_the_highest_one_below_it(tmp_path: Path) -> None:
    text = ROOM.replace("level: 2, ", "")
    assert read(tmp_path, text).arrangements[0].placements[3].location[2] > 1.9
    couch = "kind: couch, size_m: [0.9, 1.6, 0.8]"
    text = ROOM.replace("kind: desk, size_m: [0.8, 1.6, 0.74]", couch)
    location = read(tmp_path, text).arrangements[0].placements[0].location
    assert location[2] == pytest.approx(0.44 + CATALOGUE["book1"].size_m[2] / 2)


MISTAKES = {
    "kind: office\n": ("kind: cave\n", "kind: value 'cave'; expected one of"),
    "scene: den": ("scene: lair", "scene is 'lair', expected 'den'"),
    "height_m: 2.5": (
        "height_m: 1.5",
        "height_m: value 1.5; expected number at least 2",
    ),
    "size_m: [0.8, 1.6": (
        "size_m: [0.8, big",
        "furniture[desk1].size_m[1]: value 'big'; expected number",
    ),
    "yaw_deg: 30}": ("yaw_deg: .inf}", ".inf is not a finite number"),
    "habit: tidy": ("habit: tidy\n    habit: tall", "key 'habit' is given twice"),
    "[[0, 0], [4, 0]": ("[[4, 0], [0, 0]", "expected a polygon that is simple"),
    "[4, 0], [4, 3], [0, 3]]": (
        "[0, 3], [4, 3], [4, 0]]",
        "expected corners counter-clockwise",
    ),
    "offset_m: 3,": ("offset_m: 3.2,", "expected it within its wall of 4.000 m"),
    "wall: 0": ("wall: 4", "openings[0].wall is 4, expected one of the walls 0 to 3"),
    "position_m: [2, 2.5], yaw_deg: -90}\n  -": (
        "position_m: [2, 2.7], yaw_deg: -90}\n  -",
        "furniture[desk1].position_m is [2.0, 2.7, 0.0], expected its footprint inside",
    ),
    "id: case1": ("id: desk1", "id 'desk1' is given twice"),
    "kind: desk": ("kind: throne", "furniture[desk1].kind: unknown furniture kind"),
    "[book1, mug1,": ("[book1, mug1, grail,", "objects has 'grail', expected one of"),
    "plate1, book2]": ("plate1]", "'book2' is not listed"),
    "mug1, plate1": ("mug1, cup, plate1", "'cup' is not placed"),
    "on: floor": (
        "on: ceiling",
        "placements.plate1.on: unknown carrier 'ceiling'",
    ),
    "level: 2": ("level: 9", "placements.book2.level is 9, expected one of the"),
    "position_m: [3, 1]": ("position_m: [5, 1]", "is [5, 1], expected it inside the"),
    "[2.02, 2.5]": ("[2.4, 2.5]", "is [2.4, 2.5], expected it above what book1 offers"),
    "book1: {on: desk1": ("book1: {on: mug1", "carry each other in a circle"),
    "stance: edge": (
        "stance: head",
        "arrangements[ada].placements.book2.stance: value 'head'; expected one of",
    ),
    "habit: tidy\n": (
        "habit: tidy\n    mood: 1\n",
        "arrangements[ada]: unknown key 'mood'; expected the keys habit, labeller",
    ),
}


@pytest.mark.parametrize("right", MISTAKES)
def test_a_mistake_is_one_line_with_file_field_and_value(
    right: str, tmp_path: Path
) -> None:
    wrong, message = MISTAKES[right]
    assert ROOM.count(right) == 1
    with pytest.raises(BadInput) as error:
        read(tmp_path, ROOM.replace(right, wrong))
    assert str(error.value).startswith(f"{tmp_path}/den.yaml: ")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[1",
        "a: &x 1\nb: *x",
        "[" * 300,
        "a: 2001-99-99",
        "a: " + "9" * 5000,
        "\0",
        "{[]: 1}",
        "!!python/object/apply:os.getcwd []",
        "x" * 1_000_001,
    ],
)
def test_hostile_text_is_refused_in_one_line(text: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"^.*den.yaml: [^\n]+$"):
        read(tmp_path, text)


def test_an_object_too_high_for_its_shelf_is_refused(tmp_path: Path) -> None:
    book = replace(CATALOGUE["book2"], size_m=(0.6, 0.2, 0.03))
    path = tmp_path / "den.yaml"
    path.write_text(ROOM)
    with pytest.raises(BadInput, match=r"book2 is 0\.600 m high, expected at most the"):
        read_layout(path, {**CATALOGUE, "book2": book}, SCHEMA)


def test_there_are_seven_kitchens_six_living_rooms_and_seven_offices(
    layouts: list[Layout],
) -> None:
    kinds = Counter(layout.kind for layout in layouts)
    assert kinds == {"kitchen": 7, "livingroom": 6, "office": 7}


def test_each_room_can_be_lived_in(layouts: list[Layout]) -> None:
    faults = {layout.scene: room_plan.faults(layout) for layout in layouts}
    assert {scene: lines for scene, lines in faults.items() if lines} == {}


def test_no_two_rooms_are_alike(layouts: list[Layout]) -> None:
    for a, b in combinations(layouts, 2):
        assert likeness(a, b) < 0.5, (a.scene, b.scene)


def test_a_mirrored_room_is_alike(layouts: list[Layout]) -> None:
    mirror = np.array([-1.0, 1.0])
    for layout in layouts:
        pieces = []
        for piece in layout.furniture:
            T = piece.T_world_furniture.copy()
            T[4:6] *= mirror
            pieces.append(replace(piece, T_world_furniture=T))
        outline = (layout.outline_m * mirror)[::-1]
        mirrored = replace(layout, outline_m=outline, furniture=tuple(pieces))
        assert likeness(layout, mirrored) > 0.9


def test_rooms_hold_all_objects_and_each_category_three_times(
    layouts: list[Layout],
) -> None:
    assert all(12 <= len(layout.objects) <= 19 for layout in layouts)
    assert all(any(o.is_movable for o in layout.objects) for layout in layouts)
    used: set[str] = {o.object_id for layout in layouts for o in layout.objects}
    assert used == set(CATALOGUE)
    rooms = Counter(c for layout in layouts for c in categories(layout.objects))
    assert min(rooms.values()) >= 3


def categories(objects: tuple[SceneObject, ...]) -> set[str]:
    """Return the categories of some objects."""
    return {item.category for item in objects}


BLOCKED: dict[str, dict[str, Any]] = {
    "share": {"position_m": (0.5, 1.0, 0.0)},
    "blocks a door": {"position_m": (3.4, 0.9, 0.0)},
    "stands on nothing": {"position_m": (2.0, 1.5, 1.0)},
    "off a wall": {"position_m": (2.0, 1.5, 1.0), "kind": "picture"},
    "out of reach": {"position_m": (1.0, 1.5, 0.0), "size_m": (0.3, 2.9, 0.74)},
}


@pytest.mark.parametrize("fault", BLOCKED)
def test_the_plan_check_sees(fault: str, tmp_path: Path) -> None:
    layout = read(tmp_path)
    assert room_plan.faults(layout) == []
    changes = dict(BLOCKED[fault])
    pose = rigid.from_yaw(0, changes.pop("position_m"))
    desk = replace(layout.furniture[0], T_world_furniture=pose, **changes)
    case = layout.furniture[1]
    faults = room_plan.faults(replace(layout, furniture=(desk, case)))
    assert any(fault in line for line in faults)

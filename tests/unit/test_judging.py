"""The judge knows what people say of places, decides all, and trusts no model."""

import csv
import json
from importlib.metadata import files
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from placing import rigid
from placing.dressing import standing_shape
from placing.errors import BadInput, UnknownName
from placing.rooms.catalogue import read_catalogue
from placing.scene import Furniture, Layout, Placement
from placing.shapes.furniture import FURNITURE, furniture_shape
from placing.tables.correct_places import ROOMS, read_correct_places
from placing.tables.judging import judge, supports_of

CONFIG = Path(__file__).parents[2] / "config"
PLACES, SUPPORTS = CONFIG / "correct_places.csv", CONFIG / "supports.csv"
OBJECTS = read_catalogue(CONFIG / "objects.csv")
CATEGORIES = list(dict.fromkeys(item.category for item in OBJECTS.values()))
TABLE = read_correct_places(PLACES, SUPPORTS, CATEGORIES)
GROUPS = list(dict.fromkeys(rule.support for rule in TABLE.rules))
LEAST_SHARE = 0.05


def piece(kind, size, x, y, z=0.0):
    """Return furniture that looks along +x."""
    return Furniture(kind, kind, size, rigid.from_yaw(0.0, (x, y, z)))


FURNISHED = (
    piece("table", (0.8, 1.4, 0.75), 1, 1),
    piece("couch", (0.9, 2.0, 0.85), 1, 4),
    piece("bookcase", (0.3, 0.9, 1.9), 4, 1),
    piece("counter", (0.6, 1.8, 0.9), 4, 4),
    piece("dish_rack", (0.35, 0.45, 0.15), 4, 4.3, 0.9),
    piece("stemware_holder", (0.3, 0.6, 0.4), 4, 3.4, 1.5),
    piece("fridge", (0.65, 0.6, 1.8), 1, 5.5),
)
NOWHERE = "nothing"


def layout(names, kind="apartment"):
    """Return a furnished room with objects of the catalogue."""
    outline = np.array([(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)])
    things = tuple(OBJECTS[name] for name in names)
    return Layout("room", kind, outline, 2.5, (), FURNISHED, things, ())


def on(name, x, y, height):
    """Return an object that stands upright at a height."""
    location = np.array([x, y, height + OBJECTS[name].size_m[2] / 2])
    return Placement(name, "", location, rigid.yaw_quaternion(0.0))


def judged(name, x, y, height, kind="apartment"):
    """Return the judgement of one object."""
    (found,) = judge(layout([name], kind), [on(name, x, y, height)], TABLE)
    return found


def patch_of(kind, name):
    """Return the height of a support of the furnished room."""
    (item,) = [p for p in FURNISHED if p.kind == kind]
    (found,) = [s for s in standing_shape(item).supports if s.name == name]
    return found.height_m


def test_shoes_on_a_table_are_wrong():
    found = judged("shoe_pair1", 1, 1, 0.75)
    assert (found.support, found.is_correct) == ("table", False)
    assert found.row.source.startswith("paper 3.1")


def test_shoes_on_the_ground_and_at_the_bottom_of_a_shelf_are_right():
    assert judged("shoe_pair1", 2.5, 2.5, 0.0).is_correct
    assert judged("shoe_pair1", 4, 1, patch_of("bookcase", "shelf1")).is_correct
    assert not judged("shoe_pair1", 4, 1, patch_of("bookcase", "shelf3")).is_correct


def test_a_bottle_on_the_couch_is_wrong():
    found = judged("soda_can", 1.2, 4, 0.44)
    assert (found.support, found.is_correct) == ("couch", False)
    assert judged("soda_can", 1, 1, 0.75).is_correct


def test_food_and_books_belong_on_the_middle_level_of_a_shelf():
    for name in ("bread", "book1"):
        assert judged(name, 4, 1, patch_of("bookcase", "shelf3")).is_correct


def test_fruit_on_top_of_the_fridge_is_wrong_and_in_it_is_right():
    top, shelf = patch_of("fridge", "top"), patch_of("fridge", "shelf1")
    assert not judged("fruit_bowl", 1, 5.5, top).is_correct
    assert judged("fruit_bowl", 1, 5.5, shelf).is_correct


def test_the_tray_of_a_dish_rack_counts_and_not_the_counter_below_it():
    assert judged("plate1", 4, 4.3, 0.915).support == "dish_rack"
    assert judged("plate1", 4, 3.6, 0.9).support == "counter"


def test_a_glass_that_hangs_is_held_by_its_holder():
    assert judged("mug1", 4, 3.4, 1.7).support == "stemware_holder"
    assert judged("mug1", 2.5, 2.5, 1.7).support == NOWHERE


def test_a_placement_may_be_a_little_off_its_support():
    assert judged("mug1", 1, 1, 0.75 + 0.055).support == "table"
    assert judged("mug1", 1, 1, 0.75 - 0.055).support == "table"
    assert judged("mug1", 1, 1, 0.75 + 0.065).support == NOWHERE
    assert judged("mug1", 1.4 + 0.045, 1, 0.75).support == "table"
    floating = judged("mug1", 1.4 + 0.055, 1, 0.75)
    assert (floating.support, floating.is_correct) == (NOWHERE, False)


def test_the_support_of_a_stacked_book_is_that_of_the_lowest_one():
    names = ["book3", "book2", "book1"]
    heights = np.cumsum([0.75, *(OBJECTS[name].size_m[2] for name in names)])
    stack = [on(n, 1, 1, h) for n, h in zip(names, heights, strict=False)]
    for placements in (stack, stack[::-1]):
        assert set(supports_of(layout(names), placements, TABLE).values()) == {"table"}
    # High enough above the table that only the pile can tell what carries the last.
    high = ["monitor1", "book1"]
    pile = [on("monitor1", 1, 1, 0.75), on("book1", 1, 1, 0.75 + 0.43)]
    assert supports_of(layout(high), pile, TABLE)["book1"] == "table"


def test_what_stands_below_a_board_does_not_carry_what_is_on_it():
    low, high = (patch_of("bookcase", f"shelf{i}") for i in (1, 2))
    under = on("shoe_pair2", 4, 1, high - 0.03 - 0.24)
    found = supports_of(
        layout(["shoe_pair2", "book1"]), [under, on("book1", 4, 1, high)], TABLE
    )
    assert low < high
    assert found["book1"] == "shelf"


def test_an_object_that_is_not_placed_is_judged_and_wrong():
    (found,) = judge(layout(["mug1"]), [], TABLE)
    assert (found.support, found.is_correct) == (NOWHERE, False)


def test_an_object_of_another_scene_is_refused():
    with pytest.raises(UnknownName, match="unknown object 'cup'"):
        judge(layout(["mug1"]), [on("cup", 1, 1, 0.75)], TABLE)


def test_every_category_is_decided_on_every_kind_of_support_in_every_room():
    assert len(CATEGORIES) == 19
    for category, support, room in product(CATEGORIES, GROUPS, ROOMS):
        row = TABLE.decision(category, support, room)
        assert row.category == category
        assert row.support in (support, "any")
        assert row.room in (room, "any")


def test_every_category_has_a_correct_place_in_every_room():
    for category, room in product(CATEGORIES, ROOMS):
        rows = [TABLE.decision(category, support, room) for support in GROUPS]
        assert {row.is_correct for row in rows} == {True, False}


def test_every_patch_of_furniture_is_a_kind_of_support():
    for kind in FURNITURE:
        for patch in furniture_shape(kind, (0.9, 1.5, 0.9)).supports:
            for height_m in (0.1, 1.0, 2.0):
                assert TABLE.support(kind, patch.name, height_m) in GROUPS


def test_the_row_of_a_room_counts_before_that_of_any_room():
    assert TABLE.decision("monitor", "table", "office").is_correct
    assert not TABLE.decision("monitor", "table", "kitchen").is_correct
    assert TABLE.decision("monitor", "bed", "office").support == "any"


def test_shares_in_the_table_are_those_of_the_receptacles():
    """Compare with a second count; what stands on 5 in 100 pieces belongs there."""
    (found,) = [f for f in files("procthor") or [] if f.name == "receptacles.json"]
    receptacles = json.loads(Path(str(found.locate())).read_text())
    with (CONFIG / "thor_types.csv").open() as file:
        types = {r["object_type"]: r["category"] for r in csv.DictReader(file)}
    n_shares = 0
    for row in TABLE.rows.values():
        if not row.source.startswith("receptacles.json: ") or "/" not in row.source:
            continue
        kinds, share = row.source.split()[1:]
        held = [receptacles[kind] for kind in kinds.split("+")]
        # The file holds counts and shares; their ratio is the number of receptacles.
        numbers = [next(iter(h.values())) for h in held]
        total = sum(round(x["count"] / x["p"]) for x in numbers)
        count = sum(
            x["count"]
            for h in held
            for name, x in h.items()
            if types.get(name) == row.category
        )
        assert share == f"{count}/{total}", row
        assert row.is_correct == (count / total >= LEAST_SHARE), row
        n_shares += 1
    assert n_shares > 100


def written(folder, *lines):
    """Return a table of places of these lines."""
    path = folder / "correct_places.csv"
    header = "category,support,room,is_correct,source"
    path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["boook,any,any,True,x"], "line 2: category: value 'boook'; expected one of"),
        (["book,roof,any,True,x"], "line 2: support: value 'roof'; expected one of"),
        (["book,any,attic,True,x"], "line 2: room: value 'attic'; expected one of"),
        (["book,any,any,yes,x"], "line 2: is_correct: value 'yes'; expected one of"),
        (["book,any,any,True,"], "line 2: source: value ''"),
        (["book,any,any,True,x"] * 2, "line 3: category support room: value"),
        (
            ["book,any,office,True,x"],
            "no row for category 'book', support 'floor', room 'kitchen'",
        ),
    ],
)
def test_a_bad_table_is_refused_in_one_line(tmp_path, lines, message):
    with pytest.raises(BadInput, match=message) as caught:
        read_correct_places(written(tmp_path, *lines), SUPPORTS, ["book"])
    assert "\n" not in str(caught.value)
    assert "correct_places.csv" in str(caught.value)


def test_a_bad_table_of_supports_is_refused(tmp_path):
    path = tmp_path / "supports.csv"
    path.write_text("furniture,patch,below_m,support\nthrone,*,,couch\n")
    with pytest.raises(BadInput, match="line 2: furniture: value 'throne'"):
        read_correct_places(PLACES, path, CATEGORIES)
    path.write_text("furniture,patch,below_m,support\nbed,*,low,bed\n")
    with pytest.raises(BadInput, match="line 2: below_m: value 'low'"):
        read_correct_places(PLACES, path, CATEGORIES)

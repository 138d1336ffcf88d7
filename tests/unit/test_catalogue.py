"""The catalogue holds what the paper's tables say, and bad lines are named."""

from collections import Counter
from pathlib import Path

import pytest

from placing.errors import BadInput
from placing.rooms.catalogue import COLUMNS, read_catalogue

CATALOGUE = Path(__file__).parents[2] / "config" / "objects.csv"
HEADER = ",".join(COLUMNS)
GOOD = "mug1,dishware,mug,0.08,0.11,0.1,0.3,True,True"


def written(folder, *lines):
    path = folder / "objects.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_catalogue_has_47_objects_of_19_categories():
    objects = read_catalogue(CATALOGUE)
    assert len(objects) == 47
    assert len({item.category for item in objects.values()}) == 19


def test_category_is_movable_as_a_whole():
    objects = read_catalogue(CATALOGUE).values()
    movable = {item.category for item in objects if item.is_movable}
    assert not movable & {item.category for item in objects if not item.is_movable}
    assert len(movable) == 11
    assert movable.isdisjoint({"laptop", "monitor", "tv", "trash_bin", "decoration"})


def test_masses_are_those_of_everyday_things():
    """Nothing is lighter than cork or heavier than steel, measured by its box."""
    for item in read_catalogue(CATALOGUE).values():
        depth, width, height = item.size_m
        density = item.mass_kg / (depth * width * height)
        assert 10 < density < 4000, item.object_id


def test_line_becomes_an_object(tmp_path):
    (item,) = read_catalogue(written(tmp_path, HEADER, GOOD)).values()
    assert (item.object_id, item.category, item.shape) == ("mug1", "dishware", "mug")
    assert item.size_m == (0.08, 0.11, 0.1)
    assert item.mass_kg == 0.3
    assert item.has_front
    assert item.is_movable


def test_order_of_the_file_is_kept(tmp_path):
    lines = [GOOD.replace("mug1", name) for name in ("zebra", "apple", "mango")]
    objects = read_catalogue(written(tmp_path, HEADER, *lines))
    assert list(objects) == ["zebra", "apple", "mango"]


@pytest.mark.parametrize(
    ("bad", "complaint"),
    [
        (GOOD.replace(",mug,", ",mgu,"), r"shape: value 'mgu'; expected one of"),
        (GOOD.replace("0.11", "wide"), r"width_m: value 'wide'; expected a finite"),
        (GOOD.replace("0.11", "nan"), r"width_m: value 'nan'; expected a finite"),
        (GOOD.replace("0.11", "inf"), r"width_m: value 'inf'; expected a finite"),
        (GOOD.replace("0.3", "-1"), r"mass_kg: value '-1'; expected .* above 0"),
        (GOOD.replace("True,True", "True,yes"), r"movable: value 'yes'; expected"),
        (GOOD.replace("mug1", ""), r"object: value ''; expected a word"),
        (
            GOOD.replace("mug1", "../mug"),
            r"object: value '../mug'; expected a word",
        ),
        (GOOD.replace("mug1", "cup"), r"object: value 'cup'; .* not used above"),
        (GOOD + ",more", r"10 cells; expected 9"),
    ],
)
def test_bad_line_is_named_with_what_was_expected(tmp_path, bad, complaint):
    path = written(tmp_path, HEADER, GOOD.replace("mug1", "cup"), bad)
    with pytest.raises(BadInput, match=rf"line 3: {complaint}") as caught:
        read_catalogue(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_bad_header_missing_file_and_empty_table_are_named(tmp_path):
    with pytest.raises(BadInput, match=r"line 1: header 'a,b'; expected object,cat"):
        read_catalogue(written(tmp_path, "a,b", "1,2"))
    with pytest.raises(BadInput, match="no rows"):
        read_catalogue(written(tmp_path, HEADER))
    with pytest.raises(BadInput, match=r"nowhere\.csv: .*expected a CSV file"):
        read_catalogue(tmp_path / "nowhere.csv")


def test_categories_hold_as_many_objects_as_the_list_says():
    counts = Counter(item.category for item in read_catalogue(CATALOGUE).values())
    assert counts["dishware"] == counts["food"] == 5
    assert counts["book"] == 4
    assert counts["tv"] == counts["remote"] == 1

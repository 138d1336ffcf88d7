"""Ratings are read as they were given, or refused in one line."""

from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from sklearn.metrics import cohen_kappa_score

from placing.errors import BadInput
from placing.methods.names import JOINT_NAMES
from placing.rating.agreement import agreement, cohen_kappa
from placing.rating.answers import MAX_BYTES, rated_cells, read_ratings
from placing.rating.blinding import Blinded, blinded
from placing.rooms.file import read_yaml
from placing.scene import Placement, SceneObject
from placing.tables.table2 import table2

SCHEMA = read_yaml(Path(__file__).parents[2] / "workflow/schemas/ratings.schema.yaml")
HEADER = "rater,arrangement,question,answer\n"
OBJECTS = tuple(
    SceneObject(name, "dishware", "mug", (0.1, 0.1, 0.1), 0.3, True, True)
    for name in ("mug1", "mug2", "cup")
)


def placement(name):
    return Placement(name, "area1", np.zeros(3), np.array([1.0, 0, 0, 0]))


FIRST = Blinded("0123abcd", "apt1", "dp", (placement("mug1"), placement("cup")), ())
SECOND = Blinded("ffffffff", "apt1", "fmm", (placement("mug1"),), ("cup",))
GOOD = (
    "ann,0123abcd,mug1,yes\nann,0123abcd,cup,no\nann,0123abcd,whole,3.5\n"
    "ann,ffffffff,mug1,yes\nann,ffffffff,whole,2\n"
)


@pytest.fixture
def rate(tmp_path):
    """Return the function that writes files of raters and reads them."""

    def read(*texts):
        files = []
        for number, text in enumerate(texts):
            files.append(tmp_path / f"file{number}.csv")
            files[-1].write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_ratings(files, SCHEMA, (FIRST, SECOND))

    return read


def test_cells_are_means_over_raters_and_unplaced_objects_are_wrong(rate):
    other = GOOD.replace("ann", "bob").replace("cup,no", "cup,yes").replace("3.5", "5")
    found = rated_cells(rate(HEADER + GOOD, HEADER + other)).set_index("method")
    assert found.loc["dp", "co"] == pytest.approx((50 + 100) / 2)
    assert found.loc["dp", "sc"] == pytest.approx(4.25)
    assert found.loc["fmm", "co"] == pytest.approx(50)
    wide = table2(rated_cells(rate(HEADER + GOOD))).set_index("method")
    assert wide.loc["dp", "average_sc"] == 3.5
    assert np.isnan(wide.loc["object_context", "apt1_co"])


def test_no_files_are_no_ratings(rate):
    assert rate().empty
    assert rated_cells(rate()).empty
    assert agreement(rate()).empty


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: header ''; expected rater,arrangement,question,answer"),
        (HEADER, "no rows"),
        ("a" * (MAX_BYTES + 1), f"{MAX_BYTES + 1} bytes; expected at most {MAX_BYTES}"),
        (b"\xff\xfe\x00", "UTF-8"),
        (HEADER + "../../etc,0123abcd,cup,no\n", "rater: value '../../etc'; expected"),
        (HEADER + "ann,0123abcd,cup,maybe\n", "answer: value 'maybe'; expected one of"),
        (HEADER + "ann,0123abcd,whole,5.5\n", "answer: value '5.5'; expected one of"),
        (HEADER + "ann,0123abcd,whole,nan\n", "answer: value 'nan'; expected one of"),
        (HEADER + "ann,0123abcd,whole,yes\n", "expected a number from 0 to 5"),
        (HEADER + "ann,0123abcd,cup,3\n", "cup: value '3'; expected yes or no"),
        (HEADER + "ann,99999999,cup,no\n", "arrangement: value '99999999'; expected"),
        (HEADER + "ann,0123abcd,tv1,no\n", "value 'tv1'; expected one of mug1, cup"),
        (HEADER + "ann,ffffffff,cup,no\n", "value 'cup'; expected one of mug1, whole"),
        (HEADER + GOOD + GOOD, "is that of line 2 too"),
        (HEADER + GOOD.replace("ann", "bob", 1), "rater: values ['ann', 'bob']"),
        (HEADER + GOOD.replace("ann,0123abcd,cup,no\n", ""), "no answer for 'cup'"),
        (HEADER + 'ann,0123abcd,"cup\n', "line 2: 3 cells; expected 4"),
    ],
)
def test_a_file_that_cannot_be_right_is_refused_in_one_line(rate, text, said):
    with pytest.raises(BadInput) as caught:
        rate(text)
    assert said in str(caught.value)
    assert "file0.csv" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_rater_has_one_file(rate):
    with pytest.raises(BadInput, match=r"file1.csv: rater: value 'ann' is that of"):
        rate(HEADER + GOOD, HEADER + GOOD)


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(BadInput, match="cannot be read: No such file"):
        read_ratings([tmp_path / "none.csv"], SCHEMA, ())


def test_kappa_is_that_of_the_literature():
    # SOURCE: Viera and Garrett, Understanding interobserver agreement: the kappa
    # statistic, Family Medicine 37(5), 2005, 360-363: 15 both yes, 70 both no, 5 and 10
    # apart.
    one = np.repeat([True, True, False, False], [15, 5, 10, 70])
    other = np.repeat([True, False, True, False], [15, 5, 10, 70])
    assert cohen_kappa(one, other) == pytest.approx(0.57, abs=0.005)


def test_kappa_is_that_of_scikit_learn():
    rng = np.random.default_rng(0)
    for share in (0.3, 0.9):
        one, other = rng.random((2, 60)) < share
        assert cohen_kappa(one, other) == pytest.approx(cohen_kappa_score(one, other))


def test_kappa_is_1_for_full_agreement_and_undefined_for_a_single_answer():
    mixed = np.array([True, False, True])
    assert cohen_kappa(mixed, mixed) == pytest.approx(1)
    assert np.isnan(cohen_kappa(np.ones(3, bool), np.ones(3, bool)))
    assert np.isnan(cohen_kappa(np.empty(0, bool), np.empty(0, bool)))


def test_raters_agree_over_what_both_were_asked(rate):
    only = "bob,0123abcd,mug1,yes\nbob,0123abcd,cup,yes\nbob,0123abcd,whole,5\n"
    row = agreement(rate(HEADER + GOOD, HEADER + only)).iloc[0]
    assert (row["rater"], row["other"]) == ("ann", "bob")
    assert row["n_objects"] == 2
    assert row["same"] == pytest.approx(0.5)
    assert row["n_arrangements"] == 1
    assert row["score_difference"] == pytest.approx(1.5)


def joint(shift=0.0):
    """Return joint placements of two scenes in which methods do as well."""
    pose = (shift, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    rows = [
        (scene, method, item.object_id, "area1", "", item.object_id != "cup", "", *pose)
        for scene, method, item in product(("apt1", "apt2"), JOINT_NAMES, OBJECTS)
    ]
    names = ["scene", "method", "object", "area", "on", "is_placed", "reason"]
    names += ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
    return pd.DataFrame(rows, columns=names)


def test_names_are_blind_and_follow_from_seed_and_placements():
    objects = {"apt1": OBJECTS, "apt2": OBJECTS}
    once = blinded(joint(), objects, 1)
    names = [one.name for one in once]
    assert len(set(names)) == 8
    assert {(one.scene, one.method) for one in once} == set(
        product(objects, JOINT_NAMES)
    )
    assert [one.unplaced for one in once] == [("cup",)] * 8
    assert names == [one.name for one in blinded(joint(), objects, 1)]
    assert not set(names) & {one.name for one in blinded(joint(0.01), objects, 1)}
    assert not set(names) & {one.name for one in blinded(joint(), objects, 2)}
    order = [(one.scene, one.method) for one in once]
    assert order != list(product(objects, JOINT_NAMES))

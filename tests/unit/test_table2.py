"""Table 2 follows from errors and verdicts as its own footnotes say."""

from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from placing.candidates import Candidates
from placing.errors import BadArtifact
from placing.methods.names import JOINT_NAMES
from placing.scene import Arrangement, Placement, Scene, SceneObject
from placing.tables.table2 import cells, score, table2
from placing.tables.table2_answers import answers_of, placements_of
from placing.tables.table2_errors import answer_errors, chance_errors, matched_error
from placing.tables.table2_page import paper_table, table2_markdown
from placing.tables.table2_scores import score_scene

PAPER = Path(__file__).parents[2] / "config" / "paper.csv"
UPRIGHT = np.array([1.0, 0, 0, 0])
CUP = SceneObject("cup", "dishware", "mug", (0.1, 0.1, 0.1), 0.3, True, True)
BOOKS = tuple(
    SceneObject(f"book{n}", "book", "book", (0.2, 0.1, 0.03), 0.4, True, True)
    for n in (1, 2)
)
OBJECTS = (CUP, *BOOKS)


@dataclass(frozen=True)
class Verdict:
    """What the judge says of one object."""

    object_id: str
    is_correct: bool
    category: str = ""
    support: str = "desk"
    room: str = "office"
    row: int = 0


def arrangement(name, *xy):
    placed = [
        Placement(item.object_id, "area1", np.array([*at, 0.75]), UPRIGHT)
        for item, at in zip(OBJECTS, xy, strict=True)
    ]
    return Arrangement(name, "", tuple(placed))


LABELLED = (
    arrangement("one", (0, 0), (1, 0), (2, 0)),
    arrangement("two", (0, 0.3), (1, 0.3), (2, 0.3)),
)


def places(n=9):
    """Return places on a lattice of 4 m x 4 m on which everything fits."""
    axis = np.linspace(-1, 3, n)
    xy = np.stack(np.meshgrid(axis, axis, indexing="ij"), -1).reshape(-1, 2)
    location = np.column_stack([xy, np.full(len(xy), 0.7)])
    return Candidates(location, np.zeros(len(xy), np.int32), np.full((len(xy), 4), 5.0))


def scene(name="office1", labelled=LABELLED):
    return Scene(name, "office", (), OBJECTS, labelled)


def joint(name="office1", xy=((0, 0), (1, 0), (2, 0)), unplaced=()):
    """Return the same placements by every method."""
    rows = []
    for method in JOINT_NAMES:
        for item, at in zip(OBJECTS, xy, strict=True):
            is_placed = item.object_id not in unplaced
            reason = "" if is_placed else "no room"
            key = (name, method, item.object_id, "area1", "", is_placed, reason)
            rows.append((*key, *at, 0.75, *UPRIGHT))
    names = ["scene", "method", "object", "area", "on", "is_placed", "reason"]
    names += ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
    return pd.DataFrame(rows, columns=names)


def verdicts(answers, of_scene, wrong=()):
    """Return a judge that finds everything right that is placed and not `wrong`."""
    said = {
        method: [
            Verdict(p.object_id, p.object_id not in wrong) for p in placements_of(rows)
        ]
        for method, rows in answers_of(answers, of_scene.scene, of_scene.objects)
    }
    every = [Verdict(item.object_id, True) for item in OBJECTS]
    return said | {one.name: every for one in of_scene.arrangements}


def scored(answers, of_scene=None, wrong=()):
    of_scene = of_scene or scene()
    rng = np.random.default_rng(0)
    judged = verdicts(answers, of_scene, wrong)
    return score_scene(rng, of_scene, places(), answers, judged, 0.7)


def cell_of(table, method="dp", of_scene="office1"):
    found = table[(table["method"] == method) & (table["scene"] == of_scene)]
    return found.iloc[0]


def test_a_method_as_far_from_labels_as_they_are_from_each_other_has_5():
    # Labels are 0.3 m apart; this answer is 0.3 m beside both.
    side = np.sqrt(0.3**2 - 0.15**2)
    answer = joint(xy=[(x + side, 0.15) for x in (0, 1, 2)])
    cell = cell_of(cells(scored(answer)))
    assert cell["location_error_m"] == pytest.approx(0.3)
    assert cell["spread_m"] == pytest.approx(0.3)
    assert cell["sc"] == pytest.approx(5)


def test_a_method_that_places_nothing_has_the_error_of_chance_and_0():
    answer = joint(unplaced=[item.object_id for item in OBJECTS])
    cell = cell_of(cells(scored(answer)))
    assert cell["location_error_m"] == pytest.approx(cell["chance_m"])
    assert cell["sc"] == pytest.approx(0, abs=1e-9)
    assert cell["co"] == 0
    assert cell["n_unplaced"] == 3


def test_a_score_is_linear_between_spread_and_chance_and_clipped_outside():
    assert score(0.8, spread=0.3, chance=1.3) == pytest.approx(2.5)
    assert score(0.1, spread=0.3, chance=1.3) == 5
    assert score(9.0, spread=0.3, chance=1.3) == 0
    assert np.isnan(score(0.5, spread=1.3, chance=1.3))
    assert np.isnan(score(0.5, spread=np.nan, chance=1.3))


def test_an_object_that_is_not_placed_is_not_correct():
    assert cell_of(cells(scored(joint())))["co"] == 100
    some = cells(scored(joint(unplaced=["book1"]), wrong=["cup"]))
    assert cell_of(some)["co"] == pytest.approx(100 / 3)
    rows = scored(joint(unplaced=["book1"]))
    assert set(rows.loc[~rows["is_placed"] & (rows["method"] == "dp"), "reason"]) == {
        "no room"
    }


def test_books_that_have_changed_places_have_no_error():
    answer = np.array([(0, 0), (2, 0), (1, 0)], float)
    labelled = np.array([(0, 0), (1, 0), (2, 0)], float)
    to, error = answer_errors(answer, labelled, np.ones(3), OBJECTS)
    assert to.tolist() == [0, 2, 1]
    assert error.tolist() == [0, 0, 0]


def test_the_matching_decides_which_label_goes_without_an_object():
    answer = np.array([(0, 0), (np.nan, np.nan), (1, 0)], float)
    labelled = np.array([(0, 0), (1, 0), (2, 0)], float)
    to, error = answer_errors(answer, labelled, np.array([1, 1.1, 1.2]), OBJECTS)
    assert to.tolist() == [0, 2, 1]
    assert error.tolist() == [0, 1.2, 0]


def test_chance_of_a_single_object_is_the_mean_over_its_places():
    labelled = np.array([(0.2, 0.1), (1, 0), (2, 0)])
    found = chance_errors(np.random.default_rng(0), OBJECTS, labelled, places(), 0.7)
    slow = [np.hypot(x - 0.2, y - 0.1) for x, y, _ in places().location]
    assert found[0] == pytest.approx(np.mean(slow))


def test_chance_of_two_books_is_the_mean_over_all_pairs_of_places():
    few = places(5)
    labelled = np.array([(0, 0), (1, 0), (2, 0.5)], float)
    found = chance_errors(np.random.default_rng(0), OBJECTS, labelled, few, 0.7)
    sums = []
    for one in few.location[:, :2]:
        for other in few.location[:, :2]:
            pair = np.array([one, other])
            sums.append(
                min(
                    np.linalg.norm(pair[list(order)] - labelled[1:], axis=1).sum()
                    for order in permutations(range(2))
                )
            )
    assert found[1:].sum() == pytest.approx(np.mean(sums), abs=0.05)


def test_drawn_errors_stand_at_the_label_they_are_matched_to():
    drawn = np.array([[(5.0, 0), (0, 1)]])
    labelled = np.array([(0.0, 0), (5, 0)])
    assert matched_error(drawn, labelled).tolist() == [1, 0]


def test_averages_count_every_scene_once():
    tables = [scored(joint()), scored(joint("apt1", unplaced=["cup"]), scene("apt1"))]
    tables.append(scored(joint("office2"), scene("office2"), wrong=["cup", "book2"]))
    wide = table2(cells(pd.concat(tables)))
    assert wide["method"].tolist() == list(JOINT_NAMES)
    heads = [
        "office1_co",
        "office1_sc",
        "office2_co",
        "office2_sc",
        "apt1_co",
        "apt1_sc",
    ]
    assert list(wide) == ["method", *heads, "average_co", "average_sc"]
    row = wide.iloc[0]
    each = [row[f"{name}_co"] for name in ("office1", "office2", "apt1")]
    assert row["average_co"] == pytest.approx(np.mean(each))
    each = [row[f"{name}_sc"] for name in ("office1", "office2", "apt1")]
    assert row["average_sc"] == pytest.approx(np.mean(each))


def test_the_labels_themselves_have_5():
    assert cell_of(cells(scored(joint())), "labels")["sc"] == pytest.approx(5)


def test_a_scene_with_one_labelled_arrangement_has_no_score():
    cell = cell_of(cells(scored(joint(), scene(labelled=LABELLED[:1]))))
    assert np.isnan(cell["sc"])
    assert cell["co"] == 100


def test_a_method_that_lost_an_object_is_named():
    with pytest.raises(BadArtifact, match=r"office1 by object_context.*expected"):
        scored(joint().iloc[1:], scene())


def test_a_cell_follows_from_the_long_table():
    rows = scored(joint(xy=[(0.1, 0), (1, 0.4), (2.5, 0)]))
    cell = cell_of(cells(rows), "fmm")
    mean = rows.groupby("method")["location_error_m"].mean()
    share = (mean["chance"] - mean["fmm"]) / (mean["chance"] - mean["labels"])
    assert cell["sc"] == pytest.approx(5 * share)


def test_the_papers_averages_are_unweighted_means_of_its_scenes():
    paper = paper_table(pd.read_csv(PAPER)).set_index("method")
    assert list(paper.index) == list(JOINT_NAMES)
    for name, within in (("co", 1.0), ("sc", 0.051)):
        scenes = [c for c in paper if c.endswith(f"_{name}") and "average" not in c]
        assert len(scenes) == 5
        gap = paper[scenes].mean(axis=1) - paper[f"average_{name}"]
        assert gap.abs().max() < within
    assert paper.loc["dp", [c for c in scenes]].mean() == pytest.approx(4.22)


def test_the_page_keeps_measured_published_and_rated_numbers_apart():
    of_cells = cells(scored(joint()))
    wide, paper = table2(of_cells), pd.read_csv(PAPER)
    none = pd.DataFrame()
    page = table2_markdown(of_cells, wide, paper, wide.iloc[:0], none)
    measured, published = page.split("## As the paper's raters saw it")
    assert "| human context (DP) | 100 | 5.0 |" in measured
    assert "4.3" not in measured
    assert "| human context (DP) | 100 | 5.0 | 100 | 4.3 | 91 | 4.0 | 74 |" in published
    for text in ("`Co`: per cent of **all**", "`Sc`: 5 where", "90 is 90.6"):
        assert text in page
    assert "our raters" not in page
    assert "our raters" in table2_markdown(of_cells, wide, paper, wide, none)

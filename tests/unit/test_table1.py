"""Table 1 agrees with Figure 6, counts what is not placed, compares like with like."""

import numpy as np
import pandas as pd
import pytest
from study import study

from placing.methods.answer_tables import LOCATION, NO_PLACE, ORIENTATION, PLACED
from placing.methods.names import LABELS
from placing.plans.robot_plans import REFUSED
from placing.tables.metrics import AVERAGE, summarise
from placing.tables.scoring import ANSWER_COLUMNS
from placing.tables.table1 import (
    CATEGORIES,
    long_table,
    paired_table,
    reasons_table,
    score_constraints,
    wide_table,
)
from placing.tables.table1_page import recomputed, table1_markdown
from placing.tasks import questions

PAPER = pd.read_csv("config/paper.csv")


def answers(scene, shift_m, refused=()):
    """Return answers that put every object off its first label by a shift."""
    by_object = {p.object_id: p for p in scene.arrangements[0].placements}
    rows = []
    for question in questions(scene, "empty"):
        for item in question.wanted:
            p = by_object[item.object_id]
            named = (question.name, question.labels, item.object_id, item.category)
            status = REFUSED if item.object_id in refused else PLACED
            pose = (*(p.location + shift_m), *p.orientation)
            pose = pose if status == PLACED else [np.nan] * 7
            rows.append((scene.scene, "dp", *named, status, *pose))
    return pd.DataFrame(rows, columns=list(ANSWER_COLUMNS))


def plans_of(scene, constraints, shift_m, refused=()):
    movable = {item.object_id for item in scene.objects if item.is_movable}
    found = answers(scene, shift_m, refused)
    found = found[found["object"].isin(movable)]
    reason = np.where(found["status"] == PLACED, "", "no path")
    return found.assign(constraints=constraints, reason=reason, task="empty")


@pytest.fixture(scope="module")
def scene():
    return study()[0]


@pytest.fixture(scope="module")
def plans(scene):
    up = np.array([0, 0, 0.3])
    return pd.concat(
        [
            plans_of(scene, "with", 2 * up, refused=["shoes"]),
            plans_of(scene, "inside", up),
        ],
        ignore_index=True,
    )


@pytest.fixture(scope="module")
def scores(scene, plans):
    without = answers(scene, np.array([0, 0, 0.1]))
    return score_constraints(scene, without, plans).assign(task="empty")


def value(long, metric, constraints, category):
    keys = ["metric", "constraints", "category"]
    return long.set_index(keys).loc[(metric, constraints, category), "value"]


def test_only_what_the_robot_can_carry_is_compared(scores):
    assert set(scores["category"]) == {"mouse", "shoe"}
    assert LABELS not in set(scores["method"])


def test_errors_are_those_of_figure_6(scores):
    table = summarise(scores.assign(dataset="rooms")).set_index(["method", "category"])
    long = long_table(scores)
    for (method, category), row in table.iterrows():
        for metric in ("location_m", "height_m"):
            found = value(long, metric, method, category)
            assert found == pytest.approx(row[metric])


def test_heights_and_shares_are_right(scores):
    long = long_table(scores)
    assert value(long, "height_m", "without", AVERAGE) == pytest.approx(0.1)
    assert value(long, "height_m", "with", "mouse") == pytest.approx(0.6)
    assert value(long, "height_m", "inside", AVERAGE) == pytest.approx(0.3)
    assert value(long, "placed_percent", "with", "shoe") == 0
    assert value(long, "placed_percent", "with", AVERAGE) == 50
    assert value(long, "placed_percent", "without", AVERAGE) == 100


def test_the_wide_table_has_the_columns_of_the_paper(scores):
    wide = wide_table(long_table(scores))
    assert list(wide.columns) == ["task", "metric", "constraints", *CATEGORIES, AVERAGE]
    with_heights = wide[
        (wide["metric"] == "height_m") & (wide["constraints"] == "with")
    ]
    assert with_heights["mouse"].item() == pytest.approx(0.6)
    assert with_heights[AVERAGE].item() == pytest.approx(0.6)
    assert with_heights[["shoe", "book"]].isna().all(axis=None)
    assert wide["constraints"].tolist() == ["without", "with", "inside"] * 3


def test_ratios_are_over_the_objects_placed_under_both(scores):
    others = scores.assign(scene="other")
    both = pd.concat([scores, others], ignore_index=True)
    paired = paired_table(np.random.default_rng(0), both)
    ratios = paired.set_index(["metric", "constraints", "compared_with"])
    of = ratios.loc["height_m"]
    assert of.loc[("with", "without"), "ratio"] == pytest.approx(6)
    assert of.loc[("inside", "without"), "ratio"] == pytest.approx(3)
    assert of.loc[("inside", "with"), "ratio"] == pytest.approx(0.5)
    n_all, n_mice = (of.loc[(c, "without"), "n"] for c in ("inside", "with"))
    assert n_mice < n_all
    assert (of["low"] <= of["ratio"] + 1e-9).all()
    assert (of["ratio"] <= of["high"] + 1e-9).all()


def test_reasons_are_counted(plans):
    reasons = reasons_table(plans)
    assert reasons.to_dict("records") == [
        {"task": "empty", "constraints": "with", "reason": "no path", "n": 1}
    ]


def test_the_lost_average_of_the_paper_is_recomputed():
    # SOURCE: the means over the 11 numbers that each row of the paper has.
    said = [("filled", 1.42, 1.62, 0.095, 0.277), ("empty", 1.61, 1.91, 0.125, 0.343)]
    for task, *values in said:
        pairs = [
            (m, c) for m in ("location_m", "height_m") for c in ("without", "with")
        ]
        found = [
            recomputed(PAPER[PAPER["source"] == "Table 1"], task, *pair)
            for pair in pairs
        ]
        np.testing.assert_allclose(found, values, atol=0.006)


def test_the_page_says_what_it_is_not(scores, plans):
    long = long_table(scores)
    paired = paired_table(np.random.default_rng(0), scores)
    page = table1_markdown("rooms", long, paired, reasons_table(plans), PAPER)
    for words in ("not the paper's data", "recomputed", "no path", "| **AVG** |"):
        assert words in page
    assert "nan" not in page


def test_without_a_place_there_is_no_error(scene, plans):
    nowhere = answers(scene, 0.0).assign(status=NO_PLACE)
    nowhere[[*LOCATION, *ORIENTATION]] = np.nan
    scores = score_constraints(scene, nowhere, plans).assign(task="empty")
    long = long_table(scores)
    assert value(long, "placed_percent", "without", AVERAGE) == 0
    assert not (
        (long["metric"] == "height_m") & (long["constraints"] == "without")
    ).any()

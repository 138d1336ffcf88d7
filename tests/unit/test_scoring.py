"""Scores compare answers with the right labels."""

from itertools import permutations

import numpy as np
import pandas as pd
import pytest
from study import study

from placing import rigid
from placing.methods.answer_tables import LOCATION, NO_PLACE, ORIENTATION, PLACED
from placing.methods.names import LABELS
from placing.tables.metrics import ERRORS
from placing.tables.scoring import ANSWER_COLUMNS, score_scene
from placing.tasks import questions


@pytest.fixture(scope="module")
def scene():
    return study()[0]


def answers_of(scene, task, labeller):
    """Return the answers of a method that copies the placements of a labeller."""
    labelled = next(a for a in scene.arrangements if a.name == labeller)
    by_object = {p.object_id: p for p in labelled.placements}
    rows = []
    for question in questions(scene, task):
        for item in question.wanted:
            p = by_object[item.object_id]
            named = (question.name, question.labels, item.object_id, item.category)
            rows.append((scene.scene, "copy", *named, PLACED))
            rows[-1] += (*p.location, *p.orientation)
    return pd.DataFrame(rows, columns=list(ANSWER_COLUMNS))


def likelihoods_of(scene):
    """Return another nll and rank for every labelled object."""
    keys = [
        ("copy", labels.name, placement.object_id)
        for labels in scene.arrangements
        for placement in labels.placements
    ]
    table = pd.DataFrame(keys, columns=["method", "labels", "object"])
    number = np.arange(1, len(table) + 1)
    return table.assign(nll=1.0 * number, rank=1 / number)


def score(scene, answers):
    return score_scene(scene, answers, likelihoods_of(scene))


def copied(scene, task, labels=None):
    """Return the scores of a copy of labeller1 against some labels."""
    table = score(scene, answers_of(scene, task, "labeller1"))
    table = table[table["method"] == "copy"]
    return table if labels is None else table[table["labels"] == labels]


def test_copying_the_labels_has_no_error(scene):
    own = copied(scene, "filled", "labeller1")
    assert len(own) == 4
    assert own[list(ERRORS)].abs().to_numpy().max() < 1e-12
    assert own["orientation_error_deg"].max() < 1e-9


def test_filled_answers_are_compared_with_the_arrangement_they_were_given(scene):
    errors = copied(scene, "filled", "labeller2").set_index("object")
    errors = errors["location_error_m"]
    assert errors["shoes"] == pytest.approx(2.4)
    assert errors.drop("shoes").abs().max() < 1e-12


def test_empty_answers_are_compared_with_every_arrangement(scene):
    counts = copied(scene, "empty").groupby("labels").size()
    assert counts.to_dict() == {"labeller1": 4, "labeller2": 4}


def test_labels_are_compared_with_each_other(scene):
    table = score(scene, answers_of(scene, "filled", "labeller1"))
    spread = table[table["method"] == LABELS]
    shoes = spread[spread["object"] == "shoes"]["location_error_m"]
    np.testing.assert_allclose(shoes, [2.4, 2.4])
    assert len(spread) == 8
    assert spread[["nll", "rank"]].isna().to_numpy().all()
    assert spread["orientation_error_deg"].notna().sum() == 6


@pytest.mark.parametrize("task", ["filled", "empty"])
def test_every_object_has_the_likelihood_of_its_own_label(scene, task):
    keys = ["labels", "object"]
    found = copied(scene, task).set_index(keys).sort_index()
    expected = likelihoods_of(scene).set_index(keys).sort_index()
    for column in ("nll", "rank"):
        np.testing.assert_array_equal(found[column], expected[column])


def test_an_object_without_a_place_keeps_its_reason(scene):
    answers = answers_of(scene, "filled", "labeller1")
    is_shoes = answers["object"] == "shoes"
    answers.loc[is_shoes, "status"] = NO_PLACE
    answers.loc[is_shoes, [*LOCATION, *ORIENTATION]] = np.nan
    table = score(scene, answers)
    row = table[(table["method"] == "copy") & (table["object"] == "shoes")].iloc[0]
    assert row["status"] == NO_PLACE
    assert np.isnan(row["location_error_m"])
    assert np.isfinite(row["nll"])


def test_one_of_two_objects_without_a_place_leaves_the_other_its_error(scene):
    answers = answers_of(scene, "filled", "labeller1")
    is_gone = answers["object"] == "mouse1"
    answers.loc[is_gone, "status"] = NO_PLACE
    answers.loc[is_gone, [*LOCATION, *ORIENTATION]] = np.nan
    table = score(scene, answers)
    own = table[(table["method"] == "copy") & (table["labels"] == "labeller1")]
    found = own.set_index("object")["location_error_m"]
    assert np.isnan(found["mouse1"])
    assert found["mouse2"] == pytest.approx(0)


def test_interchangeable_objects_may_be_swapped(scene):
    answers = answers_of(scene, "filled", "labeller1")
    at = [*LOCATION, *ORIENTATION]
    one, two = (answers["object"] == f"mouse{k}" for k in (1, 2))
    swapped = answers.copy()
    swapped.loc[one, at] = answers.loc[two, at].to_numpy()
    swapped.loc[two, at] = answers.loc[one, at].to_numpy()
    table = score(scene, swapped)
    own = table[(table["method"] == "copy") & (table["labels"] == "labeller1")]
    assert own[list(ERRORS)].abs().to_numpy().max() < 1e-12


@pytest.mark.parametrize("turn_deg", [0, 90, -170, 180, 350])
def test_orientation_error_is_the_turn_between_matched_headings(scene, turn_deg):
    answers = answers_of(scene, "filled", "labeller1")
    yaw = rigid.yaw_of(answers[ORIENTATION].to_numpy(float)) + np.radians(turn_deg)
    answers[ORIENTATION] = [rigid.yaw_quaternion(value) for value in yaw]
    table = score(scene, answers)
    own = table[(table["method"] == "copy") & (table["labels"] == "labeller1")]
    found = own.set_index("object")["orientation_error_deg"]
    expected = min(abs(turn_deg), 360 - abs(turn_deg))
    assert np.isnan(found["shoes"])  # shoes have no front
    np.testing.assert_allclose(found.drop("shoes"), expected, atol=1e-6)


def test_scores_of_a_jumbled_answer_are_those_of_a_slow_loop(scene):
    rng = np.random.default_rng(1)
    answers = answers_of(scene, "empty", "labeller1")
    answers[LOCATION] = rng.uniform(0, 3, (len(answers), 3))
    answers = answers.sample(frac=1, random_state=2)
    table = score(scene, answers)
    at = dict(zip(answers["object"], answers[LOCATION].to_numpy(), strict=True))
    for arrangement in scene.arrangements:
        to = {p.object_id: p.location for p in arrangement.placements}
        mice = [name for name in to if name.startswith("mouse")]
        best = min(
            sum(
                np.hypot(*(at[a] - to[b])[:2]) for a, b in zip(order, mice, strict=True)
            )
            for order in permutations(mice)
        )
        rows = table[
            (table["method"] == "copy") & (table["labels"] == arrangement.name)
        ]
        found = rows.set_index("object")["location_error_m"]
        assert found[mice].sum() == pytest.approx(best)
        for name in ("laptop1", "shoes"):
            assert found[name] == pytest.approx(np.hypot(*(at[name] - to[name])[:2]))

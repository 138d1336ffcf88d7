"""Scores compare answers with the right labels."""

import numpy as np
import pandas as pd
import pytest
from study import study

from placing.answer_tables import NO_PLACE, PLACEMENT_COLUMNS, placement_rows
from placing.answering import Answer
from placing.scene import Placement
from placing.scoring import LABELS, ScoringConfig, density_key, score_scene
from placing.tasks import questions

CONFIG = ScoringConfig(0.01)


@pytest.fixture(scope="module")
def parts():
    return study()


def score(parts, task, placed_by):
    """Return the scores of a method that copies the placements of a labeller."""
    scene, candidates, _ = parts
    n = len(candidates.location)
    labelled = next(a for a in scene.arrangements if a.name == placed_by)
    by_object = {p.object_id: p for p in labelled.placements}
    rows, densities = [], {}
    for question in questions(scene, task):
        placements = tuple((o, by_object[o.object_id]) for o in question.wanted)
        answer = Answer(placements, {}, None)
        rows += placement_rows(scene.scene, task, "copy", question, answer)
        for item in question.wanted:
            key = density_key("copy", question.name, item.category)
            densities[key] = np.full(n, 1 / n)
    answers = pd.DataFrame(rows, columns=PLACEMENT_COLUMNS)
    return (
        answers,
        densities,
        score_scene(scene, answers, densities, candidates, 0.05, CONFIG),
    )


def test_copying_the_labels_has_no_error(parts):
    _, _, table = score(parts, "filled", "labeller1")
    own = table[(table["method"] == "copy") & (table["labels"] == "labeller1")]
    assert len(own) == 4
    assert own["location_error_m"].abs().max() < 1e-12


def test_filled_answers_are_compared_with_the_arrangement_they_were_given(parts):
    _, _, table = score(parts, "filled", "labeller1")
    other = table[(table["method"] == "copy") & (table["labels"] == "labeller2")]
    errors = other.set_index("object")["location_error_m"]
    assert errors["shoes"] == pytest.approx(2.4)
    assert errors.drop("shoes").abs().max() < 1e-12


def test_empty_answers_are_compared_with_every_arrangement(parts):
    _, _, table = score(parts, "empty", "labeller1")
    counts = table[table["method"] == "copy"].groupby("labels").size()
    assert counts.to_dict() == {"labeller1": 4, "labeller2": 4}


def test_labels_are_compared_with_each_other(parts):
    _, _, table = score(parts, "filled", "labeller1")
    spread = table[table["method"] == LABELS]
    shoes = spread[spread["object"] == "shoes"]["location_error_m"]
    np.testing.assert_allclose(shoes, [2.4, 2.4])
    assert len(spread) == 8


def test_nll_of_a_uniform_density_is_the_log_of_the_area(parts):
    _, _, table = score(parts, "filled", "labeller1")
    n = len(parts[1].location)
    own = table[table["method"] == "copy"]["nll"]
    np.testing.assert_allclose(own, np.log(n * 0.05**2))


def test_an_object_without_a_place_keeps_its_reason(parts):
    scene, candidates, _ = parts
    answers, densities, _ = score(parts, "filled", "labeller1")
    is_shoes = answers["object"] == "shoes"
    answers.loc[is_shoes, "status"] = NO_PLACE
    answers.loc[is_shoes, ["x_m", "y_m", "z_m"]] = np.nan
    table = score_scene(scene, answers, densities, candidates, 0.05, CONFIG)
    row = table[(table["method"] == "copy") & (table["object"] == "shoes")].iloc[0]
    assert row["status"] == NO_PLACE
    assert np.isnan(row["location_error_m"])


def test_interchangeable_objects_may_be_swapped(parts):
    scene, candidates, _ = parts
    answers, densities, _ = score(parts, "filled", "labeller1")
    one, two = (answers["object"] == f"mouse{k}" for k in (1, 2))
    at = ["x_m", "y_m", "z_m"]
    answers.loc[one, at], answers.loc[two, at] = (
        answers.loc[two, at].to_numpy(),
        answers.loc[one, at].to_numpy(),
    )
    table = score_scene(scene, answers, densities, candidates, 0.05, CONFIG)
    own = table[(table["method"] == "copy") & (table["labels"] == "labeller1")]
    assert own["location_error_m"].abs().max() < 1e-12
    assert isinstance(scene.arrangements[0].placements[0], Placement)

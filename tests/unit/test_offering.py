"""What a robot may choose among is what people would have, and room beside it."""

from functools import partial

import numpy as np
import pandas as pd
import pytest
from study import study_model

from placing.artifacts.formats import write_table
from placing.artifacts.options import read_options
from placing.errors import BadArtifact
from placing.learning.learned import Choices
from placing.methods.answering import Asked
from placing.plans.offering import (
    OPTION_COLUMNS,
    OfferingConfig,
    offered_places,
    offered_rows,
)
from placing.plans.robot_candidates import arranged, candidates_of, in_falling_score
from placing.seeds import generator
from placing.tasks import questions

CONFIG = OfferingConfig(n_best=6, n_spread=5, n_headings=3, distance_m=0.125)


@pytest.fixture(scope="module")
def asked():
    model = study_model()
    question = questions(model.scene, "empty")[0]
    asked = Asked(partial(generator, 0), model, question, Choices(2, 0.5))
    asked.answer("dp")
    return asked


@pytest.fixture(scope="module")
def options(asked):
    rows = offered_rows("empty", asked, CONFIG)
    return pd.DataFrame(rows, columns=list(OPTION_COLUMNS))


def test_only_what_the_robot_can_carry_is_offered(asked, options):
    movable = {o.object_id for o in asked.question.wanted if o.is_movable}
    assert set(options["object"]) == movable
    counts = options.groupby("object")["option"].nunique()
    assert (counts == CONFIG.n_best + CONFIG.n_spread).all()


def test_the_first_option_is_the_decision_of_dp(asked, options):
    answer = asked.answer("dp")
    for category in {c.item.category for c in answer.chosen if c.item.is_movable}:
        chosen = next(c for c in answer.chosen if c.item.category == category)
        of_object = options[options["object"] == chosen.item.object_id]
        first = candidates_of(of_object)[chosen.item.object_id][0]
        decided = chosen.placement
        placed = first.placement(chosen.item)
        np.testing.assert_allclose(placed.location, decided.location, atol=1e-9)
        np.testing.assert_allclose(placed.orientation, decided.orientation, atol=1e-9)
        assert placed.area == decided.area


def test_modes_are_the_best_that_keep_their_distance(asked):
    # Against taking, again and again, the best of all that is far from what was taken.
    model = asked.model
    item = next(o for o in asked.question.wanted if o.is_movable)
    _, smooth = asked.found("dp", item.category)
    allowed = asked.allowed[item.object_id]
    location = model.candidates.location
    places, n_modes = offered_places(location, item, smooth, allowed, CONFIG)
    taken = []
    for _ in range(CONFIG.n_best):
        free = [
            p
            for p in np.flatnonzero(allowed)
            if all(
                np.linalg.norm(location[p] - location[t]) >= CONFIG.distance_m
                for t in taken
            )
        ]
        taken.append(max(free, key=lambda p: smooth[p]))
    assert n_modes == CONFIG.n_best
    np.testing.assert_allclose(smooth[places[:n_modes]], smooth[taken])
    assert len(set(places.tolist())) == len(places)
    assert allowed[places].all()


def test_headings_are_from_likely_to_unlikely(options):
    for _, of_place in options.groupby(["object", "option"]):
        assert len(of_place) <= CONFIG.n_headings
        assert of_place["log_heading"].is_monotonic_decreasing
        assert np.exp(of_place["log_heading"]).sum() <= 1 + 1e-9


def test_orders_of_candidates(options):
    for candidates in candidates_of(options).values():
        best = arranged(candidates, 4)
        assert [c.option for c in best] == [0, 1, 2, 3]
        assert all(c.heading == 0 and c.is_mode for c in best)
        every = in_falling_score(candidates)
        scores = [c.log_score for c in every]
        assert scores == sorted(scores, reverse=True)
        assert len(every) == len(candidates)


def test_a_damaged_table_is_one_line(tmp_path, options):
    write_table(tmp_path / "good.parquet", options)
    assert len(read_options(tmp_path / "good.parquet")) == len(options)
    write_table(tmp_path / "bad.parquet", options.assign(log_density=np.nan))
    with pytest.raises(BadArtifact, match="log_density: expected finite numbers"):
        read_options(tmp_path / "bad.parquet")

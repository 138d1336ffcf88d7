"""Of what is tried, the likeliest wins; ranks of the winner calibrate the regions."""

from functools import partial

import numpy as np
import pandas as pd
import pytest
from study import study_model

from placing.learning.learned import Choices
from placing.learning.likelihoods import ScoringConfig, likelihood_rows, with_uniform
from placing.learning.tuning import (
    COLUMNS,
    TuningConfig,
    asked_of,
    choose,
    try_variants,
)
from placing.methods.answering import Asked
from placing.methods.names import METHODS
from placing.seeds import generator

CONFIG = TuningConfig((2, 3), (0.25, 0.75), 1, 1, 5, 10)
SCORING = ScoringConfig(0.01)


@pytest.fixture(scope="module")
def model():
    return study_model()


@pytest.fixture(scope="module")
def tried(model):
    rows = []
    for task in ("filled", "empty"):
        for question in asked_of(model, task, 0):
            stream = partial(generator, 0, question.name)
            args = stream, model, task, question, CONFIG, SCORING
            rows += try_variants(*args)
    return pd.DataFrame(rows, columns=COLUMNS)


def test_every_method_and_every_number_is_tried_on_every_labelled_object(tried):
    variants = set(zip(tried["method"], tried["variant"], strict=True))
    plain = {(m, "") for m in METHODS if m not in ("fmm", "dp_object")}
    mixtures = {("fmm", "2"), ("fmm", "3")}
    assert variants == plain | mixtures | {("dp_object", "0.25"), ("dp_object", "0.75")}
    counts = tried.groupby(["task", "method", "variant"]).size()
    assert set(counts["filled"]) == {4}  # one of two arrangements of four objects
    assert set(counts["empty"]) == {8}  # both


def test_what_is_tried_is_what_the_method_would_answer(model, tried):
    question = asked_of(model, "filled", 0)[0]
    stream = partial(generator, 0, question.name)
    asked = Asked(stream, model, question, Choices(3, 0.75))
    of_category = tried[tried["category"] == question.wanted[0].category]
    for method, variant in (("fmm", "3"), ("dp_object", "0.75"), ("height", "")):
        densities = asked.answer(method).densities
        mixed = {c: with_uniform(d, SCORING) for c, d in densities.items()}
        args = model.nearest, question, mixed, 0.05
        (_, _, _, nll, rank) = next(iter(likelihood_rows(*args)))
        of = of_category.query(f"method == '{method}' and variant == '{variant}'")
        row = of[of["task"] == "filled"].iloc[0]
        assert row["nll"] == pytest.approx(nll)
        assert row["rank"] == pytest.approx(rank)


def planted(nll_of):
    return pd.DataFrame(
        [
            (scene, "filled", method, variant, category, "x", nll, 0.1 * (i + 1))
            for i, scene in enumerate(("a", "b"))
            for category in ("mug", "tv")
            for (method, variant), nll in nll_of.items()
        ],
        columns=COLUMNS,
    )


def test_the_number_of_lowest_nll_is_chosen_and_calibrates():
    table = planted(
        {
            ("fmm", "2"): 1.0,
            ("fmm", "8"): 0.5,
            ("dp_object", "0.1"): 0.2,
            ("dp_object", "0.9"): 0.3,
            ("dp", ""): 1.0,
        }
    )
    table.loc[(table["method"] == "fmm") & (table["variant"] == "8"), "rank"] = 0.7
    chosen = choose(table)
    assert chosen["choices"] == {"filled": {"n_components": 8, "object_weight": 0.1}}
    ranks = chosen["calibration"]["filled"]
    assert ranks["fmm"] == [0.7] * 4
    assert ranks["dp"] == pytest.approx([0.1, 0.1, 0.2, 0.2])


def test_every_category_counts_the_same_in_the_choice():
    often = planted({("fmm", "2"): 0.0, ("fmm", "8"): 1.0, ("dp_object", "0.5"): 0.0})
    rare = often[(often["category"] == "tv") & (often["method"] == "fmm")].copy()
    rare["category"], rare["nll"] = "pen", np.where(rare["variant"] == "2", 9.0, 0.0)
    table = pd.concat([often, often, often, rare])
    chosen = choose(table)["choices"]["filled"]["n_components"]
    assert chosen == 8  # (0 + 0 + 9) / 3 against (1 + 1 + 0) / 3


def test_arrangements_fill_training_scenes_in_turn(model):
    names = [{q.labels for q in asked_of(model, "filled", turn)} for turn in range(3)]
    assert names == [{"labeller1"}, {"labeller2"}, {"labeller1"}]
    assert len(asked_of(model, "empty", 1)) == 1

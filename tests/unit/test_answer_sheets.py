"""What is written about answers is complete, and reasons add up to the score."""

from functools import partial

import numpy as np
import pytest
from study import study_model

from placing.artifacts.formats import write_json
from placing.artifacts.tuning import read_tuning
from placing.errors import BadArtifact
from placing.learning.learned import Choices
from placing.learning.likelihoods import ScoringConfig
from placing.methods.answering import Asked
from placing.methods.names import METHODS
from placing.plans.offering import OfferingConfig
from placing.seeds import generator
from placing.tables.answer_sheets import COLUMNS, EXPLAINED, Sheets
from placing.tasks import questions

RANKS = {method: np.linspace(0.05, 1, 30) for method in METHODS}


@pytest.fixture(scope="module")
def filled():
    """Return the sheets of one question, what it asked and the densities kept."""
    model = study_model()
    question = questions(model.scene, "filled")[1]
    asked = Asked(partial(generator, 0), model, question, Choices(2, 0.5))
    sheets = Sheets(ScoringConfig(0.01), RANKS)
    kept = sheets.fill("filled", asked)
    sheets.offer("filled", asked, OfferingConfig(3, 2, 2, 0.125))
    return sheets, asked, kept


@pytest.mark.parametrize("name", COLUMNS)
def test_every_table_has_its_columns_and_rows(filled, name):
    table = filled[0].table(name)
    assert list(table.columns) == list(COLUMNS[name])
    assert len(table)


def test_every_method_places_every_wanted_object(filled):
    sheets, asked, _ = filled
    table = sheets.table("arrangements")
    wanted = {item.object_id for item in asked.question.wanted}
    for method in METHODS:
        assert set(table[table["method"] == method]["object"]) == wanted
    assert (table["area_50_m2"] <= table["area_90_m2"]).all()
    likely = sheets.table("likelihoods")
    assert len(likely) == len(METHODS) * len(wanted)
    assert likely["rank"].between(0, 1).all()


def test_reasons_add_up_to_the_score_of_the_placement(filled):
    sheets, asked, _ = filled
    reasons = sheets.table("explanations")
    placed = sheets.table("arrangements").set_index(["method", "object"])
    for key, terms in reasons.groupby(["method", "object"]):
        method, name = key
        item = asked.model.items[name]
        _, smooth = asked.found(method, item.category)
        row = placed.loc[key]
        at = row[["x_m", "y_m", "z_m"]].to_numpy(float) - [0, 0, item.size_m[2] / 2]
        away = np.linalg.norm(asked.model.candidates.location - at, axis=1)
        heading = terms[terms["term"] == "heading"]["value"].item()
        score = np.log(smooth[away.argmin()]) + heading
        assert terms["value"].sum() == pytest.approx(score, abs=1e-9)
        assert terms["is_decisive"].sum() == 1
        loss = (terms["value"] - terms["alternative_value"]).to_numpy()
        assert terms["is_decisive"].to_numpy()[loss.argmax()]
    assert set(reasons["method"]) == set(EXPLAINED)


def test_densities_are_kept_for_the_methods_that_are_explained(filled):
    kept = filled[2]
    assert {key.split("/")[0] for key in kept} == set(EXPLAINED)


def test_chains_are_traced_sweep_by_sweep(filled):
    sheets, asked, _ = filled
    traces = sheets.table("traces")
    counts = traces.groupby("chain")["sweep"].agg(["size", "max"])
    assert len(counts) == asked.model.settings.sampling.n_chains
    assert (counts["size"] == counts["max"] + 1).all()


def tuning(**changes):
    chosen = {"n_components": 4, "object_weight": 0.5} | changes
    return {"choices": {"filled": chosen}, "calibration": {"filled": {"dp": [0.5]}}}


def test_what_was_tuned_comes_back(tmp_path):
    write_json(tmp_path / "t.json", tuning())
    choices, ranks = read_tuning(tmp_path / "t.json", "filled")
    assert choices == Choices(4, 0.5)
    np.testing.assert_array_equal(ranks["filled"]["dp"], [0.5])


@pytest.mark.parametrize(
    ("document", "said"),
    [
        (tuning(n_components=0), "n_components: value 0; expected a whole number"),
        (tuning(n_components=2.5), "n_components: value 2.5; expected a whole number"),
        (tuning(object_weight=1.5), "object_weight: value 1.5; expected a number"),
        (tuning(object_weight="x"), "object_weight: value 'x'; expected a number"),
        (tuning() | {"choices": {}}, "choices.filled: 'filled'; expected a file of"),
        ([], "t.json"),
    ],
)
def test_a_damaged_tuning_file_is_one_line(tmp_path, document, said):
    write_json(tmp_path / "t.json", document)
    with pytest.raises(BadArtifact, match=said) as error:
        read_tuning(tmp_path / "t.json", "filled")
    assert "\n" not in str(error.value)

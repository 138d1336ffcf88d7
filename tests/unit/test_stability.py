"""What stays scores higher, probabilities can be believed, files are checked."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pandas as pd
import pytest

from placing.artifacts.stability import read_stability, write_stability
from placing.errors import PlacingError
from placing.psi.stability import (
    StabilityConfig,
    fit_trees,
    folds_of,
    learn_stability,
    log_psi_stability,
    sum_trees,
)
from placing.tables.stability_report import (
    ALL,
    NEW,
    PROTOCOLS,
    REPORT_COLUMNS,
    SAME,
    area_under_curve,
    calibration_error,
    held_out,
    models_without,
    precision_at,
    report_of,
    report_rows,
    stability_markdown,
)

CONFIG = StabilityConfig(
    n_trees=30,
    max_depth=3,
    learning_rate=0.2,
    min_leaf=10,
    tried_share=0.7,
    tried_features=0.7,
    n_folds=3,
    n_candidates=10,
    min_probability=0.5,
)
NAMES = ("margin_m", "slope", "gap_m")


@cache
def tried(n=1500):
    """Return features and outcomes of boxes: most stay whose centre is on the area."""
    rng = np.random.default_rng(3)
    features = rng.normal(size=(n, 3)).astype(np.float32)
    chance = 1 / (1 + np.exp(-3 * features[:, 0] + 2 * np.maximum(features[:, 1], 0)))
    table = pd.DataFrame(
        {
            "fixture": rng.choice(["shelf", "table"], n),
            "object": rng.choice([f"object{i}" for i in range(9)], n),
            "stays": rng.random(n) < chance,
        }
    )
    return features, table, chance


def folds():
    known = folds_of(tried()[1]["object"], CONFIG.n_folds)
    return np.array([known[name] for name in tried()[1]["object"]])


@cache
def model():
    features, table, _ = tried()
    stays = table["stays"].to_numpy()
    return learn_stability(NAMES, features, stays, folds(), CONFIG)


def test_scores_grow_with_how_far_the_centre_is_inside():
    rows = np.array([[margin, -0.5, 0.0] for margin in (-1.5, -0.5, 0.5, 1.5)])
    scores = log_psi_stability(model(), rows)
    assert np.all(np.diff(scores) > 0)
    assert np.all(scores < 0)


def test_probabilities_agree_with_the_truth_on_held_out_trials():
    rng = np.random.default_rng(8)
    features = rng.normal(size=(20000, 3))
    truth = 1 / (1 + np.exp(-3 * features[:, 0] + 2 * np.maximum(features[:, 1], 0)))
    probability = np.exp(log_psi_stability(model(), features))
    stays = rng.random(len(truth)) < truth
    assert calibration_error(probability, stays) < 0.03
    assert np.mean(np.abs(probability - truth)) < 0.08


def test_the_loop_over_trees_gives_what_the_learner_gives():
    from sklearn.ensemble import GradientBoostingClassifier

    features, table, _ = tried()
    stays = table["stays"].to_numpy()
    learner = GradientBoostingClassifier(
        n_estimators=30,
        max_depth=3,
        learning_rate=0.2,
        min_samples_leaf=10,
        subsample=0.7,
        max_features=0.7,
        random_state=0,
    ).fit(features, stays)
    trees = fit_trees(NAMES, features, stays, CONFIG)
    expected = learner.decision_function(features)
    assert sum_trees(trees, features) == pytest.approx(expected, abs=1e-6)


def test_a_model_keeps_its_numbers_in_a_file(tmp_path):
    write_stability(tmp_path / "model.json", model())
    again = read_stability(tmp_path / "model.json")
    features = tried()[0]
    difference = log_psi_stability(again, features) - log_psi_stability(
        model(), features
    )
    assert np.abs(difference).max() < 1e-6
    assert again.features == NAMES


def spoilt(change):
    """Return the document of the model after a change."""

    def of(document):
        change(document)
        return json.dumps(document)

    return of


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda document: json.dumps(document)[:-200], "cannot be read as JSON"),
        (lambda document: "[1, 2]", "fields: value"),
        (spoilt(lambda d: d.pop("slope")), "fields: value"),
        (spoilt(lambda d: d.update(extra=1)), "fields: value"),
        (spoilt(lambda d: d.update(slope=float("nan"))), "slope: value nan"),
        (spoilt(lambda d: d.update(slope=-1.0)), "slope: value -1.0"),
        (spoilt(lambda d: d.update(start=True)), "start: value True"),
        (spoilt(lambda d: d.update(start=None)), "start: value None"),
        (spoilt(lambda d: d.update(features=["a", "a"])), "features: value"),
        (spoilt(lambda d: d["value"][0].pop()), "value: value"),
        (spoilt(lambda d: d["value"][3].__setitem__(2, "x")), "value: value 'x'"),
        (spoilt(lambda d: d["value"][3].__setitem__(2, 1e400)), "value: value inf"),
        (spoilt(lambda d: d["cut"][0].__setitem__(0, 0.5)), "cut: value 0.5"),
        (spoilt(lambda d: d["cut"][0].__setitem__(0, 3)), "cut: value 3"),
        (spoilt(lambda d: d["left"][0].__setitem__(0, 0)), "left: value 0"),
        (spoilt(lambda d: d.update(cut=[])), "cut: value []"),
    ],
)
def test_a_spoilt_file_is_refused_in_one_line(tmp_path, spoil, said):
    path = tmp_path / "model.json"
    write_stability(path, model())
    path.write_text(spoil(json.loads(path.read_text())))
    with pytest.raises(PlacingError) as caught:
        read_stability(path)
    line = str(caught.value)
    assert str(path) in line
    assert said in line
    assert "\n" not in line


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(PlacingError, match=r"none\.json: file is missing, expected"):
        read_stability(tmp_path / "none.json")


def test_other_columns_than_it_learned_from_are_refused():
    with pytest.raises(ValueError, match="expected 3 columns"):
        log_psi_stability(model(), np.zeros((2, 4)))


def test_models_of_a_protocol_never_saw_what_they_are_asked_about(monkeypatch):
    seen = []

    def remember(names, features, stays, config):
        seen.append(features[:, 0].tolist())
        return model()

    monkeypatch.setattr("placing.tables.stability_report.fit_trees", remember)
    features, table, _ = tried()
    for protocol in PROTOCOLS:
        seen.clear()
        models = models_without(NAMES, features, table, folds(), protocol, CONFIG)
        assert set(models) == {(k, f) for k in ("shelf", "table") for f in range(3)}
        cases = [(None, f) for f in range(3)]
        if protocol == NEW:
            cases = [(kind, f) for f in range(3) for kind in ("shelf", "table")]
        for (kind, fold), values in zip(cases, seen, strict=True):
            used = (folds() != fold) & (table["fixture"] != kind).to_numpy()
            assert values == features[used, 0].tolist()


def test_the_report_takes_the_rows_of_each_protocol():
    features, table, _ = tried()
    models = {SAME: models_without(NAMES, features, table, folds(), SAME, CONFIG)}
    chosen = table.head(10).assign(protocol=[SAME] * 4 + [NEW] * 6)
    report = report_of(models, features, table, folds(), chosen)
    scores = held_out(models[SAME], features, table, folds(), log_psi_stability)
    rows = report_rows(SAME, table, scores, chosen.head(4))
    pd.testing.assert_frame_equal(report, pd.DataFrame(rows), check_dtype=False)


def test_the_report_finds_what_can_be_known():
    features, table, chance = tried()
    models = models_without(NAMES, features, table, folds(), SAME, CONFIG)
    scores = held_out(models, features, table, folds(), log_psi_stability)
    chosen = table.head(10).assign(stays=[True] * 9 + [False])
    rows = report_rows(SAME, table, scores, chosen)
    assert [row["fixture"] for row in rows] == ["shelf", "table", ALL]
    overall = rows[-1]
    stays = table["stays"].to_numpy()
    best = area_under_curve(chance, stays)
    assert best - 0.03 < overall["auc"] <= best + 0.01
    assert overall["precision_at_1"] > 0.85
    assert overall["calibration_error"] < 0.05
    assert (overall["n_chosen"], overall["chosen_stay"]) == (10, 0.9)
    text = stability_markdown(pd.DataFrame(rows, columns=list(REPORT_COLUMNS)))
    assert f"| {SAME} | all | 1500 |" in text


def test_the_area_under_the_curve_is_the_share_of_pairs_in_order():
    rng = np.random.default_rng(1)
    scores, stays = rng.integers(0, 9, 60).astype(float), rng.random(60) < 0.4
    good, bad = scores[stays][:, None], scores[~stays][None]
    expected = np.mean((good > bad) + 0.5 * (good == bad))
    assert area_under_curve(scores, stays) == pytest.approx(expected)


def test_precision_looks_at_the_best_of_each_pair_that_can_tell():
    table = pd.DataFrame(
        {
            "fixture": "table",
            "object": ["a"] * 3 + ["b"] * 2 + ["c"] * 2,
            "stays": [True, False, True, True, False, False, False],
        }
    )
    scores = np.array([0.9, 0.1, 0.3, 0.1, 0.8, 0.5, 0.2])
    assert precision_at(1, table, scores) == 0.5  # right for a, wrong for b
    assert precision_at(2, table, scores) == 1.0  # only of a do two stay
    assert np.isnan(precision_at(3, table, scores))


def test_calibration_sees_overconfidence():
    stays = np.arange(1000) % 10 < 8
    assert calibration_error(np.full(1000, 0.8), stays) == pytest.approx(0)
    assert calibration_error(np.full(1000, 0.97), stays) == pytest.approx(0.17)


def test_more_than_a_hundred_thousand_placements_a_second():
    from time import process_time

    big = replace(
        model(),
        **{
            name: np.tile(getattr(model(), name), (4, 1))
            for name in ("cut", "threshold", "left", "right", "value")
        },
    )
    features = np.tile(tried()[0], (70, 1))
    log_psi_stability(big, features[:10])
    start = process_time()
    log_psi_stability(big, features)
    assert len(features) / (process_time() - start) > 1e5

"""Regions hold what they state, whatever the density; ties and few ranks are safe."""

import json

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from placing.errors import BadArtifact, BadInput, PlacingError
from placing.methods.regions import (
    REGION_LEVELS,
    TOLERANCE,
    calibrate,
    ranks_of,
    region_areas,
)
from placing.tables.coverage import (
    AREA_COLUMNS,
    LEVELS,
    add_areas,
    folds_of,
    measure_coverage,
    read_calibration,
)
from placing.tables.coverage_figure import IN_FRONT, plot_coverage
from placing.tables.coverage_table import coverage_markdown
from placing.tables.figures import METHODS

TIED = np.array([0.1, 0.3, 0.1, 0.4, 0.1, 0.0])


def test_the_rank_is_the_mass_of_the_places_at_least_as_dense():
    expected = [1.0, 0.7, 1.0, 0.4, 1.0, 1.0]
    np.testing.assert_allclose(ranks_of(TIED, np.arange(6)), expected)
    assert float(ranks_of(TIED, 1)) == pytest.approx(0.7)
    np.testing.assert_allclose(ranks_of(5 * TIED, [1]), 0.7)


def test_ranks_are_those_of_each_place():
    rng = np.random.default_rng(0)
    density = rng.integers(0, 30, 400) / 1.0
    direct = [density[density >= d].sum() / density.sum() for d in density]
    np.testing.assert_allclose(ranks_of(density, np.arange(400)), direct)


def region(density, threshold):
    """Return the places whose rank is at most a threshold, shape (p,)."""
    ranks = ranks_of(density, np.arange(len(density)))
    return (ranks <= threshold + TOLERANCE) | (threshold >= 1)


def test_a_region_is_the_densest_places_of_at_most_the_threshold():
    np.testing.assert_array_equal(np.flatnonzero(region(TIED, 0.7)), [1, 3])
    np.testing.assert_array_equal(np.flatnonzero(region(TIED, 0.99)), [1, 3])
    assert region(TIED, 1.0).all()
    assert not region(TIED, 0.39).any()


def test_the_area_of_a_region_counts_its_places():
    rng = np.random.default_rng(1)
    thresholds = np.array([0.0, 0.05, 0.31, 0.5, 0.8, 0.97, 1.0])
    for density in (TIED, rng.dirichlet(np.ones(300)), rng.integers(0, 4, 300) / 450):
        counted = [region(density, t).sum() * 0.05**2 for t in thresholds]
        np.testing.assert_allclose(region_areas(density, thresholds, 0.05), counted)
    assert region_areas(TIED, np.array([0.7]), 0.5)[0] == pytest.approx(2 * 0.25)


def test_a_uniform_density_has_no_region_but_everything():
    uniform = np.full(50, 1 / 50)
    thresholds = calibrate(ranks_of(uniform, np.arange(30)), REGION_LEVELS)
    np.testing.assert_array_equal(thresholds, 1)
    np.testing.assert_allclose(region_areas(uniform, thresholds, 1.0), 50)


def test_calibration_takes_the_rank_with_the_finite_sample_correction():
    ranks = np.arange(1, 10) / 100  # nine ranks: level k / 10 is the k-th of them
    np.testing.assert_allclose(
        calibrate(ranks[::-1], [0.1, 0.5, 0.9]), ranks[[0, 4, 8]]
    )
    np.testing.assert_allclose(calibrate(ranks, [0.11, 0.51]), ranks[[1, 5]])
    assert calibrate(ranks, [0.91])[0] == 1.0


@pytest.mark.parametrize("n", [0, 1, 4])
def test_too_few_ranks_give_the_whole_set(n):
    thresholds = calibrate(np.full(n, 0.2), [0.9])
    assert thresholds.tolist() == [1.0]
    assert region(TIED, thresholds[0]).all()


@pytest.mark.parametrize("sharpness", [0.3, 1.0, 3.0])
def test_coverage_of_exchangeable_objects_is_the_level_however_wrong_the_density(
    sharpness,
):
    rng = np.random.default_rng(7)
    truth = rng.dirichlet(np.full(200, 0.5))
    stated = truth**sharpness / (truth**sharpness).sum()  # too vague, right, too sure
    levels = np.array([0.5, 0.8, 0.9])
    inside = []
    for _ in range(200):
        ranks = ranks_of(stated, rng.choice(200, 39 + 50, p=truth))
        inside.append(ranks[39:, None] <= calibrate(ranks[:39], levels))
    coverage = np.mean(inside, axis=(0, 1))
    # Over draws of 39 calibration ranks: the level, plus what ties of a place add.
    se = np.std(np.mean(inside, axis=1), axis=0) / np.sqrt(200)
    assert (coverage > levels - 3 * se).all()
    assert (coverage < levels + 1 / 40 + np.max(truth) + 3 * se).all()
    as_stated = (ranks[:, None] <= levels).mean(0)
    assert sharpness != 3.0 or (as_stated < levels - 0.2).all()


def scores_of(seed=3, n_scenes=30, n=8):
    """Return ranks of `n` objects per scene that share the luck of their scene."""
    rng = np.random.default_rng(seed)
    rank = np.clip(
        rng.beta(2, 1, (n_scenes, 1)) + rng.normal(0, 0.05, (n_scenes, n)), 0, 1
    )
    scene = np.repeat([f"s{i}" for i in range(n_scenes)], n)
    tables = [
        pd.DataFrame(
            {"task": task, "method": method, "scene": scene, "rank": rank.ravel()}
        )
        for task in ("filled", "empty")
        for method in ("chance", "height", "dp")
    ]
    table = pd.concat(tables, ignore_index=True)
    table.loc[table["method"] == "chance", "rank"] = 1.0
    return table.assign(dataset="rooms")


def calibration_of(scores, fold_of):
    """Return the ranks of the objects in the other folds, by fold."""
    fold = scores["scene"].map(fold_of)
    return {
        f: {
            task: {m: g["rank"].to_numpy() for m, g in of_task.groupby("method")}
            for task, of_task in scores[fold != f].groupby("task")
        }
        for f in sorted(set(fold_of.values()))
    }


@pytest.fixture
def measured():
    scores = scores_of()
    fold_of = {f"s{i}": i % 3 for i in range(30)}
    return scores, fold_of, calibration_of(scores, fold_of)


def test_coverage_is_the_share_of_objects_inside_in_the_test_folds(measured):
    scores, fold_of, calibration = measured
    table = measure_coverage(scores, fold_of, calibration)
    dp = scores[(scores["task"] == "filled") & (scores["method"] == "dp")]
    for level in (0.2, 0.9):
        inside = [
            rank
            <= calibrate(calibration[fold_of[s]]["filled"]["dp"], [level])[0] + 1e-6
            for s, rank in zip(dp["scene"], dp["rank"], strict=True)
        ]
        row = table.query("task == 'filled' and method == 'dp'")
        row = row[np.isclose(row["level"], level)].iloc[0]
        assert row["coverage"] == pytest.approx(np.mean(inside))
        assert row["coverage_as_stated"] == pytest.approx((dp["rank"] <= level).mean())
        by_scene = pd.Series(inside).groupby(dp["scene"].to_numpy()).mean()
        # All scenes have as many objects: then it is the error of a mean over scenes.
        assert row["coverage_se"] == pytest.approx(by_scene.sem())
        assert (row["n"], row["n_scenes"]) == (240, 30)
    everything = table[table["method"] == "chance"]
    assert (everything["coverage"] == 1).all()
    assert (everything["share_everything"] == 1).all()


def test_the_labels_have_no_ranks_and_are_left_out(measured):
    scores, fold_of, calibration = measured
    labels = scores[scores["method"] == "dp"].assign(method="labels", rank=np.nan)
    with_labels = pd.concat([scores, labels])
    pd.testing.assert_frame_equal(
        measure_coverage(with_labels, fold_of, calibration),
        measure_coverage(scores, fold_of, calibration),
    )


def test_areas_stand_beside_the_levels_they_belong_to(measured):
    table = measure_coverage(*measured)
    arrangements = pd.DataFrame({"task": "filled", "method": ["dp", "dp", "height"]})
    for i, column in enumerate(AREA_COLUMNS.values()):
        arrangements[column] = [1.0 + i, 2.0 + i, 5.0]
    with_areas = add_areas(table, arrangements)
    assert len(with_areas) == len(table)
    dp = with_areas.query("task == 'filled' and method == 'dp'").set_index("level")
    assert dp["area_m2"].dropna().to_dict() == {0.5: 1.5, 0.8: 2.5, 0.9: 3.5}
    page = coverage_markdown(with_areas)
    assert "Data set `rooms`" in page
    assert "| 1.50 |" in page
    assert "area [m²]" not in coverage_markdown(table)


@pytest.mark.parametrize(
    ("document", "complaint"),
    [
        ([], r"f.json: value \[\]; expected a mapping"),
        ({}, "f.json: calibration: value None; expected a mapping"),
        ({"calibration": {"filled": 3}}, "calibration.filled: value 3; expected a map"),
        (
            {"calibration": {"filled": {"dp": "x\ny"}}},
            r"value 'x\\ny'; expected a list",
        ),
        ({"calibration": {"filled": {"dp": [0.5, None]}}}, r"dp\[1\]: value None; exp"),
        ({"calibration": {"filled": {"dp": [True]}}}, "value True; expected a rank"),
        ({"calibration": {"filled": {"dp": [1.5]}}}, "value 1.5; expected a rank"),
        ({"calibration": {"filled": {"dp": [-1]}}}, "value -1; expected a rank"),
        ({"calibration": {"filled": {"dp": [float("nan")]}}}, "value nan; expected a"),
        ({"calibration": {"filled": {"dp": [[0.1] * 99]}}}, r"\.\.\.; expected a rank"),
    ],
)
def test_a_hostile_tuning_file_is_refused_in_one_line(document, complaint):
    with pytest.raises(BadArtifact, match=complaint) as error:
        read_calibration(json.loads(json.dumps(document)), "f.json")
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("f.json: ")


def test_what_cannot_be_measured_is_refused_in_one_line(measured):
    scores, fold_of, calibration = measured
    without = {f: {"filled": ranks["filled"]} for f, ranks in calibration.items()}
    with pytest.raises(
        BadArtifact, match=r"fold 0: calibration.empty: key 'chance' is"
    ):
        measure_coverage(scores, fold_of, without)
    with pytest.raises(PlacingError, match="unknown scene in the scores: 's0'"):
        measure_coverage(scores, {"other": 0}, calibration)
    both = pd.concat([scores, scores.assign(dataset="thor")])
    with pytest.raises(BadInput, match="dataset is rooms, thor; expected one"):
        measure_coverage(both, fold_of, calibration)
    sheet = pd.DataFrame({"dataset": ["rooms"], "scene": ["a"], "fold": [0]})
    assert folds_of(sheet, "rooms") == {"a": 0}
    with pytest.raises(PlacingError, match="unknown data set 'thor'; known are rooms"):
        folds_of(sheet, "thor")


def test_each_line_of_the_plot_goes_through_its_numbers(measured):
    table = measure_coverage(*measured)
    figure = plot_coverage(table)
    (stated, _), (miss, _) = np.array(figure.axes).reshape(2, 2)
    rows = table.query("task == 'filled' and method == 'height'")
    name, color = METHODS["height"]
    for axes, y in (
        (stated, rows["coverage_as_stated"]),
        (miss, rows["coverage"] - rows["level"]),
    ):
        (line,) = [line for line in axes.lines if line.get_label() == name]
        assert line.get_color() == color
        np.testing.assert_allclose(line.get_xdata(), LEVELS)
        np.testing.assert_allclose(line.get_ydata(), y)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["ideal", "height", METHODS[IN_FRONT][0]]
    assert "data set rooms" in figure.get_suptitle()
    plt.close(figure)

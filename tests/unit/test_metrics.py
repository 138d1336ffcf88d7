"""Errors are matched within a category and averaged over scenes."""

from itertools import permutations

import numpy as np
import pandas as pd
import pytest

from placing.tables.metrics import ERRORS, SUMMARY_COLUMNS, errors, summarise


def test_matching_is_the_best_of_all_permutations():
    rng = np.random.default_rng(0)
    predicted, labelled = rng.normal(size=(2, 4, 3))
    best = min(
        np.hypot(*(predicted[list(order)] - labelled)[:, :2].T).sum()
        for order in permutations(range(4))
    )
    match, found = errors(predicted, labelled)
    assert found[:, 0].sum() == pytest.approx(best)
    direct = np.hypot(*(predicted[match] - labelled)[:, :2].T)
    np.testing.assert_allclose(found[:, 0], direct)


def test_location_error_is_horizontal_and_height_has_its_own():
    _, found = errors(np.array([[3.0, 4.0, 1.0]]), np.array([[0.0, 0.0, 0.5]]))
    by_name = dict(zip(ERRORS, found[0], strict=True))
    assert by_name["location_error_m"] == pytest.approx(5)
    assert by_name["height_error_m"] == pytest.approx(0.5)
    assert by_name["location3d_error_m"] == pytest.approx(np.hypot(5, 0.5))


def scores(rows):
    columns = ["scene", "category", "location_error_m"]
    table = pd.DataFrame(rows, columns=columns)
    error = table["location_error_m"]
    table["location3d_error_m"] = table["height_error_m"] = error
    table["nll"], table["orientation_error_deg"] = 2 * error, 10 * error
    return table.assign(dataset="rooms", task="filled", method="dp", labels="a")


def test_a_scene_counts_once_however_many_objects_it_has():
    table = scores([("a", "mug", 1.0), ("a", "mug", 1.0), ("b", "mug", 4.0)])
    row = summarise(table).set_index("category").loc["mug"]
    assert row["location_m"] == pytest.approx(2.5)
    assert row["n"] == 3
    assert row["location_se_m"] == pytest.approx(1.5)


def test_average_counts_every_category_once():
    rows = [("a", "mug", 1.0), ("b", "mug", 1.0), ("a", "tv", 3.0)]
    average = summarise(scores(rows)).set_index("category").loc["AVG"]
    assert average["location_m"] == pytest.approx(2.0)
    assert average["n"] == 3


def test_unplaced_objects_are_left_out_of_means():
    rows = [("a", "mug", 1.0), ("a", "mug", np.nan)]
    row = summarise(scores(rows)).set_index("category").loc["mug"]
    assert row["n"] == 1
    assert row["location_m"] == pytest.approx(1.0)


def test_every_measure_is_averaged_as_by_a_slow_loop():
    rng = np.random.default_rng(1)
    n = 300
    table = scores(
        list(
            zip(
                rng.choice(list("abcdefg"), n),
                rng.choice(["book", "mug", "tv"], n),
                rng.exponential(size=n),
                strict=True,
            )
        )
    )
    columns = {
        "nll": "nll",
        "orientation_deg": "orientation_error_deg",
        "height_m": "height_error_m",
    }
    for column in columns.values():
        table[column] = rng.exponential(size=n)
    table.loc[table["category"] == "book", "orientation_error_deg"] = np.nan
    found = summarise(table).set_index("category")
    for name, column in columns.items():

        def average(left_out: str, column=column) -> float:
            kept = table[(table["scene"] != left_out) & table[column].notna()]
            means = []
            for category in sorted(set(kept["category"])):
                of_category = kept[kept["category"] == category]
                by_scene = [
                    of_category[of_category["scene"] == scene][column].mean()
                    for scene in sorted(set(of_category["scene"]))
                ]
                means.append(np.mean(by_scene))
            return float(np.mean(means))

        assert found.loc["AVG", name] == pytest.approx(average(""))
        left_out = np.array([average(scene) for scene in "abcdefg"])
        se = np.sqrt(6 / 7 * ((left_out - left_out.mean()) ** 2).sum())
        error = {"nll": "nll_se"}.get(name, name.replace("_", "_se_", 1))
        assert found.loc["AVG", error] == pytest.approx(se)
        tv = table[table["category"] == "tv"].groupby("scene")[column].mean()
        assert found.loc["tv", name] == pytest.approx(tv.mean())
        assert found.loc["tv", error] == pytest.approx(tv.sem())


def test_a_category_without_a_front_has_no_orientation_and_leaves_the_average_alone():
    table = scores([("a", "mug", 1.0), ("b", "mug", 3.0), ("a", "book", 8.0)])
    table.loc[table["category"] == "book", "orientation_error_deg"] = np.nan
    found = summarise(table).set_index("category")
    assert np.isnan(found.loc["book", "orientation_deg"])
    assert found.loc["AVG", "orientation_deg"] == pytest.approx(20.0)


def test_columns_stay_where_readers_expect_them():
    table = summarise(scores([("a", "mug", 1.0)]))
    assert tuple(table.columns) == SUMMARY_COLUMNS
    assert SUMMARY_COLUMNS[:11] == (
        *("dataset", "task", "method", "category", "n", "location_m"),
        *("location_se_m", "location3d_m", "height_m", "height_se_m", "nll"),
    )


def test_unmixed_is_the_share_of_questions_in_which_a_category_is_wanted():
    filled = scores(
        [("a", "mug", 1.0), ("a", "mug", 1.0), ("a", "tv", 1.0), ("b", "mug", 1.0)]
    )
    empty = filled.assign(task="empty")
    table = pd.concat([filled, empty])
    both = [table, table.assign(method="dp_object"), table.assign(method="chance")]
    rows = [
        ("a", "filled", "dp", "a/mug", False),
        ("a", "filled", "dp", "a/tv", True),
        ("b", "filled", "dp", "a/mug", True),
        ("a", "empty", "dp", "all", True),
        ("b", "empty", "dp", "all", False),
    ]
    columns = ["scene", "task", "method", "question", "is_mixed"]
    diagnostics = pd.DataFrame(rows, columns=columns)
    found = summarise(pd.concat(both), diagnostics)
    found = found.set_index(["task", "method", "category"])["unmixed"]
    for method in ("dp", "dp_object"):
        assert found["filled", method, "mug"] == pytest.approx(1 / 2)
        assert found["filled", method, "tv"] == 0
        assert found["filled", method, "AVG"] == pytest.approx(1 / 3)
        assert found["empty", method, "mug"] == pytest.approx(1 / 2)
        assert found["empty", method, "tv"] == 0
        assert found["empty", method, "AVG"] == pytest.approx(1 / 2)
    assert found.loc[:, "chance"].isna().all()

"""Errors are matched within a category and averaged over scenes."""

from itertools import permutations

import numpy as np
import pandas as pd
import pytest

from placing.metrics import ERRORS, errors, summarise


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
    table["location3d_error_m"] = table["height_error_m"] = table["location_error_m"]
    return table.assign(dataset="rooms", task="filled", method="dp", nll=1.0)


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

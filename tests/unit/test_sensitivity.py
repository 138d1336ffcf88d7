"""Variations are compared with the configuration scene by scene."""

import numpy as np
import pandas as pd
import pytest

from placing.seeds import generator
from placing.tables import metrics
from placing.tables.sensitivity import SENSITIVITY_COLUMNS, compare_variations
from placing.tables.sensitivity_table import sensitivity_markdown

SHIFTS = {"smoothing_m=0.1": 0.3, "base": 0.0, "concentration=0.3": 0.0}


def varied(shifts=SHIFTS, n_scenes=12):
    """Return scores whose errors differ from those of `base` by a shift."""
    rng = np.random.default_rng(0)
    keys = [(f"s{k}", c) for k in range(n_scenes) for c in ("book", "tv")]
    shared, tables = rng.exponential(2, len(keys)), []
    for variation, shift in shifts.items():
        table = pd.DataFrame(keys, columns=["scene", "category"])
        noise = 0 if variation == "base" else rng.normal(0, 0.1, len(keys))
        for column in metrics.MEASURES.values():
            table[column] = shared + shift + noise
        tables.append(table.assign(variation=variation))
    scores = pd.concat(tables, ignore_index=True)
    return scores.assign(dataset="rooms", task="filled", method="dp", labels="a")


def compare(scores):
    return compare_variations(generator(0, "test"), scores)


def test_base_comes_first_and_differs_from_itself_by_nothing():
    table = compare(varied())
    assert table["variation"].tolist() == [
        "base",
        "smoothing_m=0.1",
        "concentration=0.3",
    ]
    base = table.iloc[0]
    for end in ("difference", "low", "high"):
        assert base[f"location_m_{end}"] == 0
    assert tuple(table.columns) == SENSITIVITY_COLUMNS


def test_a_planted_shift_is_found_and_no_shift_is_not():
    table = compare(varied()).set_index("variation")
    shifted, same = table.loc["smoothing_m=0.1"], table.loc["concentration=0.3"]
    for metric in ("location_m", "height_m", "nll"):
        assert 0.2 < shifted[f"{metric}_low"] < 0.3 < shifted[f"{metric}_high"] < 0.4
        assert same[f"{metric}_low"] < 0 < same[f"{metric}_high"]


def test_averages_are_those_of_figure_6():
    scores = varied()
    table = compare(scores).set_index("variation")
    figure6 = metrics.summarise(scores[scores["variation"] == "base"])
    average = figure6.set_index("category").loc["AVG"]
    base = table.loc["base"]
    assert base["location_m"] == pytest.approx(average["location_m"])
    assert base["location_m_se"] == pytest.approx(average["location_se_m"])
    assert base["nll_se"] == pytest.approx(average["nll_se"])
    assert base["n_scenes"] == 12


def test_differences_are_over_the_scenes_that_both_have():
    scores = varied()
    is_left_out = (scores["variation"] == "smoothing_m=0.1") & (scores["scene"] < "s2")
    kept = scores[~is_left_out]
    found = compare(kept).set_index("variation").loc["smoothing_m=0.1"]
    assert found["location_m_difference"] == pytest.approx(0.3, abs=0.1)
    assert found["n_scenes"] < 12


def test_without_base_there_is_no_difference():
    table = compare(varied({"concentration=0.3": 0.0}))
    assert np.isnan(table["location_m_difference"]).all()
    assert np.isfinite(table["location_m"]).all()


def test_page_marks_what_differs():
    page = sensitivity_markdown(compare(varied()))
    assert "Data set `rooms`" in page
    lines = {line.split("`")[3]: line for line in page.splitlines() if "`dp`" in line}
    assert lines["smoothing_m=0.1"].count("\\*") == 3
    assert "\\*" not in lines["concentration=0.3"]
    assert "\\*" not in lines["base"]

"""A claim holds, is contradicted or is not resolved as the planted differences say."""

import numpy as np
import pandas as pd
import pytest

from placing.methods.names import ORDER
from placing.seeds import generator
from placing.tables import metrics
from placing.tables.claims import (
    CLAIMS,
    COLUMNS,
    CONTRADICTED,
    HOLDS,
    METRICS,
    NOT_RESOLVED,
    Claim,
    check_claims,
    verdict,
)
from placing.tables.claims_table import claims_markdown

CATEGORIES = ("book", "laptop", "shoe", "tv")


def planted(shifts, n_scenes=20, task="filled"):
    """Return scores of methods whose errors differ from a shared one by a shift."""
    rng = np.random.default_rng(3)
    scenes = [f"scene{k}" for k in range(n_scenes)]
    keys = [(s, c) for s in scenes for c in CATEGORIES]
    shared = pd.Series(rng.exponential(2, len(keys)))
    tables = []
    for method, shift in shifts.items():
        table = pd.DataFrame(keys, columns=["scene", "category"])
        error = shared + shift + rng.normal(0, 0.2, len(keys))
        for column in metrics.MEASURES.values():
            table[column] = error
        has_front = table["category"] == "laptop"
        table["orientation_error_deg"] = (10 * error).where(has_front)
        tables.append(table.assign(method=method))
    scores = pd.concat(tables, ignore_index=True)
    return scores.assign(dataset="rooms", task=task, labels="a", object="o")


def check(scores, *claims):
    table = check_claims(generator(0, "test"), scores, claims or CLAIMS)
    return table.set_index(["task", "better", "worse", "metric"])


@pytest.mark.parametrize(
    ("shift", "expected"),
    [(-0.5, HOLDS), (0.5, CONTRADICTED), (0.0, NOT_RESOLVED)],
)
def test_planted_difference_gets_its_verdict(shift, expected):
    scores = planted({"dp": 1 + shift, "object": 1.0})
    found = check(scores, Claim("filled", ("dp",), ("object",), "a.", "b"))
    assert set(found["verdict"]) == {expected}
    assert len(found) == len(METRICS)


def test_difference_and_interval_are_those_of_a_slow_bootstrap():
    scores = planted({"dp": 0.9, "object": 1.0}, n_scenes=8)
    scores = scores.drop(scores.index[(scores["scene"] == "scene1")][::3])
    claim = Claim("filled", ("dp",), ("object",), "a.", "b")
    row = check(scores, claim).loc["filled", "dp", "object", "location_m"]
    wide = scores.pivot_table("location_error_m", ["method", "category"], "scene")
    rng = np.random.default_rng(0)

    def gap(drawn):
        means = [
            np.nanmean(wide.loc[method].to_numpy()[:, drawn], axis=1).mean()
            for method in ("dp", "object")
        ]
        return means[0] - means[1]

    spread = [gap(rng.integers(0, 8, 8)) for _ in range(2000)]
    low, high = np.quantile(spread, [0.025, 0.975])
    assert row["difference"] == pytest.approx(gap(np.arange(8)))
    width = high - low
    assert row["low"] == pytest.approx(low, abs=0.1 * width)
    assert row["high"] == pytest.approx(high, abs=0.1 * width)


def test_a_claim_about_some_categories_reads_only_these():
    scores = planted({"dp": 1.0, "object": 1.0})
    is_hit = (scores["method"] == "dp") & (scores["category"] == "tv")
    scores.loc[is_hit, "location_error_m"] -= 3
    tv = Claim("filled", ("dp",), ("object",), "a.", "b", ("tv",))
    rest = Claim("filled", ("dp",), ("object",), "a.", "b", ("book", "shoe"))
    key = ("filled", "dp", "object", "location_m")
    assert check(scores, tv).loc[key, "difference"] == pytest.approx(-3, abs=0.2)
    assert check(scores, rest).loc[key, "verdict"] == NOT_RESOLVED
    assert ("filled", "dp", "object", "orientation_deg") not in check(
        scores, rest
    ).index


def test_a_method_is_compared_with_itself_in_another_task():
    filled = planted({"dp": 1.0})
    empty = planted({"dp": 2.0}, task="empty")
    claim = Claim("filled", ("dp",), (), "a.", "b", (), "empty")
    found = check(pd.concat([filled, empty]), claim)
    row = found.loc["filled", "dp", "dp", "location_m"]
    assert row["difference"] == pytest.approx(-1, abs=0.2)
    assert row["worse_task"] == "empty"
    assert row["verdict"] == HOLDS


def test_one_scene_resolves_nothing():
    scores = planted({"dp": 0.0, "object": 9.0}, n_scenes=1)
    found = check(scores, Claim("filled", ("dp",), ("object",), "a.", "b"))
    assert set(found["verdict"]) == {NOT_RESOLVED}
    assert verdict(np.nan, np.nan) == NOT_RESOLVED


def test_same_seed_gives_the_same_table():
    scores = planted({"dp": 1.0, "object": 1.1, "chance": 2.0})
    one, two = (check_claims(generator(5, "a"), scores) for _ in range(2))
    pd.testing.assert_frame_equal(one, two)
    assert tuple(one.columns) == COLUMNS


def test_claims_name_known_methods_tasks_and_categories():
    for claim in CLAIMS:
        methods = {method for pair in claim.pairs() for method in pair}
        assert methods <= set(ORDER)
        assert {claim.task, claim.worse_task or claim.task} <= {"filled", "empty"}
        assert claim.pairs()
        assert claim.sentence.endswith(".")


def test_page_says_every_comparison_once_and_what_is_lacking():
    scores = planted({"dp": 0.5, "object": 1.0, "chance": 1.0})
    table = check_claims(generator(0, "a"), scores)
    page = claims_markdown(table, "rooms")
    assert "Data set `rooms`" in page
    n_comparisons = len(table.drop_duplicates(["sentence", "better", "worse"]))
    assert page.count("\n- `") == n_comparisons
    assert page.count("**holds**") + page.count("**contradicted**") + page.count(
        "*not resolved*"
    ) - page.count("**holds**: ") - page.count("**contradicted**: ") - page.count(
        "*not resolved*: "
    ) == len(table)
    lacking = page.split("Not in these scores: ")[1].split(".")[0]
    assert lacking == "height, room, area, random_human, fmm, dp_object"


def test_page_of_no_claim_says_so():
    table = check_claims(generator(0, "a"), planted({"chance": 1.0}))
    assert "No claim can be tested" in claims_markdown(table, "rooms")

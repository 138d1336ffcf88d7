"""Hits count labels on the most probable areas; ties share their ranks."""

from itertools import permutations

import numpy as np
import pytest
from study import SETTINGS, study

from placing.methods.baselines import learn_histograms
from placing.psi.labelled_areas import label_shares
from placing.tables.semantics_table import (
    height_shares,
    hit_rows,
    hits,
    tabulate_semantics,
)


def slow_hits(weights, shares, k):
    """Return the share of labels on the first k areas, over all orders of ties."""
    found = []
    for order in permutations(range(len(weights))):
        if all(np.diff(np.array(weights)[list(order)]) <= 0):
            found.append(sum(shares[i] for i in order[:k]))
    return np.mean(found)


@pytest.mark.parametrize(
    "weights", [(3, 2, 1, 4, 0), (1, 1, 1, 1, 1), (2, 2, 1, 1, 1), (0, 5, 5, 5, 1)]
)
def test_ties_count_as_all_their_orders_would(weights):
    shares = np.array([0.25, 0, 0.5, 0, 0.25])
    top1, top3, _ = hits(np.array(weights, float), shares)
    assert top1 == pytest.approx(slow_hits(weights, shares, 1))
    assert top3 == pytest.approx(slow_hits(weights, shares, 3))


def test_the_log_is_that_of_the_labelled_areas():
    *_, nll = hits(np.array([3.0, 1.0]), np.array([0.5, 0.5]))
    assert nll == pytest.approx(-0.5 * np.log(0.75 * 0.25), abs=1e-4)
    assert np.isfinite(hits(np.array([1.0, 0.0]), np.array([0.0, 1.0]))).all()


def test_heights_that_were_learned_are_found_again():
    scene, candidates, _ = study()
    # Shoes as if no training scene had any.
    values = {name: np.full((2, 1), 0.74) for name in ("laptop", "mouse")}
    config = SETTINGS.baselines
    histograms = learn_histograms(values, "height", config)
    found = height_shares(scene, candidates, histograms, config)
    np.testing.assert_allclose(found.sum(1), 1)
    assert (found[:3].argmax(1) == 2).all()  # the desk
    share_of_floor = np.mean(candidates.area == 0)
    assert found[3, 0] == pytest.approx(share_of_floor)


def test_rows_are_averaged_by_category():
    scene, *_ = study()
    shares = label_shares(scene)
    shares[3] = 0  # No label is on an area.
    rows = hit_rows(scene, shares, {"chance": np.ones_like(shares), "best": shares})
    table = tabulate_semantics(rows).set_index(["category", "method"])
    assert table.loc[("mouse", "best"), "n_objects"] == 2
    assert table.loc[("all", "best"), "top1"] == 1
    assert table.loc[("all", "chance"), "top1"] == pytest.approx(1 / 3)
    assert "shoe" not in table.index.get_level_values("category")

"""Averages under weights are those of a loop over scenes drawn that often."""

import numpy as np
import pytest

from placing.tables.averages import (
    Side,
    average,
    difference,
    jackknife_se,
    mean_of,
    resamples,
)


def table(seed=0):
    """Return values of 4 categories in 6 scenes, of which some are missing."""
    rng = np.random.default_rng(seed)
    values = rng.exponential(size=(4, 6))
    values[rng.random(values.shape) < 0.4] = np.nan
    values[0, 0], values[1, 1] = 1.0, 2.0
    return values


def slow(values, drawn):
    """Return the mean over categories of the mean over the scenes drawn."""
    means = []
    for row in values:
        known = [row[scene] for scene in drawn if np.isfinite(row[scene])]
        if known:
            means.append(np.mean(known))
    return np.mean(means)


def test_resampled_averages_are_those_of_the_scenes_drawn():
    values, weights = table(), resamples(np.random.default_rng(1), 6, 50)
    assert (weights.sum(1) == 6).all()
    for found, times in zip(average(values, weights), weights, strict=True):
        drawn = np.repeat(np.arange(6), times.astype(int))
        assert found == pytest.approx(slow(values, drawn))
    assert mean_of(values) == pytest.approx(slow(values, range(6)))


def test_jackknife_of_one_category_is_the_standard_error_of_the_mean():
    values = np.array([[1.0, 2.0, np.nan, 6.0]])
    se = np.std([1, 2, 6], ddof=1) / np.sqrt(3)
    assert jackknife_se(values) == pytest.approx(se)
    assert np.isnan(jackknife_se(values[:, :1]))


def test_interval_of_a_difference_is_paired():
    rng = np.random.default_rng(2)
    hard = rng.exponential(5, size=(1, 40))  # scenes differ far more than methods do
    weights = resamples(rng, 40)
    sides = [Side.of(v, weights) for v in (hard, hard + rng.normal(0.2, 0.1, 40))]
    found, low, high = difference(*sides)
    assert found == pytest.approx(-0.2, abs=0.05)
    assert -0.3 < low < found < high < -0.1


def test_one_scene_tells_nothing_of_a_difference():
    weights = resamples(np.random.default_rng(0), 1)
    sides = [Side.of(np.array([[value]]), weights) for value in (1.0, 2.0)]
    found, low, high = difference(*sides)
    assert found == -1
    assert np.isnan([low, high]).all()

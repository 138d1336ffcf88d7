"""Theta is found again in rooms that were made with it."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from placing.dpmm import DpmmConfig
from placing.fitting import FittingConfig, fit
from placing.learning import Example, LearningConfig, learn_theta

CONFIG = LearningConfig(15, 10, 10)
FITTING = FittingConfig(1.0, 50.0, 0.05, 0.02)
SAMPLING = DpmmConfig("exact_birth", 1.0, 8, 1, 0, 1)


def drawn_pairs(rng, n):
    return pd.DataFrame(
        {
            "log_distance": rng.normal(-0.5, 0.3, n),
            "bearing": stats.vonmises.rvs(4.0, loc=0.5, size=n, random_state=rng),
            "height": rng.normal(-0.3, 0.1, n),
            "orientation": stats.vonmises.rvs(2.0, loc=3.0, size=n, random_state=rng),
            "has_front": True,
            "weight": 1.0,
        }
    )


def test_fit_finds_the_parameters_that_drew_the_pairs():
    theta = fit(drawn_pairs(np.random.default_rng(0), 20_000), FITTING)
    drawn = [-0.5, 0.3, 0.5, 4.0, -0.3, 0.1, 3.0, 2.0]
    np.testing.assert_allclose(theta.vector(), drawn, atol=0.15)


def test_kappa_and_sigma_stay_within_their_bounds():
    pairs = drawn_pairs(np.random.default_rng(0), 1).loc[[0] * 500]
    theta = fit(pairs, FITTING)
    assert theta.bearing_kappa <= FITTING.max_kappa
    assert theta.log_distance_sigma >= FITTING.min_log_distance_sigma
    assert theta.height_sigma_m >= FITTING.min_height_sigma_m


def simulated_scene(rng, name):
    """Return one person among 400 valid poses and 4 objects used by that person."""
    references = np.column_stack(
        [rng.uniform(0, 5, (400, 2)), np.full(400, 1.0), rng.integers(0, 8, 400)]
    )
    references[:, 3] *= np.pi / 4
    x, y, z, yaw = references[rng.integers(400)]
    d = np.exp(rng.normal(-0.5, 0.15, 4))
    bearing = yaw + rng.normal(0, 0.25, 4)
    heading = yaw + np.pi + rng.normal(0, 0.3, 4)
    columns = [x + d * np.cos(bearing), y + d * np.sin(bearing)]
    columns += [z + rng.normal(-0.25, 0.05, 4), heading]
    objects, has_front = np.column_stack(columns), np.ones(4, np.bool_)
    look = [np.cos(references[:, 3]), np.sin(references[:, 3])]
    references = np.column_stack([references[:, :3], *look])
    prior = np.full(400, 1 / 400)
    return [Example(name, ("mug",) * 4, objects, has_front, references, prior)]


def test_theta_is_recovered_without_ever_seeing_the_people():
    rng = np.random.default_rng(3)
    scenes = [simulated_scene(rng, f"scene{i}") for i in range(40)]
    thetas, trace = learn_theta(rng, scenes, SAMPLING, CONFIG, FITTING)
    theta = thetas["mug"]
    assert theta.log_distance_mean == pytest.approx(-0.5, abs=0.25)
    assert theta.height_mean_m == pytest.approx(-0.25, abs=0.05)
    assert abs(np.angle(np.exp(1j * theta.bearing_mean_rad))) < 0.3
    assert abs(np.angle(np.exp(1j * (theta.orientation_mean_rad - np.pi)))) < 0.4
    by_round = trace.groupby("iteration")["log_likelihood"].first()
    assert by_round.iloc[-1] > by_round.iloc[0]

"""The closed form is the maximum of the log potential."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy import stats

from placing.learning.fitting import (
    BROAD,
    STATISTICS,
    FittingConfig,
    expected_statistics,
    fit,
)
from placing.people.potential import Theta, log_psi_human

WEAK = FittingConfig(1e-6, 50.0, 0.05, 0.02)
DRAWN = Theta(-0.5, 0.3, 0.5, 4.0, -0.3, 0.1, 3.0, 2.0)


def drawn_objects(rng, n):
    """Return objects drawn from `DRAWN` around a pose at the origin, (n, 4)."""
    d = np.exp(rng.normal(-0.5, 0.3, n))
    bearing = stats.vonmises.rvs(4.0, loc=0.5, size=n, random_state=rng)
    yaw = stats.vonmises.rvs(2.0, loc=3.0, size=n, random_state=rng)
    xy = d * np.cos(bearing), d * np.sin(bearing)
    return np.column_stack([*xy, rng.normal(-0.3, 0.1, n), yaw])


def sums_of(objects, has_front, weight):
    """Return the sums of `STATISTICS` with a pose at the origin, from its angles."""
    log_d = np.log(np.hypot(objects[:, 0], objects[:, 1]))
    bearing, yaw = np.arctan2(objects[:, 1], objects[:, 0]), objects[:, 3]
    z, one = objects[:, 2], np.ones(len(objects))
    columns = [one, log_d, log_d**2, np.cos(bearing), np.sin(bearing), z, z**2]
    columns += [has_front * c for c in (one, np.cos(yaw), np.sin(yaw))]
    return np.array(columns) @ weight


def test_fit_finds_the_parameters_that_drew_the_pairs():
    objects = drawn_objects(np.random.default_rng(0), 20_000)
    theta = fit(sums_of(objects, np.ones(20_000), np.ones(20_000)), WEAK)
    np.testing.assert_allclose(theta.vector(), DRAWN.vector(), atol=0.05)


def test_no_parameter_can_be_moved_to_raise_the_weighted_log_potential():
    rng = np.random.default_rng(1)
    objects, has_front = drawn_objects(rng, 500), rng.random(500) < 0.7
    weight = rng.uniform(0, 2, 500)
    theta = fit(sums_of(objects, has_front, weight), WEAK)
    pose = np.array([[0.0, 0.0, 0.0, 1.0, 0.0]])

    def value(theta):
        return weight @ log_psi_human(theta, objects, has_front, pose)[:, 0] / 500

    for field in fields(Theta):
        at = getattr(theta, field.name)
        up, down = (replace(theta, **{field.name: at + e}) for e in (0.01, -0.01))
        assert value(theta) > max(value(up), value(down)), field.name
        curvature = (2 * value(theta) - value(up) - value(down)) / 0.01**2
        slope = (value(up) - value(down)) / 0.02
        # The step to the top that the slope asks for.
        assert abs(slope / curvature) < 2e-3, field.name


def test_kappa_and_sigma_stay_within_their_bounds():
    config = FittingConfig(1.0, 50.0, 0.05, 0.02)
    objects = np.repeat(drawn_objects(np.random.default_rng(0), 1), 5000, axis=0)
    theta = fit(sums_of(objects, np.ones(5000), np.ones(5000)), config)
    assert (theta.bearing_kappa, theta.orientation_kappa) == (50.0, 50.0)
    assert theta.log_distance_sigma == 0.05
    assert theta.height_sigma_m == 0.02


def test_a_category_nobody_has_seen_keeps_the_broad_theta():
    theta = fit(np.zeros(len(STATISTICS)), FittingConfig(2.0, 50.0, 0.05, 0.02))
    np.testing.assert_allclose(theta.vector(), BROAD.vector(), atol=1e-6)


def test_the_prior_counts_for_as_many_objects_as_it_says():
    seen = 6 * expected_statistics(DRAWN)
    theta = fit(seen, FittingConfig(2.0, 50.0, 0.05, 0.02))
    expected = (6 * DRAWN.height_mean_m + 2 * BROAD.height_mean_m) / 8
    assert theta.height_mean_m == pytest.approx(expected)

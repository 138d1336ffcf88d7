"""The potential is the product of the densities it names."""

import numpy as np
import pytest
from scipy import integrate, stats

from placing import rigid
from placing.potential import (
    Theta,
    height_factor,
    log_psi_human,
    log_psi_loc,
    log_psi_ori,
    planar_table,
)

THETA = Theta(-0.4, 0.5, 0.3, 2.0, -0.2, 0.1, 3.0, 1.5)


def random_pairs(rng, n):
    objects = rng.uniform([-2, -2, 0, -3], [2, 2, 2, 3], (n, 4))
    poses = rng.uniform([-2, -2, 0.5, -3], [2, 2, 1.5, 3], (n, 4))
    return objects, poses


def looking(poses):
    """Return poses with cosine and sine in place of their yaw, shape (q, 5)."""
    yaw = poses[:, 3]
    return np.column_stack([poses[:, :3], np.cos(yaw), np.sin(yaw)])


def test_each_factor_is_the_density_of_scipy():
    objects, poses = random_pairs(np.random.default_rng(0), 50)
    dx, dy = (objects[:, :2] - poses[:, :2]).T
    d, bearing = np.hypot(dx, dy), np.arctan2(dy, dx) - poses[:, 3]
    expected = stats.lognorm.logpdf(d, 0.5, scale=np.exp(-0.4)) - np.log(d)
    expected += stats.vonmises.logpdf(bearing, 2.0, loc=0.3)
    expected += stats.norm.logpdf(objects[:, 2] - poses[:, 2], -0.2, 0.1)
    expected += stats.vonmises.logpdf(objects[:, 3] - poses[:, 3], 1.5, loc=3.0)
    has_front = np.ones(50, np.bool_)
    found = np.diag(log_psi_human(THETA, objects, has_front, looking(poses)))
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-4)


def test_location_density_integrates_to_one_over_space():
    pose = np.array([[0.3, -0.2, 1.0, 0.7]])

    def density(r, angle):
        at = np.array([[0.3 + r * np.cos(angle), -0.2 + r * np.sin(angle), 0.8, 0.0]])
        return r * np.exp(log_psi_loc(THETA, at, looking(pose))[0, 0])

    planar, _ = integrate.dblquad(density, -np.pi, np.pi, 0.06, 8, epsabs=1e-4)
    at_mode = stats.norm.pdf(0.8 - 1.0, -0.2, 0.1)
    assert planar == pytest.approx(at_mode, rel=1e-3)


def test_object_without_front_ignores_its_heading():
    objects, poses = random_pairs(np.random.default_rng(1), 5)
    no_front = np.zeros(5, np.bool_)
    turned = objects + np.array([0, 0, 0, 1.0])
    a = log_psi_human(THETA, objects, no_front, looking(poses))
    np.testing.assert_array_equal(
        a, log_psi_human(THETA, turned, no_front, looking(poses))
    )


def test_potential_is_unchanged_when_object_and_person_move_together():
    objects, poses = random_pairs(np.random.default_rng(2), 20)
    T = rigid.from_yaw(1.1, (0.4, -2.0, 0.0))

    def moved(rows):
        return np.column_stack([rigid.apply(T, rows[:, :3]), rows[:, 3] + 1.1])

    has_front = np.ones(20, np.bool_)
    before = log_psi_human(THETA, objects, has_front, looking(poses))
    after = log_psi_human(THETA, moved(objects), has_front, looking(moved(poses)))
    np.testing.assert_allclose(after, before, atol=2e-4)


def test_tables_agree_with_the_potential():
    table = planar_table(THETA, 0.05, 2.0, 8)
    half, poses = 40, np.array([[0.0, 0.0, 1.0, 3 * np.pi / 4]])
    objects = np.array([[0.5, 0.25, 0.9, 0.0], [-1.2, 0.4, 1.3, 0.0]])
    for place, direct in zip(
        objects, log_psi_loc(THETA, objects, looking(poses))[:, 0], strict=True
    ):
        i, j = np.round(place[:2] / 0.05).astype(int) + half
        h = height_factor(THETA, place[2:3], poses[:, 2])[0, 0]
        assert np.log(table[3, i, j] * h) == pytest.approx(direct, abs=1e-3)


def test_log_psi_ori_is_a_density_of_the_heading():
    yaw = np.linspace(-np.pi, np.pi, 2001)
    density = np.exp(log_psi_ori(THETA, yaw, np.array(0.4)))
    assert integrate.trapezoid(density, yaw) == pytest.approx(1, abs=1e-6)

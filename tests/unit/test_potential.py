"""The potential is the product of the densities it names."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats

from placing import rigid
from placing.people.potential import (
    Theta,
    height_factor,
    log_factors,
    log_psi_human,
    log_psi_ori,
    planar_table,
)

THETA = Theta(-0.4, 0.5, 0.3, 2.0, -0.2, 0.1, 3.0, 1.5)
THETAS = (
    THETA,
    Theta(0.3, 0.25, -2.4, 8.0, 0.5, 0.4, 0.0, 20.0),
    Theta(-0.2, 0.8, 1.5, 0.05, 0.0, 0.6, -1.0, 0.3),
)
ANGLE = st.floats(-7, 7)
PLACE = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 2), ANGLE)


def psi_loc(theta, objects, pose):
    """Return Psi_loc of each object with one pose, shape (n,)."""
    logs = log_psi_human(theta, objects, np.zeros(len(objects), np.bool_), pose)
    return np.exp(logs[:, 0].astype(float))


def random_pairs(rng, n):
    objects = rng.uniform([-2, -2, 0, -3], [2, 2, 2, 3], (n, 4))
    poses = rng.uniform([-2, -2, 0.5, -3], [2, 2, 1.5, 3], (n, 4))
    return objects, poses


def looking(poses):
    """Return poses with cosine and sine in place of their yaw, shape (q, 5)."""
    yaw = poses[:, 3]
    return np.column_stack([poses[:, :3], np.cos(yaw), np.sin(yaw)])


def scipy_factors(theta, objects, poses):
    """Return the logs of the four densities of eq. 2 after SciPy, shape (n, 4).

    The density of the distance and the bearing on the plane is f(d) g(r) / d.
    """
    m_d, s_d, m_r, k_r, m_h, s_h, m_o, k_o = theta.vector()
    dx, dy = (objects[:, :2] - poses[:, :2]).T
    d, bearing = np.hypot(dx, dy), np.arctan2(dy, dx) - poses[:, 3]
    return np.column_stack(
        [
            stats.lognorm.logpdf(d, s_d, scale=np.exp(m_d)) - np.log(d),
            stats.vonmises.logpdf(bearing, k_r, loc=m_r),
            stats.norm.logpdf(objects[:, 2] - poses[:, 2], m_h, s_h),
            stats.vonmises.logpdf(objects[:, 3] - poses[:, 3], k_o, loc=m_o),
        ]
    )


@pytest.mark.parametrize("theta", THETAS)
def test_potential_is_the_product_of_the_densities_of_scipy(theta):
    objects, poses = random_pairs(np.random.default_rng(0), 50)
    expected = scipy_factors(theta, objects, poses)
    found = log_psi_human(theta, objects, np.ones(50, np.bool_), looking(poses))
    np.testing.assert_allclose(np.diag(found), expected.sum(1), rtol=1e-5, atol=1e-4)
    found = log_psi_human(theta, objects, np.zeros(50, np.bool_), looking(poses))
    expected = expected[:, :3].sum(1)
    np.testing.assert_allclose(np.diag(found), expected, rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("theta", THETAS)
def test_each_factor_is_its_density_of_scipy(theta):
    objects, poses = random_pairs(np.random.default_rng(1), 50)
    expected = scipy_factors(theta, objects, poses)
    pairs = zip(objects[:, :3], looking(poses), strict=True)
    factors = np.array([log_factors(theta, at, reference) for at, reference in pairs])
    np.testing.assert_allclose(factors, expected[:, :3], rtol=1e-9)
    found = log_psi_ori(theta, objects[:, 3], poses[:, 3])
    np.testing.assert_allclose(found, expected[:, 3], rtol=1e-9)
    found = height_factor(theta, objects[:, 2], poses[:, 2])
    np.testing.assert_allclose(np.log(np.diag(found)), expected[:, 2], rtol=1e-9)


@pytest.mark.parametrize("theta", THETAS)
def test_psi_loc_integrates_to_one_over_plane_and_height(theta):
    pose = np.array([[0.3, -0.2, 1.0, 0.7]])
    m_d, s_d, _, _, m_h, s_h, _, _ = theta.vector()
    # The log of the distance, the angle and the height in nine sigmas, by midpoints.
    axes = [
        (m_d - 9 * s_d, m_d + 9 * s_d, 60),
        (-np.pi, np.pi, 60),
        (1 + m_h - 9 * s_h, 1 + m_h + 9 * s_h, 40),
    ]
    middles = [a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in axes]
    log_d, angle, z = (grid.ravel() for grid in np.meshgrid(*middles, indexing="ij"))
    d = np.exp(log_d)
    x, y = 0.3 + d * np.cos(angle), -0.2 + d * np.sin(angle)
    objects = np.column_stack([x, y, z, 0 * z])
    psi = psi_loc(theta, objects, looking(pose))
    cell = np.prod([(b - a) / n for a, b, n in axes])
    is_clear = d > 0.05  # below it the density is held constant
    whole = (psi * d * d)[is_clear].sum() * cell
    below = stats.lognorm.cdf(0.05, s_d, scale=np.exp(m_d))
    assert whole + below == pytest.approx(1, abs=2e-3)


@pytest.mark.parametrize("theta", THETAS)
def test_psi_ori_integrates_to_one_over_the_circle(theta):
    yaw = np.linspace(-np.pi, np.pi, 2001)
    density = np.exp(log_psi_ori(theta, yaw, np.array(0.4)))
    assert integrate.trapezoid(density, yaw) == pytest.approx(1, abs=1e-6)


def test_object_without_front_ignores_its_heading():
    objects, poses = random_pairs(np.random.default_rng(1), 5)
    no_front = np.zeros(5, np.bool_)
    turned = objects + np.array([0, 0, 0, 1.0])
    a = log_psi_human(THETA, objects, no_front, looking(poses))
    np.testing.assert_array_equal(
        a, log_psi_human(THETA, turned, no_front, looking(poses))
    )


@settings(max_examples=200, deadline=None)
@given(PLACE, PLACE, ANGLE, st.floats(-5, 5), st.floats(-5, 5))
def test_potential_is_unchanged_when_object_and_person_move_together(
    thing, person, turn, x, y
):
    move = rigid.from_yaw(turn, (x, y, 0.0))

    def moved(row):
        return np.append(rigid.apply(move, row[:, :3]), row[:, 3:] + turn, axis=1)

    one = np.ones(1, np.bool_)
    thing, person = np.array([thing]), np.array([person])
    before = log_psi_human(THETA, thing, one, looking(person))
    after = log_psi_human(THETA, moved(thing), one, looking(moved(person)))
    np.testing.assert_allclose(after, before, rtol=1e-5, atol=1e-4)


@settings(max_examples=50, deadline=None)
@given(
    st.integers(0, 7), st.floats(0.5, 1.5), st.floats(0.2, 2), st.sampled_from(THETAS)
)
def test_table_and_height_factor_multiply_to_psi_loc(heading, height, radius_m, theta):
    table = planar_table(theta, 0.05, radius_m, 8)
    half = table.shape[1] // 2
    steps = np.arange(-half, half + 1) * 0.05
    x, y = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    objects = np.column_stack([x, y, 0 * x + height, 0 * x])
    pose = np.array([[0.0, 0.0, 1.0, heading * np.pi / 4]])
    psi = psi_loc(theta, objects, looking(pose))
    factor = height_factor(theta, np.array([height]), np.ones(1))[0, 0]
    expected = np.where(np.hypot(x, y) <= radius_m + 1e-9, psi / factor, 0)
    np.testing.assert_allclose(table[heading].ravel(), expected, rtol=1e-4, atol=1e-30)

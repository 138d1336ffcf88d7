"""The tabulated sums equal sums of the potential written out in full."""

import numpy as np
import pytest

from placing.arranging import ArrangingConfig, UseOfObject
from placing.candidates import FEATURES, Candidates
from placing.human import HumanPoses
from placing.potential import Theta, log_psi_loc

THETA = Theta(-0.4, 0.5, 0.3, 2.0, -0.2, 0.3, 3.0, 1.5)
HALF_HEIGHT = 0.1


@pytest.fixture
def scene():
    rng = np.random.default_rng(0)
    xy = rng.choice(60, (200, 2)) * 0.05
    z = rng.choice([0.0, 0.45, 0.75], 200)
    location = np.column_stack([xy, z])
    features = np.zeros((200, len(FEATURES)))
    candidates = Candidates(location, np.zeros(200, np.int32), features)
    kind = rng.integers(0, 6, 50).astype(np.uint8)
    place = np.column_stack([rng.choice(30, (50, 2)) * 0.1, np.full(50, 0.45)])
    yaw = np.arange(50) % 8 * np.pi / 4
    return candidates, HumanPoses(kind, place, yaw, np.full(50, 1 / 50))


def use_of(scene, row_spacing_m=0.05):
    config = ArrangingConfig(5.0, row_spacing_m)
    return UseOfObject(THETA, *scene, 0.05, HALF_HEIGHT, config)


def direct(scene):
    """Return Psi_loc of every place with every pose, shape (p, q)."""
    candidates, poses = scene
    objects = np.column_stack([candidates.location, np.zeros(200)])
    objects[:, 2] += HALF_HEIGHT
    return np.exp(log_psi_loc(THETA, objects, poses.references()).astype(float))


def test_row_is_the_sum_over_places(scene):
    np.testing.assert_allclose(use_of(scene).row(), direct(scene).sum(0), rtol=1e-4)


def test_row_spacing_sums_the_places_of_the_coarser_lattice(scene):
    cells = np.round(scene[0].location[:, :2] / 0.05)
    coarse = (cells % 2 == 0).all(1)
    expected = direct(scene)[coarse].sum(0)
    np.testing.assert_allclose(use_of(scene, 0.1).row(), expected, rtol=1e-4)


def test_density_mixes_the_normalised_potentials_of_the_poses(scene):
    weight = np.zeros(50)
    weight[[3, 7, 20]] = 0.5, 0.3, 0.2
    psi = direct(scene)
    expected = (psi / psi.sum(0)) @ weight
    use = use_of(scene)
    found = use.density(weight, use.row())
    np.testing.assert_allclose(found, expected / expected.sum(), rtol=1e-3, atol=1e-9)
    assert found.sum() == pytest.approx(1)


def test_heading_turns_the_front_as_learned(scene):
    weight = np.zeros(50)
    weight[11] = 1.0
    use = use_of(scene)
    yaws = np.arange(8) * np.pi / 4
    place = int(np.argmax(direct(scene)[:, 11]))
    yaw = use.heading(place, weight, use.row(), yaws)
    wanted = scene[1].yaw[11] + THETA.orientation_mean_rad
    off = np.angle(np.exp(1j * (yaw - wanted)))
    assert abs(off) <= np.pi / 8 + 1e-9

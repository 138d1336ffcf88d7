"""Places are chosen at the mode of the smoothed density."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from placing.candidates import FEATURES, Candidates
from placing.methods.decision import DecisionConfig, Smoother, choose_places

CONFIG = DecisionConfig(0.2, 0.25)


@pytest.fixture
def table():
    """Return the places of a 1 x 1 m table, a place every 5 cm."""
    x, y = np.meshgrid(np.arange(21) * 0.05, np.arange(21) * 0.05, indexing="ij")
    location = np.column_stack([x.ravel(), y.ravel(), np.full(441, 0.75)])
    features = np.zeros((441, len(FEATURES)))
    return Candidates(location, np.zeros(441, np.int32), features)


def everywhere(table):
    return np.ones(len(table.location), np.bool_)


def test_a_broad_hill_beats_a_narrow_peak(table):
    x, y = table.location[:, 0], table.location[:, 1]
    hill = np.exp(-((x - 0.25) ** 2 + (y - 0.25) ** 2) / 0.02)
    density = hill / hill.sum()
    density[np.flatnonzero((x > 0.94) & (y > 0.94))[0]] += 0.05
    smooth = Smoother(table, 0.05, 0.2)(density)
    chosen = choose_places(
        np.random.default_rng(0), smooth, [everywhere(table)], table, CONFIG
    )
    assert np.linalg.norm(table.location[chosen[0], :2] - 0.25) < 0.12


def test_a_uniform_density_stays_uniform_and_is_drawn_from(table):
    smooth = Smoother(table, 0.05, 0.2)(np.full(441, 1 / 441))
    assert np.ptp(smooth) < 1e-12
    rng = np.random.default_rng(0)
    drawn = {
        choose_places(rng, smooth, [everywhere(table)], table, CONFIG)[0]
        for _ in range(30)
    }
    assert len(drawn) > 20


def test_objects_of_one_category_keep_their_distance(table):
    smooth = np.exp(-np.linalg.norm(table.location[:, :2] - 0.5, axis=1))
    chosen = choose_places(
        np.random.default_rng(0), smooth, [everywhere(table)] * 3, table, CONFIG
    )
    at = table.location[chosen]
    gaps = np.linalg.norm(at[:, None] - at[None], axis=2)[np.triu_indices(3, 1)]
    assert gaps.min() >= CONFIG.min_distance_m


def test_an_object_that_fits_nowhere_gets_no_place(table):
    nowhere = ~everywhere(table)
    chosen = choose_places(
        np.random.default_rng(0), np.ones(441), [nowhere], table, CONFIG
    )
    assert chosen == [None]


def test_smoothing_is_a_gaussian_filter_of_what_lies_on_the_area(table):
    density = np.random.default_rng(0).random(441)
    sigma = 0.2 / 0.05
    grid, mask = density.reshape(21, 21), np.ones((21, 21))
    filtered, share = (
        gaussian_filter(g, sigma, mode="constant", truncate=3.0) for g in (grid, mask)
    )
    smooth = Smoother(table, 0.05, 0.2)(density)
    np.testing.assert_allclose(smooth, (filtered / share).ravel(), rtol=1e-9)

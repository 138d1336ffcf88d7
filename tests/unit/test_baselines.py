"""Baselines give every category the shares that its training objects had."""

import numpy as np
import pytest

from placing.baselines import (
    BaselinesConfig,
    chance_density,
    histogram_density,
    learn_histograms,
)
from placing.candidates import Candidates

CONFIG = BaselinesConfig(0.1, 1e-6, 0.5, 1e-6, 3.0, 0.0)


@pytest.fixture
def candidates():
    """Return 90 places on the floor and 10 on a table, near and far from a wall."""
    z = np.repeat([0.02, 0.72], [90, 10])
    wall = np.where(np.arange(100) % 2, 0.2, 1.7)
    features = np.column_stack([z, np.full(100, 9.0), np.full(100, 0.5), wall])
    location = np.column_stack([np.arange(100) * 0.05, np.zeros(100), z])
    return Candidates(location, np.zeros(100, np.int32), features)


def test_height_shares_training_objects_among_the_places_of_a_height(candidates):
    values = {"mug": np.array([[0.75]] * 3 + [[0.0]])}
    shares = learn_histograms(values, "height", CONFIG)
    density = histogram_density(shares["mug"], candidates, "height", CONFIG)
    assert density[90:].sum() == pytest.approx(0.75)
    assert np.ptp(density[:90]) < 1e-12


def test_room_tells_places_near_the_wall_from_others(candidates):
    values = {"shoe": np.array([[0.0, 0.1]] * 4)}
    shares = learn_histograms(values, "room", CONFIG)
    density = histogram_density(shares["shoe"], candidates, "room", CONFIG)
    is_near = candidates.feature("wall_distance_m") < 0.5
    assert density[:90][is_near[:90]].sum() == pytest.approx(1)


def test_chance_is_uniform(candidates):
    np.testing.assert_allclose(chance_density(candidates), 0.01)


def test_every_density_sums_to_one(candidates):
    config = BaselinesConfig(0.05, 0.05, 0.1, 0.2, 3.0, 2.0)
    values = {"a": np.array([[0.7, 0.3]]), "b": np.array([[0.0, 2.0]] * 3)}
    for method, columns in (("height", 1), ("room", 2)):
        of_method = {name: v[:, :columns] for name, v in values.items()}
        for shares in learn_histograms(of_method, method, config).values():
            density = histogram_density(shares, candidates, method, config)
            assert density.sum() == pytest.approx(1)


def test_a_category_seen_once_leans_on_all_categories():
    values = {"rare": np.array([[0.0]]), "common": np.array([[0.75]] * 20)}
    config = BaselinesConfig(0.1, 1e-6, 0.5, 1e-6, 3.0, 2.0)
    rare = learn_histograms(values, "height", config)["rare"]
    assert rare[7] == pytest.approx(2 / 3 * 20 / 21)

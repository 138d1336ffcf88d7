"""Baselines give every category the shares that its training objects had."""

import numpy as np
import pytest

from placing.candidates import Candidates
from placing.methods.baselines import (
    FEATURES_OF,
    BaselinesConfig,
    chance_density,
    histogram_density,
    learn_histograms,
    place_features,
)

AREA = (1.0, 0.7, 12.0, 0.1, 0.1, 1.0)
SHARP = (1.0, 1e-6, 12.0, 0.1, 1e-6, 1.0)
CONFIG = BaselinesConfig(0.1, 1e-6, 0.5, 1e-6, 3.0, 0.0, *SHARP)


@pytest.fixture
def candidates():
    """Return 90 places on the floor and 10 on a table, near and far from a wall."""
    z = np.repeat([0.02, 0.72], [90, 10])
    wall = np.where(np.arange(100) % 2, 0.2, 1.7)
    features = np.column_stack([z, np.full(100, 9.0), np.full(100, 0.5), wall])
    location = np.column_stack([np.arange(100) * 0.05, np.zeros(100), z])
    return Candidates(location, np.repeat([0, 1], [90, 10]).astype(np.int32), features)


def areas():
    """Return the places of a floor of 4 m2, a table of 1 m2 and a shelf of 0.04 m2."""
    blocks = []
    for number, (x, width, z) in enumerate([(0, 2, 0), (3, 1, 0.72), (5, 0.2, 0.72)]):
        steps = np.arange(round(width / 0.05)) * 0.05
        grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), -1).reshape(-1, 2)
        edge = np.maximum(np.minimum(grid, width - 0.05 - grid).min(1), 0)
        one, zero = np.ones(len(grid)), np.zeros(len(grid))
        columns = [grid[:, 0] + x, grid[:, 1], z * one, number * one, edge, zero]
        blocks.append(np.column_stack(columns))
    x, y, z, number, edge, wall = np.concatenate(blocks).T
    features = np.column_stack([z, np.full(len(z), 9.0), edge, wall])
    return Candidates(np.column_stack([x, y, z]), number.astype(np.int32), features)


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
    config = BaselinesConfig(0.05, 0.05, 0.1, 0.2, 3.0, 2.0, *AREA)
    values = {"a": np.array([[0.7, 0.3]]), "b": np.array([[0.0, 2.0]] * 3)}
    for method, columns in FEATURES_OF.items():
        of_method = {n: np.resize(v, (len(v), len(columns))) for n, v in values.items()}
        for shares in learn_histograms(of_method, method, config).values():
            density = histogram_density(shares, candidates, method, config)
            assert density.sum() == pytest.approx(1)


def test_a_category_seen_once_leans_on_all_categories():
    values = {"rare": np.array([[0.0]]), "common": np.array([[0.75]] * 20)}
    config = BaselinesConfig(0.1, 1e-6, 0.5, 1e-6, 3.0, 2.0, *SHARP)
    rare = learn_histograms(values, "height", config)["rare"]
    assert rare[7] == pytest.approx(2 / 3 * 20 / 21)


def test_the_extent_of_an_area_is_that_of_its_places():
    doublings = place_features(areas(), "area")[:, 1]
    for number, extent_m2 in enumerate((4.0, 1.0, 0.04)):
        of_area = doublings[areas().area == number]
        np.testing.assert_allclose(of_area, np.log2(extent_m2 / 0.01))


def test_the_extent_of_an_area_turns_and_moves_with_the_room():
    here = areas()
    x, y, z = here.location.T
    there = Candidates(np.column_stack([7 - y, x - 3, z]), here.area, here.features)
    before, after = (place_features(c, "area") for c in (here, there))
    np.testing.assert_allclose(before, after)


def test_a_scene_without_places_has_an_empty_density():
    none = Candidates(np.empty((0, 3)), np.empty(0, np.int32), np.empty((0, 4)))
    shares = learn_histograms({"mug": np.array([[0.7, 6.6, 0.1]])}, "area", CONFIG)
    assert histogram_density(shares["mug"], none, "area", CONFIG).shape == (0,)


def test_area_tells_a_table_from_a_shelf_of_the_same_height():
    candidates = areas()
    table = place_features(candidates, "area")[candidates.area == 1]
    shares = learn_histograms({"laptop": table[::7]}, "area", CONFIG)
    density = histogram_density(shares["laptop"], candidates, "area", CONFIG)
    assert density[candidates.area == 1].sum() == pytest.approx(1)
    height = learn_histograms({"laptop": table[::7, :1]}, "height", CONFIG)
    less = histogram_density(height["laptop"], candidates, "height", CONFIG)
    assert less[candidates.area == 2].sum() == pytest.approx(16 / 416)


def test_area_tells_the_edge_of_a_table_from_its_middle():
    candidates = areas()
    values = place_features(candidates, "area")
    is_edge = (candidates.area == 1) & (values[:, 2] < 0.1)
    shares = learn_histograms({"phone": values[is_edge]}, "area", CONFIG)
    density = histogram_density(shares["phone"], candidates, "area", CONFIG)
    assert density[is_edge].sum() == pytest.approx(1)


@pytest.mark.parametrize("method", FEATURES_OF)
def test_what_lies_anywhere_has_a_uniform_density(method):
    candidates = areas()
    config = BaselinesConfig(0.05, 0.05, 0.1, 0.2, 3.0, 2.0, *AREA)
    values = {"anything": place_features(candidates, method)}
    shares = learn_histograms(values, method, config)["anything"]
    density = histogram_density(shares, candidates, method, config)
    np.testing.assert_allclose(density, 1 / len(density), rtol=1e-9)


def test_a_place_gets_the_share_of_its_bin_over_the_places_there():
    candidates = areas()
    found = place_features(candidates, "area")
    values = {"mug": found[[3, 1700, 1701, 2010]], "tv": found[[1900] * 3]}
    config = BaselinesConfig(0.1, 1e-6, 0.5, 1e-6, 3.0, 1.5, *SHARP)
    shares = learn_histograms(values, "area", config)["mug"]
    density = histogram_density(shares, candidates, "area", config)
    cells = [tuple(np.floor(v / [0.1, 1.0, 0.1]).astype(int)) for v in found]
    mugs = [cells[i] for i in (3, 1700, 1701, 2010)]
    everything = mugs + [cells[1900]] * 3
    expected = [
        (mugs.count(cell) + 1.5 * everything.count(cell) / 7) / cells.count(cell)
        for cell in cells
    ]
    np.testing.assert_allclose(density, expected / np.sum(expected), atol=1e-12)

"""The rows of the learning are the potential, and its statistics those of the pairs."""

import numpy as np
import pytest

from placing.people import dpmm
from placing.people.offsets import (
    find_offsets,
    find_spots,
    parameters_of,
    sufficient_statistics,
    weight_rows,
)
from placing.people.potential import Theta, log_psi_human

THETAS = (
    Theta(-0.4, 0.5, 0.3, 2.0, -0.2, 0.1, 3.0, 1.5),
    Theta(0.2, 0.1, -2.0, 50.0, 0.4, 0.05, 0.1, 50.0),
)


def scene(rng):
    """Return four objects, and poses of which many share a spot."""
    objects = rng.uniform([0, 0, 0, -3], [3, 3, 1, 3], (4, 4))
    spots = rng.uniform([0, 0, 0.8], [3, 3, 1.2], (40, 3))
    yaw = rng.integers(0, 8, 300) * np.pi / 4
    look = [np.cos(yaw), np.sin(yaw)]
    references = np.column_stack([spots[rng.integers(0, 40, 300)], *look])
    return objects, np.array([True, False, True, False]), references


def test_every_pose_has_the_spot_of_its_reference_point():
    _, _, references = scene(np.random.default_rng(0))
    spots = find_spots(references)
    np.testing.assert_array_equal(spots.location[spots.of_pose], references[:, :3])
    assert len(spots.location) == len(np.unique(references[:, :3], axis=0))


@pytest.mark.parametrize("theta", THETAS)
def test_rows_are_the_potential_of_objects_and_poses(theta):
    objects, has_front, references = scene(np.random.default_rng(1))
    log_psi = log_psi_human(theta, objects, has_front, references)
    spots = find_spots(references)
    rows, top = weight_rows(
        find_offsets(objects, spots), spots, parameters_of([theta] * 4), has_front
    )
    np.testing.assert_allclose(rows, dpmm.weight_rows(log_psi), rtol=1e-3)
    np.testing.assert_allclose(top, log_psi.max(1), rtol=1e-5, atol=1e-4)


def test_statistics_are_means_over_the_sampled_pairs():
    objects, has_front, references = scene(np.random.default_rng(2))
    pose = np.random.default_rng(3).integers(0, 300, (5, 4))
    spots = find_spots(references)
    offsets = find_offsets(objects, spots)
    found = sufficient_statistics(offsets, spots, has_front, pose)
    for i in range(4):
        away = objects[i, :3] - references[pose[:, i], :3]
        yaw = np.arctan2(references[pose[:, i], 4], references[pose[:, i], 3])
        log_d = np.log(np.hypot(away[:, 0], away[:, 1]))
        bearing = np.arctan2(away[:, 1], away[:, 0]) - yaw
        turned, one = objects[i, 3] - yaw, np.ones(5)
        columns = [one, log_d, log_d**2, np.cos(bearing), np.sin(bearing)]
        columns += [away[:, 2], away[:, 2] ** 2]
        columns += [has_front[i] * c for c in (one, np.cos(turned), np.sin(turned))]
        np.testing.assert_allclose(found[i], np.mean(columns, axis=1), atol=1e-5)

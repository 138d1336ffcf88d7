"""Theta is found again in simulated rooms, and the better the more rooms there are."""

import numpy as np
import pytest

from placing.learning.fitting import FittingConfig
from placing.learning.theta import Example, LearningConfig, learn_theta
from placing.people.dpmm import DpmmConfig
from placing.people.offsets import find_spots
from placing.people.potential import Theta

SAMPLING = DpmmConfig("exact_birth", 1.0, 8, 1, 0, 1)
CONFIG = LearningConfig(30, 5, 5, 100, 3)
FITTING = FittingConfig(0.5, 50.0, 0.05, 0.02)
TRUE = {
    "cup": Theta(np.log(0.5), 0.25, 0.6, 6.0, -0.25, 0.08, np.pi, 4.0),
    "screen": Theta(np.log(1.1), 0.2, 0.0, 8.0, 0.1, 0.1, np.pi, 6.0),
}
SCALE = np.array([0.25, 0.25, 0.4, 4.0, 0.1, 0.05, 0.4, 4.0])
"""What counts as one unit of error in each parameter of Theta."""
N_OBJECTS, CONCENTRATION = 8, 1.0


def lattice_of_poses():
    """Return the poses of an open room of 5 x 5 m, half of them seated, (q, 5)."""
    axis, yaw = np.arange(0, 5, 0.5), np.arange(8) * np.pi / 4
    x, y, z, yaw = (g.ravel() for g in np.meshgrid(axis, axis, (0.9, 1.4), yaw))
    return np.column_stack([x, y, z, np.cos(yaw), np.sin(yaw)])


def simulated_room(rng, name):
    """Return objects of people who share them as the Chinese restaurant process says.

    Nothing but P0 and Theta places them: there is no furniture and no wall.
    """
    references = lattice_of_poses()
    poses, users = [], []
    for i in range(N_OBJECTS):
        if rng.random() < CONCENTRATION / (CONCENTRATION + i):
            poses.append(rng.integers(len(references)))
            users.append(len(poses) - 1)
        else:
            users.append(users[rng.integers(i)])
    categories = tuple(sorted(rng.choice(list(TRUE), N_OBJECTS).tolist()))
    people = references[np.array(poses)[rng.permutation(users)]]
    objects = np.array(
        [drawn(rng, TRUE[c], p) for c, p in zip(categories, people, strict=True)]
    )
    prior = np.full(len(references), 1 / len(references))
    has_front, spots = np.ones(N_OBJECTS, np.bool_), find_spots(references)
    return [Example(name, categories, objects, has_front, spots, prior)]


def drawn(rng, theta, person):
    """Return x, y, z, yaw of an object drawn from Theta around a person."""
    m_d, s_d, m_r, k_r, m_h, s_h, m_o, k_o = theta.vector()
    look = np.arctan2(person[4], person[3])
    d, bearing = np.exp(rng.normal(m_d, s_d)), look + rng.vonmises(m_r, k_r)
    x, y = person[:2] + d * np.array([np.cos(bearing), np.sin(bearing)])
    return x, y, person[2] + rng.normal(m_h, s_h), look + rng.vonmises(m_o, k_o)


def error(thetas):
    """Return the root mean square error of the parameters, in units of `SCALE`."""
    away = np.array([thetas[c].vector() - TRUE[c].vector() for c in TRUE])
    away[:, [2, 6]] = np.angle(np.exp(1j * away[:, [2, 6]]))
    return np.sqrt(np.mean((away / SCALE) ** 2))


@pytest.mark.parametrize("n_components", [0, 4])
def test_theta_is_recovered_and_the_error_shrinks_with_the_number_of_rooms(
    n_components,
):
    errors = {10: [], 80: []}
    for seed in (0, 1):
        rng = np.random.default_rng(seed)
        rooms = [simulated_room(rng, f"room{i:02}") for i in range(80)]
        for n, found in errors.items():
            args = rooms[:n], SAMPLING, CONFIG, FITTING, n_components
            found.append(error(learn_theta(rng, *args)[0]))
    assert np.mean(errors[80]) < 0.3 * np.mean(errors[10])
    assert max(errors[80]) < 0.2


def test_learning_from_the_truth_does_not_creep_away():
    """The rounds end where the objects came from, not farther out."""
    rng = np.random.default_rng(5)
    rooms = [simulated_room(rng, f"room{i:02}") for i in range(80)]
    _, trace = learn_theta(rng, rooms, SAMPLING, CONFIG, FITTING)
    for name, theta in TRUE.items():
        found = trace[trace["category"].eq(name) & trace["iteration"].ge(20)]
        found = found.loc[found["parameter"].eq("log_distance_mean"), "value"].mean()
        assert found == pytest.approx(theta.log_distance_mean, abs=0.08)

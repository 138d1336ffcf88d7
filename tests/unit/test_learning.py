"""Learning returns the likeliest of its runs, whatever things are called.

That Theta is found again in simulated rooms is tested in tests/statistical.
"""

from dataclasses import replace

import numpy as np
import pytest

from placing.learning.fitting import BROAD, FittingConfig
from placing.learning.theta import Example, LearningConfig, learn_theta
from placing.people.dpmm import DpmmConfig
from placing.people.offsets import find_spots

CONFIG = LearningConfig(6, 5, 5, 100, 1)
FITTING = FittingConfig(1.0, 50.0, 0.05, 0.02)
SAMPLING = DpmmConfig("exact_birth", 1.0, 8, 1, 0, 1)
CATEGORIES = ("cup", "screen", "cup", "mouse")


def simulated_scene(rng, name, n_labels=1):
    """Return arrangements of 4 objects that one person of 200 valid poses uses."""
    poses = np.column_stack([rng.uniform(0, 5, (200, 2)), np.full(200, 1.0)])
    yaw = rng.integers(0, 8, 200) * np.pi / 4
    references = np.column_stack([poses, np.cos(yaw), np.sin(yaw)])
    examples = []
    for _ in range(n_labels):
        user = rng.integers(200)
        bearing = yaw[user] + rng.normal(0, 0.25, 4)
        d = np.exp(rng.normal(-0.5, 0.15, 4))
        xy = poses[user, :2] + (d * np.array([np.cos(bearing), np.sin(bearing)])).T
        heading = yaw[user] + np.pi + rng.normal(0, 0.3, 4)
        objects = np.column_stack([xy, 1 + rng.normal(-0.25, 0.05, 4), heading])
        has_front, prior = np.ones(4, np.bool_), np.full(200, 1 / 200)
        args = CATEGORIES, objects, has_front, find_spots(references), prior
        examples.append(Example(name, *args))
    return examples


@pytest.fixture(scope="module")
def scenes():
    rng = np.random.default_rng(3)
    return [simulated_scene(rng, f"scene{i}", 1 + i % 2) for i in range(10)]


def learn(scenes, config=CONFIG, n_components=0):
    rng = np.random.default_rng(0)
    return learn_theta(rng, scenes, SAMPLING, config, FITTING, n_components)


def test_the_first_rounds_raise_the_log_joint(scenes):
    _, trace = learn(scenes)
    by_round = trace.groupby("iteration")["log_likelihood"].first()
    assert by_round.iloc[-1] > by_round.iloc[0] + 1


def test_the_same_stream_learns_the_same(scenes):
    assert learn(scenes)[0] == learn(scenes)[0]


def test_the_order_of_the_scenes_does_not_matter(scenes):
    assert learn(scenes)[0] == learn(scenes[::-1])[0]


def test_the_names_of_the_categories_do_not_matter(scenes):
    """The new names sort in another order than the old ones."""
    new = {"cup": "z", "screen": "y", "mouse": "x"}
    renamed = [
        [replace(e, categories=tuple(new[c] for c in e.categories)) for e in scene]
        for scene in scenes
    ]
    old, found = learn(scenes)[0], learn(renamed)[0]
    assert found == {new[name]: theta for name, theta in old.items()}


def test_the_order_of_the_objects_matters_no_more_than_the_seed(scenes):
    """Objects are visited in turn, so that another order draws other numbers."""
    reversed_scenes = [
        [
            replace(
                e,
                categories=e.categories[::-1],
                objects=e.objects[::-1],
                has_front=e.has_front[::-1],
            )
            for e in scene
        ]
        for scene in scenes
    ]
    one, other = learn(scenes)[0], learn(reversed_scenes)[0]
    for name, theta in one.items():
        away = theta.vector() - other[name].vector()
        assert np.abs(away[[0, 1, 4, 5]]).max() < 0.2


@pytest.mark.parametrize("n_components", [0, 3])
def test_the_run_with_the_likeliest_later_rounds_is_kept(scenes, n_components):
    thetas, trace = learn(scenes, replace(CONFIG, n_restarts=3), n_components)
    later = trace[trace["iteration"] >= 3]
    value = later.groupby(["restart", "iteration"])["log_likelihood"].first()
    best = value.groupby("restart").mean().idxmax()
    last = trace[trace["restart"].eq(best) & trace["iteration"].eq(5)]
    for name, theta in thetas.items():
        values = last.loc[last["category"].eq(name), "value"]
        np.testing.assert_array_equal(values, theta.vector())


def test_restarts_start_from_other_thetas(scenes):
    _, trace = learn(scenes, replace(CONFIG, n_restarts=3, n_iterations=1))
    assert trace.groupby("restart")["log_likelihood"].first().nunique() == 3
    columns = ["iteration", "restart", "category", "parameter", "value"]
    assert list(trace) == [*columns, "log_likelihood"]


def test_every_fit_looks_at_all_arrangements_seen_so_far(scenes):
    """All people look from 1 m, so that who uses an object does not change heights."""
    _, trace = learn(scenes, replace(CONFIG, n_iterations=3))
    is_mean = trace["parameter"].eq("height_mean_m") & trace["category"].eq("mouse")
    found = trace[is_mean].set_index("iteration")["value"]
    first = [scene[0].objects[3, 2] - 1 for scene in scenes]
    second = [scene[1].objects[3, 2] - 1 for scene in scenes if len(scene) > 1]
    expected = [
        np.mean([BROAD.height_mean_m, *seen]) for seen in (first, first + second)
    ]
    np.testing.assert_allclose(
        found, [expected[0], expected[1], expected[1]], atol=1e-6
    )


def test_scenes_that_take_turns_teach_the_same(scenes):
    turns = replace(CONFIG, scenes_per_round=4, n_iterations=12)
    thetas, _ = learn(scenes, turns)
    whole, _ = learn(scenes)
    for name, theta in whole.items():
        assert thetas[name].height_mean_m == pytest.approx(theta.height_mean_m, abs=0.1)

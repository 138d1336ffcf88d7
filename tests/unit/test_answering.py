"""Methods answer with densities over the places that fit."""

import numpy as np
import pytest
from study import SETTINGS, study

from placing import dpmm
from placing.answering import METHODS, answer
from placing.baselines import FEATURES_OF, learn_histograms
from placing.examples import baseline_values, examples_of
from placing.fitting import BROAD, FittingConfig
from placing.learning import LearningConfig, learn_theta
from placing.scene_model import Learned, SceneModel
from placing.seeds import generator
from placing.tasks import questions


@pytest.fixture(scope="module")
def model():
    """Return the answers of a method that has learned from the very same scene."""
    scene, candidates, poses = study()
    rng = generator(0, "test")
    fitting = FittingConfig(0.2, 50.0, 0.1, 0.05)
    config = LearningConfig(5, 10, 10)
    examples = [examples_of(scene, poses)]
    thetas, _ = learn_theta(rng, examples, SETTINGS.sampling, config, fitting)
    histograms = {
        method: learn_histograms(
            baseline_values([(scene, candidates)], method), method, SETTINGS.baselines
        )
        for method in FEATURES_OF
    }
    return SceneModel(scene, candidates, poses, Learned(thetas, histograms), SETTINGS)


def ask(model, task, method, question=0):
    asked = questions(model.scene, task)[question]
    return asked, answer(generator(0, task, method), model, asked, method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("task", ["filled", "empty"])
def test_every_method_places_every_wanted_object_on_an_area(model, task, method):
    question, given = ask(model, task, method)
    assert [o for o, _ in given.placements] == sorted(
        question.wanted, key=lambda o: o.category
    )
    heights = [area.height_m for area in model.scene.areas]
    for item, placement in given.placements:
        bottom = placement.location[2] - item.size_m[2] / 2
        assert min(abs(bottom - h) for h in heights) < 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_densities_sum_to_one_and_avoid_what_stands_there(model, method):
    question, given = ask(model, "filled", method, question=1)
    (density,) = given.densities.values()
    assert density.sum() == pytest.approx(1)
    laptop = next(p for p in question.given if p.object_id == "laptop1")
    offset = model.candidates.location - laptop.location
    is_below_laptop = np.abs(offset[:, :2]).max(1) < 0.1
    is_below_laptop &= model.candidates.location[:, 2] > 0.7
    assert is_below_laptop.any()
    assert (density[is_below_laptop] == 0).all()


def test_people_bring_the_laptop_back_to_the_desk(model):
    _, given = ask(model, "filled", "dp")
    (_, placement) = given.placements[0]
    assert placement.area == "area2"
    is_on_desk = model.candidates.location[:, 2] > 0.7
    share = given.densities["laptop"][is_on_desk].sum()
    by_chance = ask(model, "filled", "chance")[1].densities["laptop"]
    assert share > 2 * by_chance[is_on_desk].sum()


def test_the_same_stream_gives_the_same_answer(model):
    one, two = (ask(model, "empty", "dp")[1] for _ in range(2))
    for category, density in one.densities.items():
        np.testing.assert_array_equal(density, two.densities[category])
    np.testing.assert_array_equal(one.chains.pose, two.chains.pose)


def test_the_chain_samples_given_and_wanted_objects_together(model):
    question, given = ask(model, "filled", "dp")
    n_objects = len(question.given) + len(question.wanted)
    assert given.chains.pose.shape == (2, SETTINGS.sampling.n_samples, n_objects)


def test_a_category_never_seen_uses_the_broad_theta(model):
    learned = Learned({}, {})
    scene, candidates, poses = model.scene, model.candidates, model.poses
    unlearned = SceneModel(scene, candidates, poses, learned, SETTINGS)
    question = questions(scene, "filled")[0]
    given = answer(generator(0, "x"), unlearned, question, "dp")
    assert unlearned.use("laptop")[0].theta == BROAD
    assert given.placements[0][1] is not None


def test_without_valid_poses_human_context_falls_back_to_chance(model):
    nobody = type(model.poses)(
        np.empty(0, np.uint8), np.empty((0, 3)), np.empty(0), np.empty(0)
    )
    scene, candidates = model.scene, model.candidates
    alone = SceneModel(scene, candidates, nobody, model.learned, SETTINGS)
    given = answer(generator(0, "x"), alone, questions(scene, "empty")[0], "dp")
    assert given.chains is None
    density = given.densities["laptop"]
    assert np.ptp(density[density > 0]) < 1e-12


def test_rows_are_scaled_the_same_from_logs_and_from_sums():
    row = np.array([0.1, 0.4, 0.0])
    with np.errstate(divide="ignore"):
        logs = dpmm.weight_rows(np.log(row)[None])[0]
    np.testing.assert_allclose(dpmm.scale_row(row), logs, rtol=1e-6)

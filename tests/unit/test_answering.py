"""Methods answer with densities over the places that fit."""

import numpy as np
import pytest
from study import SETTINGS, study

from placing import dpmm
from placing.answering import METHODS, Answerer, Learned
from placing.baselines import FEATURES_OF, learn_histograms
from placing.examples import baseline_values, examples_of
from placing.fitting import BROAD, FittingConfig
from placing.learning import LearningConfig, learn_theta
from placing.seeds import generator
from placing.tasks import questions


@pytest.fixture(scope="module")
def answerer():
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
    return Answerer(scene, candidates, poses, Learned(thetas, histograms), SETTINGS)


def ask(answerer, task, method, question=0):
    asked = questions(answerer.scene, task)[question]
    return asked, answerer.answer(generator(0, task, method), asked, method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("task", ["filled", "empty"])
def test_every_method_places_every_wanted_object_on_an_area(answerer, task, method):
    question, answer = ask(answerer, task, method)
    assert [o for o, _ in answer.placements] == sorted(
        question.wanted, key=lambda o: o.category
    )
    heights = [area.height_m for area in answerer.scene.areas]
    for item, placement in answer.placements:
        bottom = placement.location[2] - item.size_m[2] / 2
        assert min(abs(bottom - h) for h in heights) < 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_densities_sum_to_one_and_avoid_what_stands_there(answerer, method):
    question, answer = ask(answerer, "filled", method, question=1)
    (density,) = answer.densities.values()
    assert density.sum() == pytest.approx(1)
    laptop = next(p for p in question.given if p.object_id == "laptop1")
    offset = answerer.candidates.location - laptop.location
    is_below_laptop = np.abs(offset[:, :2]).max(1) < 0.1
    is_below_laptop &= answerer.candidates.location[:, 2] > 0.7
    assert is_below_laptop.any()
    assert (density[is_below_laptop] == 0).all()


def test_people_bring_the_laptop_back_to_the_desk(answerer):
    _, answer = ask(answerer, "filled", "dp")
    (_, placement) = answer.placements[0]
    assert placement.area == "area2"
    is_on_desk = answerer.candidates.location[:, 2] > 0.7
    share = answer.densities["laptop"][is_on_desk].sum()
    by_chance = ask(answerer, "filled", "chance")[1].densities["laptop"]
    assert share > 2 * by_chance[is_on_desk].sum()


def test_the_same_stream_gives_the_same_answer(answerer):
    one, two = (ask(answerer, "empty", "dp")[1] for _ in range(2))
    for category, density in one.densities.items():
        np.testing.assert_array_equal(density, two.densities[category])
    np.testing.assert_array_equal(one.chain.pose, two.chain.pose)


def test_the_chain_samples_given_and_wanted_objects_together(answerer):
    question, answer = ask(answerer, "filled", "dp")
    n_objects = len(question.given) + len(question.wanted)
    assert answer.chain.pose.shape == (SETTINGS.sampling.n_samples, n_objects)


def test_a_category_never_seen_uses_the_broad_theta(answerer):
    learned = Learned({}, {})
    scene, candidates, poses = answerer.scene, answerer.candidates, answerer.poses
    unlearned = Answerer(scene, candidates, poses, learned, SETTINGS)
    question = questions(scene, "filled")[0]
    answer = unlearned.answer(generator(0, "x"), question, "dp")
    assert unlearned._use("laptop")[0].theta == BROAD
    assert answer.placements[0][1] is not None


def test_without_valid_poses_human_context_falls_back_to_chance(answerer):
    nobody = type(answerer.poses)(
        np.empty(0, np.uint8), np.empty((0, 3)), np.empty(0), np.empty(0)
    )
    scene, candidates = answerer.scene, answerer.candidates
    alone = Answerer(scene, candidates, nobody, answerer.learned, SETTINGS)
    answer = alone.answer(generator(0, "x"), questions(scene, "empty")[0], "dp")
    assert answer.chain is None
    density = answer.densities["laptop"]
    assert np.ptp(density[density > 0]) < 1e-12


def test_rows_are_scaled_the_same_from_logs_and_from_sums():
    row = np.array([0.1, 0.4, 0.0])
    with np.errstate(divide="ignore"):
        logs = dpmm.weight_rows(np.log(row)[None])[0]
    np.testing.assert_allclose(dpmm.scale_row(row), logs, rtol=1e-6)

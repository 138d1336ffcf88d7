"""Methods answer with densities over the places that fit."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from study import SETTINGS, study_model

from placing.learning.fitting import BROAD
from placing.learning.learned import Choices, Learned
from placing.methods.answering import NO_EXAMPLE, NO_PLACE, NO_POSE, Asked
from placing.methods.names import METHODS
from placing.methods.scene_model import SceneModel
from placing.people import dpmm
from placing.seeds import generator
from placing.tasks import questions


@pytest.fixture(scope="module")
def model():
    return study_model()


def asked_of(model, task, question=0):
    choices = Choices(n_components=2, object_weight=0.25)
    return Asked(
        partial(generator, 0, task), model, question_of(model, task, question), choices
    )


def question_of(model, task, number=0):
    return questions(model.scene, task)[number]


def ask(model, task, method, question=0):
    return asked_of(model, task, question).answer(method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("task", ["filled", "empty"])
def test_every_method_places_every_wanted_object_on_an_area(model, task, method):
    given = ask(model, task, method)
    wanted = sorted(question_of(model, task).wanted, key=lambda o: o.category)
    assert [chosen.item for chosen in given.chosen] == wanted
    heights = [area.height_m for area in model.scene.areas]
    for chosen in given.chosen:
        bottom = chosen.placement.location[2] - chosen.item.size_m[2] / 2
        assert min(abs(bottom - h) for h in heights) < 1e-9
        assert chosen.reason == ""


@pytest.mark.parametrize("method", METHODS)
def test_densities_sum_to_one_and_avoid_what_stands_there(model, method):
    question = question_of(model, "filled", 1)
    (density,) = ask(model, "filled", method, 1).densities.values()
    assert density.sum() == pytest.approx(1)
    laptop = next(p for p in question.given if p.object_id == "laptop1")
    offset = model.candidates.location - laptop.location
    is_below_laptop = np.abs(offset[:, :2]).max(1) < 0.1
    is_below_laptop &= model.candidates.location[:, 2] > 0.7
    assert is_below_laptop.any()
    assert (density[is_below_laptop] == 0).all()


def test_people_bring_the_laptop_back_to_the_desk(model):
    given = ask(model, "filled", "dp")
    assert given.chosen[0].placement.area == "area2"
    is_on_desk = model.candidates.location[:, 2] > 0.7
    share = given.densities["laptop"][is_on_desk].sum()
    by_chance = ask(model, "filled", "chance").densities["laptop"]
    assert share > 2 * by_chance[is_on_desk].sum()


@pytest.mark.parametrize("method", ["fmm", "dp"])
def test_the_same_stream_gives_the_same_answer(model, method):
    one, two = (ask(model, "empty", method) for _ in range(2))
    for category, density in one.densities.items():
        np.testing.assert_array_equal(density, two.densities[category])
    np.testing.assert_array_equal(one.people.chains.pose, two.people.chains.pose)


def test_dp_object_mixes_the_densities_of_both_contexts(model):
    asked = asked_of(model, "filled")
    mixed = asked.answer("dp_object").densities["laptop"]
    parts = [asked.answer(method) for method in ("dp", "object")]
    whole = [asked.found(method, "laptop")[0] for method in ("dp", "object")]
    expected = asked.fitting("laptop", 0.25 * whole[0] + 0.75 * whole[1])
    np.testing.assert_allclose(mixed, expected)
    assert mixed.max() != pytest.approx(parts[0].densities["laptop"].max())


def test_an_answer_does_not_depend_on_what_was_asked_before(model):
    alone = ask(model, "filled", "dp_object").densities["laptop"]
    asked = asked_of(model, "filled")
    for method in METHODS:
        last = asked.answer(method)
    np.testing.assert_array_equal(alone, last.densities["laptop"])


def test_the_finite_mixture_never_uses_more_poses_than_it_has(model):
    assert ask(model, "empty", "fmm").people.chains.n_poses.max() <= 2


def test_the_chain_samples_given_and_wanted_objects_together(model):
    question = question_of(model, "filled")
    n_objects = len(question.given) + len(question.wanted)
    chains = ask(model, "filled", "dp").people.chains
    assert chains.pose.shape == (2, SETTINGS.sampling.n_samples, n_objects)


def test_a_category_never_seen_uses_the_broad_theta_and_says_so(model):
    learned = Learned({"dp": {}}, {"height": {}}, model.learned.relations)
    scene, candidates, poses = model.scene, model.candidates, model.poses
    unlearned = SceneModel(scene, candidates, poses, learned, SETTINGS)
    for method in ("dp", "height"):
        (chosen,) = ask(unlearned, "filled", method).chosen
        assert chosen.placement is not None
        assert chosen.reason == NO_EXAMPLE
    assert unlearned.use("dp", "laptop").theta == BROAD


def test_without_valid_poses_human_context_falls_back_to_chance_and_says_so(model):
    nobody = type(model.poses)(
        np.empty(0, np.uint8), np.empty((0, 3)), np.empty(0), np.empty(0)
    )
    scene, candidates = model.scene, model.candidates
    alone = SceneModel(scene, candidates, nobody, model.learned, SETTINGS)
    for method in ("random_human", "fmm", "dp"):
        given = ask(alone, "empty", method)
        assert given.people is None
        assert given.chosen[0].reason == NO_POSE
        density = given.densities["laptop"]
        assert np.ptp(density[density > 0]) < 1e-12


def test_an_object_that_fits_nowhere_has_no_placement_and_a_reason(model):
    scene = model.scene
    huge = [replace(item, size_m=(9.0, 9.0, 9.0)) for item in scene.objects]
    scene = replace(scene, objects=tuple(huge))
    args = model.candidates, model.poses, model.learned, SETTINGS
    crowded = SceneModel(scene, *args)
    for method in METHODS:
        for chosen in ask(crowded, "empty", method).chosen:
            assert chosen.placement is None
            assert chosen.reason == NO_PLACE


def test_rows_are_scaled_the_same_from_logs_and_from_sums():
    row = np.array([0.1, 0.4, 0.0])
    with np.errstate(divide="ignore"):
        logs = dpmm.weight_rows(np.log(row)[None])[0]
    np.testing.assert_allclose(dpmm.scale_row(row), logs, rtol=1e-6)

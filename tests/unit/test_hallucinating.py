"""People are sampled until their chains agree, and new people count as well."""

from dataclasses import replace

import numpy as np
import pytest
from study import SETTINGS, study_model

from placing.methods.scene_model import SceneModel
from placing.people.diagnostics import DiagnosticsConfig
from placing.people.hallucinating import hallucinate, random_people
from placing.seeds import generator
from placing.tasks import questions


@pytest.fixture(scope="module")
def model():
    return study_model()


def gated(model, max_rhat, max_variation, n_doublings):
    gates = DiagnosticsConfig(max_rhat, max_variation, n_doublings)
    settings = replace(SETTINGS, diagnostics=gates)
    parts = model.scene, model.candidates, model.poses, model.learned
    return SceneModel(*parts, settings)


def n_samples(model):
    question = questions(model.scene, "empty")[0]
    people = hallucinate(generator(0, "x"), model, question)
    return people.chains.n_poses.shape[1], people


def test_chains_within_the_gates_are_run_once(model):
    n, people = n_samples(gated(model, 1e6, 1.1, 3))
    assert n == SETTINGS.sampling.n_samples
    assert people.diagnosis is not None


def test_chains_outside_the_gates_are_doubled_as_often_as_allowed(model):
    n, people = n_samples(gated(model, 1.0 + 1e-12, 1e-12, 2))
    assert n == 4 * SETTINGS.sampling.n_samples
    assert not people.diagnosis.is_mixed(DiagnosticsConfig(1.0 + 1e-12, 1e-12, 2))


def test_a_single_chain_has_no_diagnosis(model):
    sampling = replace(SETTINGS.sampling, n_chains=1)
    settings = replace(SETTINGS, sampling=sampling)
    parts = model.scene, model.candidates, model.poses, model.learned
    n, people = n_samples(SceneModel(*parts, settings))
    assert people.diagnosis is None
    assert n == sampling.n_samples


@pytest.mark.parametrize("task", ["filled", "empty"])
def test_the_users_of_a_category_are_somewhere_with_certainty(model, task):
    for question in questions(model.scene, task):
        people = hallucinate(generator(0, "x"), model, question)
        assert list(people.weight) == question.categories
        for name, weight in people.weight.items():
            assert weight.sum() == pytest.approx(1)
            assert weight.min() >= 0
            share = people.seen[name].sum() + people.p_new[name]
            assert share == pytest.approx(1)


def test_with_a_huge_concentration_every_object_has_a_new_person(model):
    sampling = replace(SETTINGS.sampling, concentration=1e6)
    parts = model.scene, model.candidates, model.poses, model.learned
    lonely = SceneModel(*parts, replace(SETTINGS, sampling=sampling))
    question = questions(model.scene, "filled")[0]
    people = hallucinate(generator(0, "x"), lonely, question)
    for name, weight in people.weight.items():
        new = lonely.use("dp", name).new_person()
        assert np.abs(weight - new).sum() < 1e-3


def test_random_people_are_those_of_the_prior(model):
    question = questions(model.scene, "empty")[0]
    people = random_people(model, question)
    for weight in people.weight.values():
        np.testing.assert_array_equal(weight, model.poses.prior)
    assert people.diagnosis is None

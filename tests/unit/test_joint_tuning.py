"""Labelled scenes choose omega by likelihood and tell what is stacked."""

from dataclasses import replace

import numpy as np
import pytest
from study import placement, study

from placing.joint.joint_tuning import most_frequent, stack_shares, weight_nll
from placing.learning.likelihoods import ScoringConfig
from placing.scene import Arrangement, resting_point

WEIGHTS = (0.1, 0.5, 0.9)
SCORING = ScoringConfig(0.01)


@pytest.fixture(scope="module")
def parts():
    scene, candidates, _ = study()
    return scene, candidates.location


def test_nll_is_that_of_a_loop_over_labels(parts):
    scene, places = parts
    rng = np.random.default_rng(0)
    shape = len(scene.objects), len(places)
    dp, context = (d / d.sum(1)[:, None] for d in rng.random((2, *shape)))
    densities = {"dp": dp, "object_context": context}
    found = weight_nll(scene, places, densities, WEIGHTS, 0.05, SCORING)
    for w, value in zip(WEIGHTS, found, strict=True):
        terms = []
        for arrangement in scene.arrangements:
            for placed in arrangement.placements:
                names = [item.object_id for item in scene.objects]
                i = names.index(placed.object_id)
                at = resting_point(scene.objects[i], placed)
                p = int(np.argmin(np.linalg.norm(places - at, axis=1)))
                density = w * dp[i, p] + (1 - w) * context[i, p]
                density = 0.99 * density + 0.01 / len(places)
                terms.append(-np.log(density / 0.05**2))
        assert value == pytest.approx(np.mean(terms))


def test_the_context_that_knows_the_labels_gets_the_weight(parts):
    scene, places = parts
    flat = np.full((len(scene.objects), len(places)), 1 / len(places))
    sharp = np.zeros_like(flat)
    placements = {p.object_id: p for p in scene.arrangements[0].placements}
    for i, item in enumerate(scene.objects):
        at = resting_point(item, placements[item.object_id])
        sharp[i, np.argmin(np.linalg.norm(places - at, axis=1))] = 1
    knows = {"dp": sharp, "object_context": flat}
    args = WEIGHTS, 0.05, SCORING
    assert np.argmin(weight_nll(scene, places, knows, *args)) == 2
    knows = {"dp": flat, "object_context": sharp}
    assert np.argmin(weight_nll(scene, places, knows, *args)) == 0


def test_the_smaller_of_two_as_frequent_wins():
    assert most_frequent([8, 4, 4, 8, 2]) == 4


def test_shares_count_objects_on_their_like_only(parts):
    scene, _ = parts
    assert stack_shares([scene]) == {}
    # One mouse on the other, in one of two arrangements: 1 of 4 labelled mice.
    on_top = placement("mouse2", 1.8, 2.4, 0.80, 0.0)
    one = tuple(
        on_top if p.object_id == "mouse2" else p
        for p in scene.arrangements[0].placements
    )
    stacked = replace(
        scene, arrangements=(Arrangement("a", "b", one), scene.arrangements[1])
    )
    assert stack_shares([stacked]) == {"mouse": 0.25}
    # Shoes below a mouse are no stack of mice.
    apart = placement("mouse2", 0.3, 0.3, 0.12, 0.0)
    one = tuple(
        apart if p.object_id == "mouse2" else p
        for p in scene.arrangements[0].placements
    )
    assert (
        stack_shares([replace(scene, arrangements=(Arrangement("a", "b", one),))]) == {}
    )

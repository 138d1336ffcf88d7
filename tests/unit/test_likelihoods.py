"""The likelihood of a label is that of the place nearest to where its object rests."""

import numpy as np
import pytest
from study import study

from placing.learning.likelihoods import (
    ScoringConfig,
    fit,
    likelihood_rows,
    nearest_places,
    with_uniform,
)
from placing.scene import resting_point
from placing.tasks import questions

SPACING_M = 0.05


@pytest.fixture(scope="module")
def parts():
    scene, candidates, _ = study()
    return scene, candidates.location


def rows_of(parts, task, densities, share=0.01):
    """Return nll and rank by labels and object over all questions of a task."""
    scene, places = parts
    nearest, config = nearest_places(scene, places), ScoringConfig(share)
    return {
        (labels, name): (nll, rank)
        for question in questions(scene, task)
        for labels, name, _, nll, rank in likelihood_rows(
            *(nearest, question),
            {c: with_uniform(densities[c], config) for c in question.categories},
            SPACING_M,
        )
    }


def test_nearest_place_is_that_of_a_loop(parts):
    scene, places = parts
    found = nearest_places(scene, places)
    items = {item.object_id: item for item in scene.objects}
    for arrangement in scene.arrangements:
        for placement in arrangement.placements:
            at = resting_point(items[placement.object_id], placement)
            away = [np.linalg.norm(place - at) for place in places]
            place = found[arrangement.name][placement.object_id]
            assert away[place] == pytest.approx(min(away))


@pytest.mark.parametrize("task", ["filled", "empty"])
def test_uniform_density_gives_the_log_of_the_area_and_every_place_ties(parts, task):
    n = len(parts[1])
    uniform = dict.fromkeys(("laptop", "mouse", "shoe"), np.full(n, 1 / n))
    rows = rows_of(parts, task, uniform)
    assert len(rows) == 8
    for nll, rank in rows.values():
        assert nll == pytest.approx(np.log(n * SPACING_M**2))
        assert rank == pytest.approx(1)


def test_density_is_read_where_the_labelled_object_rests(parts):
    scene, places = parts
    n = len(places)
    shoes = scene.arrangements[1].placements[-1]
    items = {item.object_id: item for item in scene.objects}
    away = np.linalg.norm(places - resting_point(items["shoes"], shoes), axis=1)
    peak = (np.arange(n) == away.argmin()).astype(float)
    densities = dict.fromkeys(("laptop", "mouse"), np.full(n, 1 / n))
    rows = rows_of(parts, "empty", densities | {"shoe": peak})
    hit, miss = rows["labeller2", "shoes"], rows["labeller1", "shoes"]
    assert hit[0] == pytest.approx(-np.log((0.99 + 0.01 / n) / SPACING_M**2))
    assert miss[0] == pytest.approx(-np.log(0.01 / n / SPACING_M**2))
    assert hit[1] == pytest.approx(0.99 + 0.01 / n)
    assert miss[1] == pytest.approx(1)


def test_fit_is_that_of_a_loop_over_the_mixed_density():
    rng = np.random.default_rng(0)
    density = rng.choice([0, 1, 2, 5], 60).astype(float)  # with ties
    density /= density.sum()
    at = [3, 17, 17, 59]
    found = fit(with_uniform(density, ScoringConfig(0.2)), at, SPACING_M)
    mixed = [0.8 * value + 0.2 / 60 for value in density]
    for (nll, rank), place in zip(found, at, strict=True):
        as_dense = sum(value for value in mixed if value >= mixed[place])
        assert rank == pytest.approx(as_dense)
        assert nll == pytest.approx(-np.log(mixed[place] / SPACING_M**2))

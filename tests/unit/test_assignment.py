"""The joint placement is the best one without overlap, and says how sure it is."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import shapely

from placing.joint.assignment import AssignmentConfig, assign
from placing.joint.options import Options
from placing.joint.stacking import StackPair, footprints, overhangs, stacked_boxes

CONFIG = AssignmentConfig(
    n_best=200,
    n_spread=100,
    margin_m=0.01,
    max_levels=3,
    max_overhang=0.3,
    unplaced_penalty=20.0,
    point_spacing_m=0.05,
    n_price_steps=60,
    mip_rel_gap=1e-9,
    node_limit=1000,
    n_core=12,
    max_core=100_000,
    n_cut_rounds=3,
    n_rounds=60,
)


def options(rng, n_options, size, clearance=9.0, n_places=6):
    """Return options at places 10 cm apart in a row, at any heading."""
    place = np.sort(rng.choice(n_places, n_options))
    size = np.tile(size, (n_options, 1))
    at = np.column_stack([0.1 * place, 0.03 * (place % 2), 0.7 + size[:, 2] / 2])
    yaw = rng.integers(0, 8, n_options) * np.pi / 4
    area = np.zeros(n_options, np.int32)
    free = np.full(n_options, clearance)
    score = rng.normal(0, 2, n_options)
    return Options(at, size, yaw, area, place.astype(np.int32), free, score)


def random_case(rng, n_objects=4, n_options=6, with_stacks=False):
    """Return objects that crowd each other, and pairs of them that may be stacked."""
    sizes = rng.uniform((0.06, 0.06, 0.03), (0.22, 0.16, 0.12), (n_objects, 3))
    clearance = rng.choice([0.15, 0.25, 9.0])
    count = rng.integers(2, n_options + 1, n_objects)
    objects = [
        options(rng, k, size, clearance) for k, size in zip(count, sizes, strict=True)
    ]
    pairs = [
        StackPair(i, j, float(rng.normal(0.5, 1)))
        for i, j in product(range(n_objects), repeat=2)
        if with_stacks and i != j and rng.random() < 0.7
    ]
    return objects, pairs


def have_common_part(a, b):
    """Return whether two boxes overlap, from their polygons and heights."""
    first, second = footprints(np.array([a, b]))
    is_level = abs(a[2] - b[2]) < (a[5] + b[5]) / 2 - 1e-6
    return is_level and shapely.intersection(first, second).area > 1e-9


def is_allowed(objects, choice, on, config):
    """Return whether a placement keeps all rules, each checked by itself."""
    boxes = stacked_boxes(objects, choice, on)
    placed = np.flatnonzero(choice >= 0)
    place = np.array([objects[i].place[choice[i]] for i in placed])
    if len(np.unique(place[on[placed] < 0])) < (on[placed] < 0).sum():
        return False
    for i in placed[on[placed] >= 0]:
        j, k = on[i], i
        height, n_levels = boxes[i, 5], 1
        while on[k] >= 0:
            k = on[k]
            height, n_levels = height + boxes[k, 5], n_levels + 1
        below = objects[j].boxes[[choice[j]]]
        overhang = overhangs(objects[i].boxes[[choice[i]]], below)[0]
        if (
            objects[i].place[choice[i]] != objects[j].place[choice[j]]
            or overhang > config.max_overhang
            or n_levels > config.max_levels
            or height > objects[i].clearance_m[choice[i]] + 1e-6
        ):
            return False
    wide = boxes + np.array([0, 0, 0, config.margin_m, config.margin_m, 0, 0])
    return not any(
        have_common_part(wide[i], wide[j]) for i in placed for j in placed if i < j
    )


def has_cycle_or_gap(choice, on):
    """Return whether an object stands on nothing, on a shared one, or on itself."""
    upper = np.flatnonzero(on >= 0)
    if (choice[on[upper]] < 0).any() or len(np.unique(on[upper])) < len(upper):
        return True
    for i in upper:
        k = i
        for _ in range(len(on) + 1):
            if on[k] < 0:
                break
            k = on[k]
        else:
            return True
    return False


def value_of(objects, pairs, choice, on, config):
    """Return the sum of log scores and penalties."""
    pair_score = {(pair.upper, pair.lower): pair.log_score for pair in pairs}
    total = 0.0
    for i, item in enumerate(objects):
        if choice[i] < 0:
            total += item.log_score.min() - config.unplaced_penalty
        else:
            total += item.log_score[choice[i]] + pair_score.get((i, on[i]), 0.0)
    return total


def by_exhaustion(objects, pairs, config):
    """Return the largest sum over all placements, by looking at every one."""
    below = {i: [-1] for i in range(len(objects))}
    for pair in pairs:
        below[pair.upper].append(pair.lower)
    states = [
        [(-1, -1), *product(range(len(item.yaw)), below[i])]
        for i, item in enumerate(objects)
    ]
    pair_score = {(pair.upper, pair.lower): pair.log_score for pair in pairs}
    total = np.zeros(1)
    for i, item in enumerate(objects):
        nowhere = item.log_score.min() - config.unplaced_penalty
        worth = [
            item.log_score[o] + pair_score.get((i, j), 0.0) if o >= 0 else nowhere
            for o, j in states[i]
        ]
        total = (total[:, None] + np.array(worth)).ravel()
    shape = tuple(len(of_object) for of_object in states)
    for at in np.argsort(-total):
        state = [states[i][k] for i, k in enumerate(np.unravel_index(at, shape))]
        choice, on = (np.array(x) for x in zip(*state, strict=True))
        if not has_cycle_or_gap(choice, on) and is_allowed(objects, choice, on, config):
            return float(total[at])
    raise AssertionError


@pytest.mark.parametrize("seed", range(10))
def test_the_objective_is_that_of_exhaustion(seed):
    objects, pairs = random_case(np.random.default_rng(seed))
    found = assign(objects, pairs, CONFIG)
    assert found.objective == pytest.approx(by_exhaustion(objects, pairs, CONFIG))
    assert is_allowed(objects, found.choice, found.on, CONFIG)
    assert found.gap < 1e-5


@pytest.mark.parametrize("seed", range(8))
def test_the_objective_with_stacks_is_that_of_exhaustion(seed):
    rng = np.random.default_rng(100 + seed)
    objects, pairs = random_case(rng, 3 + seed % 2, 6 - 3 * (seed % 2), True)
    found = assign(objects, pairs, CONFIG)
    expected = by_exhaustion(objects, pairs, CONFIG)
    assert found.objective == pytest.approx(expected)
    assert found.bound >= expected - 1e-6
    assert found.gap < 1e-5
    assert not has_cycle_or_gap(found.choice, found.on)
    assert is_allowed(objects, found.choice, found.on, CONFIG)
    value = value_of(objects, pairs, found.choice, found.on, CONFIG)
    assert found.objective == pytest.approx(value)


def test_the_same_question_has_the_same_answer():
    objects, pairs = random_case(np.random.default_rng(5), 8, 12, True)
    first, second = (assign(objects, pairs, CONFIG) for _ in range(2))
    np.testing.assert_array_equal(first.choice, second.choice)
    np.testing.assert_array_equal(first.on, second.on)
    assert first.objective == second.objective


def test_a_search_that_stops_early_is_honest_about_its_gap():
    objects, pairs = random_case(np.random.default_rng(6), 8, 12)
    best = assign(objects, pairs, CONFIG)
    limits = {
        "n_rounds": 1,
        "n_cut_rounds": 0,
        "n_price_steps": 1,
        "n_core": 1,
        "max_core": 1,
    }
    early = assign(objects, pairs, replace(CONFIG, **limits))
    assert best.gap < 1e-5
    assert early.objective <= best.objective + 1e-6 <= early.bound + 2e-6
    assert is_allowed(objects, early.choice, early.on, CONFIG)

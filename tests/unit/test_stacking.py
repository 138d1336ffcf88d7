"""Stacks are linear, low enough and supported."""

from dataclasses import replace

import numpy as np
import pytest

from placing.joint.assignment import CROWDED_OUT, NO_OPTION, AssignmentConfig, assign
from placing.joint.options import Options, thin_options
from placing.joint.stacking import StackPair, overhangs, stacked_boxes

CONFIG = AssignmentConfig(
    200, 100, 0.005, 4, 0.3, 50, 0.05, 50, 1e-9, 500, 20, 10**5, 10, 30
)


def book(score=0.0, size=(0.2, 0.15, 0.03), clearance=9.0, n_places=1):
    """Return the options of a book at places half a metre apart."""
    at = np.column_stack([0.5 * np.arange(n_places), np.zeros((n_places, 2))])
    at[:, 2] = 0.7 + size[2] / 2
    place = np.arange(n_places, dtype=np.int32)
    full = np.ones(n_places)
    size = np.tile(size, (n_places, 1))
    return Options(at, size, 0 * full, 0 * place, place, clearance * full, score * full)


def everyone(n, log_score=1.0):
    pairs = [(i, j) for i in range(n) for j in range(n) if i != j]
    return [StackPair(i, j, log_score) for i, j in pairs]


def test_books_with_one_place_make_one_stack():
    found = assign([book()] * 3, everyone(3), CONFIG)
    assert sorted(found.level) == [0, 1, 2]
    assert found.objective == pytest.approx(2.0)
    boxes = stacked_boxes([book()] * 3, found.choice, found.on)
    np.testing.assert_allclose(np.sort(boxes[:, 2]), [0.715, 0.745, 0.775])


def test_a_stack_has_no_more_levels_than_allowed():
    found = assign([book()] * 3, everyone(3), replace(CONFIG, max_levels=2))
    assert sorted(found.level) == [-1, 0, 1]
    assert sorted(found.reason) == ["", "", CROWDED_OUT]


def test_a_stack_stays_below_what_is_above():
    low = [book(clearance=0.065)] * 3
    assert sorted(assign(low, everyone(3), CONFIG).level) == [-1, 0, 1]


def test_a_large_object_does_not_stand_on_a_small_one():
    objects = [book(), book(size=(0.1, 0.1, 0.02))]
    found = assign(objects, everyone(2), CONFIG)
    assert list(found.on) == [-1, 0]
    only = assign(objects, [StackPair(0, 1, 5.0)], CONFIG)
    assert (only.choice < 0).sum() == 1


def test_pairs_that_are_worth_less_than_two_places_are_not_stacked():
    objects = [book(n_places=2)] * 2
    assert (assign(objects, everyone(2, -1.0), CONFIG).on < 0).all()
    assert (assign(objects, everyone(2, 1.0), CONFIG).on >= 0).sum() == 1


def test_a_raised_object_does_not_hit_a_tall_neighbour():
    wide, narrow = book(size=(0.24, 0.15, 0.03)), book(size=(0.2, 0.15, 0.03))
    neighbour = book(size=(0.05, 0.05, 0.3), n_places=2)
    at = neighbour.location.copy()
    at[0, 0], at[1, 0] = 0.13, 1.0  # clear of the narrow book, not of the wide one
    score, place = np.array([3.0, 0.0]), np.array([7, 8], np.int32)
    neighbour = replace(neighbour, location=at, log_score=score, place=place)
    objects, pair = [narrow, wide, neighbour], [StackPair(1, 0, 1.0)]
    found = assign(objects, pair, CONFIG)
    assert list(found.on) == [-1, 0, -1]
    assert found.choice[2] == 1


def test_overhang_is_the_share_that_lies_off():
    lower = np.array([[0, 0, 0, 0.2, 0.2, 0.1, 0]])
    upper = np.array([[0.05, 0, 0, 0.2, 0.2, 0.1, np.pi / 2]])
    assert overhangs(upper, lower)[0] == pytest.approx(0.25)


def test_an_object_without_options_is_left_out_with_a_reason():
    empty = book().only(np.zeros(0, np.int64))
    found = assign([empty, book()], [], CONFIG)
    assert list(found.choice) == [-1, 0]
    assert found.reason == (NO_OPTION, "")
    assert assign([empty], [], CONFIG).gap == 0


def test_thinning_keeps_the_best_options_and_some_far_away():
    many = book(n_places=100)
    many = replace(many, log_score=-np.arange(100.0))
    kept = thin_options(many, 10, 5)
    assert list(kept[:10]) == list(range(10))
    assert len(kept) == 15
    assert kept.max() > 13
    assert list(thin_options(many.only(kept), 10, 5)) == list(range(15))

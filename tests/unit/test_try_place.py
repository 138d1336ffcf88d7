"""The search for a placing order against every order of every choice of placements."""

from itertools import product

import numpy as np
import pytest

from placing.plans.conflicts import minimal_conflict
from placing.plans.placing_order import Verdict
from placing.plans.try_place import Limits, place_most, try_place, try_place_printed

N_WORLDS = 400
LIMITS = Limits(max_calls=100_000, max_steps=100_000)


class World:
    """Placements are (object, number); each is blocked once some others are there."""

    def __init__(self, seed, n_objects=None, is_stacked=False):
        rng = np.random.default_rng(seed)
        n = n_objects or int(rng.integers(2, 6))
        names = [f"o{i}" for i in range(n)]
        sizes = rng.integers(1, 4, n)
        self.possible = {
            name: [(name, k) for k in range(size)]
            for name, size in zip(names, sizes, strict=True)
        }
        every = [p for ps in self.possible.values() for p in ps]
        self.support = {}
        if is_stacked:
            for i, above in enumerate(every):
                below = [p for p in every[:i] if p[0] != above[0]]
                if below and rng.random() < 0.3:
                    self.support[above] = below[rng.integers(len(below))]
        self.blocks = {p: self._blocks(rng, p, every) for p in every}
        self.asked = []

    def _blocks(self, rng, placement, every):
        others = [p for p in every if p[0] != placement[0]]
        n = rng.choice(4, p=[0.05, 0.1, 0.2, 0.65])
        sizes = rng.choice([0, 1, 2], p=[0.02, 0.93, 0.05], size=n)
        picks = [rng.permutation(len(others))[:size] for size in sizes]
        return [frozenset(others[j] for j in pick) for pick in picks]

    def feasible(self, placement, placed):
        self.asked.append((placement, placed))
        below = self.support.get(placement)
        assert below is None or below in placed
        found = [c for c in self.blocks[placement] if c <= placed]
        return Verdict(not found, found[0] if found else frozenset())

    def can(self, placement, placed):
        below = self.support.get(placement)
        is_held = below is None or below in placed
        return is_held and not any(c <= placed for c in self.blocks[placement])

    def reachable(self):
        """Every set of placements that some order of feasible steps leads to."""
        found, todo = {frozenset()}, [frozenset()]
        while todo:
            placed = todo.pop()
            taken = {name for name, _ in placed}
            for name, placements in self.possible.items():
                for p in placements if name not in taken else []:
                    new = placed | {p}
                    if self.can(p, placed) and new not in found:
                        found.add(new)
                        todo.append(new)
        return found

    def placeable(self):
        """Every set of objects that are placed in some reachable state."""
        return {frozenset(name for name, _ in state) for state in self.reachable()}


def is_sound(world, order):
    steps = [world.can(p, frozenset(order[:n])) for n, p in enumerate(order)]
    return all(steps) and len({name for name, _ in order}) == len(order)


def covers(placeable, wanted):
    return any(frozenset(wanted) <= objects for objects in placeable)


def worlds(is_stacked):
    seeds = range(N_WORLDS)
    return [World([seed, is_stacked], is_stacked=is_stacked) for seed in seeds]


def solve(world):
    return try_place(world.possible, world.feasible, LIMITS, world.support)


@pytest.mark.parametrize("is_stacked", [False, True])
def test_default_finds_an_order_wherever_one_exists(is_stacked):
    n_solvable = 0
    for world in worlds(is_stacked):
        found = solve(world)
        solvable = covers(world.placeable(), world.possible)
        n_solvable += solvable
        assert found.is_complete == solvable
        assert is_sound(world, found.order)
        if found.is_complete:
            assert {name for name, _ in found.order} == set(world.possible)
    assert 0.25 * N_WORLDS < n_solvable < 0.9 * N_WORLDS


@pytest.mark.parametrize("is_stacked", [False, True])
def test_default_asks_each_step_once(is_stacked):
    for world in worlds(is_stacked):
        found = solve(world)
        assert len(world.asked) == len(set(world.asked)) == found.n_feasibility_calls
        steps = {(p, frozenset(found.order[:n])) for n, p in enumerate(found.order)}
        assert steps <= set(world.asked)


@pytest.mark.parametrize("is_stacked", [False, True])
def test_conflict_is_minimal(is_stacked):
    n_conflicts = 0
    for world in worlds(is_stacked):
        found = solve(world)
        conflict = found.conflict
        assert bool(conflict) != found.is_complete
        if found.is_complete:
            continue
        n_conflicts += len(conflict) > 1
        placeable = world.placeable()
        assert not covers(placeable, conflict)
        assert all(covers(placeable, conflict - {name}) for name in conflict)
    assert n_conflicts > 20


def test_printed_version_is_sound_and_misses_solvable_worlds():
    n_solvable = n_missed = 0
    for world in worlds(is_stacked=False):
        found = try_place_printed(world.possible, world.feasible)
        assert is_sound(world, found.order)
        solvable = covers(world.placeable(), world.possible)
        assert solvable or not found.is_complete
        n_solvable += solvable
        n_missed += solvable and not found.is_complete
    assert n_missed > 0.15 * n_solvable


def test_printed_version_bans_what_failed_only_beside_another():
    # The front first, then the back: the back is banned, though it may come first.
    def feasible(placement, placed):
        return Verdict(placement == "front" or not placed, placed)

    possible = {"front": ["front"], "back": ["back"]}
    assert not try_place_printed(possible, feasible).is_complete
    assert try_place(possible, feasible, LIMITS).order == ("back", "front")


def test_default_asks_less_than_every_order():
    asked = [0, 0]
    for world in worlds(is_stacked=False):
        asked[0] += solve(world).n_feasibility_calls
        asked[1] += plain_calls(world)
    assert asked[0] < asked[1] / 2


def plain_calls(world):
    """How often backtracking over orders and placements asks without any memory."""
    n_calls = 0

    def search(placed):
        nonlocal n_calls
        taken = {name for name, _ in placed}
        left = [name for name in world.possible if name not in taken]
        if not left:
            return True
        for name in left:
            for p in world.possible[name]:
                n_calls += 1
                if world.can(p, placed) and search(placed | {p}):
                    return True
                if n_calls > 2000:
                    return True
        return False

    search(frozenset())
    return n_calls


@pytest.mark.parametrize("is_stacked", [False, True])
def test_most_leaves_out_the_least_of_a_conflict(is_stacked):
    for world in worlds(is_stacked)[:200]:
        worth = {name: -i for i, name in enumerate(world.possible)}
        args = world.possible, world.feasible, LIMITS, worth, world.support
        found, dropped = place_most(*args)
        assert found.is_complete
        assert is_sound(world, found.order)
        placed = {name for name, _ in found.order}
        assert set(world.possible) - set(dropped) <= placed
        placeable = world.placeable()
        for name, conflict in dropped.items():
            assert name == min(conflict, key=lambda name: worth[name])
            assert not covers(placeable, conflict)


@pytest.mark.parametrize("max_calls", [0, 1, 2, 5])
def test_limit_counts_calls(max_calls):
    for world in worlds(is_stacked=False)[:100]:
        limits = Limits(max_calls, max_steps=1000)
        found = try_place(world.possible, world.feasible, limits)
        assert len(world.asked) == found.n_feasibility_calls <= max_calls
        assert is_sound(world, found.order)
        assert found.is_complete or found.has_hit_limit or found.conflict


def test_limit_counts_steps():
    world = World(0, n_objects=5)
    found = try_place(world.possible, world.feasible, Limits(1000, max_steps=1))
    assert found.has_hit_limit
    assert not found.is_complete


def test_best_candidates_are_taken_where_all_are_free():
    possible = {name: [(name, k) for k in range(3)] for name in "abc"}
    found = try_place(possible, lambda p, placed: Verdict(True), LIMITS)
    assert sorted(found.order) == [("a", 0), ("b", 0), ("c", 0)]
    assert found.n_feasibility_calls == 3


def test_what_is_below_comes_first_though_its_object_is_not_wanted():
    possible = {"book": [("book", 0)], "mug": [("mug", 0), ("mug", 1)]}
    support = {("mug", 0): ("book", 0)}
    free = [("book", 0), ("mug", 0)]
    found = try_place(possible, lambda p, _: Verdict(p in free), LIMITS, support)
    assert found.order == tuple(free)


def test_an_object_without_candidates_is_a_conflict_of_its_own():
    found = try_place({"a": [0], "b": []}, lambda p, placed: Verdict(True), LIMITS)
    assert found.conflict == {"b"}


def test_minimal_conflict_against_every_subset():
    rng = np.random.default_rng(0)
    names = list("abcde")
    subsets = [
        frozenset(n for n, k in zip(names, pick, strict=True) if k)
        for pick in product([0, 1], repeat=5)
    ]
    for _ in range(200):
        bad = [subsets[i] for i in rng.integers(1, 32, 3)]

        def core(wanted, bad=bad):
            inside = [b for b in bad if b <= set(wanted)]
            return frozenset(wanted) if inside else None

        found = minimal_conflict(names, core)
        assert found in [b for b in bad if not any(c < b for c in bad)]

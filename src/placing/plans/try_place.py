"""The order in which a robot places objects, and where (Algorithm 1).

`try_place_printed` is the listing of the paper to the letter. `try_place` finds an
order wherever one exists and otherwise names the objects in conflict. Neither knows a
robot: `feasible` says whether one more placement can be carried out.

    DIFFERS: line 9 of the listing adds {O_i} to the infeasible plans, which bans a
    placement for ever that failed only beside what was there; and an unordered plan
    P and O_i forgets that O_i may come first. The default remembers "O_i cannot be
    put once C, a part of P, is there" instead.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Generic

from placing.plans.conflict_search import ConflictSearch, Dead
from placing.plans.conflicts import minimal_conflict
from placing.plans.placing_order import LimitReached, Ordering, P, Verdict

Feasible = Callable[[P, frozenset[P]], Verdict[P]]
NOTHING_BELOW: Mapping = MappingProxyType({})


def never(one: object, other: object) -> bool:
    """Return that two placements do not exclude each other."""
    return False


@dataclass(frozen=True)
class Limits:
    """How long a search may take; the values live in `config/config.yaml`."""

    max_calls: int
    """How often feasibility is asked."""
    max_steps: int
    """How often one more object is given a place."""


@dataclass(frozen=True)
class Found(Generic[P]):
    """What a search found."""

    order: tuple[P, ...]
    """Placements in an order whose every step is feasible; the longest that was seen
    where not all objects are placed."""
    n_feasibility_calls: int
    is_complete: bool
    """Whether all objects are placed."""
    has_hit_limit: bool
    """Whether the search ended early; without, no answer means that there is none."""
    conflict: frozenset[str]
    """Objects that cannot all be placed; minimal if no limit was hit."""


def try_place_printed(
    possible: Mapping[str, Sequence[P]], feasible: Feasible[P]
) -> Found[P]:
    """Return what Algorithm 1 finds as it is printed."""
    infeasible: set[frozenset[P]] = set()
    n_calls = 0

    def search(placed: tuple[P, ...], left: tuple[str, ...]) -> tuple[P, ...] | None:
        nonlocal n_calls
        if not left:
            return placed
        for i in left:
            for placement in possible[i]:
                plan = frozenset([*placed, placement])
                if any(plan >= known for known in infeasible):
                    continue
                n_calls += 1
                if feasible(placement, frozenset(placed)).is_feasible:
                    others = tuple(name for name in left if name != i)
                    if (found := search((*placed, placement), others)) is not None:
                        return found
                infeasible.add(frozenset({placement}))
        return None

    order = search((), tuple(possible))
    return Found(order or (), n_calls, order is not None, False, frozenset())


def try_place(
    possible: Mapping[str, Sequence[P]],
    feasible: Feasible[P],
    limits: Limits,
    support: Mapping[P, P] = NOTHING_BELOW,
    exclusive: Callable[[P, P], bool] = never,
) -> Found[P]:
    """Return an order that places every object, or the objects in conflict.

    `possible` holds the placements of each object, best first, and `support` the
    placement that another stands on, itself among the possible ones; `exclusive` may
    tell without asking the robot that two placements cannot both be.
    """
    args = possible, feasible, limits, support, exclusive
    return _Placing(*args).place(tuple(possible))


def place_most(
    possible: Mapping[str, Sequence[P]],
    feasible: Feasible[P],
    limits: Limits,
    worth: Mapping[str, float],
    support: Mapping[P, P] = NOTHING_BELOW,
    exclusive: Callable[[P, P], bool] = never,
) -> tuple[Found[P], dict[str, frozenset[str]]]:
    """Return an order of what can be placed, and the conflict of each object left out.

    Of objects in conflict the one of least worth is left out. An object that was left
    out may still be placed where another one stands on it. Where a limit is hit, the
    longest order that was seen is made longer as far as it goes.
    """
    # ASSUME: the paper does not say what happens when not everything can be placed.
    placing = _Placing(possible, feasible, limits, support, exclusive)
    left, dropped = tuple(possible), {}
    while True:
        found = placing.place(left)
        if found.has_hit_limit:
            names = sorted(left, key=lambda name: -worth[name])
            return placing.lengthened(found.order, names), dropped
        if found.is_complete:
            return found, dropped
        least = min(sorted(found.conflict), key=lambda name: worth[name])
        dropped[least] = found.conflict
        left = tuple(name for name in left if name != least)


class _Placing(Generic[P]):
    """A search for several sets of objects among the same candidates."""

    def __init__(
        self,
        possible: Mapping[str, Sequence[P]],
        feasible: Feasible[P],
        limits: Limits,
        support: Mapping[P, P],
        exclusive: Callable[[P, P], bool],
    ) -> None:
        """Take what `try_place` is given."""
        self._possible, self._limits = possible, limits
        self._ordering = Ordering(feasible, support, limits.max_calls)
        args = possible, self._ordering, exclusive, limits.max_steps
        self._search = ConflictSearch(*args)

    def place(self, wanted: tuple[str, ...]) -> Found[P]:
        """Return an order that places the wanted objects, or those in conflict."""
        try:
            found = self._search.solve(wanted)
        except LimitReached:
            order = self._search.longest
            return self._found(order, is_complete=False, has_hit_limit=True)
        if not isinstance(found, Dead):
            return self._found(found, is_complete=True)
        order, conflict = self._search.longest, sorted(found.objects)
        try:
            smallest = minimal_conflict(conflict, self._core)
        except LimitReached:
            core = frozenset(conflict)
            return self._found(order, is_complete=False, has_hit_limit=True, core=core)
        return self._found(order, is_complete=False, core=smallest)

    def lengthened(self, order: tuple[P, ...], wanted: Sequence[str]) -> Found[P]:
        """Return an order with as many more of the wanted objects as can come last.

        As many calls as before are allowed once more.
        """
        self._ordering.allow(self._limits.max_calls)
        for name in wanted:
            for candidate in self._possible[name]:
                if self._search.ruled_out(candidate, order) is not None:
                    continue
                try:
                    longer = self._ordering.extended(order, candidate)
                except LimitReached:
                    return self._found(order, is_complete=False, has_hit_limit=True)
                if longer is not None:
                    order = longer
                    break
        return self._found(order, is_complete=False, has_hit_limit=True)

    def _core(self, wanted: Sequence[str]) -> frozenset[str] | None:
        """Return objects that cannot all be placed; None if all wanted ones can."""
        found = self._search.solve(wanted)
        return found.objects if isinstance(found, Dead) else None

    def _found(
        self,
        order: tuple[P, ...],
        *,
        is_complete: bool,
        has_hit_limit: bool = False,
        core: frozenset[str] = frozenset(),
    ) -> Found[P]:
        """Return what was found so far."""
        n_calls = self._ordering.n_calls
        return Found(order, n_calls, is_complete, has_hit_limit, core)

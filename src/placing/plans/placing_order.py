"""Orders in which given placements can be carried out, asked for as rarely as possible.

What is learned is "placement O cannot be put once the placements C are there". More
objects never make a placement easier, save for what it stands on, which must be there
first: so whatever can be put when all the others are there may as well come last. An
order is built from its end by that rule, then asked step by step; a step that fails
teaches one more C, and the next order respects it.

    DIFFERS: Algorithm 1 tries orders one after the other. This finds one without
    going back wherever one exists, and asks each (O, P) at most once.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

P = TypeVar("P", bound=Hashable)


@dataclass(frozen=True)
class Verdict(Generic[P]):
    """Whether a placement can be put when others are there."""

    is_feasible: bool
    blockers: frozenset[P] = frozenset()
    """Those that are to blame, a subset of what is there; empty: it never can be."""


class LimitReached(Exception):
    """Feasibility was asked as often as allowed, or the search took as many steps."""


class Ordering(Generic[P]):
    """What is known about which placements stand in each other's way."""

    def __init__(
        self,
        feasible: Callable[[P, frozenset[P]], Verdict[P]],
        support: Mapping[P, P],
        max_calls: int,
    ) -> None:
        """Know nothing; `support` maps a placement to the one it stands on."""
        self.n_calls = 0
        self._feasible, self._support, self._max_calls = feasible, support, max_calls
        self._blocked: dict[P, list[frozenset[P]]] = {}
        self._fine: set[tuple[P, frozenset[P]]] = set()

    def chain(self, placement: P) -> tuple[P, ...]:
        """Return a placement after all that it stands on, lowest first."""
        below = self._support.get(placement)
        return (*self.chain(below), placement) if below is not None else (placement,)

    def is_hopeless(self, placement: P) -> bool:
        """Return whether a placement is known to be infeasible when it is alone."""
        return frozenset() in self._blocked.get(placement, [])

    def find(self, chosen: Sequence[P]) -> tuple[P, ...] | frozenset[P]:
        """Return an order of the chosen placements, or some that exclude each other.

        Placements keep the order of `chosen` where nothing speaks against it; what
        each stands on is among them.
        """
        while True:
            order = self._consistent(chosen)
            if isinstance(order, frozenset) or self._is_carried_out(order):
                return order

    def _is_carried_out(self, order: tuple[P, ...]) -> bool:
        """Return whether every step is feasible; learn from the first that is not."""
        for n, placement in enumerate(order):
            placed = frozenset(order[:n])
            if not self._is_feasible(placement, placed):
                return False
        return True

    def _is_feasible(self, placement: P, placed: frozenset[P]) -> bool:
        """Return whether a step is feasible, asked only if it is not known."""
        if (placement, placed) in self._fine:
            return True
        known = self._blocked.setdefault(placement, [])
        if any(blockers <= placed for blockers in known):
            return False
        if self.n_calls >= self._max_calls:
            raise LimitReached
        self.n_calls += 1
        verdict = self._feasible(placement, placed)
        if verdict.is_feasible:
            self._fine.add((placement, placed))
        else:
            known.append(verdict.blockers & placed)
        return verdict.is_feasible

    def extended(self, order: tuple[P, ...], placement: P) -> tuple[P, ...] | None:
        """Return a feasible order with one placement more at its end, if it can be."""
        longer = order
        for step in self.chain(placement):
            if step not in longer:
                if not self._is_feasible(step, frozenset(longer)):
                    return None
                longer = (*longer, step)
        return longer

    def allow(self, max_calls: int) -> None:
        """Allow so many calls from now on."""
        self._max_calls = self.n_calls + max_calls

    def _consistent(self, chosen: Sequence[P]) -> tuple[P, ...] | frozenset[P]:
        """Return an order that respects what is known, from its end to its start."""
        left, end = list(chosen), []
        while left:
            last = next((p for p in reversed(left) if not self._blame(p, left)), None)
            if last is None:
                return self._smallest_circle(left)
            left.remove(last)
            end.append(last)
        return tuple(reversed(end))

    def _blame(self, placement: P, left: Sequence[P]) -> list[frozenset[P]]:
        """Return the known reasons why a placement is not the last of those left."""
        others = frozenset(left) - {placement}
        found = [c for c in self._blocked.get(placement, []) if c <= others]
        above = (p for p in left if self._support.get(p) == placement)
        return found + [frozenset({p}) for p in above]

    def _smallest_circle(self, left: Sequence[P]) -> frozenset[P]:
        """Return few placements of which none can be last, so no order has them all."""
        blame = {p: min(self._blame(p, left), key=len) for p in left}
        circles = []
        for start in left:
            circle, todo = {start}, [start]
            while todo:
                new = blame[todo.pop()] - circle
                circle |= new
                todo += new
            circles.append(frozenset(circle))
        return min(circles, key=len)

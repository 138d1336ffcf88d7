"""Search for a placement of every object by conflicts: the engine of `try_place`.

The object with fewest candidates left is placed next, at its best candidate first. A
dead end names the placements that led to it and the objects that cannot all be placed
beside them; the search jumps back to the last choice that is among them, and never
makes the same mistake twice.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic

from placing.plans.placing_order import LimitReached, Ordering, P


@dataclass(frozen=True)
class Dead(Generic[P]):
    """Placements beside which objects cannot all be placed."""

    placements: frozenset[P]
    objects: frozenset[str]
    """Empty: the placements exclude each other."""


class ConflictSearch(Generic[P]):
    """A search that keeps what it has learned from one set of objects to the next."""

    def __init__(
        self,
        possible: Mapping[str, Sequence[P]],
        ordering: Ordering[P],
        exclusive: Callable[[P, P], bool],
        max_steps: int,
    ) -> None:
        """Take the candidates of each object, best first, and who orders them.

        `exclusive` tells of two placements that cannot both be, whatever the order.
        """
        self.longest: tuple[P, ...] = ()
        """The longest order seen so far."""
        self._possible, self._ordering = possible, ordering
        self._exclusive = exclusive
        self._object_of = {p: name for name, ps in possible.items() for p in ps}
        self._dead: dict[P, list[Dead[P]]] = {}
        self._n_steps, self._max_steps = 0, max_steps
        self._wanted: tuple[str, ...] = ()

    def solve(self, wanted: Sequence[str]) -> tuple[P, ...] | Dead[P]:
        """Return an order that places all wanted objects, or why there is none.

        An object that is not wanted is placed only where a wanted one stands on it.
        """
        self._wanted = tuple(wanted)
        return self._extend(())

    def _extend(self, order: tuple[P, ...]) -> tuple[P, ...] | Dead[P]:
        """Return an order with the placements of `order` and all wanted objects."""
        self._n_steps += 1
        if self._n_steps > self._max_steps:
            raise LimitReached
        placed = {self._object_of[p] for p in order}
        left = [name for name in self._wanted if name not in placed]
        if len(order) > len(self.longest):
            self.longest = order
        if not left:
            return order
        name, known = self._tightest(left, order)
        culprits: set[P] = set()
        objects = {name}
        for candidate, dead in zip(self._possible[name], known, strict=True):
            new = [p for p in self._ordering.chain(candidate) if p not in order]
            found = dead or self._with(order, new)
            if not isinstance(found, Dead):
                return found
            if found.placements.isdisjoint(new):
                return found
            culprits |= found.placements.difference(new)
            objects |= found.objects
        return self._learned(Dead(frozenset(culprits), frozenset(objects)))

    def _with(self, order: tuple[P, ...], new: list[P]) -> tuple[P, ...] | Dead[P]:
        """Return an order with new placements too and all wanted objects."""
        found = self._ordering.find([*order, *new])
        if isinstance(found, frozenset):
            return self._learned(Dead(found, frozenset()))
        return self._extend(found)

    def _tightest(
        self, left: Sequence[str], order: tuple[P, ...]
    ) -> tuple[str, list[Dead[P] | None]]:
        """Return the object with fewest candidates left, and what rules out others."""
        known = {
            name: [self.ruled_out(p, order) for p in self._possible[name]]
            for name in left
        }
        name = min(left, key=lambda name: known[name].count(None))
        return name, known[name]

    def ruled_out(self, candidate: P, order: tuple[P, ...]) -> Dead[P] | None:
        """Return what is known to rule out a candidate beside the placements chosen."""
        chain = self._ordering.chain(candidate)
        together = frozenset([*order, *chain])
        for placement in chain:
            if self._ordering.is_hopeless(placement):
                return Dead(frozenset({placement}), frozenset())
            for other in order:
                if placement != other and self._is_either_or(placement, other):
                    return Dead(frozenset({placement, other}), frozenset())
            for dead in self._dead.get(placement, []):
                applies = dead.objects.issubset(self._wanted)
                if applies and dead.placements <= together:
                    return dead
        return None

    def _is_either_or(self, one: P, other: P) -> bool:
        """Return whether two placements are of one object or exclude each other."""
        is_same = self._object_of[one] == self._object_of[other]
        return is_same or self._exclusive(one, other)

    def _learned(self, dead: Dead[P]) -> Dead[P]:
        """Return a dead end after remembering it."""
        for placement in dead.placements:
            self._dead.setdefault(placement, []).append(dead)
        return dead

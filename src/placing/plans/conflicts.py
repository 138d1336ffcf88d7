"""The smallest sets of objects that cannot all be placed."""

from collections.abc import Callable, Sequence


def minimal_conflict(
    objects: Sequence[str],
    core: Callable[[Sequence[str]], frozenset[str] | None],
) -> frozenset[str]:
    """Return objects that cannot all be placed, though they can without any of them.

    `objects` cannot all be placed; `core` returns None where all objects it is given
    can be placed, and otherwise some of them that cannot.
    """
    left, is_needed = list(objects), set()
    while candidates := [name for name in left if name not in is_needed]:
        without = [name for name in left if name != candidates[0]]
        found = core(without)
        if found is None:
            is_needed.add(candidates[0])
        else:
            left = [name for name in left if name in found]
    return frozenset(left)

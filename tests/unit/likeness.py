"""How much two rooms look alike, whichever way they are turned or mirrored."""

from collections import Counter

import numpy as np

from placing.scene import Array, Layout

CELL_M = 0.6


def likeness(a: Layout, b: Layout) -> float:
    """Return the share of furniture that is alike in two rooms, turned or mirrored."""
    larger = max(len(a.furniture), len(b.furniture))
    plan_b = signature(b, np.eye(2))
    return max(
        sum((signature(a, turn) & plan_b).values()) / larger for turn in symmetries()
    )


def symmetries() -> list[Array]:
    """Return the turns and mirror images of the floor by right angles, each (2, 2)."""
    turn, mirror = np.array([[0.0, -1.0], [1.0, 0.0]]), np.diag([1.0, -1.0])
    turns = [np.linalg.matrix_power(turn, n) for n in range(4)]
    return [*turns, *(t @ mirror for t in turns)]


def signature(layout: Layout, turn: Array) -> Counter:
    """Return how often each kind of furniture stands in each cell about the middle."""
    low, high = layout.outline_m.min(0), layout.outline_m.max(0)
    places = [p.T_world_furniture[4:6] - (low + high) / 2 for p in layout.furniture]
    cells = np.round(np.array(places) @ turn.T / CELL_M).astype(int)
    kinds = [piece.kind for piece in layout.furniture]
    return Counter(zip(kinds, *cells.T.tolist(), strict=True))

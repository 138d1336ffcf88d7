"""The options of an object in the joint placement, and which of them are kept.

Shapes: o options of one object.
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Options:
    """Where one object may stand, each with a log score; all arrays of one length."""

    location: Array
    """(o, 3) centre of the object's box in the world [m]."""
    size: Array
    """(o, 3) of the box in the frame of the heading [m]."""
    yaw: Array
    """(o,) heading of the box [rad]."""
    area: NDArray[np.int32]
    """(o,) index of the placing area."""
    place: NDArray[np.int32]
    """(o,) index of the place; what stands at one place shares a stack."""
    clearance_m: Array
    """(o,) free height above the area, for this object and what is below it."""
    log_score: Array
    """(o,) log Psi of the context; an option of score -inf is none."""

    @property
    def boxes(self) -> Array:
        """Centre, size and yaw, shape (o, 7)."""
        return np.column_stack([self.location, self.size, self.yaw])

    @property
    def is_usable(self) -> NDArray[np.bool_]:
        """Return which options have a score and enough free height, shape (o,)."""
        return np.isfinite(self.log_score) & (self.size[:, 2] <= self.clearance_m)

    def only(self, kept: NDArray) -> "Options":
        """Return some of the options: an index or a mask, shape (o,)."""
        return Options(*(getattr(self, field.name)[kept] for field in fields(self)))


def thin_options(options: Options, n_best: int, n_spread: int) -> NDArray[np.int64]:
    """Return the indices of the options worth a variable, in falling score.

    The best ones are where all want to stand. Spread ones keep the program feasible:
    over all places, each the best of what is farther from those already kept than an
    object is wide, then half of that, and so on until there are enough.
    """
    order = np.argsort(-options.log_score, kind="stable")
    order = order[options.is_usable[order]]
    if len(order) <= n_best + n_spread:
        return order
    is_kept = np.zeros(len(options.yaw), np.bool_)
    is_kept[order[:n_best]] = True
    spread = spread_out(options, order[n_best:], order[:n_best], n_spread)
    is_kept[spread] = True
    return order[is_kept[order]]


def spread_out(
    options: Options, order: NDArray[np.int64], kept: NDArray[np.int64], n: int
) -> NDArray[np.int64]:
    """Return `n` of the options in `order` that keep a distance, (n,)."""
    distance = 2 * float(options.size[:, :2].max())
    nearest = _distances(options, order, kept)  # (o,)
    chosen: list[int] = []
    while len(chosen) < n:
        far = np.flatnonzero(nearest >= distance)
        if len(far) == 0:
            # Headings at a place that is kept already come last.
            distance = distance / 2 if distance > 1e-3 else -1.0
            continue
        first = far[0]
        chosen.append(int(order[first]))
        nearest = np.minimum(nearest, _distances(options, order, order[[first]]))
        nearest[first] = -2.0
    return np.array(chosen, np.int64)


def _distances(
    options: Options, at: NDArray[np.int64], kept: NDArray[np.int64]
) -> Array:
    """Return the distance of options to the nearest of those kept, (o,) [m]."""
    if len(kept) == 0:
        return np.full(len(at), np.inf)
    offset = options.location[at][:, None] - options.location[kept][None]
    return np.linalg.norm(offset, axis=2).min(1)

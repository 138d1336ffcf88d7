"""Human poses of a scene: kind, place and heading, and the prior P0 over them.

Shapes: q poses.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing.people import skeleton

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HumanPoses:
    """The valid human poses of a scene; those that follow each other are near."""

    kind: NDArray[np.uint8]
    """(q,) index into `skeleton.KINDS`."""
    location: Array
    """(q, 3) origin of the pose: a point of the floor or of a seat."""
    yaw: Array
    """(q,) where the person looks."""
    prior: Array
    """(q,) P0 of each pose; sums to 1."""

    def references(self) -> Array:
        """Return where each person is and looks, shape (q, 5).

        x, y, z of the reference point, and cosine and sine of the yaw, since the
        potential needs no angle.
        """
        offsets = np.array([skeleton.reference_m(kind) for kind in skeleton.KINDS])
        z = self.location[:, 2] + offsets[self.kind]
        look = [np.cos(self.yaw), np.sin(self.yaw)]
        return np.column_stack([self.location[:, :2], z, *look])


def headings(n_headings: int) -> Array:
    """Return the headings that poses and placements may take, shape (n_headings,)."""
    return np.linspace(0, 2 * np.pi, n_headings, endpoint=False)


def prior_of(kind: NDArray[np.uint8]) -> Array:
    """Return P0 of valid poses by their kinds, shape (q,), sum 1."""
    # ASSUME: every kind that a scene allows is as likely as another, and all its poses
    # are alike; otherwise the lattice and the free floor would decide how often people
    # sit, and there is a hundred times more floor than seat.
    _, which, count = np.unique(kind, return_inverse=True, return_counts=True)
    return 1 / (len(count) * count[which]) if len(kind) else np.empty(0)

"""A search for a motion to a place, and how far it has come.

Letters: b base poses, a joints of the arm.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.distance_field import Mask
from placing.robot.grasps import Grasp
from placing.robot.hands import Hands
from placing.robot.paths import Query
from placing.robot.planning import NO_PLACE, REASONS


@dataclass
class Search:
    """One search for a motion, and how far it has come."""

    is_putting: bool
    T_world_object: Array
    """(7,) where the object stands when it is not held."""
    bases: Array
    """Where the robot can stand while nothing else stands there, (b, 3)."""
    stands: Mask
    """At which of these it can stand now, (b,)."""
    grasps: Sequence[tuple[Grasp, Held]]
    without: SceneChecker
    """Knows what stands there but the object."""
    among: SceneChecker
    """Knows the object as well."""
    hands: Hands
    start: Array | None
    """Where the robot waits, by default where the floor is most open."""
    query: Query
    n_paths: int
    """Paths that may still be sought."""
    reason: str = NO_PLACE
    n_free: int = 0
    """Goals found free."""
    blocked: list[frozenset[int]] = field(default_factory=list)
    """Numbers of the boxes that each goal hits which is free without them."""

    @property
    def alone(self) -> SceneChecker:
        """Knows only what always stands there."""
        return self.hands.alone

    def reached(self, reason: str) -> None:
        """Remember the reason if the search came as far as that."""
        if REASONS.index(reason) > REASONS.index(self.reason):
            self.reason = reason

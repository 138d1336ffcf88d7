"""What a planned motion is: segments of a path, or the reason why there is none.

Light: what only reads motions needs no planner and no simulator.
"""

from dataclasses import dataclass

from placing.rigid import Array

TOO_WIDE = "too wide to grasp"
NO_PLACE = "no standing place"
NO_ARM = "no arm solution"
GOAL_HIT = "goal in collision"
NO_PATH = "no path"
REJECTED = "rejected by the exact check"
FALLS = "falls"
REASONS = (TOO_WIDE, NO_PLACE, NO_ARM, GOAL_HIT, NO_PATH, REJECTED, FALLS)
"""Why the robot does not put an object somewhere, in the order they are found."""

PUTTING = ("drive", "raise", "reach", "lower", "retreat", "fold")
PICKING = ("drive", "raise", "reach", "approach", "lift", "fold")
"""Segments in order; the gripper opens or closes after the fourth."""


@dataclass(frozen=True)
class PlanningConfig:
    """What the planner tries; values: config/config.yaml."""

    floor_cell_m: float
    """Lattice of base poses on the floor."""
    n_headings: int
    turn_m: float
    """Way on the floor that turning by one radian counts as."""
    n_bases: int
    """Base poses tried around an object."""
    n_goals: int
    """Goals of a grasp for which a path is sought."""
    n_paths: int
    """Paths sought for a placement in all, with ways of the base not found."""
    n_checks: int
    """Checks of edges in one query of the path planner."""
    range_rad: float
    """Longest edge of the path planner."""
    tip_m: float
    """Least height of the tool above the bottom of what it takes from above."""
    step_m: float
    """Step of straight lines of the tool."""
    lift_m: float
    """Farthest an object is moved straight down before it touches."""
    retreat_m: tuple[float, float]
    """Least and longest straight way of the hand away from an object."""
    contact_m: float
    """How far a placement may be moved up or down until it touches."""
    blame_m: float
    """What stands farther from a placement is not to blame."""


@dataclass(frozen=True)
class Segment:
    """A part of a motion during which the gripper does not move."""

    name: str
    path: Array
    """(t, 4 + a) configurations joined by straight lines."""
    is_holding: bool
    opening_m: float
    """Distance of the fingers."""


@dataclass(frozen=True)
class Motion:
    """How the robot puts an object somewhere, or picks it up there."""

    object_id: str
    T_world_object: Array
    """(7,) where it stands when the hand is off it."""
    grasp: str
    T_tool_object: Array
    """(7,) where it is in the hand."""
    segments: tuple[Segment, ...]


@dataclass(frozen=True)
class Refusal:
    """Why there is no motion."""

    reason: str
    """One of `REASONS`."""
    blockers: tuple[str, ...]
    """Objects that stand there and are to blame, sorted; none if nothing helps."""

"""How closely the replay of a certificate looks at it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ReplayConfig:
    """How closely a certificate is looked at; values: config/config.yaml."""

    step_m: float
    """Base and torso move no more than this between two looks."""
    step_rad: float
    """No joint turns more than this between two looks."""
    touch_m: float
    """Deeper overlaps are collisions."""
    support_m: float
    """Deepest overlap of an object with what carries it when it is put down."""
    finger_m: float
    """Deepest overlap of the open fingers with the object between them."""
    wheel_m: float
    """Deepest overlap of the wheels with the floor."""
    drop_m: float
    """An object is let go no higher than this above where it ends."""
    max_error_m: float
    """Farthest that an object may be from its place when it is grasped and let go."""
    max_error_deg: float
    joint_rad: float
    """Guards the comparison of two ends of segments that are the same."""

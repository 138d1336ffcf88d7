"""Skeletons of the six kinds of human pose: 15 joints of an adult in the pose's frame.

The origin is on the floor between the feet of the standing kinds and on the seat below
the pelvis of the sitting kinds; x is forward (where the person looks), y left, z up.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placing import rigid
from placing.errors import unknown

Array = NDArray[np.float64]

JOINTS = (
    "head",
    "neck",
    "torso",
    *("left_shoulder", "right_shoulder", "left_elbow", "right_elbow"),
    *("left_hand", "right_hand", "left_hip", "right_hip"),
    *("left_knee", "right_knee", "left_foot", "right_foot"),
)
BONES = (
    *((0, 1), (1, 2), (1, 3), (1, 4), (3, 5), (4, 6), (5, 7), (6, 8)),
    *((2, 9), (2, 10), (9, 11), (10, 12), (11, 13), (12, 14)),
)
"""Pairs of joints; a bone has the same length in every kind."""

# ASSUME: a person of 1.70 m, between the mean heights of adult women and men.
STATURE_M = 1.70
# SOURCE: Drillis & Contini 1966 as in Winter, Biomechanics and Motor Control of Human
# Movement, fig. 4.1, as fractions of stature; the hand joint is the middle of the hand.
UPPER_ARM_M = 0.186 * STATURE_M
FOREARM_M = (0.146 + 0.108 / 2) * STATURE_M
THIGH_M = (0.530 - 0.285) * STATURE_M
SHANK_M = 0.285 * STATURE_M
TRUNK_M = (0.818 - 0.530) * STATURE_M
HEAD_M = (0.936 - 0.818) * STATURE_M
HALF_SHOULDERS_M = 0.259 / 2 * STATURE_M
HALF_HIPS_M = 0.191 / 2 * STATURE_M
# ASSUME: the hip joint of a sitting adult is 7 cm above the seat, so that the soles are
# 0.41 m below it, the usual height of a seat.
HIP_ABOVE_SEAT_M = 0.07

# ASSUME: thinner than a real body by about 2 cm, so that touching a seat, its back or
# the floor is no collision; one radius per joint, linear along a bone.
RADIUS_M = np.array(
    [
        *(0.10, 0.07, 0.12, 0.06, 0.06, 0.045, 0.045, 0.04, 0.04),
        *(0.05, 0.05, 0.05, 0.05, 0.04, 0.04),
    ]
)
SPHERES_PER_BONE = 5
LOWEST_ON_SHANK = 0.85
"""The spheres end at the ankle, so that those of a foot do not reach into the floor."""


@dataclass(frozen=True)
class Posture:
    """Angles of the limbs in the vertical plane the person looks along [deg].

    The trunk and the head count from upright, the limbs from hanging down, all
    positive towards the front.
    """

    is_sitting: bool
    trunk_deg: float
    head_deg: float
    upper_arm_deg: float
    forearm_deg: float
    thigh_deg: float
    shank_deg: float


# ASSUME: the paper names the six kinds and shows pictures; these angles are read from
# them, and `reaching` stands with its hands above the shoulders, as before a shelf.
POSTURES = {
    "sitting_upright": Posture(True, -3, 0, 12, 92, 90, 5),
    "sitting_reclined": Posture(True, -25, -8, -5, 75, 90, 25),
    "sitting_forward": Posture(True, 22, 15, 58, 88, 88, -8),
    "reaching": Posture(False, 5, -5, 105, 125, 0, 0),
    "standing": Posture(False, 0, 0, 8, 70, 0, 0),
    "leaning_forward": Posture(False, 42, 35, 45, 70, 10, 10),
}
KINDS = tuple(POSTURES)
SITTING = tuple(kind for kind in KINDS if POSTURES[kind].is_sitting)
"""The kinds whose origin is on a seat; that of the others is on the floor."""


def joints(kind: str) -> Array:
    """Return the 15 joints of a kind in the pose's frame, shape (15, 3) [m]."""
    if kind not in POSTURES:
        raise unknown("kind of human pose", kind, list(KINDS))
    posture = POSTURES[kind]
    leg = THIGH_M * _down(posture.thigh_deg) + SHANK_M * _down(posture.shank_deg)
    hip = np.array([0, 0, HIP_ABOVE_SEAT_M]) if posture.is_sitting else -leg
    knee = hip + THIGH_M * _down(posture.thigh_deg)
    neck = hip - TRUNK_M * _down(-posture.trunk_deg)
    head = neck - HEAD_M * _down(-posture.head_deg)
    elbow = neck + UPPER_ARM_M * _down(posture.upper_arm_deg)
    hand = elbow + FOREARM_M * _down(posture.forearm_deg)
    pairs = [
        *(_pair(at, HALF_SHOULDERS_M) for at in (neck, elbow, hand)),
        *(_pair(at, HALF_HIPS_M) for at in (hip, knee, hip + leg)),
    ]
    return np.concatenate([[head, neck, (neck + hip) / 2], *pairs])


def _down(angle_deg: float) -> Array:
    """Return the direction turned from straight down towards the front, shape (3,)."""
    angle = np.deg2rad(angle_deg)
    return np.array([np.sin(angle), 0.0, -np.cos(angle)])


def _pair(middle: Array, half_width_m: float) -> Array:
    """Return the left and the right joint beside a middle, shape (2, 3) [m]."""
    return middle + np.array([[0, half_width_m, 0], [0, -half_width_m, 0]])


def reference_m(kind: str) -> float:
    """Return the height of the torso joint above the pose's origin [m].

    It is the height from which the heights of objects are measured.
    """
    # ASSUME: the paper measures from the person without saying from where; the torso
    # joint, the middle between hips and shoulders, is the origin of its skeletons.
    return float(joints(kind)[JOINTS.index("torso"), 2])


def place(kind: str, location: Array, yaw: Array) -> Array:
    """Return the joints of poses of one kind in the world, shape (k, 15, 3) [m].

    `location` (k, 3) is where the pose's origin is, `yaw` (k,) where its x points.
    """
    return rigid.turn_about_z(yaw[:, None], joints(kind)) + location[:, None]


def capsule_samples(kind: str) -> Array:
    """Return spheres that fill the body, x y z radius, shape (71, 4) [m]."""
    solid = np.column_stack([joints(kind), RADIUS_M])  # (15, 4)
    along = np.arange(1, SPHERES_PER_BONE + 1)[:, None] / SPHERES_PER_BONE
    spheres = [solid[:1]]
    for a, b in BONES:
        end = LOWEST_ON_SHANK if JOINTS[b].endswith("foot") else 1.0
        spheres.append(solid[a] + end * along * (solid[b] - solid[a]))
    return np.concatenate(spheres)

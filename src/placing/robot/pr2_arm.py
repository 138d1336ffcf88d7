"""Closed-form inverse of arms shaped like the PR2's: pan free, all other joints solved.

The axes are pan (z), lift (y), roll (x), elbow (y), roll (x), flex (y), roll (x); lift
and roll, elbow and roll, flex and roll meet in one point each. For a given pan the
distance from shoulder to wrist gives the elbow, the wrist's position lift and roll, and
the tool's rotation the last three: up to 4 solutions within one turn of each joint.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.robot.kernels import Tree, inner

Array = NDArray[np.float64]

AXES = "zyxyxyx"
"""Axes of the joints from shoulder to wrist."""
STRAIGHT = 1e-9
"""Guards divisions where the arm is stretched or the wrist straight."""
N_MOST = 16
"""Solutions of one pan: two elbows, two rolls with a turn each, two wrists."""


class Pr2Arm(NamedTuple):
    """Dimensions of the arm, from its description."""

    shoulder_m: Array
    """Axis of the pan in the frame of the torso, (3,)."""
    offset_m: float
    """From the axis of the pan to the shoulder."""
    upper_m: float
    """From shoulder to elbow."""
    fore_m: float
    """From elbow to wrist."""
    lower: Array
    upper: Array
    """Limits of the joints, (7,)."""


def pr2_arm(tree: Tree, lower: Array, upper: Array) -> Pr2Arm | None:
    """Return the dimensions of an arm of that shape, or nothing for any other."""
    fixed, axes = tree.T_parent_joint[2:], tree.axis[2:]
    if len(fixed) != len(AXES) or not tree.is_turning[2:].all():
        return None
    wanted = np.array([np.eye(3)["xyz".index(axis)] for axis in AXES])
    at = fixed[:, :, 3]
    lengths = np.zeros((6, 3))
    lengths[[0, 2, 4], 0] = at[[1, 3, 5], 0]
    is_aligned = np.allclose(axes, wanted, atol=1e-9)
    is_square = np.allclose(fixed[:, :, :3], np.eye(3), atol=1e-9)
    if not (is_aligned and is_square and np.allclose(at[1:], lengths, atol=1e-9)):
        return None
    offset, upper_arm, forearm = lengths[[0, 2, 4], 0].tolist()
    limits = lower[4:].copy(), upper[4:].copy()
    return Pr2Arm(at[0].copy(), offset, upper_arm, forearm, *limits)


@njit(cache=True)
def solve(arm: Pr2Arm, T_torso_wrist: Array, pans: Array, out: Array) -> int:
    """Write the solutions of all pans into `out` (k, 7) and return their number."""
    k, M = 0, np.empty((3, 3))
    for pan in pans:
        if arm.lower[0] <= pan <= arm.upper[0]:
            k = _solve_pan(arm, T_torso_wrist, pan, M, out, k)
    return k


@njit(cache=True)
def solve_many(
    arm: Pr2Arm,
    Ts_torso_wrist: Array,
    pans: Array,
    out: Array,
    which: NDArray[np.int64],
) -> int:
    """Write the solutions of many poses (n, 3, 4) and whose they are; return how many.

    Poses whose solutions might not fit into `out` (k, 7) are left out.
    """
    k, M = 0, np.empty((3, 3))
    for i in range(len(Ts_torso_wrist)):
        if k + N_MOST * len(pans) > len(out):
            break
        first = k
        for pan in pans:
            if arm.lower[0] <= pan <= arm.upper[0]:
                k = _solve_pan(arm, Ts_torso_wrist[i], pan, M, out, k)
        which[first:k] = i
    return k


@njit(cache=True)
def follow_line(
    arm: Pr2Arm,
    Ts_torso_wrist: Array,
    start: Array,
    steps: Array,
    max_step: float,
    out: Array,
) -> int:
    """Write the nearest solutions along a line of poses (t, 3, 4) into `out` (t, 7).

    The first is the one nearest to `start` (7,); joints without limits go on turning.
    Returned is how many poses are reached before a joint would turn more than
    `max_step`; `steps` are the changes of the pan that are tried.
    """
    some, M = np.empty((N_MOST, 7)), np.empty((3, 3))
    last, best, near = start.copy(), np.empty(7), np.empty(7)
    for i in range(len(Ts_torso_wrist)):
        least = np.inf
        for step in steps:
            if abs(step) > least:
                continue
            pan = last[0] + step
            if not arm.lower[0] <= pan <= arm.upper[0]:
                continue
            n = _solve_pan(arm, Ts_torso_wrist[i], pan, M, some, 0)
            for k in range(n):
                turned = 0.0
                for j in range(7):
                    angle = some[k, j] - last[j]
                    if np.isinf(arm.upper[j]):
                        angle -= 2 * np.pi * np.round(angle / (2 * np.pi))
                    near[j] = last[j] + angle
                    turned = max(turned, abs(angle))
                if turned < least:
                    least = turned
                    best[:] = near
        if least > max_step:
            return i
        out[i] = best
        last[:] = best
    return len(Ts_torso_wrist)


@inner
def _solve_pan(arm: Pr2Arm, T: Array, pan: float, M: Array, out: Array, k: int) -> int:
    """Add the solutions of one pan from row k on and return the next free row.

    `M` (3, 3) is written over.
    """
    c, s = np.cos(pan), np.sin(pan)
    x = T[0, 3] - arm.shoulder_m[0] - c * arm.offset_m
    y = T[1, 3] - arm.shoulder_m[1] - s * arm.offset_m
    vx, vy, vz = c * x + s * y, c * y - s * x, T[2, 3] - arm.shoulder_m[2]
    a, b = arm.upper_m, arm.fore_m
    bend = (vx * vx + vy * vy + vz * vz - a * a - b * b) / (2 * a * b)
    if abs(bend) > 1.0:
        return k
    for side in range(2):
        elbow = np.arccos(bend) * (1 - 2 * side)
        ux, uz = a + b * np.cos(elbow), -b * np.sin(elbow)
        if not arm.lower[3] <= elbow <= arm.upper[3] or abs(uz) < STRAIGHT:
            continue
        if abs(vy) > abs(uz):
            continue
        for turn in range(2):
            roll = np.arcsin(-vy / uz)
            if turn == 1:
                roll = np.pi - roll
            w = uz * np.cos(roll)
            lift = np.arctan2(vx * w - vz * ux, vx * ux + vz * w)
            if arm.lower[1] <= lift <= arm.upper[1]:
                k = _solve_wrist(arm, T, (pan, lift, roll, elbow), M, out, k)
    return k


@inner
def _solve_wrist(
    arm: Pr2Arm,
    T: Array,
    first: tuple[float, float, float, float],
    M: Array,
    out: Array,
    k: int,
) -> int:
    """Add the solutions of one position of the elbow and return the next free row."""
    _turn_back(T, first, M)
    sine = np.sqrt(M[0, 1] ** 2 + M[0, 2] ** 2)
    for side in range(2):
        sign = 1.0 - 2.0 * side
        flex = np.arctan2(sign * sine, M[0, 0])
        if not arm.lower[5] <= flex <= arm.upper[5] or sine < STRAIGHT:
            continue
        forearm = np.arctan2(sign * M[1, 0], -sign * M[2, 0])
        wrist = np.arctan2(sign * M[0, 1], sign * M[0, 2])
        for n_turns in range(-1, 2):
            roll = first[2] + 2 * np.pi * n_turns
            if not arm.lower[2] <= roll <= arm.upper[2] or k >= len(out):
                continue
            out[k, 0], out[k, 1], out[k, 2], out[k, 3] = (
                first[0],
                first[1],
                roll,
                first[3],
            )
            out[k, 4], out[k, 5], out[k, 6] = forearm, flex, wrist
            k += 1
    return k


@inner
def _turn_back(T: Array, first: tuple[float, float, float, float], M: Array) -> None:
    """Write the rotation that pan, lift, roll and elbow leave to the wrist, (3, 3)."""
    for i in range(3):
        for j in range(3):
            M[i, j] = T[i, j]
    _about(M, 0, 1, -first[0])
    _about(M, 2, 0, -first[1])
    _about(M, 1, 2, -first[2])
    _about(M, 2, 0, -first[3])


@inner
def _about(M: Array, i: int, j: int, angle: float) -> None:
    """Turn the rows of a matrix in the plane from axis i to axis j [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    for col in range(3):
        a, b = M[i, col], M[j, col]
        M[i, col], M[j, col] = c * a - s * b, s * a + c * b

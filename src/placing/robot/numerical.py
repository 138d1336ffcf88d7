"""Inverse of any arm by damped least squares from fixed starts, in a fixed order.

Each start follows the pseudo-inverse of the arm's Jacobian, damped where the arm is
singular, with joints kept inside their limits (Nakamura and Hanafusa 1986). Starts are
points of a Halton sequence; both starts and steps are counted, never timed.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing.robot.halton import halton
from placing.robot.model import RobotModel

Array = NDArray[np.float64]

N_STEPS = 25
"""Steps of one start: those that converge do so in about 15."""
DAMPING = 1e-3
"""Least damping, added to squared lengths of rows of the Jacobian [m2, rad2]."""
MOST_RAD = 0.5
"""A step turns no joint more, as the Jacobian holds for small turns only."""
CLOSE_M, CLOSE_RAD = 1e-6, 1e-5
"""A start has converged when the tool is this close."""
SAME_RAD = 0.05
"""Solutions whose joints all differ less count once."""


def solutions(model: RobotModel, T_torso_wrist: Array, n_starts: int) -> Array:
    """Return the different solutions of n starts, (k, a) [rad]."""
    low, high = _limits(model)
    starts = low + halton(n_starts, len(low)) * (high - low)
    found = _solve(model, T_torso_wrist, starts)
    kept: list[Array] = []
    for arm in found:
        if all(np.max(np.abs(arm - other)) > SAME_RAD for other in kept):
            kept.append(arm)
    return np.array(kept).reshape(-1, len(low))


def solutions_near(model: RobotModel, T_torso_wrist: Array, arm: Array) -> Array:
    """Return the solution that continues from `arm`, (0 or 1, a) [rad]."""
    return _solve(model, T_torso_wrist, arm[None])


def _limits(model: RobotModel) -> tuple[Array, Array]:
    """Return limits of the joints, one turn for those that have none, (a,) each."""
    low, high = model.lower[4:], model.upper[4:]
    return np.where(np.isinf(low), -np.pi, low), np.where(np.isinf(high), np.pi, high)


def _solve(model: RobotModel, T_torso_wrist: Array, starts: Array) -> Array:
    """Return what the starts converge to, in their order, (k, a)."""
    fixed, axes = model.tree.T_parent_joint[2:], model.tree.axis[2:]
    limits = model.lower[4:], model.upper[4:]
    out = np.empty_like(starts)
    return out[: descend(fixed, axes, *limits, T_torso_wrist, starts, out)]


@njit(cache=True)
def descend(
    fixed: Array,
    axes: Array,
    lower: Array,
    upper: Array,
    target: Array,
    starts: Array,
    out: Array,
) -> int:
    """Write what the starts converge to into `out` and return how many do."""
    a, k = len(axes), 0
    frames, jacobian, error = np.empty((a, 3, 4)), np.empty((6, a)), np.empty(6)
    for start in starts:
        arm = start.copy()
        for _ in range(N_STEPS):
            _chain(fixed, axes, arm, frames)
            _difference(frames[-1], target, error)
            near_m, near_rad = (
                np.sqrt(np.sum(error[:3] ** 2)),
                np.sqrt(np.sum(error[3:] ** 2)),
            )
            if near_m < CLOSE_M and near_rad < CLOSE_RAD:
                out[k] = arm
                k += 1
                break
            _jacobian(frames, axes, jacobian)
            damping = DAMPING * min(1.0, near_m + near_rad) + 1e-9
            step = _step(jacobian, error, damping, arm, lower, upper)
            arm = np.minimum(np.maximum(arm + step, lower), upper)
    return k


@njit(cache=True)
def _step(
    jacobian: Array,
    error: Array,
    damping: float,
    arm: Array,
    lower: Array,
    upper: Array,
) -> Array:
    """Return the damped step, without joints that would push against a limit, (a,)."""
    J = jacobian.copy()
    step = np.zeros(len(arm))
    for _ in range(len(arm)):
        step = J.T @ np.linalg.solve(J @ J.T + damping * np.eye(6), error)
        is_stuck = ((arm <= lower) & (step < 0)) | ((arm >= upper) & (step > 0))
        if not np.any(is_stuck):
            break
        for i in np.flatnonzero(is_stuck):
            J[:, i] = 0.0
    largest = np.max(np.abs(step))
    return step * (MOST_RAD / largest) if largest > MOST_RAD else step


@njit(cache=True)
def _chain(fixed: Array, axes: Array, arm: Array, frames: Array) -> None:
    """Write the frames of the joints, seen from the torso, into `frames` (a, 3, 4)."""
    R, at = np.eye(3), np.zeros(3)
    for i in range(len(arm)):
        at = at + R @ fixed[i, :, 3].copy()
        R = R @ fixed[i, :, :3].copy() @ _rotation(axes[i], arm[i])
        frames[i, :, :3], frames[i, :, 3] = R, at


@njit(cache=True)
def _rotation(axis: Array, angle: float) -> Array:
    """Return the rotation about a unit axis by Rodrigues' formula, (3, 3)."""
    x, y, z = axis[0], axis[1], axis[2]
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K)


@njit(cache=True)
def _jacobian(frames: Array, axes: Array, out: Array) -> None:
    """Write how the last frame moves and turns with each joint into `out` (6, a)."""
    for i in range(len(axes)):
        axis = frames[i, :, :3].copy() @ axes[i]
        arm = frames[-1, :, 3] - frames[i, :, 3]
        out[0, i] = axis[1] * arm[2] - axis[2] * arm[1]
        out[1, i] = axis[2] * arm[0] - axis[0] * arm[2]
        out[2, i] = axis[0] * arm[1] - axis[1] * arm[0]
        out[3:, i] = axis


@njit(cache=True)
def _difference(T: Array, target: Array, out: Array) -> None:
    """Write the shift [m] and turn [rad] from a frame to the target into `out` (6,)."""
    for r in range(3):
        out[r] = target[r, 3] - T[r, 3]
    R = target[:, :3].copy() @ T[:, :3].copy().T
    out[3], out[4], out[5] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    sine = np.sqrt(out[3] ** 2 + out[4] ** 2 + out[5] ** 2) / 2
    cosine = (R[0, 0] + R[1, 1] + R[2, 2] - 1) / 2
    if sine > 1e-9:
        out[3:] *= np.arctan2(sine, cosine) / (2 * sine)
    elif cosine < 0:
        # Half a turn: any axis of the plane of symmetry will do to get away from it.
        out[3] = np.pi

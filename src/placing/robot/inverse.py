"""Joints of the arm that bring the tool to a pose, and along a line of poses.

The closed form of `pr2_arm` is used for robots whose file says so, the numerical
inverse of `numerical` for all others; both try a fixed number of times, in order.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from placing import rigid
from placing.robot import numerical, pr2_arm
from placing.robot.model import RobotModel

Array = NDArray[np.float64]

MOST_SOLUTIONS = 128
"""Room for solutions, per pose; what is left out then has many beside it."""
FINER = 4
"""Times more pans are tried when none of the first has a solution."""
PAN_STEPS_RAD = np.array(sorted(np.linspace(-0.3, 0.3, 61).tolist(), key=abs))
"""Changes of the pan between two steps of a line, the smallest first."""


def arm_solutions(model: RobotModel, T_base_tool: Array, torso_m: float) -> Array:
    """Return all solutions found within the limits, (k, a) [rad].

    The base is the frame on the floor. A joint without limits is between -pi and pi.
    """
    T_torso_wrist = _wrist(model, T_base_tool, torso_m)
    n = model.settings.n_tries
    if model.arm is None:
        return numerical.solutions(model, T_torso_wrist, n)
    found = _solve(model.arm, T_torso_wrist, _pans(model.arm, n))
    if len(found) == 0:
        found = _solve(model.arm, T_torso_wrist, _pans(model.arm, FINER * n))
    return found


def solutions_at(
    model: RobotModel, places: Array, T_world_tool: Array
) -> tuple[NDArray[np.int64], Array]:
    """Return the solutions for a tool (4, 4) from many places.

    Places are x, y, yaw of the base and a height of the torso, (n, 4). Returned are
    whose each solution is (k,), and the solutions (k, a) as `arm_solutions` returns
    them, without its second, finer try.
    """
    n, tree = model.settings.n_tries, model.tree
    T_world_wrist = np.ascontiguousarray((T_world_tool @ model.T_tool_frame)[:3])
    Ts = _seen_from(places, T_world_wrist, tree.T_parent_joint[1], tree.axis[1])
    if model.arm is None:
        found = [numerical.solutions(model, T, n) for T in Ts]
        which = np.repeat(np.arange(len(found)), [len(arms) for arms in found])
        return which, np.vstack([np.empty((0, model.n_arm)), *found])
    pans = _pans(model.arm, n)
    out = np.empty((MOST_SOLUTIONS * len(Ts) + pr2_arm.N_MOST * len(pans), 7))
    which = np.empty(len(out), np.int64)
    k = pr2_arm.solve_many(model.arm, Ts, pans, out, which)
    return which[:k].copy(), out[:k].copy()


@njit(cache=True)
def _seen_from(
    places: Array, T_world_wrist: Array, T_base_joint: Array, axis: Array
) -> Array:
    """Return a frame (3, 4) in the frame of the torso at places, (n, 3, 4)."""
    seen = np.empty((len(places), 3, 4))
    for i in range(len(places)):
        c, s = np.cos(places[i, 2]), np.sin(places[i, 2])
        for k in range(4):
            x, y, z = T_world_wrist[0, k], T_world_wrist[1, k], T_world_wrist[2, k]
            if k == 3:
                x, y = x - places[i, 0], y - places[i, 1]
            x, y = c * x + s * y, c * y - s * x
            if k == 3:
                x -= T_base_joint[0, 3]
                y -= T_base_joint[1, 3]
                z -= T_base_joint[2, 3]
            for r in range(3):
                seen[i, r, k] = (
                    T_base_joint[0, r] * x
                    + T_base_joint[1, r] * y
                    + T_base_joint[2, r] * z
                )
        for r in range(3):
            seen[i, r, 3] -= places[i, 3] * axis[r]
    return seen


def follow(model: RobotModel, q: Array, Ts_world_tool: Array) -> Array:
    """Return configurations with the tool at each pose, base and torso as in `q`.

    Each is the solution nearest to the one before, (t, 4 + a); it ends before the first
    pose that has none, or where a joint would turn more than `max_step_rad`.
    """
    T_world_base = rigid.homogeneous(rigid.from_yaw(q[2], (q[0], q[1], 0.0)))
    Ts = np.array([rigid.homogeneous(T) for T in Ts_world_tool])
    T_world_torso = T_world_base @ _lift(model, q[3])
    Ts = (np.linalg.inv(T_world_torso) @ Ts @ model.T_tool_frame)[:, :3]
    arms = np.empty((len(Ts), model.n_arm))
    n = _follow(model, np.ascontiguousarray(Ts), np.asarray(q[4:], float), arms)
    return np.hstack([np.tile(np.asarray(q[:4], float), (n, 1)), arms[:n]])


def _follow(model: RobotModel, Ts: Array, arm: Array, out: Array) -> int:
    """Write arms along poses of the last frame (t, 3, 4) and return how many."""
    most = model.settings.max_step_rad
    if model.arm is not None:
        return pr2_arm.follow_line(model.arm, Ts, arm, PAN_STEPS_RAD, most, out)
    for i, T_torso_wrist in enumerate(Ts):
        found = numerical.solutions_near(model, T_torso_wrist, arm)
        steps = np.max(np.abs(found - arm), axis=1, initial=0)
        if len(found) == 0 or steps.min() > most:
            return i
        arm = out[i] = found[np.argmin(steps)]
    return len(Ts)


def _lift(model: RobotModel, torso_m: Array) -> Array:
    """Return the torso's frame in the base's at heights (...), shape (..., 4, 4)."""
    joint = np.eye(4)
    joint[:3] = model.tree.T_parent_joint[1]
    lift = np.tile(joint, (*np.shape(torso_m), 1, 1))
    up = joint[:3, :3] @ model.tree.axis[1]
    lift[..., :3, 3] += np.asarray(torso_m)[..., None] * up
    return lift


def _wrist(model: RobotModel, T_base_tool: Array, torso_m: float) -> Array:
    """Return the last frame of the arm in the frame of the torso, (3, 4)."""
    T_base_wrist = rigid.homogeneous(T_base_tool) @ model.T_tool_frame
    return (np.linalg.inv(_lift(model, np.array(torso_m))) @ T_base_wrist)[:3]


def _pans(arm: pr2_arm.Pr2Arm, n: int) -> Array:
    """Return n pans at equal steps within the limits, (n,)."""
    return arm.lower[0] + (np.arange(n) + 0.5) / n * (arm.upper[0] - arm.lower[0])


def _solve(arm: pr2_arm.Pr2Arm, T_torso_wrist: Array, pans: Array) -> Array:
    """Return the solutions of all pans, (k, 7)."""
    out = np.empty((len(pans) * pr2_arm.N_MOST, 7))
    return out[: pr2_arm.solve(arm, T_torso_wrist, pans, out)]

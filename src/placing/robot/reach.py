"""From where the robot reaches a placement, and the straight lines that lead there.

Base poses around the object (a Halton sequence on the reachable part of the floor),
times heights of the torso, times grasps, times solutions of the arm: goals are those
that are free, and from which straight lines lead up to where the path planner takes
over and back to where the hand is off the object.

Letters: b base poses, t rows of a path, a joints of the arm.
"""

from functools import cache

import numpy as np

from placing import rigid
from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.driving import Floor
from placing.robot.halton import halton
from placing.robot.inverse import follow
from placing.robot.model import tool_pose
from placing.robot.planning import PlanningConfig

UP = np.array([0.0, 0.0, 1.0])


@cache
def _halton(n: int) -> Array:
    """Return the first points of a Halton sequence, shape (n, 3), from 0 to 1."""
    return halton(n + 1, 3)[1:]


def standing_places(
    floor: Floor, checker: SceneChecker, T_world_object: Array, config: PlanningConfig
) -> Array:
    """Return base poses around an object where the robot can stand, (b, 3).

    They lie between poses of the lattice on the floor: beside each of some that see
    the object, as many as may be tried, one is tried as a Halton sequence says.
    """
    settings = checker.model.settings
    x, y = T_world_object[4:6].tolist()
    bearing = np.deg2rad(settings.bearing_deg)
    nodes = floor.poses_around(x, y, settings.reach_m, bearing)
    if not len(nodes):
        return nodes
    share = _halton(config.n_bases)
    number = (share[:, 0] * len(nodes)).astype(int)
    _, first = np.unique(number, return_index=True)
    # In the order of the sequence: the first few are all around the object.
    beside = nodes[number[np.sort(first)]]
    cell = np.array([config.floor_cell_m] * 2 + [2 * np.pi / config.n_headings])
    jittered = beside + (_halton(len(beside)) - 0.5) * cell
    poses = np.vstack([beside, jittered])
    return poses[checker.are_free(floor.configurations(poses))]


def has_hand_lines(
    checker: SceneChecker,
    after: SceneChecker,
    T_world_tool: Array,
    held: Held,
    config: PlanningConfig,
) -> bool:
    """Return whether the hand alone finds free straight lines down and back.

    The tool is at (4, 4) when it lets go. Where there are none, `straight_down` or
    `straight_back` finds none either, whatever the arm.
    """
    up = _moved(T_world_tool, UP, config.lift_m, config)
    may_touch = checker.are_hands_free(up, held, touching=True)
    is_clear = checker.are_hands_free(up, held)
    is_clear[0] = False
    if not (is_clear & np.logical_and.accumulate(may_touch)).any():
        return False
    least, longest = config.retreat_m
    back = _moved(T_world_tool, -T_world_tool[:3, 0], longest, config)
    may_touch = checker.are_hands_free(back, None, touching=True)
    is_clear = after.are_hands_free(back)
    is_clear[: round(least / config.step_m)] = False
    return bool((is_clear & np.logical_and.accumulate(may_touch)).any())


def _moved(
    T_world_tool: Array, direction: Array, length_m: float, config: PlanningConfig
) -> Array:
    """Return the tool (4, 4) moved along a line in steps, (n, 4, 4)."""
    n = round(length_m / config.step_m)
    Ts = np.repeat(T_world_tool[None], n + 1, axis=0)
    Ts[:, :3, 3] += np.arange(n + 1)[:, None] * config.step_m * direction
    return Ts


def straight_down(
    checker: SceneChecker, goal: Array, held: Held, config: PlanningConfig
) -> Array | None:
    """Return the shortest free way straight down to a goal, (t, 4 + a).

    It begins where the object is clear of everything by the usual margin.
    """
    rows = _line(checker, goal, UP, config.lift_m, config)
    if len(rows) < 2:
        return None
    is_clear = checker.are_free(rows[1:], held)
    if not is_clear.any():
        return None
    end = int(is_clear.argmax()) + 2
    rows = rows[:end]
    return rows[::-1] if checker.is_path_free(rows, held, touching=True) else None


def straight_back(
    checker: SceneChecker,
    after: SceneChecker,
    goal: Array,
    T_world_tool: Array,
    config: PlanningConfig,
) -> Array | None:
    """Return the shortest free way of the empty hand off an object, (t, 4 + a).

    `after` knows the object as a box, from which the hand is clear in the end.
    """
    least, longest = config.retreat_m
    direction = -rigid.matrix(T_world_tool[:4])[:, 0]
    rows = _line(checker, goal, direction, longest, config)
    n_least = round(least / config.step_m)
    is_clear = after.are_free(rows)
    is_clear[:n_least] = False
    if not is_clear.any():
        return None
    rows = rows[: int(is_clear.argmax()) + 1]
    return rows if checker.is_path_free(rows, None, touching=True) else None


def _line(
    checker: SceneChecker,
    goal: Array,
    direction: Array,
    length_m: float,
    config: PlanningConfig,
) -> Array:
    """Return how the arm moves the tool along a line, as far as it can, (t, 4 + a)."""
    n = round(length_m / config.step_m)
    Ts = np.repeat(tool_pose(checker.model, goal)[None], n + 1, axis=0)
    Ts[:, 4:] += np.arange(n + 1)[:, None] * config.step_m * direction
    return follow(checker.model, goal, Ts)

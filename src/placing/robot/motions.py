"""From a goal at an object to a whole motion of the robot.

Letters: t rows of a path, a joints of the arm.
"""

import numpy as np

from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker
from placing.robot.driving import Floor
from placing.robot.goals import Goal
from placing.robot.paths import connect
from placing.robot.planning import NO_PATH, PICKING, PUTTING, Segment
from placing.robot.search import Search


def segments_of(search: Search, goal: Goal, floor: Floor) -> tuple[Segment, ...] | None:
    """Return the segments of a motion to a goal and back, if there are paths."""
    search.reached(NO_PATH)
    settings = search.without.model.settings
    if search.is_putting:
        first, last = goal.down, goal.back
        checkers, held = (search.without, search.among), (goal.held, None)
        leaving = np.asarray(settings.stow)
    else:
        first, last = goal.back[::-1], goal.down[::-1]
        checkers, held = (search.among, search.without), (None, goal.held)
        leaving = goal.stance.carry
    arrive = _arrive(search, goal, checkers[0], held[0], first[0])
    if arrive is None:
        return None
    leave = _leave(search, floor, checkers[1], held[1], leaving, last[-1])
    if leave is None:
        return None
    paths = (*arrive, first, last, leave)
    names = PUTTING if search.is_putting else PICKING
    wide, narrow = settings.max_opening_m, goal.grasp.width_m
    openings = (narrow, wide) if search.is_putting else (wide, narrow)
    return tuple(
        Segment(name, path, (i < 4) == search.is_putting, openings[i >= 4])
        for i, (name, path) in enumerate(zip(names, paths, strict=True))
    )


def _arrive(
    search: Search, goal: Goal, checker: SceneChecker, held: Held | None, end: Array
) -> tuple[Array, Array, Array] | None:
    """Return the ways of the base, of the torso and of the arm to `end`, if any."""
    drive = goal.stance.drive
    raised = np.concatenate([end[:4], drive[-1, 4:]])
    reach = _connected(search, checker, raised, end, held)
    if reach is None:
        return None
    lift = np.array([raised, raised])
    lift[0, 3] = drive[-1, 3]
    # The yaw of a path is continuous: what follows has as many turns as the drive.
    turns = drive[-1, 2] - end[2]
    for path in (lift, reach):
        path[:, 2] += turns
    return drive, lift, reach


def _leave(
    search: Search,
    floor: Floor,
    checker: SceneChecker,
    held: Held | None,
    arm: Array,
    begin: Array,
) -> Array | None:
    """Return the way of the arm from `begin` to where it is folded, torso low."""
    folded = np.concatenate([begin[:4], arm])
    low = folded.copy()
    low[3] = floor.low_m
    if not checker.is_edge_free(folded, low, held):
        return None
    path = _connected(search, checker, begin, folded, held)
    return None if path is None else np.vstack([path, low])


def _connected(
    search: Search, checker: SceneChecker, start: Array, end: Array, held: Held | None
) -> Array | None:
    """Return a path of the arm, while paths may be sought."""
    if search.n_paths <= 0:
        return None
    search.n_paths -= 1
    return connect(checker, start, end, held, search.query)

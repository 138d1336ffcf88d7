"""Paths of the arm between two configurations: the only module that knows OMPL.

A bidirectional tree (RRT-Connect) as in Section 3.3, over the joints of the arm alone:
base and torso stand still. Limits count checked edges, never seconds, so that a query
has the same answer on every machine.
"""

from dataclasses import dataclass

import numpy as np
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from placing.rigid import Array
from placing.robot.checker import Held, SceneChecker

N_BASE = 4
"""Columns of a configuration before those of the arm."""
N_IDLE = 200
"""Looks without a new check after which a query has nothing left to do."""


@dataclass(frozen=True)
class Query:
    """Limits of one query."""

    seed: int
    """More than 0."""
    n_checks: int
    range_rad: float


class _Edges(ob.MotionValidator):
    """Whole edges of the arm at one pose of base and torso, counted."""

    def __init__(
        self,
        space: ob.SpaceInformation,
        checker: SceneChecker,
        start: Array,
        held: Held | None,
    ) -> None:
        super().__init__(space)
        self.checker, self.held, self.n_checks = checker, held, 0
        self.a, self.b = start.copy(), start.copy()
        self.n = len(start) - N_BASE

    def checkMotion(self, first: ob.State, second: ob.State) -> bool:
        """Return whether the arm moves straight between two states."""
        self.n_checks += 1
        self.a[N_BASE:] = first[0 : self.n]
        self.b[N_BASE:] = second[0 : self.n]
        return bool(self.checker.is_edge_free(self.a, self.b, self.held))


def connect(
    checker: SceneChecker, start: Array, goal: Array, held: Held | None, query: Query
) -> Array | None:
    """Return a path of the arm from `start` to `goal`, (t, 4 + a), if one is found.

    Both share base and torso, and both have to be free.
    """
    if not (checker.is_free(start, held) and checker.is_free(goal, held)):
        return None  # The planner would wait for another goal until its limit.
    if checker.is_edge_free(start, goal, held):
        return np.array([start, goal])
    ou.setLogLevel(ou.LOG_NONE)
    # Before every query, and before anything that draws exists.
    ou.RNG.setSeed(query.seed)
    space = ob.SpaceInformation(_space(checker, start, goal))
    space.setStateValidityChecker(lambda _: True)
    edges = _Edges(space, checker, start, held)
    space.setMotionValidator(edges)
    space.setup()
    problem = ob.ProblemDefinition(space)
    problem.setStartAndGoalStates(_state(space, start), _state(space, goal))
    planner = og.RRTConnect(space)
    planner.setRange(query.range_rad)
    planner.setProblemDefinition(problem)
    planner.setup()
    planner.solve(ob.PlannerTerminationCondition(_limit(edges, query.n_checks)))
    if not problem.hasExactSolution():
        return None
    arm = _simplified(space, problem, len(start) - N_BASE)
    base = np.repeat(start[None, :N_BASE], len(arm), axis=0)
    path = np.hstack([base, arm])
    path[0], path[-1] = start, goal
    return path


def _space(checker: SceneChecker, start: Array, goal: Array) -> ob.RealVectorStateSpace:
    """Return the joints of the arm; those without an end reach a turn further."""
    low, high = checker.model.lower[N_BASE:], checker.model.upper[N_BASE:]
    both = np.array([start[N_BASE:], goal[N_BASE:]])
    low = np.where(np.isfinite(low), low, both.min(0) - np.pi)
    high = np.where(np.isfinite(high), high, both.max(0) + np.pi)
    bounds = ob.RealVectorBounds(len(low))
    for i in range(len(low)):
        bounds.setLow(i, min(low[i], both[:, i].min()))
        bounds.setHigh(i, max(high[i], both[:, i].max()))
    space = ob.RealVectorStateSpace(len(low))
    space.setBounds(bounds)
    return space


def _state(space: ob.SpaceInformation, q: Array) -> ob.State:
    """Return the state of the arm; it must not be freed by hand."""
    state = space.allocState()
    state[0 : len(q) - N_BASE] = q[N_BASE:].tolist()
    return state


def _limit(edges: _Edges, n_checks: int):  # noqa: ANN202
    """Return the function that ends a query after so many checks."""
    idle, last = 0, -1

    def is_over() -> bool:
        nonlocal idle, last
        idle = idle + 1 if edges.n_checks == last else 0
        last = edges.n_checks
        return edges.n_checks > n_checks or idle > N_IDLE

    return is_over


def _simplified(
    space: ob.SpaceInformation, problem: ob.ProblemDefinition, n: int
) -> Array:
    """Return the path found with needless corners left out, shape (t, a)."""
    path = problem.getSolutionPath()
    simplifier = og.PathSimplifier(space)
    simplifier.reduceVertices(path)
    simplifier.partialShortcutPath(path)
    simplifier.collapseCloseVertices(path)
    return np.array([state[0:n] for state in path.getStates()])

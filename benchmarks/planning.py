"""Compare the planner's checks and queries with the same ones in the simulator.

Run it with `./run python benchmarks/planning.py`. All problems are those of the PR2's
right arm in rooms of the study, base and torso still, nothing held; all figures come
from one run. Ratios carry over to other machines.
"""

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pandas as pd
import pybullet
import tyro
from checker import anywhere, robot, room, scanned, settings
from clock import seconds_of
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou
from pybullet_planning import plan_joint_motion
from pybullet_planning.utils import CLIENTS
from simulated import Simulated
from tqdm import tqdm

from placing.physics.cutting import fixed_of
from placing.robot.checker import SceneChecker
from placing.robot.distance_field import distance_field
from placing.robot.paths import Query, connect
from placing.robot.truth import Truth
from placing.seeds import generator

Row = dict[str, Any]
Array = NDArray[np.float64]
MAX_STATES = 4000
"""Checks of states after which a query in the simulator is given up."""
STEP_RAD = 0.05
"""Between two checks of an edge in the simulator, which is coarser than ours."""

# SOURCE: figures that others published, measured on their machines, and not by us.
PUBLISHED = [
    {"planner": "VAMP, Panda, boxes and cylinders", "median [ms]": 0.035},
    {"planner": "VAMP, Fetch, boxes and cylinders", "median [ms]": 0.828},
    {"planner": "VAMP, Fetch, point clouds", "median [ms]": 2.35},
]


def main(
    output: Path = Path("results/benchmarks_planning.json"),
    rooms: tuple[str, ...] = ("kitchen3", "livingroom1", "office2"),
    n_states: int = 400,
    n_problems: int = 6,
    n_slow: int = 2,
) -> None:
    """Measure checks and queries; print tables and write them as JSON.

    Args:
        output: File to write.
        rooms: Rooms of the study.
        n_states: Configurations of each kind that are checked.
        n_problems: Queries in each room.
        n_slow: Those of them that the slowest planner gets as well.
    """
    config, settling, scan = settings()
    model, checks, queries = robot(), [], []
    for name in tqdm(rooms, unit="room", disable=None):
        layout, rng = room(name), generator(0, "planning", name)
        field = distance_field(scanned(layout, scan).points, config)
        checker = SceneChecker(model, field, config)
        states = anywhere(rng, layout, model, 5000)
        still = around_one_base(rng, checker, states)
        with Simulated(
            model, fixed_of(layout, settling.margin_m), config, settling
        ) as t:
            checks += compare_checks(name, checker, t, states[:n_states], still)
            problems = pairs(checker, t, still, n_problems)
            queries += compare_queries(checker, t, problems, n_slow)
    table = pd.DataFrame(queries)
    summary = [summed(str(name), rows) for name, rows in table.groupby("planner")]
    tables = {"checks": checks, "queries": summary, "published": PUBLISHED}
    for name, rows in tables.items():
        shown = pd.DataFrame(rows).to_string(index=False, float_format="{:.4g}".format)
        print(f"\n{name}\n{shown}")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(tables, indent=1) + "\n")


def around_one_base(
    rng: np.random.Generator, checker: SceneChecker, states: Array
) -> Array:
    """Return random arms at the free base that is nearest to the furniture, (t, 11)."""
    free = states[checker.are_free(states)][:40]
    tried = []
    for base in free[:, :4]:
        rows = states[rng.permutation(len(states))[:1500]].copy()
        rows[:, :4] = base
        tried.append((checker.are_free(rows).mean(), rows))
    return min(tried, key=lambda pair: abs(pair[0] - 0.4))[1]


def compare_checks(
    name: str, checker: SceneChecker, truth: Truth, states: Array, still: Array
) -> list[Row]:
    """Return how long a check of a configuration takes, ours and in the simulator."""
    free = still[checker.are_free(still)]
    kinds = {"anywhere": states, "arm": still[: len(states)], "arm, free": free}
    rows = []
    for kind, some in kinds.items():
        some = some[: len(states)]
        ours = seconds_of(lambda some=some: checker.are_free(some)) / len(some)
        slow = seconds_of(lambda some=some: [truth.hits(q) for q in some]) / len(some)
        rows.append(check_row(name, kind, ours, slow))
    checker.is_edge_free(free[0], free[1])  # compiled now, if it was not
    before = checker.n_checks
    start = process_time()
    for q0, q1 in pairwise(free[:61]):
        checker.is_edge_free(q0, q1)
    edge = (process_time() - start) / (checker.n_checks - before)
    return [
        *rows,
        check_row(name, "arm, edges", edge, rows[-1]["simulator [us]"] / 1e6),
    ]


def check_row(name: str, kind: str, ours_s: float, slow_s: float) -> Row:
    """Return one row of the table of checks."""
    return {
        "room": name,
        "configurations": kind,
        "ours [us]": 1e6 * ours_s,
        "simulator [us]": 1e6 * slow_s,
        "ratio": slow_s / ours_s,
    }


def pairs(
    checker: SceneChecker, truth: Truth, rows: Array, n: int
) -> list[tuple[Array, Array]]:
    """Return starts and goals that are free for both checks."""
    free = rows[checker.are_free(rows)][: 4 * n]
    free = [q for q in free if not truth.hits(q)]
    return [(free[2 * i], free[2 * i + 1]) for i in range(min(n, len(free) // 2))]


def compare_queries(
    checker: SceneChecker,
    truth: Truth,
    problems: list[tuple[Array, Array]],
    n_slow: int,
) -> list[Row]:
    """Return how long each planner takes for each problem."""
    planners: dict[str, Callable[[Array, Array], bool]] = {
        "ours": lambda a, b: (
            connect(checker, a, b, None, Query(1, 20_000, 1.0)) is not None
        ),
        "OMPL, simulator": lambda a, b: in_simulator(truth, checker, a, b),
        "pybullet-planning": lambda a, b: by_birrt(truth, checker, a, b),
    }
    planners["ours"](*problems[0])
    rows = []
    for i, problem in enumerate(problems):
        for name, solve in planners.items():
            if name == "pybullet-planning" and i >= n_slow:
                continue
            start = process_time()
            solved = solve(*problem)
            taken = process_time() - start
            rows.append({"planner": name, "solved": solved, "seconds": taken})
    return rows


def summed(name: str, rows: pd.DataFrame) -> Row:
    """Return the row of one planner in the table of queries."""
    ms = 1e3 * rows["seconds"]
    return {
        "planner": name,
        "problems": len(rows),
        "solved": int(rows["solved"].sum()),
        "median [ms]": float(ms.median()),
        "mean [ms]": float(ms.mean()),
        "95 % [ms]": float(ms.quantile(0.95)),
    }


def in_simulator(truth: Truth, checker: SceneChecker, a: Array, b: Array) -> bool:
    """Return whether OMPL connects two states when the simulator checks each state."""
    ou.setLogLevel(ou.LOG_NONE)
    ou.RNG.setSeed(1)
    low, high = limits(checker)
    bounds = ob.RealVectorBounds(len(low))
    for i in range(len(low)):
        bounds.setLow(i, float(low[i]))
        bounds.setHigh(i, float(high[i]))
    vectors = ob.RealVectorStateSpace(len(low))
    vectors.setBounds(bounds)
    space, count, q = ob.SpaceInformation(vectors), [0], a.copy()

    def is_free(state: ob.State) -> bool:
        count[0] += 1
        q[4:] = state[0 : len(low)]
        return not truth.hits(q)

    space.setStateValidityChecker(is_free)
    space.setStateValidityCheckingResolution(STEP_RAD / space.getMaximumExtent())
    space.setup()
    start, goal = space.allocState(), space.allocState()
    start[0 : len(low)], goal[0 : len(low)] = a[4:].tolist(), b[4:].tolist()
    problem = ob.ProblemDefinition(space)
    problem.setStartAndGoalStates(start, goal)
    planner = og.RRTConnect(space)
    planner.setRange(1.0)
    planner.setProblemDefinition(problem)
    planner.setup()
    planner.solve(ob.PlannerTerminationCondition(lambda: count[0] > MAX_STATES))
    return bool(problem.hasExactSolution())


def limits(checker: SceneChecker) -> tuple[Array, Array]:
    """Return the limits of the arm, a turn and a half for joints without any."""
    low, high = checker.model.lower[4:], checker.model.upper[4:]
    wide = 1.5 * np.pi
    return (
        np.where(np.isfinite(low), low, -wide),
        np.where(np.isfinite(high), high, wide),
    )


def by_birrt(truth: Truth, checker: SceneChecker, a: Array, b: Array) -> bool:
    """Return whether pybullet-planning connects two states in the same world."""
    # It plans in the client whose number is 0, and keeps a list of clients.
    client, robot_body = truth._client, truth._robot
    assert client == 0
    CLIENTS[client] = None
    truth.hits(a)
    joints = [truth._joints[name] for name in checker.model.settings.chain]
    number = {name: i for i, name in truth._links.items()}
    checked = {frozenset(pair) for pair in checker.model.self_pairs.tolist()}
    solid = sorted({hull.link for hull in checker.model.hulls})
    names = checker.model.links
    allowed = {
        (number[one], number[other])
        for one in solid
        for other in solid
        if frozenset((names.index(one), names.index(other))) not in checked
    }
    bodies = [
        pybullet.getBodyUniqueId(i, client)
        for i in range(pybullet.getNumBodies(client))
    ]
    path = plan_joint_motion(
        robot_body,
        joints,
        b[4:],
        obstacles=[body for body in bodies if body != robot_body],
        self_collisions=True,
        disabled_collisions=allowed,
        resolutions=np.full(len(joints), STEP_RAD),
        max_iterations=200,
        restarts=0,
        smooth=0,
    )
    return path is not None


if __name__ == "__main__":
    tyro.cli(main)

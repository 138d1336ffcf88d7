"""Arrange all objects of an empty scene together, by any context (Section 3.1).

Every method scores the same options; the integer program of `assignment` then chooses
one for each object so that nothing overlaps and the sum of the scores is largest.

Shapes: o options of all objects, p places.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from placing.candidates import Candidates
from placing.joint.assignment import Assignment, assign
from placing.joint.assignment_config import AssignmentConfig
from placing.joint.joint_options import Proposals
from placing.joint.options import Options, thin_options
from placing.joint.stacking import StackPair, stacked_boxes
from placing.methods.answer_tables import LOCATION, ORIENTATION
from placing.scene import Scene

Array = NDArray[np.float64]

NEARLY = 0.98
"""Share of the best Psi_stability that counts as nearly as good."""
JOINT_COLUMNS = (
    *("dataset", "scene", "method", "object", "category", "area", "orientation"),
    *(*LOCATION, *ORIENTATION, "on", "level", "log_psi"),
    *("log_psi_stability", "log_psi_semantics", "is_placed", "reason"),
    *("objective", "gap", "n_nodes"),
)


@dataclass(frozen=True)
class JointConfig:
    """Settings of the joint placement; the values live in `config/config.yaml`."""

    min_stability: float
    """Options less likely to stay put are left out while surer ones remain."""
    tie_spread: float
    """Standard deviation of what is added to log scores, so that ties are drawn."""


def log_scores(proposals: Proposals, method: str, object_weight: float) -> Array:
    """Return what a method thinks of every option, shape (o,).

    `object_weight` is omega, the share of the human context in `dp_object_context`.
    """
    if method == "dp_object_context":
        human = np.log(object_weight) + proposals.log_dp
        context = np.log1p(-object_weight) + proposals.log_object_context
        return np.logaddexp(human, context)
    return getattr(proposals, f"log_{method}")


def options_of(
    rng: Generator,
    proposals: Proposals,
    candidates: Candidates,
    scores: Array,
    n_objects: int,
    config: tuple[JointConfig, AssignmentConfig],
) -> tuple[list[Options], list[NDArray[np.int64]]]:
    """Return the options of each object for the program, and their rows."""
    joint, program = config
    drawn = scores + rng.normal(0.0, joint.tie_spread, len(scores))
    clearance = candidates.feature("clearance_m")
    options, rows = [], []
    for i in range(n_objects):
        of_object = np.flatnonzero(proposals.object == i)
        roomy = of_object[proposals.has_room[of_object]]
        of_object = roomy if len(roomy) else of_object
        stability = proposals.log_stability[of_object]
        # ASSUME: every context chooses among what stays put; where nothing is sure to,
        # among what is nearly as likely to as the best.
        best = stability.max(initial=-np.inf)
        least = min(np.log(joint.min_stability), best + np.log(NEARLY))
        of_object = of_object[stability >= least]
        box, place = proposals.box[of_object], proposals.place[of_object]
        found = Options(
            *(box[:, :3], box[:, 3:6], box[:, 6]),
            *(candidates.area[place], place.astype(np.int32)),
            *(clearance[place], drawn[of_object]),
        )
        kept = thin_options(found, program.n_best, program.n_spread)
        options.append(found.only(kept))
        rows.append(of_object[kept])
    return options, rows


def arrange(
    rng: Generator,
    scene: Scene,
    candidates: Candidates,
    proposals: Proposals,
    scores: Array,
    stacks: Sequence[StackPair],
    config: tuple[JointConfig, AssignmentConfig],
) -> list[dict[str, object]]:
    """Return one row per object: where it stands, on what, and why not if it does not.

    The rows have the columns `JOINT_COLUMNS` but for data set, scene and method.
    """
    n_objects = len(scene.objects)
    args = proposals, candidates, scores, n_objects, config
    options, rows = options_of(rng, *args)
    found = assign(options, stacks, config[1])
    boxes = stacked_boxes(options, found.choice, found.on)
    shared = {
        "objective": found.objective,
        "gap": found.gap,
        "n_nodes": found.n_nodes,
    }
    return [
        _row(scene, candidates, proposals, scores, found, i, rows[i], boxes) | shared
        for i in range(n_objects)
    ]


def _row(
    scene: Scene,
    candidates: Candidates,
    proposals: Proposals,
    scores: Array,
    found: Assignment,
    i: int,
    rows: NDArray[np.int64],
    boxes: Array,
) -> dict[str, object]:
    """Return what is written of one object."""
    item, chosen = scene.objects[i], int(found.choice[i])
    row: dict[str, object] = {"object": item.object_id, "category": item.category}
    if chosen < 0:
        return row | nowhere(found.reason[i])
    o = rows[chosen]
    T = proposals.T_world_object[o].copy()
    T[6] += boxes[i, 2] - proposals.box[o, 2]  # onto what it stands on
    lower = int(found.on[i])
    area = scene.areas[candidates.area[proposals.place[o]]].area
    values = (*T[4:], *T[:4])
    named = zip((*LOCATION, *ORIENTATION), values, strict=True)
    return (
        row
        | {name: float(value) for name, value in named}
        | {
            "area": area,
            "orientation": str(proposals.orientation[o]),
            "on": scene.objects[lower].object_id if lower >= 0 else "",
            "level": int(found.level[i]),
            "log_psi": float(scores[o]),
            "log_psi_stability": float(proposals.log_stability[o]),
            "log_psi_semantics": float(proposals.log_semantics[o]),
            "is_placed": True,
            "reason": "",
        }
    )


def nowhere(reason: str) -> dict[str, object]:
    """Return what is written of an object that is not placed."""
    numbers = (*LOCATION, *ORIENTATION, "log_psi")
    numbers += ("log_psi_stability", "log_psi_semantics")
    words = {"area": "", "orientation": "", "on": "", "level": 0}
    return (
        dict.fromkeys(numbers, np.nan) | words | {"is_placed": False, "reason": reason}
    )


def stack_pairs(
    scene: Scene, stacks: Array, shares: Mapping[str, float], config: JointConfig
) -> list[StackPair]:
    """Return which objects may stand on which, with the log share of those that do.

    `stacks` (s, 3) upper, lower, log Psi_stability.
    """
    # ASSUME: only what labellers stack is stacked: on another of the same category.
    found = []
    for upper, lower, log_stability in stacks:
        share = shares.get(scene.objects[int(upper)].category, 0.0)
        if share > 0 and log_stability >= np.log(config.min_stability):
            pair = int(upper), int(lower), float(np.log(share))
            found.append(StackPair(*pair))
    return found

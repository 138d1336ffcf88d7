"""Every context chooses among the same options, and none overlaps another."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from study import study

from placing.joint.assignment_config import AssignmentConfig
from placing.joint.joint import (
    JOINT_COLUMNS,
    JointConfig,
    arrange,
    log_scores,
    options_of,
    stack_pairs,
)
from placing.joint.joint_options import Proposals
from placing.methods.names import JOINT_METHODS
from placing.overlap import overlaps

STUDY = Path(__file__).parents[2] / "config" / "config.yaml"
PROGRAM = AssignmentConfig(**yaml.safe_load(STUDY.read_text())["assignment"])
CONFIG = JointConfig(min_stability=0.9, tie_spread=0.0)


@pytest.fixture(scope="module")
def parts():
    scene, candidates, _ = study()
    return scene, candidates


def proposals(scene, candidates, rng, n=40):
    """Return options upright at random places with random scores."""
    columns = {name: [] for name in Proposals.__dataclass_fields__}
    for i, item in enumerate(scene.objects):
        place = rng.choice(len(candidates.location), n, replace=False)
        centre = candidates.location[place] + [0, 0, item.size_m[2] / 2]
        upright = np.tile([1.0, 0, 0, 0], (n, 1))
        size = np.tile(item.size_m, (n, 1))
        columns["object"].append(np.full(n, i))
        columns["place"].append(place)
        columns["orientation"].append(np.full(n, "upright"))
        columns["T_world_object"].append(np.hstack([upright, centre]))
        columns["box"].append(np.column_stack([centre, size, np.zeros(n)]))
        columns["has_room"].append(np.ones(n, np.bool_))
        columns["log_stability"].append(np.log(rng.uniform(0.5, 1, n)))
        for name in columns:
            if name.startswith("log_") and name != "log_stability":
                columns[name].append(np.log(rng.dirichlet(np.ones(n))))
    return Proposals(**{name: np.concatenate(c) for name, c in columns.items()})


@pytest.mark.parametrize("method", JOINT_METHODS)
def test_what_is_arranged_does_not_overlap(parts, method):
    scene, candidates = parts
    table = proposals(scene, candidates, np.random.default_rng(1))
    scores = log_scores(table, method, 0.5)
    rng = np.random.default_rng(0)
    args = scene, candidates, table, scores, []
    rows = arrange(rng, *args, (CONFIG, PROGRAM))
    assert all(row["is_placed"] for row in rows)
    assert set(rows[0]) == set(JOINT_COLUMNS) - {"dataset", "scene", "method"}
    boxes = np.array(
        [
            [row["x_m"], row["y_m"], row["z_m"], *item.size_m, 0.0]
            for row, item in zip(rows, scene.objects, strict=True)
        ]
    )
    for i in range(len(boxes)):
        for j in range(i):
            assert not overlaps(boxes[[i]], boxes[[j]]).any()


def test_the_mixture_is_the_sum_of_its_parts(parts):
    table = proposals(*parts, np.random.default_rng(2))
    mixed = np.exp(log_scores(table, "dp_object_context", 0.3))
    dp, context = np.exp(table.log_dp), np.exp(table.log_object_context)
    np.testing.assert_allclose(mixed, 0.3 * dp + 0.7 * context)


def test_only_what_stays_put_is_an_option_while_anything_does(parts):
    scene, candidates = parts
    table = proposals(scene, candidates, np.random.default_rng(3))
    at = np.flatnonzero(table.object == 1)
    table.log_stability[at] = np.log(0.2)
    table.log_stability[at[:5]] = np.log(0.5)
    args = table, candidates, table.log_dp, len(scene.objects), (CONFIG, PROGRAM)
    _, rows = options_of(np.random.default_rng(0), *args)
    assert (table.log_stability[rows[0]] >= np.log(0.9)).all()
    assert set(rows[1]) == set(at[:5])


def test_an_object_without_an_option_has_a_reason(parts):
    scene, candidates = parts
    table = proposals(scene, candidates, np.random.default_rng(4))
    scores = table.log_dp.copy()
    scores[table.object == 2] = -np.inf
    args = scene, candidates, table, scores, []
    rows = arrange(np.random.default_rng(0), *args, (CONFIG, PROGRAM))
    assert [row["is_placed"] for row in rows] == [True, True, False, True]
    assert rows[2]["reason"] == "it fits nowhere"


def test_only_what_labellers_stack_is_stacked_where_it_holds(parts):
    scene, _ = parts
    stacks = np.array([[1, 2, np.log(0.99)], [2, 1, np.log(0.5)]])
    (pair,) = stack_pairs(scene, stacks, {"mouse": 0.25}, CONFIG)
    assert (pair.upper, pair.lower) == (1, 2)
    assert pair.log_score == pytest.approx(np.log(0.25))
    assert stack_pairs(scene, stacks, {"book": 0.25}, CONFIG) == []

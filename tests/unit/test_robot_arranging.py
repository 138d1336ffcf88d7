"""The robot's arrangement is a sequence of steps that the robot can carry out."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from study import study_scene

from placing.artifacts.formats import write_table
from placing.artifacts.plans import read_plans, write_plans
from placing.errors import BadArtifact
from placing.overlap import overlaps
from placing.plans.offering import OPTION_COLUMNS
from placing.plans.robot_arranging import (
    IN_CONFLICT,
    NO_OPTION,
    NOWHERE,
    Robot,
    RobotPlacingConfig,
    Standing,
    arrange,
)
from placing.plans.robot_candidates import Candidate
from placing.plans.robot_plans import INSIDE, WITH, Planned, asked_of_robot
from placing.robot.planning import NO_ARM, NO_PLACE, REJECTED, Motion, Refusal
from placing.scene import standing_box

CONFIG = RobotPlacingConfig(n_arranged=2, n_labels=9, max_calls=200, max_steps=200)
SCENE = study_scene()[0]
ITEMS = {item.object_id: item for item in SCENE.objects}
STANDING = Standing(ITEMS, (), 0.25)


def candidate(name, option, x, y=2.5, score=0.0):
    return Candidate(name, option, 0, True, "area2", (x, y, 0.74), 0.0, score - option)


def motion(item, T):
    return Motion(item.object_id, T, "top", np.array([1.0, 0, 0, 0, 0, 0, 0]), ())


class Arm:
    """A robot that reaches over nothing: what stands at smaller x hides the rest.

    Beyond `true_m` it only believes that it reaches, and so beside `most` objects.
    """

    def __init__(self, reach_m=np.inf, true_m=np.inf, most=9):
        self.reach_m, self.true_m, self.asked = reach_m, true_m, []
        self.most = most
        self.robot = Robot(self.put, self.carry_out)

    def carry_out(self, item, T, boxes):
        found = self.put(item, T, boxes)
        is_rejected = T[4] > self.true_m or len(boxes) >= self.most
        return Refusal(REJECTED, ()) if is_rejected else found

    def put(self, item, T, boxes):
        self.asked.append((item.object_id, T[4], tuple(boxes)))
        if T[4] > self.reach_m:
            return Refusal(NO_PLACE, ())
        hiding = [name for name, box in boxes.items() if box[0] < T[4]]
        return Refusal(NO_ARM, tuple(hiding)) if hiding else motion(item, T)


def test_what_is_far_is_placed_first():
    possible = {
        "mouse1": [candidate("mouse1", 0, 1.0)],
        "mouse2": [candidate("mouse2", 0, 1.5)],
        "shoes": [candidate("shoes", 0, 2.0)],
    }
    robotic = arrange(possible, STANDING, Arm().robot, CONFIG)
    order = [step.candidate.object_id for step in robotic.steps]
    assert order == ["shoes", "mouse2", "mouse1"]
    assert [sorted(step.standing) for step in robotic.steps] == [
        [],
        ["shoes"],
        ["mouse2", "shoes"],
    ]
    assert not robotic.refused


def test_the_best_that_survives_is_taken():
    possible = {"shoes": [candidate("shoes", n, 3.0 - n) for n in range(3)]}
    robotic = arrange(possible, STANDING, Arm(reach_m=2.5).robot, CONFIG)
    assert [step.candidate.option for step in robotic.steps] == [1]


def test_reasons_are_those_of_the_best_candidate():
    possible = {"shoes": [candidate("shoes", 0, 3.0)], "mouse1": []}
    robotic = arrange(possible, STANDING, Arm(reach_m=2.0).robot, CONFIG)
    assert robotic.refused == {"shoes": NO_PLACE, "mouse1": NO_OPTION}
    assert robotic.steps == ()


def test_a_place_out_of_reach_is_asked_for_once_not_by_heading():
    far = candidate("shoes", 0, 3.0)
    turned = [replace(far, heading=n, yaw_rad=n * 0.8) for n in range(3)]
    possible = {"shoes": [*turned, candidate("shoes", 1, 1.0)]}
    arm = Arm(reach_m=2.0)
    robotic = arrange(possible, STANDING, arm.robot, CONFIG)
    assert [x for _, x, _ in arm.asked] == [3.0, 1.0, 1.0]
    assert [step.candidate.option for step in robotic.steps] == [1]


def test_given_objects_that_hide_a_place_make_it_infeasible_alone():
    given = SCENE.arrangements[0].placements[:1]
    possible = {"shoes": [candidate("shoes", 0, 2.0)]}
    arm = Arm()
    robotic = arrange(possible, replace(STANDING, given=given), arm.robot, CONFIG)
    assert robotic.refused == {"shoes": NO_ARM}
    assert arm.asked == [("shoes", 2.0, ("laptop1",))]


def test_what_cannot_be_carried_out_is_ruled_out_and_an_order_is_sought_again():
    possible = {
        "mouse1": [candidate("mouse1", n, 2.2 - n) for n in range(2)],
        "shoes": [candidate("shoes", 0, 1.7)],
    }
    arm = Arm(true_m=2.0)
    robotic = arrange(possible, STANDING, arm.robot, CONFIG)
    done = [(step.candidate.object_id, step.candidate.option) for step in robotic.steps]
    assert done == [("shoes", 0), ("mouse1", 1)]
    (rejected,) = {t.candidate.option for t in robotic.tried if t.reason == REJECTED}
    assert rejected == 0


@pytest.mark.parametrize("most", [1, 2])
def test_what_is_rejected_beside_others_is_left_out_in_the_end(most):
    names = ("mouse1", "mouse2", "shoes")
    possible = {
        name: [candidate(name, n, 1.0 + 0.3 * k + 1.2 * n) for n in range(2)]
        for k, name in enumerate(names)
    }
    robotic = arrange(possible, STANDING, Arm(most=most).robot, CONFIG)
    assert len(robotic.steps) == most
    assert len(robotic.refused) == 3 - most


def test_of_objects_in_conflict_the_less_likely_is_left_out():
    possible = {
        "mouse1": [candidate("mouse1", 0, 1.0, score=-5)],
        "mouse2": [candidate("mouse2", 0, 1.1, score=-1)],
    }
    robotic = arrange(possible, STANDING, Arm().robot, CONFIG)
    assert robotic.refused == {"mouse1": IN_CONFLICT}
    assert [step.candidate.object_id for step in robotic.steps] == ["mouse2"]


def test_random_plans_can_be_carried_out_again():
    rng = np.random.default_rng(0)
    n_placed = 0
    for _ in range(50):
        names = ["mouse1", "mouse2", "shoes"]
        possible = {
            name: [
                candidate(name, n, *rng.uniform([0.8, 2.3], [2.2, 2.9]))
                for n in range(4)
            ]
            for name in names
        }
        arm = Arm(reach_m=2.0)
        robotic = arrange(possible, STANDING, arm.robot, CONFIG)
        assert len(robotic.steps) + len(robotic.refused) == 3
        assert len(robotic.tried) + len(robotic.steps) == len(arm.asked)
        boxes = {}
        for step in robotic.steps:
            item = ITEMS[step.candidate.object_id]
            placement = step.candidate.placement(item)
            T = placement.T_world_object
            assert isinstance(Arm(reach_m=2.0).put(item, T, boxes), Motion)
            box = standing_box(item, placement)
            if boxes:
                assert not overlaps(box[None], np.array(list(boxes.values()))).any()
            boxes[item.object_id] = box
        n_placed += len(robotic.steps)
    assert n_placed > 100


def option_rows():
    for question in asked_of_robot(SCENE, "filled", 9):
        for item in question.wanted:
            for option in range(3):
                x = 2.1 - 0.3 * option - 0.05 * (item.object_id == "mouse2")
                named = (SCENE.scene, "filled", question.name, question.labels)
                row = (*named, item.object_id, item.category, option, True, "area2")
                yield (*row, x, 2.9, 0.74, 0.0, -1.0 * option, 0.0)


def anywhere(item, T, boxes):
    return motion(item, T)


@pytest.fixture
def planned():
    options = pd.DataFrame(option_rows(), columns=list(OPTION_COLUMNS))
    planned = Planned("rooms", options, 0.25, CONFIG)
    planned.add(SCENE, Robot(anywhere, anywhere))
    return planned


def test_every_wanted_object_has_a_row_under_both_constraints(planned):
    plans = planned.plans()
    plans = plans[plans["task"] == "filled"]
    asked = asked_of_robot(SCENE, "filled", 9)
    assert {q.name.split("/")[1] for q in asked} == {"mouse", "shoe"}
    n = sum(len(q.wanted) for q in asked)
    assert plans["constraints"].value_counts().to_dict() == {WITH: n, INSIDE: n}
    n_certified = sum(c.world.task == "filled" for c in planned.certificates)
    assert n_certified == (plans["status"] == "placed").sum()
    assert (
        len(planned.tried())
        == plans.drop_duplicates(["question", "constraints"])["n_calls"].sum()
    )


def test_where_the_robot_cannot_stand_every_object_is_refused_with_that_reason():
    options = pd.DataFrame(option_rows(), columns=list(OPTION_COLUMNS))
    planned = Planned("rooms", options, 0.25, CONFIG)
    planned.add(SCENE, NOWHERE)
    plans = planned.plans()
    offered = plans[plans["task"] == "filled"]
    assert (plans["status"] == "refused").all()
    assert set(offered["reason"]) == {NO_PLACE}
    assert planned.certificates == []


def test_plans_come_back_and_damage_is_one_line(tmp_path, planned):
    plans = planned.plans()
    write_plans(tmp_path / "p.parquet", plans)
    pd.testing.assert_frame_equal(read_plans(tmp_path / "p.parquet"), plans)
    write_table(tmp_path / "q.parquet", plans.assign(constraints="none"))
    with pytest.raises(BadArtifact, match="constraints: value 'none'; expected one"):
        read_plans(tmp_path / "q.parquet")
    write_table(tmp_path / "r.parquet", plans.assign(qw=np.nan))
    with pytest.raises(BadArtifact, match="expected a pose of every object"):
        read_plans(tmp_path / "r.parquet")

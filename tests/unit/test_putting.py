"""Putting and picking: whole motions, verified, refused with the right reason."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from robot_room import CONFIG as CHECKING
from robot_room import SETTLING, TOP_M, checker, pieces, pr2
from test_driving import CONFIG, floor
from test_grasps import ITEMS, SHEET

from placing import rigid
from placing.errors import BadInput
from placing.physics.cutting import bodies_of
from placing.robot.blame import cover
from placing.robot.errands import Errand
from placing.robot.exact import Exact
from placing.robot.held_shapes import carried, cells_of
from placing.robot.model import tool_pose
from placing.robot.planning import PICKING, PUTTING, TOO_WIDE, Motion, Refusal
from placing.robot.putting import Placer
from placing.robot.seeking import Seeker
from placing.robot.truth import Truth
from placing.scene import standing_at

CAN = ITEMS["soda_can"]
BODIES = bodies_of([CAN, ITEMS["broom"]], SETTLING.margin_m)
PLACE = rigid.from_yaw(0.0, (2.95, 1.5, TOP_M + 0.061 + 0.005))


@cache
def placer():
    truth = Truth(pr2(), pieces(), CHECKING, SETTLING).__enter__()
    exact = Exact(truth, BODIES, SETTLING.margin_m, CONFIG.contact_m)
    return placer_with(exact)


def placer_with(exact):
    return Placer(Seeker(checker(), floor(), exact, SHEET, CONFIG, 1), exact)


def to_put(item, T, boxes, grasp="", start=None):
    return Errand(True, item, T, boxes, grasp, start)


@cache
def put():
    motion = placer().carried_out(to_put(CAN, PLACE, {}))
    assert isinstance(motion, Motion), motion
    return motion


def test_a_can_is_put_on_a_table_in_joined_segments():
    motion = put()
    assert tuple(s.name for s in motion.segments) == PUTTING
    assert [s.is_holding for s in motion.segments] == [True] * 4 + [False] * 2
    for one, other in zip(motion.segments[:-1], motion.segments[1:], strict=True):
        a, b = one.path[-1].copy(), other.path[0].copy()
        a[2], b[2] = rigid.wrap(a[2]), rigid.wrap(b[2])
        assert np.allclose(a, b, atol=1e-6), (one.name, other.name)


def test_the_object_is_let_go_where_it_touches():
    motion = put()
    assert np.isclose(motion.T_world_object[6], TOP_M + 0.061, atol=0.003)
    q = motion.segments[3].path[-1]
    held = rigid.compose(tool_pose(pr2(), q), motion.T_tool_object)
    assert np.allclose(held[4:6], PLACE[4:6], atol=1e-5)
    assert 0 <= held[6] - motion.T_world_object[6] < 0.03


def test_the_same_question_has_the_same_answer():
    again = placer_with(placer().exact).carried_out(to_put(CAN, PLACE, {}))
    for one, other in zip(put().segments, again.segments, strict=True):
        assert np.array_equal(one.path, other.path)


def test_what_stands_on_the_place_is_to_blame():
    other = rigid.from_yaw(0.0, (2.95, 1.5, TOP_M + 0.1))
    boxes = {"tall": np.array([*other[4:], 0.1, 0.1, 0.2, 0.0])}
    boxes["far"] = np.array([3.3, 0.9, TOP_M + 0.05, 0.05, 0.05, 0.1, 0.0])
    refusal = placer().carried_out(to_put(CAN, PLACE, boxes))
    assert isinstance(refusal, Refusal)
    assert refusal.blockers == ("tall",)


def test_a_motion_among_boxes_is_free_of_them():
    boxes = {"near": np.array([2.8, 1.75, TOP_M + 0.1, 0.1, 0.1, 0.2, 0.0])}
    motion = placer().carried_out(to_put(CAN, PLACE, boxes))
    assert isinstance(motion, Motion), motion
    among = checker().with_boxes(np.array(list(boxes.values())))
    assert all(among.are_free(s.path).all() for s in motion.segments[:3])


def test_a_known_motion_is_taken_where_it_is_free_and_no_other():
    far = {"far": np.array([0.3, 2.7, 0.2, 0.1, 0.1, 0.4, 0.0])}
    known = placer().planned(to_put(CAN, PLACE, {}))
    assert placer().planned(to_put(CAN, PLACE, far)) is known
    x, y = known.segments[0].path[-1, :2]
    there = {**far, "there": np.array([x, y, 0.2, 0.1, 0.1, 0.4, 0.0])}
    other = placer().planned(to_put(CAN, PLACE, there))
    among = checker().with_boxes(np.array([*there.values()]))
    assert isinstance(other, Motion)
    assert other is not known
    assert all(among.is_path_free(s.path) for s in other.segments[:1])


def test_what_was_put_down_is_picked_up_by_the_same_grasp():
    done = put()
    start = done.segments[-1].path[-1]
    errand = Errand(False, CAN, done.T_world_object, {}, done.grasp, start)
    motion = placer().carried_out(errand)
    assert isinstance(motion, Motion), motion
    assert tuple(s.name for s in motion.segments) == PICKING
    assert motion.grasp == done.grasp
    assert np.allclose(motion.segments[0].path[0][:3], start[:3])


def test_what_is_too_wide_is_refused():
    wide = replace(CAN, object_id="drum", size_m=(0.3, 0.3, 0.3))
    bodies = {**BODIES, "drum": BODIES["soda_can"]}
    exact = Exact(placer().exact.truth, bodies, SETTLING.margin_m, 0.03)
    other = placer_with(exact)
    assert other.planned(to_put(wide, PLACE, {})) == Refusal(TOO_WIDE, ())


def test_a_start_in_collision_is_one_line():
    start = floor().start.copy()
    start[:2] = 3.2, 1.5
    with pytest.raises(
        BadInput, match=r"room: start: the robot pr2 at x 3.2.*collision"
    ):
        placer().planned(to_put(CAN, PLACE, {}, start=start))


def test_spheres_of_what_is_held_cover_its_shape_and_leave_out_its_air():
    broom = ITEMS["broom"]
    T = np.array([1.0, 0, 0, 0, 0, 0, 0])
    held = carried("broom", broom.size_m, cells_of(BODIES["broom"]), T)
    corners = BODIES["broom"].corners_m
    away = np.linalg.norm(corners[:, None] - held.centre_m, axis=2) - held.radius_m
    assert (away.min(1) <= 1e-9).all()
    beside_the_pole = np.array([0.0, 0.15, 0.3])
    gaps = np.linalg.norm(held.centre_m - beside_the_pole, axis=1) - held.radius_m
    assert gaps.min() > 0


def test_the_cover_of_sets_meets_each_of_them():
    assert cover([{1, 2}, {2, 3}, {2}, {5}]) == [2, 5]


def test_a_box_around_an_object_holds_its_corners():
    box = standing_at(CAN, PLACE)
    assert np.allclose(box[:3], PLACE[4:])
    assert np.allclose(box[3:6], CAN.size_m)


def test_the_exact_check_holds_the_fingers_as_the_motion_does(monkeypatch):
    exact, held = placer().exact, []
    hold = exact.truth.open_fingers
    monkeypatch.setattr(
        exact.truth, "open_fingers", lambda m: (held.append(m), hold(m))
    )
    exact.stand({})
    assert exact.complaint(put(), CAN) == ""
    assert set(held) == {s.opening_m for s in put().segments}
    assert len(set(held)) == 2

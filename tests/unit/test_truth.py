"""The exact check sees true meshes, moves what is held, and allows a touch."""

from dataclasses import replace

import numpy as np
import pybullet
import pytest
from robot_room import (
    CONFIG,
    SETTLING,
    TOP_M,
    anywhere,
    block,
    checker,
    meshes,
    pieces,
    pr2,
    reaching,
    stowed,
)

from placing import rigid
from placing.physics.bodies import Piece
from placing.physics.cutting import body_of
from placing.robot.model import fixed_values, link_poses, tool_pose
from placing.robot.truth import Truth, silence

HIGH = reaching()
MUG = body_of(block((0.06, 0.06, 0.14), (0, 0, 0)), 0.3, SETTLING.margin_m)


@pytest.fixture
def truth():
    with Truth(pr2(), pieces(), CONFIG, SETTLING) as world:
        yield world


def upright(q, drop_m=0.0):
    """Return an upright object in the tool, `T_tool_object`."""
    tool = tool_pose(pr2(), q)
    at = rigid.from_yaw(0.0, tool[4:] - [0, 0, drop_m])
    return rigid.compose(rigid.inverse(tool), at)


def test_in_the_open_nothing_is_hit_and_a_wall_is(truth):
    assert truth.hits(stowed(1.5, 1.5)) == ()
    assert "base_link/wall" in truth.hits(stowed(0.2, 1.5))
    assert any(hit.endswith("/table") for hit in truth.hits(stowed(3.2, 1.5)))
    assert truth.hits(stowed(1.5, 1.5)) == ()


def test_its_links_are_where_the_model_says(truth):
    q = anywhere(0, 1)[0]
    truth._set(q)
    poses = link_poses(pr2().tree, q)
    values = fixed_values(pr2().settings, pr2().description, 0.086)
    for i, name in truth._links.items():
        if i < 0:
            continue
        state = pybullet.getLinkState(truth._robot, i, physicsClientId=truth._client)
        expected = poses[pr2().links.index(name), :3, 3]
        assert state[4] == pytest.approx(expected, abs=1e-5)
        joint = pybullet.getJointInfo(truth._robot, i, truth._client)
        if joint[1].decode() in values:
            found = pybullet.getJointState(truth._robot, i, truth._client)[0]
            assert found == pytest.approx(values[joint[1].decode()])


def test_it_hits_itself_where_the_hand_meets_the_body(truth):
    hits = [
        truth.hits(q) for q in anywhere(1, 60) * [0, 0, *[1] * 9] + stowed(2, 1.5) * 0
    ]
    links = set(pr2().links)
    assert any(links.issuperset(hit.split("/")) for found in hits for hit in found)


def test_an_object_is_hit_until_it_is_taken_away(truth):
    mug = rigid.from_yaw(0.0, (1.5, 1.5, 0.5))
    truth.put("mug", MUG, mug)
    assert "base_link/mug" in truth.hits(stowed(1.5, 1.5))
    truth.put("mug", MUG, rigid.from_yaw(0.0, (3.2, 1.5, TOP_M + 0.07)))
    assert truth.hits(stowed(1.5, 1.5)) == ()
    truth.put("mug", MUG, mug)
    truth.remove("mug")
    assert truth.hits(stowed(1.5, 1.5)) == ()


def test_what_is_held_moves_along_and_only_the_gripper_may_touch_it(truth):
    T = upright(HIGH)
    truth.put("mug", MUG, rigid.from_yaw(0.0, (3.2, 1.5, 2.0)))
    assert truth.hits(HIGH, "mug", T) == ()
    at = rigid.compose(tool_pose(pr2(), HIGH), T)
    aside = rigid.compose(rigid.from_yaw(0.0, (0.0, 0.03, 0.0)), at)
    truth.put("mug", MUG, aside)
    assert any(hit.endswith("/mug") for hit in truth.hits(HIGH))
    assert truth.hits(HIGH, "mug") == ()
    q = HIGH.copy()
    q[0] += 0.2
    assert truth.hits(q, "mug", T) == ()
    found = pybullet.getBasePositionAndOrientation(
        truth._standing["mug"][0], truth._client
    )
    assert found[0] == pytest.approx(np.add(at[4:], (0.2, 0, 0)), abs=1e-6)


def test_what_was_held_through_a_table_does_not_stick_to_it():
    table = meshes()["table"]
    triangles = {"table": (Piece(table.vertices, table.faces, False),)}
    tool = rigid.inverse(tool_pose(pr2(), HIGH))
    with Truth(pr2(), triangles, CONFIG, SETTLING) as truth:
        for z, found in ((TOP_M + 0.068, ("mug/table",)), (TOP_M - 0.3, ())):
            at = rigid.from_yaw(0.0, (3.0, 1.2, z))
            truth.put("mug", MUG, at)
            assert truth.hits(HIGH, "mug", rigid.compose(tool, at)) == found


def test_a_table_of_triangles_is_hit_as_its_convex_parts_are():
    table = meshes()["table"]
    triangles = (Piece(table.vertices, table.faces, False),)
    rows, answers = anywhere(3, 150), []
    rows[:, 0] = 2.6
    for furniture in (triangles, pieces()["table"]):
        with Truth(pr2(), {"table": furniture}, CONFIG, SETTLING) as truth:
            answers.append([truth.hits(q) for q in rows])
    assert answers[0] == answers[1]


@pytest.mark.parametrize(
    ("overlap_m", "touching", "is_hit"),
    [
        (-0.003, False, False),
        (0.003, False, True),
        (0.003, True, False),
        (0.02, True, True),
    ],
)
def test_a_touch_is_allowed_while_putting_down(truth, overlap_m, touching, is_hit):
    T = upright(HIGH)
    low = tool_pose(pr2(), HIGH)[4:] - [0, 0, 0.07]
    slab = body_of(block((0.1, 0.1, 0.02), (0, 0, 0)), 1.0, SETTLING.margin_m)
    truth.put("mug", MUG, rigid.from_yaw(0.0, (0, 0, 9)))
    truth.put("slab", slab, rigid.from_yaw(0.0, low - [0, 0, 0.01 - overlap_m]))
    assert truth.hits(HIGH, "mug", T, touching) == (("mug/slab",) if is_hit else ())


def test_a_path_is_checked_between_its_rows(truth):
    path = np.array([stowed(1.2, 1.5), stowed(1.2, 2.3), stowed(2.2, 2.3)])
    assert truth.check_path(path) == ""
    post = body_of(block((0.02, 0.02, 1.0), (0, 0, 0.5)), 1.0, SETTLING.margin_m)
    truth.put("post", post, rigid.from_yaw(0.0, (2.0, 2.3, 0.1)))
    assert truth.check_path(path).endswith("/post after row 1")


def test_what_is_let_go_stays_on_the_table_and_falls_beside_it(truth):
    truth.put("mug", MUG, rigid.from_yaw(0.0, (3.2, 1.5, TOP_M + 0.072)))
    assert truth.let_go("mug", 0.0, 0.0) == ""
    truth.put("mug", MUG, rigid.from_yaw(0.0, (2.7, 1.5, TOP_M + 0.072)))
    assert "fell" in truth.let_go("mug", 0.0, 0.0)


def test_one_object_carries_another(truth):
    book = body_of(block((0.3, 0.2, 0.04), (0, 0, 0)), 1.0, SETTLING.margin_m)
    truth.put("book", book, rigid.from_yaw(0.0, (3.2, 1.5, TOP_M + 0.021)))
    truth.put("mug", MUG, rigid.from_yaw(0.0, (3.2, 1.5, TOP_M + 0.113)))
    assert truth.let_go("mug", 0.0, 0.0) == ""
    truth.remove("book")
    assert "moved" in truth.let_go("mug", 0.0, 0.0)


def test_the_terminal_stays_quiet(capfd):
    with Truth(pr2(), pieces(), CONFIG, SETTLING):
        pass
    assert capfd.readouterr() == ("", "")
    with silence():
        pass
    print("still there")
    assert capfd.readouterr().out == "still there\n"


def test_finer_steps_find_more():
    path = np.array([stowed(1.2, 1.5), stowed(2.3, 2.3, 1.0)])
    coarse, fine = replace(CONFIG, exact_step_m=5.0), CONFIG
    post = body_of(block((0.02, 0.02, 1.0), (0, 0, 0.5)), 1.0, SETTLING.margin_m)
    answers = []
    for config in (coarse, fine):
        with Truth(pr2(), pieces(), config, SETTLING) as world:
            world.put("post", post, rigid.from_yaw(0.0, (1.6, 2.0, 0.1)))
            answers.append(bool(world.check_path(path)))
    assert answers == [False, True]
    assert checker().config.exact_step_m < checker().config.step_m


def test_shut_fingers_reach_where_open_ones_do_not(truth):
    tool = tool_pose(pr2(), HIGH)
    truth.open_fingers(0.0)
    block_m = body_of(block((0.02, 0.2, 0.2), (0, 0, 0)), 1.0, SETTLING.margin_m)
    for ahead_m in np.arange(0.06, 0.0, -0.001):
        at = rigid.compose(tool, rigid.from_yaw(0.0, (ahead_m, 0.0, 0.0)))
        truth.put("plate", block_m, at)
        if truth.hits(HIGH):
            break
    assert {hit.split("_")[-1] for hit in truth.hits(HIGH)} == {"link/plate"}
    truth.open_fingers(pr2().settings.max_opening_m)
    assert truth.hits(HIGH) == ()


def test_fingers_may_reach_into_what_they_hold_but_not_through_it(truth):
    small, T = (0.02, 0.02, 0.02), rigid.from_yaw(0.0, (0.0, 0.0, 0.0))
    truth.open_fingers(0.0)
    at = rigid.compose(tool_pose(pr2(), HIGH), T)
    truth.put("nut", body_of(block(small, (0, 0, 0)), 0.1, SETTLING.margin_m), at)
    assert truth.hits(HIGH, "nut", T) == ()
    block_m = body_of(block((0.12, 0.3, 0.3), (0, 0, 0)), 1.0, SETTLING.margin_m)
    truth.put("block", block_m, at)
    assert any(hit.endswith("/block") for hit in truth.hits(HIGH, "block", T))


def test_the_base_rolls_over_what_is_low_and_no_higher(truth):
    for top_m, is_hit in ((0.02, False), (0.1, True)):
        plate = body_of(block((0.3, 0.3, top_m), (0, 0, 0)), 1.0, SETTLING.margin_m)
        truth.put("plate", plate, rigid.from_yaw(0.0, (1.5, 1.5, top_m / 2)))
        assert bool(truth.hits(stowed(1.5, 1.5))) is is_hit
        truth.remove("plate")

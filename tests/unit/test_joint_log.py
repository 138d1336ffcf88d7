"""A joint log is whole, the same in every run, and read by who did not write it."""

import subprocess
import sys
from dataclasses import replace
from functools import cache
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from certified import CAN, CONFIG, certificate, settings
from hypothesis import given
from hypothesis import strategies as st
from mcap_ros2._dynamic import serialize_dynamic
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from placing import rigid
from placing.logs.joint_encoding import transforms
from placing.logs.joint_log import PLANAR, write_log
from placing.logs.joint_messages import DEFINITIONS
from placing.logs.planning_result import PlanningResult
from placing.robot.box_urdf import box_urdf
from placing.robot.film import PlaybackConfig, durations, film, stretches
from placing.robot.model import link_poses, load_robot
from placing.robot.posing import link_poses_over, moving_joints
from placing.robot.urdf import read_urdf

RERUN = Path(sys.executable).with_name("rerun")
PLAYBACK = PlaybackConfig(**CONFIG["playback"])
RESULT = "placing_msgs/msg/PlanningResult"


@cache
def robot():
    return load_robot(settings())


@cache
def certificates():
    """Return a can that is picked up and put down, and a block that is handed over."""
    first = certificate()
    later = replace(first, object_id="block1", T_world_start=None)
    return first, replace(later, segments=first.segments[2:])


@cache
def parts():
    plan = stretches(certificates(), PLAYBACK)
    return plan, film(certificates(), robot(), PLAYBACK)


def result():
    targets = {c.object_id: c.T_world_object for c in certificates()}
    order, refused = ("can1", "block1"), {"pan1": "no path"}
    return PlanningResult("test", "pillars", "empty", "inside", order, refused, targets)


def write(path):
    write_log(path, robot(), result(), *parts())
    return path


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return write(tmp_path_factory.mktemp("log") / "pillars.mcap")


def read(path, topic):
    """Return times and messages of a topic as a reader without this project does."""
    with AnyReader([path]) as reader:  # it has no other types than those of the file
        channels = [c for c in reader.connections if c.topic == topic]
        return [
            (time, reader.deserialize(data, channel.msgtype))
            for channel, time, data in reader.messages(channels)
        ]


def check(path):
    command = [RERUN, "mcap", "check", "--full", path]
    return subprocess.run(command, capture_output=True, check=False).returncode


def test_the_same_plan_gives_the_same_bytes(log, tmp_path):
    again = write(tmp_path / "again.mcap")
    digests = {sha256(path.read_bytes()).digest() for path in (log, again)}
    assert len(digests) == 1


def test_no_version_of_a_library_is_named(log):
    assert b"mcap-python" not in log.read_bytes()


def test_a_log_is_whole_and_a_truncated_one_is_not(log, tmp_path):
    assert check(log) == 0
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(log.read_bytes()[:-1000])
    assert check(broken) != 0


def test_another_reader_finds_the_result_with_the_definition_in_the_file(log):
    ((time, message),) = read(log, "/planning_result")
    assert time == 0
    assert (message.scene, message.constraints) == ("pillars", "inside")
    assert message.order == ["can1", "block1"]
    assert (message.refused, message.reasons) == (["pan1"], ["no path"])


def test_definitions_are_those_of_ros():
    known = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in DEFINITIONS.items():
        if name == RESULT:
            continue
        for part in text.split("=" * 80):
            head, _, body = part.strip().partition("\n")
            kind = name if not head.startswith("MSG: ") else head[5:]
            fields = body if head.startswith("MSG: ") else part
            kind = kind if "/msg/" in kind else kind.replace("/", "/msg/")
            if kind.startswith("builtin"):
                continue
            parsed = get_types_from_msg(fields, kind)[kind][1]
            want = known.fielddefs[kind][1]
            assert [f[0] for f in parsed] == [f[0] for f in want], kind
            assert [str(f[1]) for f in parsed] == [str(f[1]) for f in want], kind


def test_trajectories_are_the_segments_of_the_plan(log):
    plan, _ = parts()
    found = read(log, "/planned_trajectory")
    assert len(found) == len(plan)
    names = [*PLANAR, robot().settings.torso, *robot().settings.chain]
    for (time, message), stretch in zip(found, plan, strict=True):
        assert time == pytest.approx(stretch.time_s[0] * 1e9, abs=1)
        assert message.joint_names == names
        rows = np.array([point.positions for point in message.points])
        np.testing.assert_array_equal(rows, stretch.q)
        ends = message.points[-1].time_from_start
        lasts = stretch.time_s[-1] - stretch.time_s[0]
        assert ends.sec + ends.nanosec / 1e9 == pytest.approx(lasts, abs=1e-8)


def matrix(transform):
    t, r = transform.translation, transform.rotation
    return rigid.homogeneous(np.array([r.w, r.x, r.y, r.z, t.x, t.y, t.z]))


def test_transforms_put_every_link_where_the_robot_has_it(log):
    ((_, still),) = read(log, "/tf_static")
    edges = {t.child_frame_id: t for t in still.transforms}
    _, shown = parts()
    moving = read(log, "/tf")
    poses = link_poses_over(robot(), shown.q, shown.opening_m)
    for i in (0, len(moving) // 2, len(moving) - 1):
        time, message = moving[i]
        assert time == pytest.approx(shown.time_s[i] * 1e9, abs=1)
        now = edges | {t.child_frame_id: t for t in message.transforms}
        for link in robot().links:
            T, frame = np.eye(4), link
            while frame != "map":
                T = matrix(now[frame].transform) @ T
                frame = now[frame].header.frame_id
            np.testing.assert_allclose(T, poses[link][i], atol=1e-9)


def test_the_can_is_said_to_go_from_its_start_to_its_target(log):
    seen = [
        matrix(t.transform)
        for _, message in read(log, "/tf")
        for t in message.transforms
        if t.child_frame_id == "object/can1"
    ]
    first = certificates()[0]
    np.testing.assert_allclose(seen[0], rigid.homogeneous(first.T_world_start))
    np.testing.assert_allclose(seen[-1], rigid.homogeneous(first.T_world_object))
    ((_, target),) = read(log, "/placement/can1")
    at = target.pose.position
    np.testing.assert_allclose([at.x, at.y, at.z], first.T_world_object[4:])


def test_joint_states_hold_the_joints_that_move(log):
    _, shown = parts()
    states = read(log, "/joint_states")
    assert [m.name for _, m in states[:1]] == [list(moving_joints(robot().settings))]
    arm = np.array([m.position[1:8] for _, m in states])
    np.testing.assert_array_equal(arm, shown.q[:, 4:])


def test_the_description_moves_as_the_robot_does(log, tmp_path):
    ((_, message),) = read(log, "/robot_description")
    assert message.data == box_urdf(robot())
    path = tmp_path / "boxes.urdf"
    path.write_text(message.data)
    found = read_urdf(path, tmp_path)  # no mesh that it could miss
    assert set(found.links) == set(robot().description.links)
    assert {s.kind for s in found.shapes} == {"box"}
    for name, joint in robot().description.joints.items():
        again = found.joints[name]
        np.testing.assert_allclose(
            again.T_parent_joint, joint.T_parent_joint, atol=1e-8
        )
        if joint.kind != "fixed":
            np.testing.assert_allclose(again.axis, joint.axis, atol=1e-8)
        assert (again.kind, again.parent) == (joint.kind, joint.parent)


def test_the_viewer_draws_the_log(log, tmp_path):
    command = [RERUN, "mcap", "convert", log, "-o", tmp_path / "log.rrd"]
    subprocess.run(command, check=True, capture_output=True)
    assert (tmp_path / "log.rrd").stat().st_size > 10_000


NAMES = st.text(max_size=9)


@given(st.lists(st.tuples(NAMES, NAMES), max_size=5), st.integers(0, 2**60))
def test_transforms_are_encoded_as_the_encoder_for_any_message_does(edges, time_ns):
    kind = "tf2_msgs/msg/TFMessage"
    encode = serialize_dynamic(kind, DEFINITIONS[kind])[kind]
    poses = np.random.default_rng(0).normal(size=(len(edges), 7))
    stamp = dict(zip(("sec", "nanosec"), divmod(time_ns, 10**9), strict=True))
    told = [
        {
            "header": {"stamp": stamp, "frame_id": parent},
            "child_frame_id": child,
            "transform": {
                "translation": dict(zip("xyz", row[:3], strict=True)),
                "rotation": dict(zip("xyzw", row[3:], strict=True)),
            },
        }
        for (parent, child), row in zip(edges, poses.tolist(), strict=True)
    ]
    expected = encode({"transforms": told})
    assert transforms(tuple(edges), time_ns, poses) == expected


# What the log is made of: times and poses.


def test_no_axis_is_faster_than_its_speed():
    plan, _ = parts()
    for stretch in plan:
        step = np.abs(np.diff(stretch.q, axis=0)) / np.diff(stretch.time_s)[:, None]
        limits = [PLAYBACK.base_m_s] * 2 + [PLAYBACK.turn_rad_s, PLAYBACK.torso_m_s]
        limits += [PLAYBACK.arm_rad_s] * 7
        assert (step <= np.array(limits) * (1 + 1e-9)).all()
        if len(stretch.q) > 1 and stretch.phase != "gripper":
            assert (step / limits).max() == pytest.approx(1, abs=1e-6)


def test_times_increase_and_every_end_is_a_frame():
    plan, shown = parts()
    assert (np.diff(shown.time_s) > 0).all()
    assert np.diff(shown.time_s).max() <= PLAYBACK.pause_s + 1e-9
    for stretch in plan:
        at = np.flatnonzero(shown.time_s == stretch.time_s[-1])
        np.testing.assert_array_equal(shown.q[at[0]], stretch.q[-1])


def test_an_object_is_in_the_hand_while_it_is_held_and_nowhere_before():
    _, shown = parts()
    for k, one in enumerate(certificates()):
        poses = shown.T_world_objects[:, k]
        held = np.flatnonzero(shown.held == k)
        for i in held[:: max(1, len(held) // 7)]:
            tool = robot().links.index(robot().settings.tool_frame)
            T_world_tool = link_poses(robot().tree, shown.q[i])[tool]
            T = T_world_tool @ rigid.homogeneous(one.T_tool_object)
            np.testing.assert_allclose(rigid.homogeneous(poses[i]), T, atol=1e-9)
        before, after = poses[: held[0]], poses[held[-1] + 1 :]
        np.testing.assert_array_equal(
            after, np.tile(one.T_world_object, (len(after), 1))
        )
        if one.T_world_start is None:
            assert np.isnan(before).all()
        else:
            start = np.tile(one.T_world_start, (len(before), 1))
            np.testing.assert_array_equal(before, start)
    assert shown.objects == (CAN.object_id, "block1")


def test_links_are_where_the_model_has_them_when_the_gripper_is_open():
    _, shown = parts()
    wide = np.full(len(shown.q), robot().settings.max_opening_m)
    poses = link_poses_over(robot(), shown.q, wide)
    for i in (0, len(shown.q) // 3, len(shown.q) - 1):
        expected = link_poses(robot().tree, shown.q[i])
        found = np.array([poses[link][i] for link in robot().links])
        np.testing.assert_allclose(found, expected, atol=1e-9)


def test_fingers_close_on_what_is_held():
    _, shown = parts()
    poses = link_poses_over(robot(), shown.q, shown.opening_m)
    tips = [poses[f"r_gripper_{side}_finger_tip_link"][:, :3, 3] for side in "lr"]
    gap = np.linalg.norm(tips[0] - tips[1], axis=1)
    assert gap[shown.held >= 0].max() < gap[shown.opening_m > 0.08].min() - 0.01


SPEEDS = {0: "base_m_s", 1: "base_m_s", 2: "turn_rad_s", 3: "torso_m_s"}
SPEEDS |= {4: "arm_rad_s", 10: "arm_rad_s"}


@pytest.mark.parametrize(("column", "speed"), SPEEDS.items())
def test_each_axis_alone_moves_at_its_speed(column, speed):
    path = np.zeros((2, 11))
    path[1, column] = -0.3
    expected = 0.3 / getattr(PLAYBACK, speed)
    assert durations(path, PLAYBACK) == pytest.approx([expected])

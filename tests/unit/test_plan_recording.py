"""The recording of a plan shows the robot, what it moves and what it tried."""

import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from certified import BLOCK, CAN, CONFIG, certificate, settings
from recorded import count_rows
from rerun.chunk import RrdReader

from placing.clouds.ply import Cloud
from placing.errors import BadArtifact
from placing.methods.answer_tables import LOCATION, ORIENTATION
from placing.pictures.robot import part_meshes
from placing.recordings.plan import Search, Tried, phases, plan_recording, turns
from placing.recordings.plan_blueprint import write_plan
from placing.recordings.plan_entities import lit_mesh
from placing.recordings.plan_tables import in_order, result_of, search_of
from placing.recordings.plan_words import COLOURS, moments, story
from placing.robot.film import PlaybackConfig
from placing.robot.model import link_poses, load_robot
from placing.robot.planning import REASONS
from placing.scene import PlacingArea, Scene

RERUN = Path(sys.executable).with_name("rerun")
PLAYBACK = PlaybackConfig(**CONFIG["playback"])
MAX_BYTES = 6_000_000
OTHER = replace(BLOCK, object_id="block2")


@cache
def robot():
    return load_robot(settings())


def plan():
    """Return a can that is picked up and put down, and a block that is handed over."""
    first = replace(certificate(), standing={"block2": np.array([1.0] + [0.0] * 6)})
    later = replace(first, object_id="block1", T_world_start=None)
    return [first, replace(later, segments=first.segments[2:])]


def tried_rows():
    """Return what was tried: the block in vain once, the other block always."""
    T = [0.5, 0.2, 0.9, 1.0, 0, 0, 0]
    rows = [("can1", "", "", ""), ("block1", "no path", "can1", "can1")]
    rows += [("block1", "", "can1", ""), ("block2", "goal in collision", "", "")]
    columns = ["object", "reason", "among", "blockers", *LOCATION, *ORIENTATION]
    return pd.DataFrame([(*row, *T) for row in rows], columns=columns)


def plan_rows():
    """Return the rows of the robot's table, not in the order of the plan."""
    rows = [("block2", "refused", "goal in collision", -1, "", 4)]
    rows += [("block1", "placed", "", 1, "top1", 4), ("can1", "placed", "", 0, "s1", 4)]
    columns = ["object", "status", "reason", "order", "grasp", "n_calls"]
    return pd.DataFrame(rows, columns=columns)


@cache
def content():
    square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    areas = (
        PlacingArea("floor", 2 * square, 0.0, np.inf, True, None),
        PlacingArea("area1", square / 4, 0.8, np.inf, False, None),
    )
    scene = Scene("pillars", "office", areas, (CAN, BLOCK, OTHER), ())
    points = np.random.default_rng(0).uniform([-2, -2, 0], [2, 2, 2], (2000, 3))
    points, grey = points.astype(np.float32), np.full((2000, 3), 150, np.uint8)
    cloud = Cloud(points, np.zeros_like(points), grey)
    search = search_of(plan_rows(), tried_rows())
    return plan_recording(0, scene, cloud, robot(), plan(), search, PLAYBACK)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("plan") / "pillars.rrd"
    write_plan(path, content())
    return path


def rows(path, entity):
    """Return the temporal rows of an entity as columns by name, times in seconds."""
    batches = [
        chunk.to_record_batch().to_pandas()
        for chunk in RrdReader(path).stream().filter(content=entity, is_static=False)
    ]
    return pd.concat(batches).sort_values("plan_time")


def test_the_viewer_accepts_a_recording(recording):
    done = subprocess.run([RERUN, "rrd", "verify", recording], capture_output=True)
    assert done.returncode == 0, done.stderr.decode()


def test_a_recording_is_small(recording):
    assert recording.stat().st_size < MAX_BYTES


def test_two_runs_record_the_same(recording, tmp_path):
    write_plan(tmp_path / "again.rrd", content())
    command = [RERUN, "rrd", "compare", "--unordered", recording]
    done = subprocess.run([*command, tmp_path / "again.rrd"], capture_output=True)
    assert done.returncode == 0, done.stderr.decode()


def test_a_recording_opens_on_its_own_views(recording):
    assert len(RrdReader(recording).blueprints()) == 1


def test_every_part_of_the_robot_has_a_shape_and_moves(recording):
    counts = count_rows(recording)
    for part in part_meshes(robot()):
        assert counts[f"/world/robot/{part}"] >= 2, part
    hand = rows(recording, "/world/robot/r_wrist_roll_link")
    assert len(hand) > 20


def test_the_hand_is_recorded_where_the_robot_has_it(recording):
    hand = rows(recording, "/world/robot/r_wrist_roll_link")
    xyz = np.stack([v[0] for v in hand["Transform3D:translation"]])
    number = robot().links.index("r_wrist_roll_link")
    film = content().film
    for q, found in ((film.q[0], xyz[0]), (film.q[-1], xyz[-1])):
        at = link_poses(robot().tree, q)[number][:3, 3]
        np.testing.assert_allclose(found, at, atol=1e-6)


def test_an_object_ends_where_it_is_placed_and_a_handed_one_is_not_there_before(
    recording,
):
    for one, (name, part) in zip(plan(), turns(content().film), strict=True):
        assert name == one.object_id
        seen = rows(recording, f"/world/objects/{name}")
        seen = seen.dropna(subset="Transform3D:translation")
        xyz = np.stack([v[0] for v in seen["Transform3D:translation"]])
        np.testing.assert_allclose(xyz[-1], one.T_world_object[4:], atol=1e-6)
        if one.T_world_start is None:
            start_s = content().film.time_s[part][0]
            first = pd.Timedelta(seen["plan_time"].iloc[0]).total_seconds()
            assert first == pytest.approx(start_s, abs=1e-6)


def test_what_nobody_moves_stands_there_all_the_time(recording):
    assert "/world/standing/block2" in count_rows(recording)
    assert set(content().standing) == {"block2"}


def test_what_was_tried_is_shown_in_the_turn_of_its_object(recording):
    boxes = rows(recording, "/world/tried/boxes")
    labels = [list(v) for v in boxes["Boxes3D:labels"]]
    assert labels == [
        ["can1: possible"],
        ["block1: no path", "block1: possible"],
        ["block2: goal in collision"],
    ]


def test_ways_are_those_of_each_turn(recording):
    assert len(rows(recording, "/world/ways/now")) == 2


def test_the_story_tells_the_order_what_was_tried_and_why_not():
    text = story(content())
    assert "2 of 3 objects placed" in text
    assert text.index("**can1**, grasp `s1`") < text.index("**block1**, grasp `top1`")
    assert "asked 2 times: 1 no path, 1 possible" in text
    assert "beside can1: no path, blocked by can1" in text
    refused = text[text.index("## Not placed") :]
    assert "**block2**: goal in collision" in refused


def test_a_long_search_is_told_in_short():
    T = np.array([1.0, 0, 0, 0, 1, 2, 3])
    many = tuple(Tried("can1", i + 1, "no path", (), (), T) for i in range(50))
    search = Search(("can1",), {}, {}, many, ())
    text = story(replace(content(), search=search))
    assert "asked 50 times: 50 no path" in text
    assert text.count("place ") < 15
    assert "place 50 at (1.00, 2.00, 3.00) m" in text


def test_every_reason_of_the_planner_has_a_colour_of_its_own():
    colours = [COLOURS[reason] for reason in REASONS]
    assert len(set(colours)) == len(REASONS)


def test_what_happens_is_told_from_when_it_starts():
    told = moments(content())
    assert [time for time, _, _ in phases(content().film)] == [t for t, _ in told]
    assert told[0][1] == "## 1 of 2: can1\n**pick approach**"
    assert told[-1][1] == "## 2 of 2: block1\n**put retreat**"


def test_certificates_are_those_of_the_placed_objects():
    search = content().search
    shuffled = plan()[::-1]
    assert [c.object_id for c in in_order(shuffled, search)] == ["can1", "block1"]
    with pytest.raises(BadArtifact, match="block1"):
        in_order(shuffled[1:], search)
    result = result_of(plan(), search)
    assert result.order == ("can1", "block1")
    assert result.refused == {"block2": "goal in collision"}


def test_a_shaded_mesh_keeps_its_triangles():
    mesh = part_meshes(robot())["r_wrist_roll_link"]
    drawn = lit_mesh(mesh)
    corners = np.array(drawn.vertex_positions.as_arrow_array().to_pylist())
    triangles = np.array(drawn.triangle_indices.as_arrow_array().to_pylist())
    np.testing.assert_allclose(corners[triangles], mesh.triangles, atol=1e-6)

"""A recording holds the whole scene, opens without a click and is always the same."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from recorded import count_rows
from rerun.chunk import RrdReader

from placing.people import skeleton
from placing.people.diagnostics import DIAGNOSTIC_COLUMNS
from placing.recordings.blueprint import hidden
from placing.recordings.content import Boxes, Mesh, SceneRecording, Term, Use
from placing.recordings.words import reasons, summary
from placing.recordings.writer import write_recording
from placing.scene import PlacingArea

RERUN = Path(sys.executable).with_name("rerun")
N_SWEEPS, N_CHAINS = 20, 4


def some_boxes(rng: np.random.Generator, *names: str) -> Boxes:
    """Return boxes of these names at random places of a 4 x 3 m room."""
    n = len(names)
    quaternion = np.tile([np.sqrt(0.5), 0, 0, np.sqrt(0.5)], (n, 1))
    return Boxes(
        names, rng.uniform(0, [4, 3, 1], (n, 3)), np.full((n, 3), 0.1), quaternion
    )


def some_poses(rng: np.random.Generator, n: int) -> pd.DataFrame:
    """Return poses of all kinds at random places, as a chain that keeps three."""
    columns = {
        "sweep": np.arange(n) // 3,
        "pose": np.arange(n) % 3,
        "kind": np.array(skeleton.KINDS)[np.arange(n) % 6],
        **dict(zip(("x_m", "y_m", "z_m"), rng.uniform(0, 3, (3, n)), strict=True)),
        "yaw_rad": rng.uniform(-np.pi, np.pi, n),
        "n_objects": rng.integers(1, 5, n),
    }
    return pd.DataFrame(columns)


def some_trace(rng: np.random.Generator) -> pd.DataFrame:
    """Return the trace of every chain, chain after chain."""
    columns = {
        "chain": np.repeat(np.arange(N_CHAINS), N_SWEEPS),
        "sweep": np.tile(np.arange(N_SWEEPS), N_CHAINS),
        "log_joint": rng.normal(size=N_CHAINS * N_SWEEPS),
        "n_poses": rng.integers(1, 5, N_CHAINS * N_SWEEPS),
        "p_new": rng.uniform(size=N_CHAINS * N_SWEEPS),
    }
    return pd.DataFrame(columns)


def diagnosis(question: str, is_mixed: bool) -> dict[str, object]:
    """Return the diagnosis of a question; the numbers do not matter."""
    row = dict.fromkeys(DIAGNOSTIC_COLUMNS, 1.0) | {"scene": "kitchen1"}
    return row | {"question": question, "is_mixed": is_mixed}


USES = {
    "mug1": Use(
        kind="sitting_upright",
        location=np.array([1.0, 2.0, 0.45]),
        yaw=np.pi / 2,
        share=0.625,
        area="area1",
        alternative=np.array([0.5, 0.25, 0.74]),
        terms=(Term("distance", -1.0, -4.0, True), Term("height", -0.5, -0.4, False)),
    ),
    "book1": Use("", np.full(3, np.nan), np.nan, np.nan, "", np.full(3, np.nan), ()),
}


@pytest.fixture
def content() -> SceneRecording:
    """Return a small scene with something of everything."""
    rng = np.random.default_rng(0)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    candidates = rng.uniform(0, 1, (50, 3))
    normals = np.tile([0.0, 0.0, 1.0], (900, 1))
    predicted = some_boxes(rng, "mug1", "book1")
    labelled = some_boxes(rng, "mug1", "book1")
    return SceneRecording(
        *("rooms", "kitchen1", "filled", "dp", 2, 7),
        points=rng.uniform(0, [4, 3, 2.5], (900, 3)),
        point_colors=rng.integers(0, 255, (900, 3)).astype(np.uint8),
        point_normals=normals,
        areas=(
            PlacingArea("floor", 4 * square, 0.0, np.inf, True, None),
            PlacingArea("area1", square, 0.74, np.inf, False, None),
        ),
        valid_poses=some_poses(rng, 300),
        sampled_poses=some_poses(rng, 3 * N_SWEEPS),
        question="labeller1/book",
        trace=some_trace(rng),
        diagnoses=pd.DataFrame([diagnosis("labeller1/book", True)]),
        uses=USES,
        given=some_boxes(rng, "plate1"),
        predicted=predicted,
        labelled=labelled,
        errors_m=np.linalg.norm(predicted.centers - labelled.centers, axis=1),
        log_density=np.array([-1.0, -2.5]),
        densities={c: (candidates, -candidates[:, 0]) for c in ("dishware", "book")},
        meshes=(
            Mesh(
                "mug1", np.eye(3), np.array([[0, 1, 2]]), np.full((1, 4), 9, np.uint8)
            ),
        ),
    )


def rerun(*arguments: str | Path) -> subprocess.CompletedProcess:
    """Run the command line of rerun."""
    return subprocess.run(
        [RERUN, "rrd", *arguments], check=False, capture_output=True, timeout=60
    )


def column(path: Path, entity: str, component: str) -> list:
    """Return the rows of a component of an entity, as Python lists."""
    rows = []
    for chunk in RrdReader(path).stream().filter(content=entity):
        batch = chunk.to_record_batch()
        if component in batch.schema.names:
            rows += batch.column(component).to_pylist()
    return rows


def test_a_recording_holds_every_part_of_the_scene(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    rows = count_rows(path)
    static = {
        *("/summary", "/reasons", "/world", "/world/areas", "/world/uses/mug1"),
        *("/world/uses/book1", "/world/cloud/room"),
        *("/world/cloud/front", "/world/density/book", "/world/density/dishware"),
        *("/world/meshes/mug1", "/world/objects/errors", "/world/objects/given"),
        *("/world/objects/labelled", "/world/objects/predicted", "/world/poses/valid"),
    }
    assert static <= set(rows)
    for entity in ("/world/poses/joints", "/world/poses/names"):
        assert rows[entity] == N_SWEEPS
    series = ("log_joint", "n_poses", "p_new")
    for entity in ("/world/poses/limbs", *(f"/diagnostics/{name}" for name in series)):
        assert rows[entity] == N_SWEEPS + 1, "one more for the static style"
    assert rerun("verify", path).returncode == 0


def test_sweep_is_the_only_timeline(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    schema = str(RrdReader(path).store().schema())
    assert "sweep" in schema
    assert "log_time" not in schema
    assert "log_tick" not in schema


def test_a_recording_is_named_after_all_that_sets_it_apart(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    (entry,) = RrdReader(path).recordings()
    assert entry.recording_id == "rooms-kitchen1-filled-dp-fold2-seed7"
    assert len(RrdReader(path).blueprints()) == 1


def test_the_skeletons_are_where_the_poses_are(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    rows = column(path, "/world/poses/joints", "Points3D:positions")
    assert len(rows) == N_SWEEPS
    pose = content.sampled_poses.iloc[-1]
    location = pose[["x_m", "y_m", "z_m"]].to_numpy(float)[None]
    expected = skeleton.place(pose["kind"], location, np.array([pose["yaw_rad"]]))[0]
    np.testing.assert_allclose(rows[-1][-15:], expected, atol=1e-5)


def test_quaternions_are_turned_to_the_order_of_rerun(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    ((quaternion,),) = column(path, "/world/objects/given", "Boxes3D:quaternions")
    np.testing.assert_allclose(quaternion, [0, 0, 0.5**0.5, 0.5**0.5], atol=1e-6)


def test_the_same_content_gives_the_same_recording(tmp_path, content):
    a, b, other = (tmp_path / name for name in ("a.rrd", "b.rrd", "other.rrd"))
    write_recording(a, content)
    write_recording(b, content)
    trace = content.trace.assign(log_joint=content.trace["log_joint"] + 1e-4)
    write_recording(other, replace(content, trace=trace))
    assert rerun("compare", "--unordered", a, b).returncode == 0
    assert rerun("compare", "--unordered", a, other).returncode == 1


def test_an_empty_room_without_people_or_predictions_can_be_recorded(tmp_path, content):
    rng, nobody = np.random.default_rng(0), content.sampled_poses.iloc[:0]
    nothing = some_boxes(rng)
    path = tmp_path / "empty.rrd"
    bare = replace(
        content,
        **dict.fromkeys(("given", "predicted", "labelled"), nothing),
        **dict.fromkeys(("sampled_poses", "valid_poses"), nobody),
        trace=content.trace.iloc[:0],
        diagnoses=content.diagnoses.iloc[:0],
        uses={},
        errors_m=np.zeros(0),
        log_density=np.zeros(0),
        point_normals=np.zeros((0, 3)),
        areas=content.areas[:1],
        densities={},
        meshes=(),
    )
    write_recording(path, bare)
    assert rerun("verify", path).returncode == 0


def test_a_failed_write_leaves_the_old_recording_and_nothing_else(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    path.write_bytes(b"old")
    broken = replace(content, sampled_poses=content.sampled_poses.drop(columns="kind"))
    with pytest.raises(KeyError):
        write_recording(path, broken)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_large_clouds_are_thinned_to_a_file_of_bounded_size(tmp_path, content):
    rng = np.random.default_rng(0)
    points = rng.uniform(0, [4, 3, 2.5], (200_000, 3))
    colors = np.full((200_000, 3), 200, np.uint8)
    path = tmp_path / "large.rrd"
    large = replace(
        content, points=points, point_colors=colors, point_normals=np.zeros((0, 3))
    )
    write_recording(path, large)
    assert path.stat().st_size < 1.5e6


def test_the_summary_says_how_far_off_each_object_is_and_what_the_data_are_not(content):
    text = summary(content)
    for name, error in zip(content.predicted.names, content.errors_m, strict=True):
        assert f"| {name} | {error:.2f} |" in text
    assert "not the data set of the paper" in text


def test_each_chain_is_a_series_of_its_own(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    shuffled = content.trace.sample(frac=1, random_state=0)
    write_recording(path, replace(content, trace=shuffled))
    rows = column(path, "/diagnostics/p_new", "Scalars:scalars")
    expected = content.trace["p_new"].to_numpy().reshape(N_CHAINS, N_SWEEPS).T
    np.testing.assert_array_equal([row for row in rows if row is not None], expected)


def test_the_user_of_an_object_is_linked_to_it(tmp_path, content):
    path = tmp_path / "kitchen1.rrd"
    write_recording(path, content)
    (lines,) = column(path, "/world/uses/mug1", "LineStrips3D:strips")
    use = content.uses["mug1"]
    body = skeleton.place(use.kind, use.location[None], np.array([use.yaw]))[0]
    torso, mug = body[skeleton.JOINTS.index("torso")], content.predicted.centers[0]
    np.testing.assert_allclose(lines[3], [torso, mug], atol=1e-5)
    np.testing.assert_allclose(lines[-1][-1], use.alternative, atol=1e-5)
    (points,) = column(path, "/world/uses/mug1", "Points3D:positions")
    np.testing.assert_allclose(points, [body[0], use.alternative], atol=1e-5)


def test_the_summary_marks_chains_outside_the_gates(content):
    assert "within the gates" in summary(content)
    assert "OUTSIDE" not in summary(content)
    rows = [diagnosis("labeller1/book", True), diagnosis("labeller1/mug", False)]
    text = summary(replace(content, diagnoses=pd.DataFrame(rows)))
    assert "1 of the 2 questions shown are within the gates" in text
    assert "Chains of `labeller1/mug` are **OUTSIDE THE GATES**" in text


def test_the_words_say_who_uses_an_object_and_why_it_is_not_elsewhere(content):
    assert "| sitting upright 62% |" in summary(content)
    text = reasons(content)
    assert "Best other place: area1 at (0.50, 0.25, 0.74) m." in text
    assert "| **distance, decisive** | -1.00 | -4.00 |" in text
    assert "| height | -0.50 | -0.40 |" in text
    assert "There is no other place." in text


def test_only_the_users_of_the_largest_objects_are_seen_at_first(content):
    rng = np.random.default_rng(0)
    names = ("pen", "tv", "mug", "book", "lamp")
    sizes = np.array([0.1, 0.9, 0.2, 0.3, 0.5])[:, None] * [1, 1, 1]
    predicted = replace(some_boxes(rng, *names), sizes=sizes)
    off = hidden(replace(content, predicted=predicted))
    assert {path for path in off if "uses" in path} == {
        "world/uses/pen",
        "world/uses/mug",
    }
    assert "world/density/dishware" not in off
    assert "world/density/book" in off

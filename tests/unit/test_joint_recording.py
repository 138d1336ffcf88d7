"""A recording of a joint arrangement has one step per object, and all of each."""

import socket
import subprocess
import sys
import time
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from recorded import count_rows
from rerun.chunk import RrdReader
from rerun.experimental import ViewerClient
from study import study

from placing import rigid
from placing.clouds.ply import Cloud
from placing.errors import BadArtifact
from placing.recordings.joint import (
    COLDEST,
    HEAT_PLACES,
    heat_of,
    joint_recording,
    method_density,
)
from placing.recordings.joint_blueprint import write_joint
from placing.recordings.joint_entities import (
    CATEGORIES,
    category_color,
    shaded_mesh,
)
from placing.recordings.joint_steps import names
from placing.recordings.joint_words import about_step, summary
from placing.scene import PlacingArea, Scene, SceneObject

RERUN = Path(sys.executable).with_name("rerun")
SPACING_M = 0.05
DRIVERS = [
    driver
    for folder in ("/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d")
    for driver in sorted(Path(folder).glob("*.json"))
]


@pytest.fixture(scope="module")
def parts():
    """Return a scene of four objects, its places, cloud, density, joint and checks."""
    scene, candidates, _ = study()
    sizes = (0.2, 0.15, 0.03), (0.2, 0.15, 0.04), (0.1, 0.3, 0.2), (0.09, 0.12, 0.1)
    kinds = ("book", "book"), ("book", "book"), ("tv", "tv"), ("dishware", "mug")
    objects = tuple(
        SceneObject(f"{category}{i}", category, shape, size, 1.0, True, True)
        for i, ((category, shape), size) in enumerate(zip(kinds, sizes, strict=True))
    )
    scene = replace(scene, objects=objects)
    rng = np.random.default_rng(0)
    density = rng.dirichlet(np.full(len(candidates.location), 0.1), len(objects))
    points = rng.uniform(0, [4, 3, 2.5], (900, 3)).astype(np.float32)
    normals = np.tile(np.float32([0, 0, 1]), (900, 1))
    cloud = Cloud(points, normals, np.full((900, 3), 200, np.uint8))
    return scene, candidates, cloud, density, *tables(scene, candidates.location[0])


def tables(scene: Scene, at: np.ndarray) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return where the objects are put, one on another, one nowhere, and checks."""
    area, rows = scene.areas[0].area, []
    for i, item in enumerate(scene.objects):
        x, y, z = at + np.array(
            [0.5 * (i > 1), 0, item.size_m[2] / 2 + 0.03 * (i == 1)]
        )
        turn = rigid.yaw_quaternion(0.7 * i)
        rows.append(
            {"object": item.object_id, "category": item.category, "area": area}
            | {"orientation": "upright", "x_m": x, "y_m": y, "z_m": z}
            | dict(zip(("qw", "qx", "qy", "qz"), turn, strict=True))
            | {"on": "book0" if i == 1 else "", "level": int(i == 1)}
            | {"log_psi": -1.25 - i, "log_psi_stability": np.log(0.9)}
            | {"log_psi_semantics": np.log(0.25), "is_placed": i < 3}
            | {"reason": "" if i < 3 else "no room", "objective": -7.5, "gap": 0.01}
        )
    joint = pd.DataFrame(rows)
    joint.loc[3, ["area", "orientation"]] = ""
    poses = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
    joint.loc[3, [*poses, "log_psi", "log_psi_stability", "log_psi_semantics"]] = np.nan
    columns = {"stays": [True, False, True, False], "reason": ["", "slides", "", "-"]}
    return joint, joint[["object"]].assign(**columns)


@pytest.fixture(scope="module")
def content(parts):
    scene, candidates, cloud, density, joint, checks = parts
    args = cloud, candidates, SPACING_M, density, joint, checks
    return joint_recording(("scans", 0, "dp"), scene, *args)


@pytest.fixture(scope="module")
def path(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("joint") / "kitchen.rrd"
    write_joint(path, content)
    return path


def rows_of(path: Path, entity: str, component: str) -> dict[int | None, list]:
    """Return the rows of a component of an entity by step, None where it is static."""
    rows = {}
    for chunk in RrdReader(path).stream().filter(content=entity):
        batch = chunk.to_record_batch()
        if component in batch.schema.names:
            n, known = batch.num_rows, batch.schema.names
            steps = batch.column("object").to_pylist() if "object" in known else [None]
            values = batch.column(component).to_pylist()
            rows |= dict(zip(steps if len(steps) == n else [None], values, strict=True))
    return rows


def test_a_recording_is_valid_and_holds_every_part(path, content):
    assert subprocess.run([RERUN, "rrd", "verify", path], check=False).returncode == 0
    rows = count_rows(path)
    static = ["/summary", "/world/cloud/room"]
    static += [f"/world/areas/{name}" for name in ("outlines", "names")]
    static += [f"/world/stack/{name}" for name in ("from", "onto", "levels")]
    static += [f"/world/objects/{c.item.object_id}" for c in content.placed]
    assert all(rows[entity] == 1 for entity in static)
    assert "/world/objects/dishware3" not in rows, "it is not placed"


@pytest.mark.skipif(not DRIVERS, reason="there is no Vulkan driver")
def test_no_view_reports_a_fault_at_any_step(path, content, monkeypatch):
    monkeypatch.setenv("RUST_LOG", "error")
    program = str(files("rerun_cli") / "rerun")
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
    with ViewerClient.spawn(
        headless=True, port=port, executable_path=program
    ) as viewer:
        viewer.open(str(path))
        while not viewer.get_state().recordings or viewer.get_state().loading:
            time.sleep(0.1)
        for step in range(1, len(content.objects) + 1):
            viewer.set_time("object", sequence=step, play_state="paused")
            viewer.take_screenshot()
            views = viewer.get_state().views
            assert len(views) == 4
            assert [report for view in views for report in view.reports] == []


def test_there_is_one_step_per_object_and_no_other_timeline(path, content):
    steps = list(range(1, len(content.objects) + 1))
    assert sorted(rows_of(path, "/now", "TextDocument:text")) == steps
    columns = str(RrdReader(path).store().schema())
    assert "log_time" not in columns
    assert "log_tick" not in columns


def test_each_step_shows_the_density_of_its_object_alone(path, content):
    for step, chosen in enumerate(content.objects, start=1):
        entity = f"/world/heat/{chosen.item.object_id}"
        centers = rows_of(path, entity, "Boxes3D:centers")
        shown = [at for at, value in centers.items() if value]
        assert shown == [step]
        xy = np.array(centers[step])[:, :2]
        np.testing.assert_allclose(xy, chosen.heat.places[:, :2], atol=1e-5)
        cleared = rows_of(path, entity, "Clear:is_recursive")
        is_last = step == len(content.objects)
        assert [at for at, value in cleared.items() if value] == [step + 1][
            : not is_last
        ]


def test_the_outlined_box_holds_the_mesh_of_its_object(path, content):
    boxes = {
        name: rows_of(path, "/world/chosen/box", f"Boxes3D:{name}")
        for name in ("centers", "half_sizes", "quaternions")
    }
    for step, chosen in enumerate(content.objects[:3], start=1):
        (center,), (half,), (xyzw,) = (boxes[name][step] for name in boxes)
        T = np.array([xyzw[3], *xyzw[:3], *center])
        entity = f"/world/objects/{chosen.item.object_id}"
        vertices = rows_of(path, entity, "Mesh3D:vertex_positions")[None]
        inside = rigid.apply(rigid.inverse(T), np.array(vertices))
        np.testing.assert_allclose(
            np.abs(inside).max(0), np.array(half) - 0.01, atol=1e-4
        )
    cleared = rows_of(path, "/world/chosen", "Clear:is_recursive")
    assert list(cleared) == [4], "what is not placed has no box"


def test_a_shared_mesh_has_the_triangles_of_the_mesh(content):
    mesh = content.objects[2].mesh
    drawn = shaded_mesh(mesh, (255, 0, 0))
    at = np.array(drawn.vertex_positions.as_arrow_array().to_pylist())
    faces = np.array(drawn.triangle_indices.as_arrow_array().to_pylist())
    np.testing.assert_allclose(at[faces], mesh.triangles, atol=1e-6)
    assert len(at) < 3 * len(faces)


def test_brackets_lead_from_an_object_to_the_one_it_stands_on(path, content):
    (line,) = rows_of(path, "/world/stack/from", "LineStrips3D:strips")[None]
    (start,) = rows_of(path, "/world/stack/onto", "Arrows3D:origins")[None]
    (way,) = rows_of(path, "/world/stack/onto", "Arrows3D:vectors")[None]
    upper, lower = content.objects[1], content.objects[0]
    assert line[0][2] == pytest.approx(upper.T_world_object[6], abs=1e-5)
    np.testing.assert_allclose(line[-1], start, atol=1e-6)
    gap = np.add(start, way) - lower.T_world_object[4:]
    assert (np.abs(gap) <= lower.half_extents + 1e-5).all()
    (label,) = rows_of(path, "/world/stack/levels", "Points3D:labels")[None]
    assert label == "level 0 book0, level 1 book1"


def test_stacks_have_one_name_and_the_object_of_the_step_its_own(content):
    def labels(step: int, *within_m: float) -> list[str]:
        drawn = names(content, content.objects[step - 1], within_m)
        return drawn.labels.as_arrow_array().to_pylist()

    assert labels(4, 0, np.inf) == ["book1 on book0", "tv2"]
    assert labels(1, 0, np.inf) == ["book1 on book0", "tv2", "book0: log Psi -1.25"]
    assert labels(1, 0.1, np.inf) == ["tv2", "book0: log Psi -1.25"]
    assert labels(3, 0, 0.1) == ["tv2: log Psi -3.25"]


def test_only_what_is_likely_is_drawn_the_likeliest_warmest():
    rng = np.random.default_rng(0)
    places, density = rng.uniform(size=(3000, 3)), rng.exponential(size=3000)
    density[:500] *= 1e-4
    heat = heat_of(places, density)
    limit = np.sort(density)[-HEAT_PLACES:].min()
    kept = density >= max(limit, COLDEST * density.max())
    assert len(heat.places) == kept.sum() == HEAT_PLACES
    assert heat.warmth[0] == 1
    np.testing.assert_array_equal(heat.places[0], places[np.argmax(density)])
    assert heat.warmth.min() > 0
    share = COLDEST ** (1 - heat.warmth)
    np.testing.assert_allclose(share, -np.sort(-density)[:HEAT_PLACES] / density.max())


def test_an_object_that_fits_nowhere_has_no_heat():
    assert len(heat_of(np.zeros((5, 3)), np.zeros(5)).places) == 0


def test_both_contexts_are_mixed_by_omega():
    densities = {"dp": np.array([[0.2, 0.8]]), "object_context": np.array([[1.0, 0.0]])}
    mixed = method_density(densities, "dp_object_context", 0.25)
    np.testing.assert_allclose(mixed, [[0.8, 0.2]])
    np.testing.assert_array_equal(method_density(densities, "dp", 0.25), [[0.2, 0.8]])


def test_the_words_say_what_was_chosen_and_what_was_not(content):
    text = summary(content)
    assert "3 of 4 objects placed together, 2 of 3 stay put when settled" in text
    assert "objective **-7.50**, gap to its bound 0.01" in text
    assert "| 2 | book1 | -2.25 | 0.9 | 0.25 | slides |" in text
    assert "| 4 | dishware3 | - | - | - | not placed |" in text
    assert "- dishware3 is not placed: no room" in text
    assert "written for this project" in text
    assert "on **book0** (level 1) on" in about_step(content, 2)
    assert "**not placed**: no room" in about_step(content, 4)


def test_without_checks_nothing_is_said_of_settling(parts):
    scene, candidates, cloud, density, joint, _ = parts
    args = cloud, candidates, SPACING_M, density, joint, None
    unknown = joint_recording(("scans", 0, "dp"), scene, *args)
    assert "settled." not in summary(unknown)
    assert "settled" not in about_step(unknown, 1)


def test_tables_of_other_objects_or_places_are_refused(parts):
    scene, candidates, cloud, density, joint, checks = parts
    args = ("scans", 0, "dp"), scene, cloud, candidates, SPACING_M
    with pytest.raises(BadArtifact, match="expected each of"):
        joint_recording(*args, density, joint.iloc[1:], checks)
    with pytest.raises(BadArtifact, match="objects by places"):
        joint_recording(*args, density[:, 1:], joint, checks)


def test_a_scene_where_nothing_is_placed_can_be_recorded(tmp_path, content):
    nothing = tuple(
        replace(c, is_placed=False, area=None, mesh=None, on="", reason="no room")
        for c in content.objects
    )
    path = tmp_path / "bare.rrd"
    write_joint(path, replace(content, objects=nothing))
    assert subprocess.run([RERUN, "rrd", "verify", path], check=False).returncode == 0


def test_categories_have_colours_of_their_own():
    assert len({category_color(name) for name in CATEGORIES}) == len(CATEGORIES)


def test_areas_of_the_floor_have_no_minus_zero(content):
    floor = PlacingArea("floor", np.eye(3)[:, :2], -0.001, np.inf, True, None)
    chosen = replace(content.objects[0], area=floor)
    text = about_step(replace(content, objects=(chosen,)), 1)
    assert "floor, 0.00 m above the floor" in text

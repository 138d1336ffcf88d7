"""Certificates are read as they were written; what is out of place is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest
from certified import ROBOT, certificate, settings

from placing.artifacts.certificates import (
    DOCUMENT,
    PATHS,
    digest_of,
    read_certificates,
    write_certificates,
)
from placing.errors import BadArtifact
from placing.robot.certificates import World, certificate_of
from placing.robot.planning import Motion, Segment

GOOD = certificate()
NEAR = np.array([1.0, 0, 0, 0, 1, 2, 0.5])
SETTINGS = settings()


def write(folder, *certificates):
    write_certificates(folder, ROBOT, SETTINGS.urdf, SETTINGS.chain, certificates)


@pytest.fixture
def folder(tmp_path):
    write(tmp_path, GOOD, replace(GOOD, T_world_start=None, standing={"mug1": NEAR}))
    return tmp_path


def test_certificates_come_back_as_they_were(folder):
    found = read_certificates(folder)
    first, second = found.certificates
    assert found.robot == "pr2"
    assert found.urdf_sha256 == digest_of(SETTINGS.urdf)
    assert found.joints == ("x_m", "y_m", "yaw_rad", "torso_m", *SETTINGS.chain)
    assert first.name == "pillars/empty/all/with/can1"
    assert first.world == GOOD.world
    assert second.T_world_start is None
    np.testing.assert_allclose(second.standing["mug1"], NEAR)
    np.testing.assert_allclose(first.T_world_object, GOOD.T_world_object, atol=1e-8)
    for one, other in zip(second.segments, GOOD.segments, strict=True):
        assert (one.name, one.is_holding) == (other.name, other.is_holding)
        assert one.opening_m == other.opening_m
        np.testing.assert_array_equal(one.path, other.path)


def test_the_same_certificates_are_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        write(tmp_path / name, GOOD)
    for file in (DOCUMENT, PATHS):
        one, other = ((tmp_path / name / file).read_bytes() for name in ("a", "b"))
        assert one == other


def test_a_folder_may_hold_no_certificate(tmp_path):
    write(tmp_path)
    assert read_certificates(tmp_path).certificates == ()


def test_a_pick_and_a_put_make_one_certificate():
    path, T = np.zeros((2, 11)), GOOD.T_tool_object
    pick, put = (
        Motion("can1", pose, "side1", T, (Segment(name, path, True, 0.05),))
        for name, pose in (("lift", GOOD.T_world_start), ("lower", GOOD.T_world_object))
    )
    world = World("scenarios", "kitchen", "empty", "all", "inside")
    whole = certificate_of(world, (pick, put), {"b": NEAR, "a": NEAR})
    assert [segment.name for segment in whole.segments] == ["pick lift", "put lower"]
    assert list(whole.standing) == ["a", "b"]
    np.testing.assert_array_equal(whole.T_world_start, GOOD.T_world_start)
    alone = certificate_of(world, (put,), {})
    assert alone.T_world_start is None
    assert alone.segments[0].name == "put lower"


def changed(folder, change):
    path = folder / DOCUMENT
    document = json.loads(path.read_text())
    change(document)
    path.write_text(json.dumps(document))


FAULTS = {
    "joints": lambda d: d.update(joints=["x_m"]),
    "robot": lambda d: d.update(robot=3),
    "object_id": lambda d: d["certificates"][0].update(object_id="two\nlines"),
    "T_world_object: ": lambda d: d["certificates"][0].update(
        T_world_object=[1, 0, 0, 0, 0, 0]
    ),
    "T_tool_object: ": lambda d: d["certificates"][0].update(
        T_tool_object=[2, 0, 0, 0, 0, 0, 0]
    ),
    "standing.mug1": lambda d: d["certificates"][1]["standing"].update(mug1="here"),
    "segments: ": lambda d: d["certificates"][0].update(segments=[]),
    "segments[0].n_rows": lambda d: d["certificates"][0]["segments"][0].update(
        n_rows=10**6
    ),
    "segments[1].n_rows": lambda d: d["certificates"][0]["segments"][1].update(
        n_rows=True
    ),
    "segments[0].is_holding": lambda d: d["certificates"][0]["segments"][0].update(
        is_holding=1
    ),
    "segments[0].opening_m": lambda d: d["certificates"][0]["segments"][0].update(
        opening_m=-1
    ),
    "world.task": lambda d: d["certificates"][0]["world"].pop("task"),
    "q: value": lambda d: d["certificates"].pop(),
    "certificates: ": lambda d: d.update(certificates={}),
}


@pytest.mark.parametrize("place", FAULTS)
def test_a_fault_is_named_in_one_line(folder, place):
    changed(folder, FAULTS[place])
    with pytest.raises(BadArtifact) as found:
        read_certificates(folder)
    assert place in str(found.value)
    assert "expected" in str(found.value)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e9])
def test_a_way_point_that_is_no_number_is_refused(folder, value):
    q = np.load(folder / PATHS)["q"]
    q[3, 5] = value
    np.savez(folder / PATHS, q=q)
    with pytest.raises(BadArtifact, match=r"q\[3, 5\]"):
        read_certificates(folder)


def test_way_points_that_are_pickled_are_refused(folder):
    np.savez(folder / PATHS, q=np.array([{}], object), allow_pickle=True)
    with pytest.raises(BadArtifact, match="q"):
        read_certificates(folder)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(BadArtifact, match=DOCUMENT):
        read_certificates(tmp_path)

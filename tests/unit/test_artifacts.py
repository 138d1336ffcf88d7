"""Artifacts come back as they were written, and damage is named."""

import json

import numpy as np
import pandas as pd
import pytest
from study import study

from placing.artifacts.densities import read_densities, write_densities
from placing.artifacts.features import read_features, write_features
from placing.artifacts.formats import read_arrays, read_table, write_json, write_table
from placing.artifacts.scenes import read_scene, write_scene
from placing.errors import BadArtifact


@pytest.fixture(scope="module")
def parts():
    return study()


def test_a_scene_comes_back(parts, tmp_path):
    write_scene(tmp_path / "office1.json", parts[0])
    again = read_scene(tmp_path / "office1.json")
    assert again.objects == parts[0].objects
    assert [a.area for a in again.areas] == [a.area for a in parts[0].areas]
    assert again.areas[0].clearance_m == np.inf
    one, two = (s.arrangements[0].placements[0] for s in (parts[0], again))
    np.testing.assert_allclose(one.location, two.location)
    write_scene(tmp_path / "again.json", again)
    assert (tmp_path / "again.json").read_bytes() == (
        tmp_path / "office1.json"
    ).read_bytes()


def test_features_come_back_with_the_same_bytes(parts, tmp_path):
    for name in ("a.npz", "b.npz"):
        write_features(tmp_path / name, *parts[1:])
    candidates, poses = read_features(tmp_path / "a.npz")
    np.testing.assert_array_equal(candidates.features, parts[1].features)
    np.testing.assert_array_equal(poses.location, parts[2].location)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_densities_come_back_by_key(tmp_path):
    densities = {"dp/all/mug": np.array([0.25, 0.75]), "dp/all/tv": np.array([1.0, 0])}
    write_densities(tmp_path / "d.npz", densities)
    again = read_densities(tmp_path / "d.npz")
    assert sorted(again) == sorted(densities)
    np.testing.assert_array_equal(again["dp/all/mug"], [0.25, 0.75])


def test_missing_and_damaged_files_are_named(tmp_path):
    with pytest.raises(BadArtifact, match=r"none.json: cannot be read"):
        read_scene(tmp_path / "none.json")
    (tmp_path / "bad.npz").write_bytes(b"not an archive")
    with pytest.raises(BadArtifact, match=r"bad.npz"):
        read_arrays(tmp_path / "bad.npz", ["a"])
    write_table(tmp_path / "t.parquet", pd.DataFrame({"a": [1]}))
    with pytest.raises(BadArtifact, match=r"t.parquet"):
        read_table(tmp_path / "t.parquet", ["a", "b"])


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "x.json"
    write_json(path, {"a": 1})
    with pytest.raises(ValueError, match="Out of range"):
        write_json(path, {"a": float("nan")})
    assert json.loads(path.read_text()) == {"a": 1}
    assert list(tmp_path.iterdir()) == [path]

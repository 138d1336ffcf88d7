"""What a fold has learned comes back, and what is out of place is named in one line."""

import json

import numpy as np
import pytest

from placing.artifacts import theta as artifacts
from placing.errors import BadArtifact
from placing.learning.fitting import BROAD
from placing.methods.object_context import BROAD_RELATION, Relations

FILES = ("dp", "height", "area", "object")


@pytest.fixture
def folder(tmp_path):
    """Return a folder with all that a fold learns, of two categories."""
    for name in ("dp", "fmm8", "fmm2"):
        thetas = {"mug": BROAD, "tv": BROAD}
        artifacts.write_thetas(tmp_path / f"{name}.json", thetas, ["office1"])
    for name, shape in (("height", (4,)), ("room", (2, 3)), ("area", (2, 3, 2))):
        shares = {"mug": np.full(shape, 1 / np.prod(shape))}
        artifacts.write_histograms(tmp_path / f"{name}.json", shares, ["office1"])
    relations = Relations(BROAD_RELATION, {"mug": {"tv": BROAD}}, 2.0)
    artifacts.write_relations(tmp_path / "object.json", relations, ["office1"])
    return tmp_path


def damage(path, *keys, value):
    """Write another value, or none for `...`, at a place of a file."""
    document = json.loads(path.read_text())
    *parents, last = keys
    part = document
    for key in parents:
        part = part[key]
    if value is ...:
        del part[last]
    else:
        part[last] = value
    path.write_text(json.dumps(document))


def message(folder):
    """Return what reading the folder says."""
    with pytest.raises(BadArtifact) as caught:
        artifacts.read_learned(folder)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_what_was_learned_comes_back(folder):
    learned = artifacts.read_learned(folder)
    assert list(learned.thetas) == ["dp", "fmm2", "fmm8"]
    found = learned.thetas["fmm8"]["tv"].vector()
    np.testing.assert_allclose(found, BROAD.vector(), atol=1e-9)
    assert learned.histograms["area"]["mug"].shape == (2, 3, 2)
    assert learned.relations.sharpness == 2
    given = learned.relations.pairs["mug"]["tv"].vector()
    np.testing.assert_allclose(given, BROAD.vector(), atol=1e-9)


def test_a_category_without_examples_is_absent(folder):
    learned = artifacts.read_learned(folder)
    assert "shoe" not in learned.thetas["dp"]
    assert "shoe" not in learned.relations.pairs


def test_other_files_are_no_mixtures(folder):
    (folder / "fmm.trace.json").write_text("{}")
    assert list(artifacts.read_learned(folder).thetas) == ["dp", "fmm2", "fmm8"]


@pytest.mark.parametrize(
    ("field", "value", "shown"),
    [
        ("bearing_kappa", ..., "None"),
        ("height_sigma_m", 0.0, "0.0"),
        ("log_distance_sigma", -0.3, "-0.3"),
        ("bearing_kappa", float("nan"), "nan"),
        ("height_mean_m", float("-inf"), "-inf"),
        ("orientation_mean_rad", 180, "180"),
        ("orientation_kappa", True, "True"),
        ("log_distance_mean", [0.7], r"[0.7]"),
        ("log_distance_mean", "a\nb", r"'a\nb'"),
    ],
)
@pytest.mark.parametrize("name", ["fmm2", "object"])
def test_a_bad_parameter_is_named(folder, name, field, value, shown):
    keys = ["categories", "mug", *(["tv"] if name == "object" else [])]
    damage(folder / f"{name}.json", *keys, field, value=value)
    place = ".".join(keys)
    start = f"{folder / name}.json: {place}.{field}: value {shown}; expected a finite"
    assert message(folder).startswith(start)


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("value", [..., None, [], "mug"])
def test_categories_that_are_no_object_are_named(folder, name, value):
    damage(folder / f"{name}.json", "categories", value=value)
    assert message(folder).startswith(f"{folder / name}.json: categories: ")


@pytest.mark.parametrize("name", ["dp", "height", "room", "area", "object"])
def test_a_missing_file_is_named(folder, name):
    (folder / f"{name}.json").unlink()
    assert message(folder).startswith(f"{folder / name}.json: cannot be read")


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("height", [0.5, None], "a finite number from 0 to 1"),
        ("height", [1.5, -0.5], "a finite number from 0 to 1"),
        ("height", [0.5, 0.4], "shares that sum to 1"),
        ("height", [], "shares along 1 axes"),
        ("height", 1, "shares along 1 axes"),
        ("room", [0.5, 0.5], "shares along 2 axes"),
        ("room", [[0.5], [0.25, 0.25]], "rows of one length"),
        ("area", [[0.5, 0.5]], "shares along 3 axes"),
    ],
)
def test_a_bad_histogram_is_named(folder, name, value, expected):
    damage(folder / f"{name}.json", "categories", "mug", value=value)
    found = message(folder)
    assert found.startswith(f"{folder / name}.json: categories.mug: value")
    assert expected in found


def test_a_number_beyond_all_floats_is_named(folder):
    damage(folder / "dp.json", "categories", "tv", "bearing_kappa", value=10**400)
    assert ": categories.tv.bearing_kappa: value 1000" in message(folder)


def test_a_category_that_is_two_lines_gives_one(folder):
    document = {"categories": {"a\nb": {}}}
    (folder / "dp.json").write_text(json.dumps(document))
    assert ": categories.a b.log_distance_mean: value None" in message(folder)


@pytest.mark.parametrize("value", [..., -1, "sharp", None])
def test_a_bad_sharpness_is_named(folder, value):
    damage(folder / "object.json", "sharpness", value=value)
    assert ": sharpness: value " in message(folder)


def test_a_bad_common_relation_is_named(folder):
    damage(folder / "object.json", "common", "height_sigma_m", value=None)
    assert ": common.height_sigma_m: value None" in message(folder)

"""Objects are put down in the few ways in which they can lie, lean, slot in or hang."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from placing import rigid
from placing.psi.object_clouds import ObjectCloud, object_cloud
from placing.psi.orientations import (
    Orientation,
    OrientationsConfig,
    drop_of,
    orientations,
    tipping_deg,
)
from placing.rooms.catalogue import read_catalogue
from placing.scene import SceneObject

CONFIG_FOLDER = Path(__file__).parents[2] / "config"
SETTINGS = yaml.safe_load((CONFIG_FOLDER / "config.yaml").read_text())["orientations"]
CONFIG = OrientationsConfig(**{**SETTINGS, "lean_deg": tuple(SETTINGS["lean_deg"])})
CATALOGUE = read_catalogue(CONFIG_FOLDER / "objects.csv")
GLASS = SceneObject(
    "glass", "dishware", "wine_glass", (0.085, 0.085, 0.21), 0.2, False, True
)


def box_cloud(x, y, z, n=14):
    """Return the cloud of a box: a lattice on each side, corners included."""
    steps = np.linspace(-0.5, 0.5, n)
    u, v = (part.ravel() for part in np.meshgrid(steps, steps))
    points, normals = [], []
    for axis in range(3):
        for side in (-0.5, 0.5):
            points.append(np.insert(np.stack([u, v], 1), axis, side, axis=1))
            normals.append(np.tile(2 * side * np.eye(3)[axis], (len(u), 1)))
    size = np.array([x, y, z])
    points, normals = np.concatenate(points) * size, np.concatenate(normals)
    return ObjectCloud("box", points, normals, np.zeros(3))


@cache
def ways_of(name):
    return orientations(object_cloud(CATALOGUE[name], 0.01), CONFIG)


def names_of(ways):
    return [way.name for way in ways]


def height_of(cloud, way):
    return np.ptp(cloud.points @ rigid.matrix(way.quaternion).T[:, 2])


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_object_has_few_orientations_and_stands_upright_first(name):
    ways = ways_of(name)
    assert ways[0].name == "upright"
    assert np.array_equal(ways[0].quaternion, rigid.IDENTITY)
    assert len(ways) <= CONFIG.n_most
    assert len(set(names_of(ways))) == len(ways)
    assert np.allclose([np.linalg.norm(way.quaternion) for way in ways], 1)


def test_a_box_lies_on_each_of_its_three_kinds_of_sides_once():
    cloud = box_cloud(0.2, 0.15, 0.11)
    ways = orientations(cloud, CONFIG)
    assert names_of(ways) == ["upright", "face1", "face2"]
    assert sorted(height_of(cloud, way) for way in ways) == pytest.approx(
        [0.11, 0.15, 0.2], abs=1e-9
    )


def test_a_cube_looks_the_same_on_every_side():
    assert names_of(orientations(box_cloud(0.1, 0.1, 0.1), CONFIG)) == ["upright"]


def test_a_face_beside_which_the_mass_is_carries_nothing():
    cloud = box_cloud(0.2, 0.15, 0.11)
    lopsided = ObjectCloud("box", cloud.points, cloud.normals, np.array([0.099, 0, 0]))
    assert tipping_deg(cloud, np.array([0.0, 0.0, -1.0])) == pytest.approx(
        np.rad2deg(np.arctan2(0.075, 0.055)), abs=0.01
    )
    assert tipping_deg(lopsided, np.array([0.0, 0.0, -1.0])) < 2
    assert tipping_deg(lopsided, np.array([1.0, 0.0, 0.0])) > 80


def test_flat_things_go_into_slots_and_lean_and_others_do_not():
    for name in ("plate1", "book1", "pen1"):
        assert names_of(ways_of(name))[1] == "edge"
        assert "lean1" in names_of(ways_of(name))
    assert {"edge", "lean1"}.isdisjoint(names_of(ways_of("mug1")))


def test_what_leans_is_as_far_from_the_vertical_as_configured():
    upright = np.array([1.0, 0.0, 0.0])  # of a book on edge, its own x axis
    leans = [way for way in ways_of("book1") if way.name.startswith("lean")]
    for way, degrees in zip(leans, CONFIG.lean_deg, strict=True):
        up = rigid.matrix(way.quaternion) @ upright
        assert np.rad2deg(np.arccos(up[2])) == pytest.approx(degrees, abs=1e-6)


def test_only_stemmed_things_hang_and_by_their_foot():
    cloud = object_cloud(GLASS, 0.01)
    hung = {way.name: way for way in orientations(cloud, CONFIG)}["hung"]
    assert rigid.matrix(hung.quaternion)[2, 2] == pytest.approx(-1)
    foot_m = GLASS.size_m[2] - drop_of(cloud, hung, CONFIG)
    assert 0.004 < foot_m < 0.025
    for name in ("mug1", "bowl", "soda_can", "book1"):
        assert "hung" not in names_of(ways_of(name))


def test_what_stands_on_its_area_does_not_reach_below_it():
    cloud = box_cloud(0.2, 0.15, 0.11)
    upright = Orientation("upright", np.array(rigid.IDENTITY))
    assert drop_of(cloud, upright, CONFIG) == 0


def test_the_same_cloud_gives_the_same_orientations():
    cloud = object_cloud(CATALOGUE["ladle"], 0.01)
    first, second = orientations(cloud, CONFIG), orientations(cloud, CONFIG)
    assert names_of(first) == names_of(second)
    for a, b in zip(first, second, strict=True):
        assert np.array_equal(a.quaternion, b.quaternion)

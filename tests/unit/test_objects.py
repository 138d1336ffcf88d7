"""Every object of the catalogue is a solid of its size that rests where it is put."""

from pathlib import Path

import numpy as np
import open3d as o3d
import pytest
import shapely

from placing.errors import BadInput, UnknownName
from placing.pictures.shading import face_colours
from placing.rooms.catalogue import read_catalogue
from placing.shapes.objects import OBJECTS, object_shape

CATALOGUE = read_catalogue(Path(__file__).parents[2] / "config" / "objects.csv")
EVERY_OBJECT = pytest.mark.parametrize("name", CATALOGUE)
CONTACT_M = 1e-3


@pytest.fixture(scope="module")
def shapes():
    return {k: object_shape(item.shape, item.size_m) for k, item in CATALOGUE.items()}


def contains(mesh, points):
    """Return which points are inside, by counting crossings of rays."""
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(np.array(mesh.vertices, np.float32)),
        o3d.core.Tensor.from_numpy(np.array(mesh.faces, np.uint32)),
    )
    queries = o3d.core.Tensor.from_numpy(np.array(points, np.float32))
    return scene.compute_occupancy(queries, nsamples=3).numpy() > 0.5


@EVERY_OBJECT
def test_object_is_one_closed_solid_that_fills_its_box(name, shapes):
    mesh, half = shapes[name].mesh, np.array(CATALOGUE[name].size_m) / 2
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert 0 < mesh.volume <= np.prod(2 * half) * (1 + 1e-9)
    np.testing.assert_allclose(mesh.bounds, [-half, half], atol=1e-6)


@EVERY_OBJECT
def test_object_rests_stably_on_its_lowest_points(name, shapes):
    mesh = shapes[name].mesh
    points = mesh.vertices[mesh.vertices[:, 2] < mesh.bounds[0, 2] + CONTACT_M, :2]
    base = shapely.MultiPoint(points).convex_hull
    centre = shapely.Point(mesh.center_mass[:2])
    assert base.contains(centre)
    # It also has to survive a small push: it tips at more than 4 degrees.
    lever = base.boundary.distance(centre)
    assert lever / (mesh.center_mass[2] - mesh.bounds[0, 2]) > np.tan(np.radians(4))


@EVERY_OBJECT
def test_object_is_coloured_and_light_enough_to_draw(name, shapes):
    mesh = shapes[name].mesh
    colours = np.unique(face_colours(mesh), axis=0)
    assert len(colours) > 1 or CATALOGUE[name].shape == "cushion"
    assert len(mesh.faces) < 5000


@pytest.mark.parametrize("shape", OBJECTS)
def test_shape_fills_boxes_of_other_proportions(shape):
    size = (0.2, 0.25, 0.15)
    mesh = object_shape(shape, size).mesh
    assert mesh.is_watertight
    np.testing.assert_allclose(mesh.extents, size, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "hollow"), [("mug1", 0.5), ("bowl", 0.5), ("vase", 0.2)]
)
def test_vessels_are_hollow(name, hollow, shapes):
    mesh, height = shapes[name].mesh, CATALOGUE[name].size_m[2]
    middle = mesh.bounds.mean(axis=0)
    if name == "mug1":
        middle[1] -= (CATALOGUE[name].size_m[1] - CATALOGUE[name].size_m[0]) / 2
    probe = np.array([[middle[0], middle[1], height * (hollow - 0.5)]])
    assert not contains(mesh, probe)[0]
    assert contains(mesh.convex_hull, probe)[0]


def test_screens_face_the_user():
    """The blue of the picture is seen from +x, and from there only."""
    for name in ("laptop", "monitor"):
        mesh = object_shape(name, (0.3, 0.4, 0.3)).mesh
        is_lit = (face_colours(mesh)[:, :3] == (0x3B, 0x6E, 0xA5)).all(axis=1)
        facing = mesh.face_normals[is_lit & (mesh.area_faces > 5e-4), 0]
        assert facing.max() > 0.9
        assert facing.min() > -0.1


def test_books_of_the_catalogue_differ_in_colour(shapes):
    covers = {
        tuple(face_colours(shapes[f"book{k}"].mesh)[:, :3].std(0)) for k in (1, 2, 3, 4)
    }
    assert len(covers) == 4


def test_spine_of_a_book_is_its_minus_y_side(shapes):
    mesh, width = shapes["book1"].mesh, CATALOGUE["book1"].size_m[1]
    probe = [[0.0, 0.003 - width / 2, 0.0], [0.0, width / 2 - 0.003, 0.0]]
    assert contains(mesh, probe).tolist() == [True, False]


def test_only_flat_tops_hold_things(shapes):
    holding = {
        CATALOGUE[name].shape for name, shape in shapes.items() if shape.supports
    }
    assert holding == {"book"}
    (top,) = shapes["book1"].supports
    assert top.height_m == pytest.approx(shapes["book1"].mesh.bounds[1, 2])
    assert shapely.Polygon(top.polygon_m).exterior.is_ccw


def test_same_shape_has_the_same_vertices_twice():
    first, second = (object_shape("figurine", (0.1, 0.1, 0.17)).mesh for _ in range(2))
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert face_colours(first).tobytes() == face_colours(second).tobytes()


@pytest.mark.parametrize("shape", ["laptop", "monitor", "spatula", "tv"])
def test_a_size_in_which_a_part_vanishes_is_refused_in_one_line(shape):
    said = rf"^object shape '{shape}': size_m is \[0.01, 0.01, 0.01\]; expected [^\n]*$"
    with pytest.raises(BadInput, match=said):
        object_shape(shape, (0.01, 0.01, 0.01))


def test_unknown_shape_is_named_beside_the_known_ones():
    with pytest.raises(UnknownName, match=r"unknown object shape 'sofa'.*bowl"):
        object_shape("sofa", (1.0, 1.0, 1.0))

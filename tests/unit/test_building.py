"""Walls stand where the outline says, with holes where the openings are."""

import numpy as np
import open3d as o3d
import pytest
import shapely

from placing.scene import Layout, Opening
from placing.shapes.building import WALL_M, opening_outline, wall_axes, walls_shape

SQUARE = [[0.0, 0.0], [4.2, 0.0], [4.2, 3.4], [0.0, 3.4]]
L_SHAPED = [[0, 0], [6, 0], [6, 2.5], [3.2, 2.5], [3.2, 5], [0, 5]]
SLANTED = [[0.0, 0.0], [4.0, 1.0], [3.0, 4.0], [-0.5, 3.0]]
OPENINGS = (
    Opening("door", 0, 0.3, 0.9, 0.0, 2.05),
    Opening("window", 2, 0.6, 1.6, 0.9, 1.2),
    Opening("window", 3, 0.4, 1.1, 0.9, 1.3),
)
every_outline = pytest.mark.parametrize("outline", [SQUARE, L_SHAPED, SLANTED])


def layout_of(outline: list, openings: tuple = OPENINGS) -> Layout:
    """Return an empty room."""
    outline_m = np.array(outline, float)
    return Layout("room1", "office", outline_m, 2.6, openings, (), (), ())


def cast(layout: Layout, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return how far rays go before they hit the building, shape (n,) [m]."""
    mesh = walls_shape(layout).mesh
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(
        o3d.core.Tensor(mesh.vertices.astype(np.float32)),
        o3d.core.Tensor(mesh.faces.astype(np.uint32)),
    )
    rays = np.hstack([origins, np.broadcast_to(directions, origins.shape)])
    hits = scene.cast_rays(o3d.core.Tensor(rays.astype(np.float32)), nthreads=1)
    return hits["t_hit"].numpy()


def is_open(opening: Opening, along_m: float, height_m: float) -> bool:
    """Return whether a point of a wall is in the light of an opening."""
    beside = along_m - opening.offset_m
    above = height_m - opening.sill_m
    return 0 < beside < opening.width_m and 0 < above < opening.height_m


@every_outline
def test_building_is_closed(outline):
    mesh = walls_shape(layout_of(outline)).mesh
    assert mesh.is_watertight
    assert mesh.volume > 0
    assert mesh.visual.face_colors.shape == (len(mesh.faces), 4)


@every_outline
def test_the_floor_is_the_outline_at_height_zero(outline):
    layout = layout_of(outline)
    (floor,) = walls_shape(layout).supports
    assert floor.name == "floor"
    np.testing.assert_array_equal(floor.polygon_m, np.array(outline, float))
    inside = shapely.Polygon(outline).buffer(-1e-3)
    points = np.random.default_rng(1).uniform(-1, 6, (400, 2))
    points = points[shapely.intersects_xy(inside, *points.T)]
    origins = np.column_stack([points, np.full(len(points), 2.0)])
    fall = cast(layout, origins, np.array([0, 0, -1]))
    np.testing.assert_allclose(fall, 2.0, atol=1e-5)
    assert np.all(np.isinf(cast(layout, origins, np.array([0, 0, 1]))))


@every_outline
def test_walls_stand_on_the_outline_except_where_they_are_open(outline):
    layout = layout_of(outline, OPENINGS[:1])
    origins, outward, expected = [], [], []
    for wall in range(len(outline)):
        start, along, normal = wall_axes(layout.outline_m, wall)
        length = np.linalg.norm(layout.outline_m[(wall + 1) % len(outline)] - start)
        for share in np.linspace(0.02, 0.98, 45):
            for height in (0.04, 1.0, 2.0, 2.3):
                here = start + share * length * along - 0.3 * normal
                is_hole = wall == 0 and is_open(OPENINGS[0], share * length, height)
                origins.append([*here, height])
                outward.append([*normal, 0.0])
                expected.append(np.inf if is_hole else 0.3)
    # Rays that start beyond a neighbouring wall say nothing about this one.
    origins, expected = np.array(origins), np.array(expected)
    room = shapely.Polygon(outline)
    is_inside = shapely.intersects_xy(room, origins[:, 0], origins[:, 1])
    reach = cast(layout, origins, np.array(outward))
    np.testing.assert_allclose(reach[is_inside], expected[is_inside], atol=1e-5)
    assert np.isinf(expected[is_inside]).any()


@every_outline
def test_walls_are_as_thick_as_they_say(outline):
    layout = layout_of(outline, ())
    solid = walls_shape(layout).mesh.volume
    room = shapely.Polygon(outline)
    grown = room.buffer(WALL_M, join_style="mitre", mitre_limit=10)
    ring = grown.area - room.area
    assert solid == pytest.approx(ring * layout.height_m + grown.area * 0.1)


@every_outline
def test_windows_have_a_frame_but_no_glass(outline):
    layout = layout_of(outline)
    window = OPENINGS[1]
    middle = opening_outline(layout, window).mean(axis=0)
    _, along, normal = wall_axes(layout.outline_m, window.wall)
    beside = middle + 0.2 * along - 0.3 * normal
    edge = middle + (window.width_m / 2 - 0.02) * along - 0.3 * normal
    height = window.sill_m + window.height_m / 2
    origins = np.array([[*beside, height], [*edge, height]])
    reach = cast(layout, origins, np.array([*normal, 0.0]))
    assert np.isinf(reach[0])
    # The rays start 0.3 m before the middle of the wall.
    assert abs(reach[1] - 0.3) < WALL_M / 2


def test_doors_are_open_down_to_the_floor():
    layout = layout_of(SQUARE)
    threshold = np.array([[0.75, -0.05, 1.0]])
    down = cast(layout, threshold, np.array([0, 0, -1]))
    np.testing.assert_allclose(down, 1.0, atol=1e-5)

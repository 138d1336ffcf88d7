"""Furniture is closed, fills its box, and is flat and free where it says it is."""

from functools import cache

import numpy as np
import open3d as o3d
import pytest
import shapely

from placing.errors import BadInput, UnknownName
from placing.shapes.appliances import slot_centres
from placing.shapes.furniture import FURNITURE, furniture_shape
from placing.shapes.parts import NARROWEST_M
from placing.shapes.shape import Shape, Support

TYPICAL = {
    "stemware_holder": (0.3, 0.5, 0.4),
    "hooks": (0.07, 0.5, 0.12),
    "pen_holder": (0.08, 0.08, 0.1),
    "desk": (0.8, 1.6, 0.74),
    "corner_desk": (1.6, 1.8, 0.74),
    "table": (1.2, 3.0, 0.75),
    "round_table": (1.1, 1.1, 0.75),
    "coffee_table": (0.6, 1.1, 0.42),
    "side_table": (0.45, 0.45, 0.55),
    "bench": (0.35, 1.2, 0.45),
    "counter": (0.62, 2.4, 0.9),
    "sink_counter": (0.62, 1.4, 0.9),
    "stove": (0.6, 0.6, 0.9),
    "island": (0.9, 1.8, 0.92),
    "wall_cabinet": (0.35, 0.8, 0.7),
    "open_shelf": (0.25, 1.2, 0.8),
    "bookcase": (0.3, 0.9, 2.0),
    "cabinet": (0.4, 1.0, 1.8),
    "shoe_rack": (0.3, 0.8, 0.5),
    "tv_stand": (0.4, 1.8, 0.5),
    "sideboard": (0.45, 1.6, 0.8),
    "dresser": (0.5, 1.2, 0.9),
    "drawer_unit": (0.5, 0.45, 0.6),
    "nightstand": (0.4, 0.45, 0.5),
    "fridge": (0.68, 0.7, 1.85),
    "dish_rack": (0.35, 0.5, 0.16),
    "microwave": (0.38, 0.5, 0.3),
    "toaster": (0.2, 0.3, 0.2),
    "coffee_machine": (0.3, 0.22, 0.36),
    "chair": (0.5, 0.46, 0.9),
    "office_chair": (0.62, 0.62, 1.05),
    "stool": (0.36, 0.36, 0.46),
    "bar_stool": (0.4, 0.4, 0.75),
    "armchair": (0.85, 0.85, 0.85),
    "couch": (0.95, 2.2, 0.85),
    "corner_couch": (2.0, 2.6, 0.85),
    "bed": (2.1, 1.6, 1.0),
    "rug": (1.6, 2.3, 0.02),
    "floor_lamp": (0.45, 0.45, 1.6),
    "plant": (0.5, 0.5, 1.2),
    "picture": (0.03, 0.8, 0.6),
    "window_sill": (0.2, 1.4, 0.04),
    "whiteboard": (0.08, 1.6, 1.0),
    "box": (0.4, 0.5, 0.3),
}
UNUSUAL = [
    ("bookcase", (0.3, 4.0, 2.4)),
    ("bookcase", (0.5, 0.4, 0.45)),
    ("counter", (0.62, 4.0, 0.9)),
    ("open_shelf", (0.2, 0.8, 0.03)),
    ("open_shelf", (0.3, 2.0, 0.25)),
    ("wall_cabinet", (0.4, 2.6, 1.1)),
    ("fridge", (0.6, 0.55, 0.85)),
    ("sink_counter", (0.5, 0.5, 0.85)),
    ("sink_counter", (0.95, 3.0, 0.95)),
    ("table", (0.4, 0.4, 0.3)),
    ("couch", (0.7, 1.2, 0.6)),
    ("bed", (1.9, 0.9, 0.45)),
    ("shoe_rack", (0.3, 0.6, 1.4)),
]
FACTORS = [(1.0, 1.0, 1.0), (0.8, 1.5, 1.25)]
CASES = [
    (kind, tuple(np.round(np.multiply(size, factor), 3).tolist()))
    for kind, size in TYPICAL.items()
    for factor in FACTORS
] + UNUSUAL
SIDES_LEFT = {
    "fridge": [[0, 0, 0], [1, 0, 0]],
    "wall_cabinet": [[0, 0, 0], [1, 0, 0]],
    "drawer_unit": [[0, 0, 0], [1, 0, 0]],
    "sink_counter": [[0, 0, 0], [0, 0, 1]],
}
"""Sides of their box that open doors, an open drawer and a tap leave."""
every_case = pytest.mark.parametrize(("kind", "size_m"), CASES)


@cache
def shape_of(kind: str, size_m: tuple) -> Shape:
    """Return the shape of a case, built once."""
    return furniture_shape(kind, size_m)


@cache
def rays_of(kind: str, size_m: tuple) -> o3d.t.geometry.RaycastingScene:
    """Return what casts rays onto the mesh of a case."""
    mesh = shape_of(kind, size_m).mesh
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(
        o3d.core.Tensor(mesh.vertices.astype(np.float32)),
        o3d.core.Tensor(mesh.faces.astype(np.uint32)),
    )
    return scene


def cast(case: tuple, origins: np.ndarray, direction: tuple) -> np.ndarray:
    """Return how far rays go before they hit the mesh, shape (n,) [m]."""
    rays = np.hstack([origins, np.broadcast_to(direction, origins.shape)])
    scene = rays_of(*case)
    hits = scene.cast_rays(o3d.core.Tensor(rays.astype(np.float32)), nthreads=1)
    return hits["t_hit"].numpy()


def points_on(support: Support) -> np.ndarray:
    """Return points all over a support, 2 mm inside its edge, shape (n, 3)."""
    inside = shapely.Polygon(support.polygon_m).buffer(-0.002)
    low_x, low_y, high_x, high_y = inside.bounds
    grid = np.meshgrid(np.linspace(low_x, high_x, 29), np.linspace(low_y, high_y, 31))
    points = np.stack(grid, axis=-1).reshape(-1, 2)
    points = points[shapely.intersects_xy(inside, points[:, 0], points[:, 1])]
    return np.column_stack([points, np.full(len(points), support.height_m)])


def test_every_kind_has_a_typical_size():
    assert set(TYPICAL) == set(FURNITURE)


@every_case
def test_meshes_are_closed_and_turned_outwards(kind, size_m):
    mesh = shape_of(kind, size_m).mesh
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert mesh.visual.face_colors.shape == (len(mesh.faces), 4)


@every_case
def test_meshes_fill_their_box(kind, size_m):
    depth, width, height = size_m
    expected = [[-depth / 2, -width / 2, 0], [depth / 2, width / 2, height]]
    beyond = (shape_of(kind, size_m).mesh.bounds - expected) * [[-1], [1]]
    left = np.array(SIDES_LEFT.get(kind, np.zeros((2, 3))), bool)
    assert np.all(np.abs(beyond[~left]) < 1e-6)
    assert np.all(beyond[left] > 0.02)


@every_case
def test_supports_are_flat_and_nothing_stands_on_them(kind, size_m):
    for support in shape_of(kind, size_m).supports:
        above = min(support.clearance_m, 1.0) - 1e-3
        origins = points_on(support) + np.array([0, 0, above])
        dip = cast((kind, size_m), origins, (0, 0, -1)) - above
        share = 1.0
        if support.softness > 0.5:  # The cushions of a row have rounded edges.
            assert np.all((dip > -1e-4) & (dip < 0.03)), support.name
            share = 0.9
        if kind == "dish_rack":  # The wires rise out of the tray.
            share = 0.9
        assert np.mean(np.abs(dip) < 1e-4) >= share, support.name


@every_case
def test_clearance_is_the_way_up_to_the_next_thing(kind, size_m):
    for support in shape_of(kind, size_m).supports:
        if kind == "dish_rack":  # The wires are thinner than the grid.
            continue
        origins = points_on(support) + np.array([0, 0, 1e-3])
        free = cast((kind, size_m), origins, (0, 0, 1)).min() + 1e-3
        if support.name == "basin":  # Rays on a grid may pass beside the tap.
            assert free > support.clearance_m - 1e-3
        elif np.isfinite(support.clearance_m):
            assert free == pytest.approx(support.clearance_m, abs=1e-3), support.name
        else:
            assert np.isinf(free), support.name


@every_case
def test_no_patch_wide_and_high_enough_to_hold_things_is_left_out(kind, size_m):
    shape = shape_of(kind, size_m)
    is_flat = shape.mesh.face_normals[:, 2] > 0.999
    triangles = shape.mesh.triangles[is_flat]
    for height in np.unique(triangles[:, :, 2].mean(axis=1).round(4)):
        level = triangles[np.abs(triangles[:, :, 2].mean(axis=1) - height) < 2e-4]
        flat = shapely.union_all(
            shapely.buffer(shapely.polygons(level[:, :, :2]), 1e-5)
        )
        known = [
            shapely.Polygon(support.polygon_m).buffer(0.01)
            for support in shape.supports
            if abs(support.height_m - height) < 1e-3
        ]
        rest = flat.difference(shapely.union_all(known))
        core = rest.buffer(-NARROWEST_M / 2, join_style="mitre")
        for piece in [] if core.is_empty else shapely.get_parts(core):
            middle = piece.representative_point()
            origin = np.array([[middle.x, middle.y, height + 1e-3]])
            assert cast((kind, size_m), origin, (0, 0, 1))[0] < 0.1, (height, piece)


@every_case
def test_supports_are_simple_polygons_named_once_from_below(kind, size_m):
    supports = shape_of(kind, size_m).supports
    for support in supports:
        polygon = shapely.Polygon(support.polygon_m)
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        assert 0 <= support.softness <= 1
    assert len({support.name for support in supports}) == len(supports)
    heights = [support.height_m for support in supports]
    assert heights == sorted(heights)


def test_bookcases_hold_things_between_their_boards():
    for height, n in ((0.8, 2), (1.2, 3), (2.0, 5), (2.4, 7)):
        *shelves, top = shape_of("bookcase", (0.3, 0.9, height)).supports
        assert len(shelves) == n
        assert all(0.28 < shelf.clearance_m < 0.4 for shelf in shelves)
        assert top.clearance_m == np.inf


@pytest.mark.parametrize("kind", ["fridge", "wall_cabinet", "bookcase", "tv_stand"])
def test_shelves_are_reached_from_the_front(kind):
    size_m = TYPICAL[kind]
    for shelf in shape_of(kind, size_m).supports[:-1]:
        middle = shapely.Polygon(shelf.polygon_m).centroid
        level = shelf.height_m + shelf.clearance_m / 2
        free = cast((kind, size_m), np.array([[2.0, middle.y, level]]), (-1, 0, 0))
        assert 2.0 - free[0] < -size_m[0] / 2 + 0.06


def test_plates_on_edge_fit_into_the_slots_of_a_dish_rack():
    size_m = TYPICAL["dish_rack"]
    (tray,) = shape_of("dish_rack", size_m).supports
    slots = slot_centres(size_m[1])
    assert len(slots) >= 5
    for y in slots:
        plate = np.array(
            [
                [-0.13, y + dy, tray.height_m + up]
                for dy in (-0.015, 0, 0.015)
                for up in (0.002, 0.05, 0.1)
            ]
        )
        assert np.all(cast(("dish_rack", size_m), plate, (1, 0, 0)) > 0.26)
        hoop = np.array([[0.0, y, size_m[2] - 0.002]])
        for aside in (-1, 1):
            assert cast(("dish_rack", size_m), hoop, (0, aside, 0))[0] < 0.02


def test_the_free_quadrant_of_corner_furniture_is_front_left():
    for kind in ("corner_desk", "corner_couch"):
        depth, width, _ = TYPICAL[kind]
        (outline,) = (
            shapely.Polygon(support.polygon_m)
            for support in shape_of(kind, TYPICAL[kind]).supports
            if support.name in ("top", "seat")
        )
        assert not outline.intersects(shapely.Point(0.4 * depth, 0.4 * width))
        assert outline.contains(shapely.Point(0.4 * depth, -0.25 * width))
        assert outline.contains(shapely.Point(-0.25 * depth, 0.3 * width))


@pytest.mark.parametrize("kind", ["chair", "office_chair", "armchair", "couch", "bed"])
def test_backs_and_headboards_are_at_the_rear(kind):
    mesh = shape_of(kind, TYPICAL[kind]).mesh
    highest = mesh.vertices[mesh.vertices[:, 2] > 0.9 * TYPICAL[kind][2]]
    assert np.all(highest[:, 0] < 0)


def test_unknown_kinds_and_impossible_sizes_are_refused():
    with pytest.raises(
        UnknownName, match=r"unknown furniture kind 'sofa'; known are a"
    ):
        furniture_shape("sofa", (1.0, 1.0, 1.0))
    for size_m in ((1.0, 0.0, 1.0), (1.0, np.nan, 1.0), (1.0, 1.0)):
        with pytest.raises(BadInput, match=r"furniture desk: size_m is .* expected"):
            furniture_shape("desk", size_m)  # pyright: ignore[reportArgumentType]

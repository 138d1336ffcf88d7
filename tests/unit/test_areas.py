"""Which placing areas are found in the clouds of simple furniture."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest
import shapely
import trimesh
from scipy import ndimage
from shapely import Polygon, box

from placing.areas.borders import cover
from placing.areas.columns import CONTACT_M, DOWN, MARGIN_M, free_heights, sort_columns
from placing.areas.coverage import compare, solids_of, tabulate, true_areas
from placing.areas.finder import AreaConfig, find_areas
from placing.areas.masks import close, erode
from placing.areas.outlines import heal, open_holes
from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import Cloud
from placing.scene import Furniture, Layout, PlacingArea

CLOUD = CloudConfig(None, (0.0, 0.0, 1.0), 0.02, 0.05, 4, 24, 0.26, 0.2, 100)
AREAS = AreaConfig(
    cell_m=0.025,
    max_tilt_rad=0.3,
    max_height_m=2.1,
    merge_m=0.015,
    min_width_m=0.1,
    min_clearance_m=0.05,
    clearance_step_m=0.15,
    clearance_quantile=0.05,
)


def block(x: tuple, y: tuple, z: tuple) -> trimesh.Trimesh:
    low, high = np.array([x, y, z], float).T
    return slab(box(*low[:2], *high[:2]), z)


def slab(outline: Polygon, z: tuple) -> trimesh.Trimesh:
    mesh = trimesh.creation.extrude_polygon(outline, z[1] - z[0])
    mesh.apply_translation((0, 0, z[0]))
    mesh.visual.face_colors = [120, 100, 80, 255]
    return mesh


FLOOR = block((-1.5, 1.5), (-1.5, 1.5), (-0.1, 0))


def scan(*meshes: trimesh.Trimesh, yaw: float = 0.0) -> Cloud:
    turn = trimesh.transformations.rotation_matrix(yaw, (0, 0, 1))
    turned = [mesh.copy().apply_transform(turn) for mesh in (FLOOR, *meshes)]
    return preprocess(sample_cloud(np.random.default_rng(4), turned, 0.015), CLOUD)


def find(*meshes: trimesh.Trimesh, yaw: float = 0.0) -> tuple[PlacingArea, ...]:
    return find_areas(scan(*meshes, yaw=yaw), AREAS)


def at(areas: tuple[PlacingArea, ...], height_m: float) -> list[PlacingArea]:
    return [a for a in areas if abs(a.height_m - height_m) < 0.01]


def overlap(area: PlacingArea, truth: Polygon) -> float:
    """Return intersection over union."""
    found = heal(area.polygon_m)
    return found.intersection(truth).area / found.union(truth).area


@pytest.mark.parametrize("yaw", [0.0, 0.3, 0.7854, 2.5])
def test_a_table_top_is_found_with_its_true_edges(yaw: float) -> None:
    outline = box(-0.6, -0.4, 0.6, 0.4)
    (top,) = at(find(slab(outline, (0.72, 0.75)), yaw=yaw), 0.75)
    turned = shapely.affinity.rotate(outline, yaw, (0, 0), use_radians=True)
    assert overlap(top, turned) > 0.96
    assert len(top.polygon_m) <= 6
    assert top.height_m == pytest.approx(0.75, abs=1e-3)
    assert np.isinf(top.clearance_m)
    assert not top.is_floor


def test_the_floor_ends_where_things_are_close_above() -> None:
    areas = find(slab(box(-0.6, -0.4, 0.6, 0.4), (0.72, 0.75)))
    below = at(areas, 0.0)
    assert areas[0].area == "floor"
    assert all(a.is_floor for a in below)
    assert np.isinf(areas[0].clearance_m)
    (under,) = below[1:]
    assert under.clearance_m == pytest.approx(0.72, abs=0.01)
    assert overlap(under, box(-0.6, -0.4, 0.6, 0.4)) > 0.9
    assert (
        overlap(areas[0], box(-1.5, -1.5, 1.5, 1.5).difference(heal(under.polygon_m)))
        > 0.97
    )


def test_nothing_is_found_inside_or_under_a_closed_box() -> None:
    areas = find(block((0, 0.5), (0, 0.5), (0, 0.4)))
    assert [round(a.height_m, 2) for a in areas] == [0.0, 0.4]
    assert overlap(areas[0], box(-1.5, -1.5, 1.5, 1.5) - box(0, 0, 0.5, 0.5)) > 0.97


def shelf() -> trimesh.Trimesh:
    boards = [block((0, 0.3), (0, 0.8), (z - 0.02, z)) for z in (0.1, 0.5, 0.9, 1.3)]
    back = block((0, 0.02), (0, 0.8), (0, 1.3))
    sides = [
        block((0, 0.3), y, (0, 1.3)) for y in ((0, 0.02), (0.39, 0.41), (0.78, 0.8))
    ]
    mesh = trimesh.boolean.union([*boards, back, *sides], engine="manifold")
    mesh.visual.face_colors = [120, 100, 80, 255]
    return mesh


@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_shelves_are_found_between_their_boards_and_end_at_uprights(yaw: float) -> None:
    areas = find(shelf(), yaw=yaw)
    for height in (0.1, 0.5, 0.9):
        compartments = at(areas, height)
        assert len(compartments) == 2
        for area in compartments:
            assert area.clearance_m == pytest.approx(0.38, abs=0.01)
            assert Polygon(area.polygon_m).area == pytest.approx(0.28 * 0.37, rel=0.08)
    (top,) = at(areas, 1.3)
    assert np.isinf(top.clearance_m)


def test_an_l_shaped_desk_stays_l_shaped() -> None:
    outline = Polygon(
        [(-1, -1), (0.6, -1), (0.6, -0.4), (-0.4, -0.4), (-0.4, 0.5), (-1, 0.5)]
    )
    (top,) = at(find(slab(outline, (0.7, 0.73))), 0.73)
    assert len(top.polygon_m) == 6
    assert overlap(top, outline) > 0.96


def test_a_sink_is_cut_out_of_its_worktop() -> None:
    outline = box(-0.6, -0.3, 0.6, 0.3) - box(-0.2, -0.2, 0.25, 0.2)
    basin = block((-0.2, 0.25), (-0.2, 0.2), (0.68, 0.7))
    areas = find(slab(outline, (0.7, 0.9)), basin)
    (top,) = at(areas, 0.9)
    (bottom,) = at(areas, 0.7)
    assert Polygon(top.polygon_m).is_valid
    assert overlap(top, outline) > 0.95
    assert overlap(bottom, box(-0.2, -0.2, 0.25, 0.2)) > 0.9


def test_a_worktop_is_split_below_the_end_of_a_wall_cabinet() -> None:
    areas = find(
        block((-0.6, 0), (-0.8, 0.8), (0, 0.9)),
        block((-0.6, -0.25), (-0.8, 0.0), (1.3, 1.9)),
    )
    clearances = sorted(a.clearance_m for a in at(areas, 0.9))
    assert clearances == pytest.approx([0.4, np.inf], abs=0.01)


def test_a_lamp_over_a_desk_does_not_split_it() -> None:
    areas = find(
        slab(box(-0.6, -0.4, 0.6, 0.4), (0.72, 0.75)),
        block((0, 0.08), (0, 0.08), (1.1, 1.15)),
    )
    (top,) = at(areas, 0.75)
    assert overlap(top, box(-0.6, -0.4, 0.6, 0.4)) > 0.96
    assert np.isinf(top.clearance_m)


def test_softness_is_the_mean_of_the_points_of_an_area_and_none_where_unknown() -> None:
    soft, hard = (block((x, x + 0.5), (-0.4, 0.4), (0, 0.4)) for x in (-1, 0))
    cloud = scan(soft, hard)
    x, z = cloud.points[:, 0], cloud.points[:, 2]
    softness = np.where((x < -0.5) & (z > 0.01), 0.5 + (x < -0.75) * 0.4, 0.0)
    softness = np.where((z < 0.01), np.nan, softness).astype(np.float32)
    floor, *tops = find_areas(replace(cloud, softness=softness), AREAS)
    assert floor.softness is None
    assert [a.softness for a in tops] == [pytest.approx(0.7, abs=0.02), 0.0]
    assert [a.softness for a in find_areas(cloud, AREAS)] == [None] * 3


def test_a_board_that_is_seen_twice_is_one_area() -> None:
    cloud = scan(slab(box(-0.6, -0.4, 0.6, 0.4), (0.72, 0.75)))
    middle = np.abs(cloud.points[:, :2]).max(axis=1) < 0.25
    again = cloud.take(middle & (cloud.points[:, 2] > 0.74))
    again = replace(again, points=again.points + np.array([0, 0, 0.02], np.float32))
    both = Cloud(
        np.concatenate([cloud.points, again.points]),
        np.concatenate([cloud.normals, again.normals]),
        np.concatenate([cloud.colors, again.colors]),
    )
    assert [a.height_m for a in find_areas(both, AREAS)] == pytest.approx(
        [a.height_m for a in find_areas(cloud, AREAS)]
    )


def test_names_are_ordered_and_the_order_of_points_does_not_matter() -> None:
    cloud = scan(shelf())
    shuffled = cloud.take(np.random.default_rng(0).permutation(len(cloud)))
    first, again = find_areas(cloud, AREAS), find_areas(shuffled, AREAS)
    assert [a.area for a in first] == [
        "floor",
        *[f"area{k}" for k in range(1, len(first))],
    ]
    heights = [round(a.height_m, 2) for a in first[1:]]
    assert heights == sorted(heights)
    assert len(first) == len(again)
    for a, b in zip(first, again, strict=True):
        assert a.area == b.area
        assert overlap(a, heal(b.polygon_m)) > 0.99


def test_free_heights_agree_with_looking_at_every_point() -> None:
    cloud = scan(shelf())
    columns = sort_columns(cloud, 0.04)
    xy = np.random.default_rng(1).uniform(-0.1, 0.9, (300, 2))
    found = free_heights(columns, xy, np.full(300, 0.5), 0.02)
    expected = np.full(300, np.inf)
    faces_down = cloud.normals[:, 2] < -0.5
    above = cloud.points[:, 2] - np.float64(0.5)
    bounds = np.where(faces_down, above > -CONTACT_M, above > MARGIN_M)
    for k, point in enumerate(xy):
        gap = np.hypot(*(cloud.points[:, :2] - point).T)
        expected[k] = max(above[bounds & (gap <= 0.02)].min(initial=np.inf), 0.0)
    assert np.allclose(found, expected, atol=1e-6)
    assert (columns.facing == DOWN).any()


def test_a_slit_opens_every_hole_and_healing_closes_it() -> None:
    holes = [box(0.2 + k, 0.2, 0.7 + k, 0.7) for k in range(5)]
    outline = box(0, 0, 5, 1) - shapely.union_all(holes)
    opened = open_holes(outline)
    assert opened.is_valid
    assert not opened.interiors
    corners = np.asarray(opened.exterior.coords)[:-1]
    assert heal(corners).symmetric_difference(outline).area < 1e-4


def test_the_border_of_cells_is_that_of_the_union_of_their_squares() -> None:
    rng = np.random.default_rng(2)
    for _ in range(30):
        parts, n_parts = ndimage.label(rng.random((20, 30)) < 0.65)
        for number in range(1, n_parts + 1):
            mask = parts == number
            squares = [box(i, j, i + 1, j + 1) for i, j in np.argwhere(mask)]
            polygon = cover(mask)
            assert polygon.is_valid
            assert polygon.equals(shapely.union_all(squares))


@pytest.mark.parametrize("n_cells", [2, 3, 4, 5])
def test_masks_erode_and_close_like_those_of_scipy(n_cells: int) -> None:
    mask = np.pad(np.random.default_rng(n_cells).random((40, 50)) < 0.8, 6)
    square = np.ones((n_cells, n_cells), bool)
    assert np.array_equal(erode(mask, n_cells), ndimage.binary_erosion(mask, square))
    closed = ndimage.binary_closing(mask, np.ones((3, 3), bool))
    assert np.array_equal(close(mask), closed)


def layout() -> Layout:
    kinds = {
        "desk": (0.8, 1.6, 0.74),
        "bookcase": (0.3, 0.9, 1.8),
        "box": (0.3, 0.3, 0.3),
    }
    places = [(1.0, 1.2, 0.0), (3.0, 1.5, 0.0), (1.0, 1.2, 0.74)]
    furniture = tuple(
        Furniture(kind, kind, size, np.array([1.0, 0, 0, 0, *place]))
        for (kind, size), place in zip(kinds.items(), places, strict=True)
    )
    outline = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])
    return Layout("test", "office", outline, 2.5, (), furniture, (), ())


def test_true_supports_are_found_and_nothing_else() -> None:
    solids = solids_of(layout())
    rng = np.random.default_rng(0)
    cloud = preprocess(sample_cloud(rng, [s.shape.mesh for s in solids], 0.015), CLOUD)
    truth = true_areas(solids, 0.05, 2.1)
    desk = next(t for t in truth if t.kind == "desk")
    assert desk.outline.area == pytest.approx(0.8 * 1.6 - 0.3**2, abs=1e-3)
    find_areas(cloud, AREAS)  # The first call may compile.
    before = process_time()
    areas = find_areas(cloud, AREAS)
    assert process_time() - before < 2.0
    table = tabulate([compare(areas, truth, solids, 0.02)]).set_index("kind")
    assert (table.loc[["desk", "bookcase", "floor", "all"], "recall"] > 0.95).all()
    assert (table.loc[["desk", "bookcase", "floor", "all"], "precision"] > 0.95).all()
    without = [a for a in areas if abs(a.height_m - 0.74) > 0.02]
    table = tabulate([compare(without, truth, solids, 0.02)]).set_index("kind")
    assert table.loc["desk", "recall"] == 0

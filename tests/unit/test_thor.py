"""The rooms of designers: frames, furniture below its objects, and what is kept."""

from pathlib import Path

import numpy as np
import pytest
from shapely import Polygon

from placing.dressing import standing_shape
from placing.errors import BadInput, UnknownName
from placing.rigid import yaw_of
from placing.shapes.furniture import FURNITURE
from placing.shapes.objects import OBJECTS
from placing.thor import data as thor_data
from placing.thor import reader as thor
from placing.thor.items import fit_box, read_item, to_world, to_yaw
from placing.thor.strips import Strip, area_of, side_strips, subtract
from placing.thor.support import check_layout
from placing.thor.types import read_types
from placing.thor.walls import outline_of

TYPES = Path(__file__).parents[2] / "config" / "thor_types.csv"
SCENES = ("FloorPlan1", "FloorPlan2", "FloorPlan207", "FloorPlan302")


@pytest.fixture(scope="module")
def types():
    return read_types(TYPES)


@pytest.fixture(scope="module")
def data():
    return thor_data.read_data(thor_data.find_data())


@pytest.fixture(scope="module")
def layouts(data, types):
    return {scene: thor.read_layout(data, scene, types) for scene in SCENES}


def unity_rotation(x_deg, y_deg, z_deg):
    """Return the rotation about z, then x, then y of a left-handed frame."""
    x, y, z = np.deg2rad([x_deg, y_deg, z_deg])
    about_z = [[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]]
    about_x = [[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]]
    about_y = [[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]
    return np.array(about_y) @ np.array(about_x) @ np.array(about_z)


def test_the_world_is_right_handed_and_seen_from_above_nothing_is_mirrored():
    right, up, forward = np.eye(3)
    # In the source, turning from forward to right is clockwise seen from above.
    assert np.cross(to_world(right), to_world(forward)) == pytest.approx(to_world(up))
    matrix = np.array([to_world(axis) for axis in np.eye(3)])
    assert np.linalg.det(matrix) == pytest.approx(-1)


@pytest.mark.parametrize("angles", [(0, 0, 0), (0, 90, 0), (20, 215, 5), (170, 30, 0)])
def test_the_heading_is_that_of_the_turned_front(angles):
    front = to_world(unity_rotation(*angles) @ [0, 0, 1])
    assert np.exp(1j * to_yaw(np.array(angles))) == pytest.approx(
        complex(*front[:2]) / np.hypot(*front[:2])
    )


def test_a_turned_box_is_found_again_from_its_corners():
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    corners = (signs * [0.3, 0.8, 0.5]) @ turn.T + [1, 2, 3]
    centre, size = fit_box(corners, 0.7)
    assert centre == pytest.approx([1, 2, 3])
    assert size == pytest.approx([0.6, 1.6, 1.0])


def test_another_file_is_refused_with_both_checksums(tmp_path):
    path = tmp_path / "other.json"
    path.write_text("{}")
    with pytest.raises(
        BadInput, match=f"other.json: sha256 is 44136f.*{thor_data.SHA256}"
    ):
        thor_data.read_data(path)


def test_an_unknown_scene_is_refused(data, types):
    with pytest.raises(UnknownName, match="FloorPlan999"):
        thor.read_layout(data, "FloorPlan999", types)


def test_a_bad_table_of_types_is_refused_with_line_and_value(tmp_path):
    path = tmp_path / "types.csv"
    path.write_text(TYPES.read_text().replace("AlarmClock,left_out", "AlarmClock,gone"))
    with pytest.raises(BadInput, match=r"types\.csv: line 2: role: value 'gone'; exp"):
        read_types(path)
    path.write_text("object_type,role\nAlarmClock,left_out\n")
    with pytest.raises(BadInput, match=r"types\.csv: line 1: header .*; expected obj"):
        read_types(path)


def test_every_type_becomes_a_shape_that_exists(types):
    for name, kind in types.items():
        if kind.role == "object":
            assert kind.shape in OBJECTS, name
            assert kind.category, name
        if kind.role == "furniture":
            assert kind.shape in FURNITURE, name


def test_all_scenes_have_names_and_kinds(data):
    kinds = [thor_data.kind_of(scene) for scene in data.scenes]
    assert [kinds.count(kind) for kind in ("kitchen", "livingroom", "bedroom")] == [
        30
    ] * 3
    assert kinds.count("apartment") == 75
    assert "FloorPlan_Val3_5" in data.scenes


def test_the_floor_is_at_zero(layouts):
    for layout in layouts.values():
        placements = layout.arrangements[0].placements
        sizes = {item.object_id: item.size_m for item in layout.objects}
        on_floor = [
            placement.location[2] - sizes[placement.object_id][2] / 2
            for placement in placements
            if placement.area == "floor"
        ]
        assert on_floor, layout.scene
        assert on_floor == pytest.approx(np.zeros(len(on_floor)), abs=0.06)


def test_chairs_look_at_a_table(data, types):
    faces = []
    for scene in [f"FloorPlan{i}" for i in range(201, 216)]:
        items = thor.read_items(data, scene, types)
        tables = [item for item in items if item.type == "DiningTable"]
        for chair in (item for item in items if item.type == "Chair" and tables):
            ways = [table.centre[:2] - chair.centre[:2] for table in tables]
            way = min(ways, key=np.linalg.norm)
            if np.linalg.norm(way) < 1.2:
                faces.append(way @ [np.cos(chair.yaw), np.sin(chair.yaw)] > 0)
    assert len(faces) > 20
    assert np.mean(faces) > 0.9


def test_sofas_have_their_back_to_the_wall(data, types):
    looks_away = []
    for scene in [f"FloorPlan{i}" for i in range(201, 231)]:
        items = thor.read_items(data, scene, types)
        low, _, high, _ = outline_of(items, "livingroom")
        for sofa in (item for item in items if item.type == "Sofa"):
            front = np.array([np.cos(sofa.yaw), np.sin(sofa.yaw)])
            gaps = {
                tuple(out): gap
                for out, gap in zip(
                    [(-1, 0), (0, -1), (1, 0), (0, 1)],
                    [*(sofa.centre[:2] - low), *(high - sofa.centre[:2])],
                    strict=True,
                )
            }
            wall, gap = min(gaps.items(), key=lambda pair: pair[1])
            if gap < 0.8:
                looks_away.append(np.dot(wall, front) < -0.5)
    assert len(looks_away) > 10
    assert np.mean(looks_away) > 0.85


def test_a_mirrored_reading_would_put_a_lamp_on_the_wrong_side(data, types):
    sources = {thing["objectId"]: thing for thing in data.scenes["FloorPlan1"]}
    for name, thing in sources.items():
        item = read_item(thing, data.asset_size)
        source = thing["axisAlignedBoundingBox"]["center"]
        assert item.name == name
        assert item.centre[2] == pytest.approx(source["y"])
        assert item.centre[:2] == pytest.approx([source["x"], source["z"]], abs=0.05)


def test_objects_rest_on_the_furniture_dressed_below_them(layouts):
    checks = [
        check
        for layout in layouts.values()
        for check in check_layout(layout, true_patches(layout))
    ]
    assert np.mean([check.is_supported for check in checks]) >= 0.95


def true_patches(layout):
    """Return the floor and the supports of all furniture in the world."""
    supports = [s for f in layout.furniture for s in standing_shape(f).supports]
    patches = [(Polygon(s.polygon_m), s.height_m) for s in supports]
    return [(Polygon(layout.outline_m), 0.0), *patches]


def test_an_object_that_hovers_is_not_supported(layouts):
    checks = check_layout(layouts["FloorPlan1"], [])
    on_others = [check for check in checks if check.reason == "stands on an object"]
    assert sum(check.is_supported for check in checks) == len(on_others)


def test_a_scene_has_one_answer_that_names_only_what_exists(layouts):
    for layout in layouts.values():
        (arrangement,) = layout.arrangements
        ids = {item.object_id for item in layout.objects}
        below = ids | {"floor"} | {item.furniture_id for item in layout.furniture}
        assert arrangement.name == "designer"
        assert {p.object_id for p in arrangement.placements} == ids
        assert {p.area for p in arrangement.placements} <= below
        assert len({f.furniture_id for f in layout.furniture}) == len(layout.furniture)
        for placement in arrangement.placements:
            assert np.isfinite(yaw_of(placement.orientation))


def test_the_middle_of_a_kitchen_with_a_wide_worktop_stays_free(layouts):
    # The box of one worktop of this kitchen covers most of it.
    layout = layouts["FloorPlan2"]
    strips = [f for f in layout.furniture if f.furniture_id.startswith("counter")]
    covered = sum(np.prod(f.size_m[:2]) for f in strips)
    low, _, high, _ = layout.outline_m
    assert covered < 0.3 * np.prod(high - low)


def test_side_strips_are_disjoint_and_cover_what_a_grid_says():
    box = Strip(np.zeros(2), np.array([3.0, 2.0]), 0.0, 0.9, "counter")
    x, y = np.meshgrid(np.arange(0.005, 3, 0.01), np.arange(0.005, 2, 0.01))
    wanted = (x < 0.6) | (y < 0.6) | (x > 2.4)
    strips = side_strips(box, (0, 1, 2), 0.6)
    assert area_of(strips) == pytest.approx(wanted.sum() * 1e-4)


def test_a_strip_without_its_hole_is_what_a_grid_says():
    strip = Strip(np.zeros(2), np.array([2.0, 0.6]), np.pi / 2, 0.9, "counter")
    hole = Strip(np.array([0.5, 0.1]), np.array([1.0, 0.5]), 0.0, 0.7, "box")
    rest = subtract(strip, hole)
    x, y = np.meshgrid(np.arange(0.005, 2, 0.01), np.arange(0.005, 0.6, 0.01))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    n_covers = np.sum([piece.holds(points, 0.0) for piece in rest], axis=0)
    assert (n_covers == ~hole.holds(points, 0.0)).all()

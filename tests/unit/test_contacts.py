"""What the features of a placement promise."""

import importlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import trimesh

from placing import rigid
from placing.clouds.cloud import CloudConfig, preprocess, sample_cloud
from placing.clouds.ply import Cloud
from placing.psi.contacts import (
    STABILITY_FEATURES,
    PlacingField,
    rest_heights,
    stability_features,
)
from placing.psi.object_clouds import ObjectCloud, object_cloud
from placing.psi.object_grids import object_grid
from placing.rooms.file import read_yaml
from placing.scene import SceneObject
from placing.shapes.appliances import slot_centres
from placing.shapes.furniture import furniture_shape

TABLE_M, RACK_M = (0.8, 1.2, 0.72), (0.45, 0.4, 0.14)
CELL_M = 0.01
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
CONFIG = read_yaml(BENCHMARKS.parent / "config" / "config.yaml")
SHAPES = {
    "box": (0.2, 0.2, 0.3),
    "plate": (0.24, 0.24, 0.022),
    "bottle": (0.07, 0.07, 0.25),
    "mug": (0.08, 0.11, 0.1),
    "pen": (0.14, 0.01, 0.01),
    "monitor": (0.2, 0.5, 0.45),
}
LYING = np.array([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])
"""Quaternion that lays an object on its side, its top to +x."""


@pytest.fixture(scope="module")
def plain() -> Iterator[ModuleType]:
    """The same features in plain numpy."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(BENCHMARKS)
        yield importlib.import_module("plain_contacts")


def furniture(kind: str, size: tuple, T: np.ndarray) -> trimesh.Trimesh:
    return furniture_shape(kind, size).mesh.copy().apply_transform(rigid.homogeneous(T))


@cache
def field(yaw: float = 0.0) -> PlacingField:
    """Return a table with a dish rack, and a shelf beside it, on a floor."""
    rng = np.random.default_rng(0)
    floor = trimesh.creation.box((3, 3, 0.02)).apply_translation((0, 0, -0.01))
    floor.visual.face_colors = [90, 90, 90, 255]
    T = rigid.from_yaw(yaw, (0, 0, 0))
    places = {
        "table": (TABLE_M, (0.0, 0.0, 0.0)),
        "dish_rack": (RACK_M, (0.0, 0.35, TABLE_M[2])),
        "open_shelf": ((0.3, 0.9, 1.2), (-1.0, 0.0, 0.0)),
    }
    meshes = [floor]
    for kind, (size, at) in places.items():
        meshes.append(furniture(kind, size, rigid.compose(T, rigid.from_yaw(0, at))))
    raw = sample_cloud(rng, meshes, CONFIG["scan"]["spacing_m"])
    return PlacingField(preprocess(raw, CloudConfig(**CONFIG["cloud"])), CELL_M)


@cache
def thing(shape: str) -> ObjectCloud:
    item = SceneObject(shape, shape, shape, SHAPES[shape], 1.0, True, True)
    return object_cloud(item, 0.01)


def pose(
    shape: str, x: float, y: float, height: float, q: tuple | None = None
) -> tuple:
    """Return the pose of an object lowered on an area, (1, 7), and height, (1,)."""
    quaternion = np.array([q or rigid.IDENTITY], float)
    xy, area = np.array([[x, y]]), np.array([height])
    z = rest_heights(field(), thing(shape), quaternion, xy, area)
    return np.concatenate([quaternion, xy, z[:, None]], axis=1), area


def describe(
    shape: str, T: np.ndarray, area: np.ndarray, at: PlacingField | None = None
) -> dict[str, float]:
    row = stability_features(at or field(), thing(shape), T, area)[0]
    return dict(zip(STABILITY_FEATURES, row.tolist(), strict=True))


def random_placements(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return poses (n, 7) in, on, under and beside the furniture, and heights (n,)."""
    rng = np.random.default_rng(3)
    q = rng.normal(size=(n, 4))
    q[::2] = [rigid.yaw_quaternion(yaw) for yaw in rng.uniform(0, 7, len(q[::2]))]
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    xyz = rng.uniform((-1.3, -0.8, -0.1), (0.6, 0.8, 1.3), (n, 3))
    return np.concatenate([q, xyz], axis=1), rng.choice([0.0, 0.72, 0.735], n)


@pytest.mark.parametrize("shape", SHAPES)
def test_heights_and_features_are_those_of_plain_numpy(
    shape: str, plain: ModuleType
) -> None:
    slow = plain.Plain(field(), thing(shape))
    T, area = random_placements(25)
    heights = rest_heights(field(), thing(shape), T[:, :4], T[:, 4:6], area)
    slow_heights = [
        slow.rest_height(t[:4], t[4:6], a) for t, a in zip(T, area, strict=True)
    ]
    np.testing.assert_allclose(heights, slow_heights, atol=1e-6)
    T[::3, 6] = heights[::3]
    fast = stability_features(field(), thing(shape), T, area)
    expected = [slow.features(t, a) for t, a in zip(T, area, strict=True)]
    assert fast.shape == (25, len(STABILITY_FEATURES))
    assert fast.dtype == np.float32
    np.testing.assert_allclose(fast, expected, atol=1e-4)


@pytest.mark.parametrize("shape", SHAPES)
def test_an_upright_object_on_a_table_stands_at_the_height_of_the_table(
    shape: str,
) -> None:
    T, _ = pose(shape, 0.0, -0.2, TABLE_M[2])
    bottom = T[0, 6] - SHAPES[shape][2] / 2
    assert bottom == pytest.approx(TABLE_M[2], abs=0.005)


def test_an_object_on_the_rim_of_a_step_stands_on_the_higher_side() -> None:
    T, _ = pose("box", 0.0, -0.5, 0.0)
    assert T[0, 6] < TABLE_M[2]  # Below the table it stands on the floor.
    T, _ = pose("box", 0.42, -0.2, 0.7)
    assert T[0, 6] - 0.15 == pytest.approx(TABLE_M[2], abs=0.005)


def test_an_object_in_a_shelf_does_not_come_from_the_board_above() -> None:
    boards = furniture_shape("open_shelf", (0.3, 0.9, 1.2)).supports
    for board in boards[:-1]:
        T, _ = pose("mug", -1.0, 0.1, board.height_m)
        assert T[0, 6] - 0.05 == pytest.approx(board.height_m, abs=0.005)


def test_a_plate_on_edge_goes_down_between_the_hoops_of_a_rack() -> None:
    for at in slot_centres(RACK_M[1]):
        T, _ = pose("plate", 0.0, 0.35 + at, TABLE_M[2] + 0.015, rigid.ON_EDGE)
        assert T[0, 6] - 0.12 == pytest.approx(TABLE_M[2] + 0.015, abs=0.006)


def test_a_box_wholly_on_a_table_has_its_mass_centre_inside_its_support() -> None:
    says = describe("box", *pose("box", 0.0, -0.2, TABLE_M[2]))
    # The outermost points of a cloud lie up to a spacing inside the edges.
    assert 0.075 < says["margin_m"] < 0.102
    assert says["tipping"] == pytest.approx(np.arctan(0.09 / 0.15), abs=0.07)
    assert says["base_contact_share"] > 0.95
    assert says["overhang"] == 0
    assert says["cut_share"] == 0
    assert says["held"] == 0


def test_a_box_half_over_the_edge_has_not() -> None:
    says = describe("box", *pose("box", 0.44, -0.2, TABLE_M[2]))
    assert says["margin_m"] == pytest.approx(-0.04, abs=0.02)
    assert says["tipping"] < 0
    assert says["overhang"] == pytest.approx(0.7, abs=0.15)
    assert says["gap_below_mass_m"] == pytest.approx(0.1)


def test_a_box_in_a_tabletop_is_cut() -> None:
    T, area = pose("box", 0.0, -0.2, TABLE_M[2])
    T[0, 6] -= 0.05
    says = describe("box", T, area)
    assert says["cut_m"] == pytest.approx(0.05, abs=0.02)
    assert says["cut_share"] > 0.5
    assert says["above_area_m"] == pytest.approx(-0.05, abs=0.005)


def test_an_object_in_the_air_touches_nothing() -> None:
    T, area = pose("box", 0.0, -0.2, TABLE_M[2])
    T[0, 6] += 0.06
    says = describe("box", T, area)
    assert says["contact_share"] == says["cut_share"] == 0
    assert says["gap_mean_m"] == pytest.approx(0.06, abs=0.005)
    assert says["margin_m"] < -0.05


def test_a_plate_between_hoops_is_caged() -> None:
    slot = 0.35 + slot_centres(RACK_M[1])[2]
    caged = describe(
        "plate", *pose("plate", 0.0, slot, TABLE_M[2] + 0.015, rigid.ON_EDGE)
    )
    free = describe("plate", *pose("plate", 0.0, -0.3, TABLE_M[2], rigid.ON_EDGE))
    assert free["held"] == 0
    assert caged["held_opposed"] > 0.4
    assert caged["held_high"] > 0.4
    assert caged["held_margin_m"] > free["held_margin_m"] + 0.01


def test_the_room_above_is_that_below_the_board() -> None:
    boards = furniture_shape("open_shelf", (0.3, 0.9, 1.2)).supports
    says = describe("mug", *pose("mug", -1.0, 0.1, boards[0].height_m))
    assert says["clearance_m"] == pytest.approx(boards[0].clearance_m - 0.1, abs=0.01)
    assert describe("mug", *pose("mug", 0, 0, TABLE_M[2]))["clearance_m"] == 0.5


def test_a_bottle_lying_rolls_and_a_bottle_standing_does_not() -> None:
    stands = describe("bottle", *pose("bottle", 0.0, -0.2, TABLE_M[2]))
    lies = describe("bottle", *pose("bottle", 0.0, -0.2, TABLE_M[2], tuple(LYING)))
    assert lies["shape_base_growth"] < 0.75 < stands["shape_base_growth"]
    assert lies["shape_base_length_m"] > 3 * lies["shape_base_width_m"]
    assert stands["shape_mass_height"] > 0.3 > lies["shape_height_m"]


@pytest.mark.parametrize("shape", ["box", "mug", "plate"])
def test_features_do_not_change_when_scene_and_object_turn_together(
    shape: str,
) -> None:
    yaw = np.deg2rad(30)  # Two of the directions in which reach is measured.
    turn = rigid.from_yaw(yaw, (0, 0, 0))
    for x, y, height in ((0.0, -0.2, 0.72), (0.36, -0.2, 0.72), (-0.7, 0.4, 0.0)):
        T, area = pose(shape, x, y, height)
        before = describe(shape, T, area)
        after = describe(shape, rigid.compose(turn, T[0])[None], area, field(yaw))
        assert after["margin_m"] == pytest.approx(before["margin_m"], abs=0.02)
        for name in ("base_contact_share", "overhang"):
            assert after[name] == pytest.approx(before[name], abs=0.15)
        for name in ("gap_mean_m", "cut_m", "slope", "clearance_m"):
            assert after[name] == pytest.approx(before[name], abs=0.02)


@pytest.mark.parametrize("shape", SHAPES)
def test_features_are_finite_wherever_the_object_is(shape: str) -> None:
    T, area = random_placements(200)
    T[:20, 4:] += 50.0
    T[20:40, 4:] *= 1e4
    for at in (field(), bare(3), bare(200)):
        rows = stability_features(at, thing(shape), T, area)
        assert np.isfinite(rows).all()
        heights = rest_heights(at, thing(shape), T[:, :4], T[:, 4:6], area)
        assert np.isfinite(heights).all()
        assert (heights >= area - 0.4).all()


@cache
def bare(n: int) -> PlacingField:
    """Return a few points without normals."""
    points = np.random.default_rng(n).uniform(-1, 1, (n, 3)).astype(np.float32)
    none = np.zeros((n, 3))
    return PlacingField(Cloud(points, none.astype(np.float32), none.astype("u1")), 0.02)


def test_no_placements_have_no_features() -> None:
    rows = stability_features(field(), thing("mug"), np.empty((0, 7)), np.empty(0))
    assert rows.shape == (0, len(STABILITY_FEATURES))
    none = rest_heights(
        field(), thing("mug"), np.empty((0, 4)), np.empty((0, 2)), np.empty(0)
    )
    assert none.shape == (0,)


def test_distances_to_a_box_are_those_of_its_formula() -> None:
    grid, half = object_grid(thing("box")), np.array(SHAPES["box"]) / 2
    low = np.array([grid.x_m, grid.y_m, grid.z_m])
    cells = np.indices(grid.cells.shape[:3]).reshape(3, -1).T
    beyond = np.abs(low + (cells + 0.5) / grid.per_m) - half
    outside = np.linalg.norm(np.maximum(beyond, 0), axis=1)
    expected = outside + np.minimum(beyond.max(axis=1), 0)
    off = np.abs(grid.cells.reshape(-1, 4)[:, 0] - expected)
    is_near = np.abs(expected) < 0.025
    assert np.quantile(off[is_near], 0.9) < 0.003
    assert off[is_near].max() < 0.02

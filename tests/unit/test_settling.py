"""Objects that would stay on a real table stay; what would fall falls."""

from dataclasses import replace
from functools import cache
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pybullet
import pytest
import trimesh
import yaml

from placing import rigid
from placing.physics.cutting import body_of, fixed_pieces
from placing.physics.settling import SettleConfig, settle, unrest
from placing.shapes.appliances import slot_centres
from placing.shapes.furniture import furniture_shape
from placing.shapes.objects import object_shape

STUDY = Path(__file__).parents[2] / "config" / "config.yaml"
CONFIG = SettleConfig(**yaml.safe_load(STUDY.read_text())["settling"])
TOP_M = 0.7
BOOK_M = (0.16, 0.22, 0.03)


def block(size_m, centre_m=(0.0, 0.0, 0.0)):
    return trimesh.creation.box(size_m).apply_translation(centre_m)


@cache
def table():
    """A table 1 m square on a floor, hollow below, so that it is no convex solid."""
    floor = block((6, 6, 0.1), (0, 0, -0.05))
    top = block((1, 1, 0.03), (0, 0, TOP_M - 0.015))
    sides = [block((0.03, 1, 0.69), (x, 0, 0.345)) for x in (-0.485, 0.485)]
    shell = trimesh.boolean.union([top, *sides])
    return {"floor": pieces(floor), "table": pieces(shell)}


def pieces(mesh):
    return fixed_pieces(mesh, CONFIG.margin_m)


def book(x, y, bottom_m, yaw=0.0):
    T = rigid.from_yaw(yaw, (x, y, bottom_m + BOOK_M[2] / 2))
    return body_of(block(BOOK_M), 0.5, CONFIG.margin_m), T


def stays(settled):
    return settled.moved_m < 1e-3 and settled.tilted_deg < 0.5


def test_a_box_on_a_table_stays():
    settled = settle(table(), {"book": book(0.1, 0.2, TOP_M, 0.4)}, CONFIG)["book"]
    assert stays(settled)
    assert settled.penetration_m < 1e-5
    assert settled.supports == ("table",)


@pytest.mark.parametrize(("overhang_m", "falls"), [(-0.01, False), (0.01, True)])
def test_a_box_falls_once_its_centre_is_beyond_the_edge(overhang_m, falls):
    placed = {"book": book(0.5 + overhang_m, 0.0, TOP_M)}
    settled = settle(table(), placed, CONFIG)["book"]
    assert stays(settled) != falls
    assert (settled.dropped_m > 0.5) == falls


@pytest.mark.parametrize("depth_m", [0.005, 0.01])
def test_a_sunk_box_is_as_deep_as_it_was_put(depth_m):
    settled = settle(table(), {"book": book(0, 0, TOP_M - depth_m)}, CONFIG)["book"]
    assert settled.penetration_m == pytest.approx(depth_m, abs=2e-4)
    assert settled.penetrated == "table"


def test_boxes_side_by_side_penetrate_by_their_overlap():
    placed = {"a": book(0, 0, TOP_M), "b": book(BOOK_M[0] - 0.012, 0, TOP_M)}
    settled = settle(table(), placed, CONFIG)
    assert settled["a"].penetration_m == pytest.approx(0.012, abs=2e-4)
    assert (settled["a"].penetrated, settled["b"].penetrated) == ("b", "a")


def test_boxes_a_centimetre_apart_leave_each_other_alone():
    placed = {"a": book(0, 0, TOP_M), "b": book(BOOK_M[0] + 0.01, 0, TOP_M)}
    settled = settle(table(), placed, CONFIG)
    assert all(stays(one) and one.penetration_m < 1e-5 for one in settled.values())


def test_a_stack_of_three_books_stays_and_each_carries_the_next():
    heights = [TOP_M + i * BOOK_M[2] for i in range(3)]
    placed = {f"book{i}": book(0.01 * i, 0, h, 0.1 * i) for i, h in enumerate(heights)}
    settled = settle(table(), placed, CONFIG)
    assert all(stays(one) for one in settled.values())
    carriers = [settled[f"book{i}"].supports for i in range(3)]
    assert carriers == [("table",), ("book0",), ("book1",)]


def test_something_in_the_air_falls_by_its_height():
    settled = settle(table(), {"book": book(0, 0, TOP_M + 0.2)}, CONFIG)["book"]
    assert settled.dropped_m == pytest.approx(0.2, abs=1e-3)
    assert settled.tilted_deg < 1.0


@pytest.mark.parametrize(("slope_deg", "slides"), [(25, False), (45, True)])
def test_a_box_slides_where_the_slope_exceeds_its_friction(slope_deg, slides):
    # On a slope of 35 degrees the friction 0.7 just holds.
    angle = np.deg2rad(slope_deg)
    T = np.array([np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0, 0.0, 0.0, 0.0])
    ramp = block((4, 4, 0.1)).apply_transform(rigid.homogeneous(T))
    above = T.copy()
    above[4:] = rigid.apply(T, np.array([[0.0, 0.0, 0.05 + BOOK_M[2] / 2]]))[0]
    body = body_of(block(BOOK_M), 0.5, CONFIG.margin_m)
    settled = settle({"ramp": pieces(ramp)}, {"book": (body, above)}, CONFIG)["book"]
    assert (settled.moved_m > 0.3) == slides
    if slides:
        g = 9.81 * (np.sin(angle) - 0.7 * np.cos(angle))
        expected_m = g * CONFIG.duration_s**2 / 2
        assert settled.moved_m == pytest.approx(expected_m, rel=0.1)


PLATE_M = (0.26, 0.26, 0.026)


@cache
def plate():
    return body_of(object_shape("plate", PLATE_M).mesh, 0.6, CONFIG.margin_m)


def plate_on_edge(y, bottom_m):
    return plate(), np.array([*rigid.ON_EDGE, 0.0, y, bottom_m + PLATE_M[0] / 2])


def test_a_plate_on_edge_falls_alone_but_stays_in_the_slot_of_a_rack():
    alone = settle(table(), {"plate": plate_on_edge(0, TOP_M)}, CONFIG)["plate"]
    assert alone.tilted_deg > 60

    rack = furniture_shape("dish_rack", (0.34, 0.42, 0.22))
    fixed = {"rack": pieces(rack.mesh)}
    y, bottom_m = slot_centres(0.42)[0], rack.supports[0].height_m
    held = settle(fixed, {"plate": plate_on_edge(y, bottom_m)}, CONFIG)["plate"]
    assert held.penetration_m < CONFIG.max_penetration_m
    assert held.tilted_deg < CONFIG.max_tilted_deg
    assert held.moved_m < CONFIG.max_moved_m


def test_a_mug_fits_under_the_screen_of_a_laptop():
    laptop = object_shape("laptop", (0.305, 0.32, 0.215)).mesh
    mug = object_shape("mug", (0.03, 0.04, 0.04)).mesh
    top = TOP_M + 0.215 / 2
    placed = {
        "laptop": (body_of(laptop, 1.6, 1e-3), rigid.from_yaw(0, (0, 0, top))),
        # Above the keyboard, where the hull of the laptop as a whole would be.
        "mug": (body_of(mug, 0.1, 1e-3), rigid.from_yaw(0, (0, 0, TOP_M + 0.06))),
    }
    assert settle(table(), placed, CONFIG)["mug"].penetration_m == 0.0


def test_a_body_stands_whatever_the_height_of_its_mass_centre():
    low = settle(table(), {"book": book(0, 0, TOP_M)}, CONFIG)["book"]
    broom = object_shape("broom", (0.12, 0.34, 1.15)).mesh  # its mass centre is low
    T = rigid.from_yaw(pi / 3, (0, 0, TOP_M + 1.15 / 2))
    high = settle(table(), {"broom": (body_of(broom, 0.9, 1e-3), T)}, CONFIG)["broom"]
    assert stays(low)
    assert stays(high)


def test_furniture_that_is_left_out_for_being_far_changes_nothing():
    far = {"far": pieces(block((0.5, 0.5, 0.5), (2, 2, 0.25)))}
    placed = {"book": book(0.1, 0.1, TOP_M, 0.2)}
    assert settle(table() | far, placed, CONFIG) == settle(table(), placed, CONFIG)


def test_the_same_trial_gives_the_same_numbers():
    placed = {f"book{i}": book(0.3 * i - 0.3, 0.02 * i, TOP_M + 0.1) for i in range(3)}
    first, second = (settle(table(), placed, CONFIG) for _ in range(2))
    assert repr(first) == repr(second)


def test_a_longer_fall_takes_as_long_as_gravity_says():
    short = replace(CONFIG, duration_s=0.25)
    settled = settle({}, {"book": book(0, 0, 1.0)}, short)["book"]
    assert settled.dropped_m == pytest.approx(9.81 * 0.25**2 / 2, rel=0.03)
    assert settled.speed_m_s == pytest.approx(
        sqrt(2 * 9.81 * settled.dropped_m), rel=0.03
    )


@pytest.mark.parametrize("seed", range(40))
def test_who_is_watched_until_it_rests_has_the_fate_of_the_whole_time(seed):
    rng = np.random.default_rng(seed)
    at = rng.uniform(0.35, 0.55), rng.uniform(-0.1, 0.1)
    body, T = book(*at, TOP_M + rng.uniform(0, 0.03), rng.uniform(-3, 3))
    placed = {"book": (body, T), "other": book(0.3, 0.0, TOP_M, 0.2)}
    aims = {"book": T - np.array([0, 0, 0, 0, 0, 0, 0.02])}
    whole, watched = (
        settle(table(), placed, CONFIG, aims=aims, until=until)["book"]
        for until in ("", "book")
    )
    assert bool(unrest(watched, CONFIG)) == bool(unrest(whole, CONFIG))
    assert watched.penetration_m == whole.penetration_m


def test_what_rests_is_watched_no_longer(monkeypatch):
    steps, step = [], pybullet.stepSimulation
    monkeypatch.setattr(pybullet, "stepSimulation", lambda c: steps.append(step(c)))
    for until in ("", "book"):
        settle(table(), {"book": book(0.1, 0.2, TOP_M)}, CONFIG, until=until)
    whole = round(CONFIG.duration_s * CONFIG.step_rate_hz)
    assert whole < len(steps) < 4 / 3 * whole

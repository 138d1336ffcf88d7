"""Holders are closed solids, and hold what they are made for in the simulator."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from placing import rigid
from placing.physics.cutting import body_of, fixed_pieces
from placing.physics.settling import SettleConfig, settle
from placing.rigid import UPSIDE_DOWN
from placing.shapes.furniture import furniture_shape
from placing.shapes.holders import (
    PITCH_M,
    SLOT_M,
    hooks_height,
    rails_height,
    slots_of,
)
from placing.shapes.objects import object_shape

STUDY = Path(__file__).parents[2] / "config" / "config.yaml"
CONFIG = SettleConfig(**yaml.safe_load(STUDY.read_text())["settling"])
RACK_M, GLASS_M = (0.3, 0.5, 0.4), (0.085, 0.085, 0.21)
CASES = [
    ("stemware_holder", RACK_M),
    ("stemware_holder", (0.24, 0.75, 0.5)),
    ("stemware_holder", (0.2, 0.15, 0.2)),
    ("hooks", (0.07, 0.5, 0.12)),
    ("hooks", (0.03, 0.1, 0.3)),
    ("pen_holder", (0.08, 0.08, 0.1)),
    ("pen_holder", (0.2, 0.3, 0.25)),
]


@pytest.mark.parametrize(("kind", "size_m"), CASES)
def test_holders_are_closed_in_one_piece_and_fill_their_box(kind, size_m):
    mesh = furniture_shape(kind, size_m).mesh
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert len(mesh.split()) == 1
    depth, width, height = size_m
    expected = [[-depth / 2, -width / 2, 0], [depth / 2, width / 2, height]]
    assert np.allclose(mesh.bounds, expected, atol=1e-6)


@pytest.mark.parametrize("shape", ["wine_glass", "martini_glass"])
def test_glasses_are_closed_hollow_and_fill_their_box(shape):
    mesh = object_shape(shape, GLASS_M).mesh
    assert mesh.is_watertight
    assert np.allclose(mesh.extents, GLASS_M, atol=1e-6)
    assert mesh.volume < 0.25 * mesh.convex_hull.volume


def test_slots_are_apart_and_inside_the_holder():
    slots = slots_of(0.75)
    assert len(slots) > 3
    assert np.allclose(np.diff(slots), PITCH_M)
    assert np.abs(slots).max() + SLOT_M < 0.75 / 2


@cache
def holder(kind, size_m):
    return {kind: fixed_pieces(furniture_shape(kind, size_m).mesh, CONFIG.margin_m)}


@cache
def body(shape, size_m):
    return body_of(object_shape(shape, size_m).mesh, 0.15, CONFIG.margin_m)


def settled(kind, size_m, shape, object_m, pose):
    """Return what an object does that is let go alone at a holder."""
    placed = {"it": (body(shape, object_m), np.array(pose, float))}
    return settle(holder(kind, size_m), placed, CONFIG)["it"]


def test_a_glass_hangs_in_its_holder_and_falls_when_it_is_turned_upright_in_it():
    at = (0.02, slots_of(RACK_M[1])[1])
    # Its foot is 2 cm high and as wide as the slot a little below that.
    z = rails_height(RACK_M[2]) + 0.017 - GLASS_M[2] / 2
    args = "stemware_holder", RACK_M, "wine_glass", GLASS_M
    hung = settled(*args, (*UPSIDE_DOWN, *at, z))
    assert hung.penetration_m < CONFIG.max_penetration_m
    assert hung.moved_m < CONFIG.max_moved_m
    assert hung.tilted_deg < CONFIG.max_tilted_deg
    assert hung.supports == ("stemware_holder",)
    upright = settled(*args, (*rigid.IDENTITY, *at, z - 0.02))
    assert upright.dropped_m > CONFIG.max_drop_m


def test_a_pen_stands_in_a_pen_holder_but_not_beside_it():
    size_m, pen_m = (0.05, 0.05, 0.11), (0.142, 0.011, 0.013)
    inside = (0.0125, 0.0125, 0.005 + pen_m[0] / 2)
    args = "pen_holder", size_m, "pen", pen_m
    assert settled(*args, (*rigid.ON_EDGE, *inside)).tilted_deg < 20
    beside = (0.2, 0.2, 0.005 + pen_m[0] / 2)
    assert settled(*args, (*rigid.ON_EDGE, *beside)).dropped_m > 0.1


def test_a_spatula_lies_across_hooks_and_falls_from_their_tips():
    size_m, spatula_m = (0.13, 0.5, 0.12), (0.33, 0.085, 0.03)
    quarter = rigid.yaw_quaternion(np.pi / 2)
    args = "hooks", size_m, "spatula", spatula_m
    z = hooks_height(size_m[2]) + spatula_m[2] / 2 + 0.001
    across = settled(*args, (*quarter, 0.0, 0.0, z))
    assert across.penetration_m < CONFIG.max_penetration_m
    assert across.dropped_m < CONFIG.max_drop_m
    beyond = settled(*args, (*quarter, 0.15, 0.0, z + 0.05))
    assert beyond.dropped_m > CONFIG.max_drop_m

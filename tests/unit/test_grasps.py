"""Grasps: they fit the gripper, and hold where the sheet says."""

from dataclasses import replace

import numpy as np
import pytest
from robot_room import ROOT

from placing import rigid
from placing.errors import BadInput
from placing.robot.grasps import facing, grasps_of, read_grasps
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml

RULES = read_yaml(ROOT / "workflow" / "schemas" / "grasps.schema.yaml")
SHEET = read_grasps(ROOT / "config" / "grasps.csv", RULES)
ITEMS = read_catalogue(ROOT / "config" / "objects.csv")
OPENING_M, TIP_M = 0.086, 0.015


def grasps(item):
    return grasps_of(item, SHEET, OPENING_M, TIP_M)


@pytest.mark.parametrize("name", [n for n, i in ITEMS.items() if i.is_movable])
def test_every_movable_object_has_grasps_within_its_box_and_the_gripper(name):
    item = ITEMS[name]
    assert item.shape in SHEET.rows, "expected a grasp of its own shape"
    assert grasps(item)
    for grasp in grasps(item):
        at = np.abs(grasp.T_object_tool[4:])
        assert np.all(at <= np.array(item.size_m) / 2 + 0.03), grasp.name
        assert 0 < grasp.width_m <= OPENING_M
        assert np.isclose(np.linalg.norm(grasp.T_object_tool[:4]), 1)


def test_no_tip_goes_below_the_bottom_of_an_object():
    for item in ITEMS.values():
        low = -item.size_m[2] / 2 + min(TIP_M, item.size_m[2] / 2)
        assert all(g.T_object_tool[6] >= low - 1e-12 for g in grasps(item))


def test_what_is_wider_than_the_gripper_has_no_grasp():
    can = ITEMS["soda_can"]
    wide = replace(can, size_m=(0.2, 0.2, 0.122))
    assert grasps(can)
    assert not grasps(wide)


def test_turns_go_around_the_upright_axis_and_keep_pointing_inwards():
    rims = [g for g in grasps(ITEMS["bowl"]) if g.name.startswith("rim_tilted")]
    assert len(rims) == 8
    for grasp in rims:
        pointing = rigid.matrix(grasp.T_object_tool[:4])[:, 0]
        assert pointing[2] < -0.8
        assert pointing[:2] @ grasp.T_object_tool[4:6] < 0


def test_a_hand_without_pitch_is_level_and_with_a_quarter_turn_points_down():
    level, down = (rigid.matrix(facing(0.5, p, 0.0)) for p in (0.0, np.pi / 2))
    assert np.allclose(level[:, 0], [np.cos(0.5), np.sin(0.5), 0])
    assert np.allclose(down[:, 0], [0, 0, -1])
    assert np.allclose(down[:, 1], level[:, 1])  # the fingers close level in both
    assert np.allclose(rigid.matrix(facing(0.5, 0.0, np.pi / 2))[:, 1], [0, 0, 1])


def test_the_object_in_the_hand_is_the_inverse_of_the_hand_at_the_object():
    grasp = grasps(ITEMS["mug1"])[0]
    both = rigid.compose(grasp.T_object_tool, grasp.T_tool_object)
    assert np.allclose(both, [1, 0, 0, 0, 0, 0, 0], atol=1e-12)


def test_an_unknown_axis_is_one_line(tmp_path):
    lines = (ROOT / "config" / "grasps.csv").read_text().splitlines()
    path = tmp_path / "grasps.csv"
    path.write_text("\n".join([lines[0], lines[1].replace(",z,", ",up,")]) + "\n")
    with pytest.raises(BadInput, match="line 2: width_axis: value 'up'; expected one"):
        read_grasps(path, RULES)

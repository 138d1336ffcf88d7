"""A description that could harm, or is not one, is refused in one line."""

import shutil
import struct

import numpy as np
import pytest
import yaml
from robot_study import ROOT, model, schema, settings

from placing.errors import BadInput
from placing.robot.meshes import hull_of
from placing.robot.settings import read_robot
from placing.robot.urdf import MAX_BYTES, read_srdf, read_urdf

PLAIN = """<robot name="cart"><link name="base"/><link name="arm"><collision><geometry>
<mesh filename="package://some/robots/cart/arm.stl"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<axis xyz="0 0 2"/><limit lower="-1" upper="1"/>
<safety_controller soft_lower_limit="-0.5" soft_upper_limit="2"/></joint></robot>"""


@pytest.fixture
def cart(tmp_path):
    """The folder of a robot with one mesh."""
    folder = tmp_path / "robots" / "cart"
    folder.mkdir(parents=True)
    (folder / "cart.urdf").write_text(PLAIN)
    mesh = settings("pr2").folder / "pr2_description/meshes/gripper_v0/l_finger.stl"
    shutil.copy(mesh, folder / "arm.stl")
    return folder


def refusal(folder, old="", new=""):
    """The complaint about a description with one change."""
    path = folder / "cart.urdf"
    path.write_text(PLAIN.replace(old, new) if old else PLAIN)
    with pytest.raises(BadInput) as caught:
        read_urdf(path, folder)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message


def test_a_plain_description_is_read(cart):
    description = read_urdf(cart / "cart.urdf", cart)
    joint = description.joints["j"]
    assert (joint.lower, joint.upper) == (-0.5, 1)
    assert np.array_equal(joint.axis, [0, 0, 1])
    assert description.shapes[0].mesh == cart / "arm.stl"


def test_declarations_are_refused(cart):
    for declaration in (
        '<!DOCTYPE robot [<!ENTITY a "b">]>',
        '<!DOCTYPE robot SYSTEM "file:///etc/passwd">',
    ):
        assert "document type" in refusal(cart, "<robot", f"{declaration}<robot")


def test_declarations_in_another_encoding_are_refused(cart):
    text = '<?xml version="1.0" encoding="utf-16"?><!DOCTYPE a [<!ENTITY b "c">]><a/>'
    (cart / "cart.urdf").write_bytes(text.encode("utf-16"))
    with pytest.raises(BadInput, match="plain UTF-8 XML"):
        read_urdf(cart / "cart.urdf", cart)


def test_a_large_file_is_refused(cart):
    padding = " " * MAX_BYTES
    assert "too large" in refusal(cart, "<robot name", f"<robot {padding}name")


def test_broken_xml_is_refused(cart):
    assert "expected plain UTF-8 XML" in refusal(cart, "</robot>", "")


@pytest.mark.parametrize(
    "name",
    [
        "package://some/robots/cart/../../../etc/passwd",
        "/etc/passwd",
        "package://some/robots/other/arm.stl",
        "file:///etc/cart/../passwd",
    ],
)
def test_a_mesh_outside_the_folder_of_its_robot_is_refused(cart, name):
    complaint = refusal(cart, "package://some/robots/cart/arm.stl", name)
    assert "expected a file inside cart/" in complaint
    assert "link 'arm'" in complaint


def test_a_link_to_a_mesh_outside_is_refused(cart, tmp_path):
    shutil.move(cart / "arm.stl", tmp_path / "arm.stl")
    (cart / "arm.stl").symlink_to(tmp_path / "arm.stl")
    assert "expected a file inside cart/" in refusal(cart)


def test_a_mesh_that_is_missing_is_named(cart):
    assert "other.stl does not exist" in refusal(cart, "arm.stl", "other.stl")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('child link="arm"', 'child link="leg"', "unknown link 'leg'"),
        ('type="revolute"', 'type="floating"', "type 'floating'"),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 0"/>', "expected a direction"),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 nan 1"/>', "finite numbers"),
        ('<parent link="base"/>', "", "<parent> is missing"),
        ('<link name="base"/>', "<link/>", "attribute 'name' is missing"),
        ("<mesh ", "<capsule ", "collision shape 'capsule'"),
    ],
)
def test_what_is_wrong_is_named(cart, old, new, expected):
    assert expected in refusal(cart, old, new)


def test_a_damaged_mesh_is_named(cart):
    (cart / "arm.stl").write_bytes(b"\0" * 80 + struct.pack("<I", 10**9) + b"\0" * 500)
    shape = read_urdf(cart / "cart.urdf", cart).shapes[0]
    with pytest.raises(BadInput, match=r"arm\.stl: 584 bytes; expected a binary STL"):
        hull_of(shape)


def test_harmless_pairs_of_the_pr2_are_read():
    pairs = read_srdf(settings("pr2").srdf)
    assert frozenset(("base_link", "torso_lift_link")) in pairs
    assert len(pairs) > 1000


def test_no_listed_pair_is_checked():
    robot = model("pr2")
    pairs = {frozenset((robot.links[i], robot.links[j])) for i, j in robot.self_pairs}
    assert pairs
    assert not pairs & read_srdf(robot.settings.srdf)


def changed(tmp_path, **changes):
    """The complaint about a robot file with some fields changed."""
    content = yaml.safe_load((ROOT / "config/robots/pr2.yaml").read_text())
    path = tmp_path / "changed.yaml"
    path.write_text(yaml.safe_dump({**content, **changes}))
    with pytest.raises(BadInput) as caught:
        read_robot(path, schema())
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message.removeprefix(f"{path}: ")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"package": "no-such-package"}, "package: 'no-such-package' is not installed"),
        ({"urdf": "pr2_description/urdf/pr3.urdf"}, "pr3.urdf' does not exist"),
        ({"urdf": "pr2_description/../../../../x"}, "expected a path inside it"),
        ({"urdf": "/etc/passwd"}, "urdf: value '/etc/passwd'"),
        ({"folder": "../../.."}, "folder: value '../../..'"),
        ({"stow": [0.0]}, "stow: 1 values; expected 7"),
        ({"torso_heights_m": [0.5]}, "torso_heights_m: value 0.5"),
        ({"reach_m": [0.9, 0.4]}, "reach_m: value [0.9, 0.4]"),
        ({"inverse": "analytic"}, "inverse: value 'analytic'; expected one of"),
        ({"speed": 1}, "unknown key 'speed'"),
        ({"gripper_closed": {"a": 0}}, "gripper_closed: joints a"),
    ],
)
def test_a_wrong_field_of_a_robot_file_is_named(tmp_path, changes, expected):
    assert expected in changed(tmp_path, **changes)

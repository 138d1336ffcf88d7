"""The scenarios are those of Section 4.3, and leave the objects of the study alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import Polygon

from placing.physics.arrangements import check_arrangement
from placing.physics.cutting import bodies_of, fixed_of
from placing.physics.settling import SettleConfig
from placing.plans.robot_candidates import Candidate
from placing.plans.scenarios import PICKUP_TABLE, off_table
from placing.rooms.catalogue import read_catalogue
from placing.rooms.checks import footprint
from placing.rooms.file import read_yaml
from placing.rooms.reader import layout_reader
from placing.shapes.objects import object_shape

ROOT = Path(__file__).parents[2]
SCHEMA = ROOT / "workflow" / "schemas" / "room.schema.yaml"
CATALOGUE = ROOT / "config" / "scenario_objects.csv"
SETTLING = SettleConfig(**read_yaml(ROOT / "config" / "config.yaml")["settling"])
# SOURCE: Section 4.3 of the paper; "cup" is what is neither cup nor saucer.
OBJECTS = {
    "kitchen": ["beer_bottle", "cup1", "soda_can", "hand_torch", "shoe1"],
    "office": ["mouse1", "pen1", "trash_bin3", "book1", "book2", "book4"],
    "livingroom": ["cup1", "tissue_box", "book2", "soda_can", "throw_pillow"],
}
FURNITURE = {
    "kitchen": {"fridge", "table"},
    "office": {"desk", "bookcase"},
    "livingroom": {"couch", "coffee_table"},
}


def layout_of(scene):
    return layout_reader(ROOT / "resources" / "scenarios", SCHEMA, CATALOGUE)(scene)


@pytest.mark.parametrize("scene", OBJECTS)
def test_a_scenario_has_the_objects_and_furniture_of_the_paper(scene):
    layout = layout_of(scene)
    assert [item.object_id for item in layout.objects] == OBJECTS[scene]
    assert FURNITURE[scene] <= {piece.kind for piece in layout.furniture}
    assert all(item.is_movable for item in layout.objects)


@pytest.mark.parametrize("scene", OBJECTS)
def test_everything_waits_on_the_pick_up_table_and_stays_there(scene):
    layout = layout_of(scene)
    (start,) = layout.arrangements
    fixed = fixed_of(layout, SETTLING.margin_m)
    bodies = bodies_of(layout.objects, SETTLING.margin_m)
    checks = check_arrangement(layout, start, fixed, bodies, SETTLING)
    assert {c.object: c.reason for c in checks} == dict.fromkeys(OBJECTS[scene], "")
    assert {c.support for c in checks} == {PICKUP_TABLE}
    assert max(c.moved_m for c in checks) < 0.005


def test_objects_of_the_study_are_the_same_in_the_scenarios():
    study = read_catalogue(ROOT / "config" / "objects.csv")
    scenario = read_catalogue(CATALOGUE)
    shared = [name for name in scenario if name in study]
    assert shared == ["soda_can", "mouse1", "pen1", "book1", "book2", "book4"]
    for name in shared:
        assert scenario[name] == study[name]
    categories = {item.category for item in study.values()}
    assert {item.category for item in scenario.values()} <= categories
    assert len(study) == 47


@pytest.mark.parametrize("name", ["hand_torch", "tissue_box", "shoe1", "beer_bottle"])
def test_what_the_study_lacks_is_a_closed_solid_of_its_size(name):
    item = read_catalogue(CATALOGUE)[name]
    mesh, half = object_shape(item.shape, item.size_m).mesh, np.array(item.size_m) / 2
    assert mesh.is_volume
    np.testing.assert_allclose(mesh.bounds, [-half, half], atol=1e-6)


def test_nothing_is_put_back_on_the_pick_up_table():
    table = next(
        f for f in layout_of("kitchen").furniture if f.furniture_id == PICKUP_TABLE
    )
    on = Candidate("cup1", 0, 0, True, "area1", (4.3, 2.2, 0.72), 0.0, -1.0)
    off = replace(on, resting_point=(1.0, 1.0, 0.75))
    outline = footprint(table.size_m, table.T_world_furniture)
    assert isinstance(outline, Polygon)
    assert off_table({"cup1": [on, off]}, outline) == {"cup1": [off]}

"""Figures 4 and 5 show the people, the density and the objects that they say."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from recorded import count_rows

from placing.candidates import Candidates
from placing.errors import PlacingError
from placing.people import skeleton
from placing.people.human import HumanPoses, prior_of
from placing.pictures.office import draw_arranged, draw_people, heat_of, likeliest
from placing.pictures.office_content import PEOPLE, Figure, Office, Tables, office_of
from placing.pictures.pages import Key, page
from placing.pictures.people import COLD, KIND_COLOURS, Person, body, heat, limb
from placing.recordings.office import write_arranged, write_people
from placing.rooms.catalogue import read_catalogue
from placing.rooms.file import read_yaml
from placing.rooms.reader import read_layout
from placing.scene import Scene

ROOT = Path(__file__).parents[2]
RERUN = Path(sys.executable).with_name("rerun")
FIGURE = Figure("rooms", "dp", "monitor", 7)


def poses_of(question: str, n_sweeps: int) -> pd.DataFrame:
    """Return a chain with two people in each sweep; the log joint rises."""
    sample = np.repeat(np.arange(n_sweeps), 2)
    columns = {
        "question": question,
        "sample": sample,
        "kind": np.where(np.arange(2 * n_sweeps) % 2, "standing", "sitting_upright"),
        "x_m": 1.0 + 0.01 * sample,
        **{"y_m": 1.5, "z_m": 0.45, "yaw_rad": 0.5, "n_objects": 3},
        "log_joint": sample.astype(float),
    }
    return pd.DataFrame(columns)


@pytest.fixture(scope="module")
def parts():
    """Return what `office_of` is given for a real room and made-up answers."""
    catalogue = read_catalogue(ROOT / "config/objects.csv")
    schema = read_yaml(ROOT / "workflow/schemas/room.schema.yaml")
    layout = read_layout(ROOT / "resources/rooms/office1.yaml", catalogue, schema)
    arrangements = layout.arrangements
    scene = Scene(layout.scene, layout.kind, (), layout.objects, arrangements)
    x, y = np.meshgrid(np.arange(1.0, 2.01, 0.05), np.arange(2.4, 2.81, 0.05))
    places = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 0.74)])
    n = len(places)
    density = np.exp(-20 * ((places[:, :2] - [1.5, 2.6]) ** 2).sum(axis=1))
    kind = np.repeat(np.arange(6, dtype=np.uint8), 4)
    location = np.column_stack([np.linspace(0.5, 2.9, 24), np.ones(24), np.zeros(24)])
    yaw = np.tile(np.arange(4) * np.pi / 2, 6)
    valid = HumanPoses(kind, location, yaw, prior_of(kind))
    placed = arrangements[1].placements
    answers = pd.DataFrame(
        {
            "object": [p.object_id for p in placed],
            "area": "area1",
            "status": "placed",
            **{f"{a}_m": [p.location[i] for p in placed] for i, a in enumerate("xyz")},
            **{
                f"q{a}": [p.orientation[i] for p in placed]
                for i, a in enumerate("wxyz")
            },
        }
    )
    answers.loc[0, "status"] = "no place fits"
    return {
        "figure": FIGURE,
        "layout": layout,
        "model": (scene, Candidates(places, np.zeros(n, np.int32), places), valid),
        "tables": Tables(
            pd.concat(
                [poses_of("labeller1/monitor", 20), poses_of("labeller1/book", 9)],
                ignore_index=True,
            ),
            poses_of("all", 8),
            answers,
        ),
        "densities": {"dp/labeller1/monitor/monitor": density / density.sum()},
    }


@pytest.fixture(scope="module")
def office(parts) -> Office:
    """Return what the figures show of this room."""
    return office_of(**parts)


@pytest.mark.parametrize("kind", skeleton.KINDS)
def test_a_body_is_as_thick_around_its_bones_as_the_skeleton_says(kind):
    person = Person(kind, np.array([1.0, -2.0, 0.45]), 0.7)
    mesh, joints = body(person), person.joints()
    inside = np.full(len(mesh.vertices), np.inf)
    for a, b in skeleton.BONES:
        along = joints[b] - joints[a]
        share = np.clip((mesh.vertices - joints[a]) @ along / (along @ along), 0, 1)
        axis = joints[a] + share[:, None] * along
        radius = (1 - share) * skeleton.RADIUS_M[a] + share * skeleton.RADIUS_M[b]
        depth = np.linalg.norm(mesh.vertices - axis, axis=1) - radius
        inside = np.minimum(inside, depth)
    assert inside.max() < 0.01
    assert np.abs(inside).min() < 1e-9
    assert (mesh.visual.face_colors[:, :3] == KIND_COLOURS[kind]).all()


def test_the_sides_of_a_limb_look_outwards():
    mesh = limb(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.1, 0.1)
    outwards = mesh.triangles_center * [1, 1, 0]
    assert (np.einsum("ij,ij->i", mesh.face_normals, outwards) > 0.05).all()


def test_heat_covers_the_warm_places_and_no_other():
    x, y = np.meshgrid(np.arange(5) * 0.05, np.arange(4) * 0.05)
    places = np.column_stack([x.ravel(), y.ravel(), np.full(20, 0.7)])
    density = np.arange(20) / 190
    mesh = heat(places, density, 0.05)
    is_warm = density > COLD * density.max()
    assert mesh.area == pytest.approx(is_warm.sum() * 0.05**2)
    assert (mesh.face_normals[:, 2] > 0.99).all()
    hottest = mesh.triangles_center[:, :2] - places[-1, :2]
    near = np.abs(hottest).max(axis=1) < 0.025
    assert near.sum() == 2
    assert len(np.unique(mesh.visual.face_colors[near], axis=0)) == 1


def test_the_likeliest_places_are_the_fewest_that_hold_the_mass():
    density = np.array([0.05, 0.5, 0.1, 0.35])
    np.testing.assert_array_equal(likeliest(density), [1, 3])


def test_people_at_random_are_valid_poses_and_as_many_as_are_sampled(parts, office):
    assert len(office.random) == len(office.sampled) == PEOPLE
    _, _, valid = parts["model"]
    for person in office.random:
        is_kind = np.array(skeleton.KINDS)[valid.kind] == person.kind
        is_here = (valid.location == person.location).all(axis=1)
        assert (is_kind & is_here & (valid.yaw == person.yaw)).any()


def test_sampled_people_are_of_the_question_and_far_apart_in_the_chain(office):
    sweeps = sorted(
        {round((person.location[0] - 1) / 0.01) for person in office.sampled}
    )
    assert sweeps == [0, 4, 8, 11, 15, 19]


def test_the_users_of_an_empty_room_are_those_of_the_likeliest_sweep(office):
    assert [person.location[0] for person in office.users] == [1.07, 1.07]


def test_given_objects_lack_the_wanted_category_and_placed_ones_the_unplaced(office):
    names = {item.object_id for item in office.layout.objects}
    assert set(office.given) == names - {"monitor1"}
    first = office.layout.arrangements[1].placements[0].object_id
    assert set(office.placed) == names - {first}


def test_a_category_that_the_room_lacks_is_named_in_one_line(parts):
    with pytest.raises(PlacingError, match=r"office1.*'piano'") as caught:
        office_of(**parts | {"figure": replace(FIGURE, category="piano")})
    assert "\n" not in str(caught.value)


def test_a_page_holds_tiles_title_key_and_notes():
    red = np.zeros((60, 260, 3), np.uint8) + np.array([250, 0, 0], np.uint8)
    key = Key({"sitting": (1, 2, 3)}, "density", "turbo")
    drawn = page({"a": red, "b": red}, 2, (260, 60), "Title", ["note"], key)
    assert (drawn == (250, 0, 0)).all(axis=2).sum() == 2 * 60 * 260
    assert (drawn == (1, 2, 3)).all(axis=2).sum() > 20
    without = page({"a": red, "b": red}, 2, (260, 60), "Title", ["note"], Key({}))
    colours = [len(np.unique(p.reshape(-1, 3), axis=0)) for p in (drawn, without)]
    assert colours[0] > colours[1] + 100


def test_pictures_show_people_in_their_colours(office):
    size = (150, 140)
    bare = replace(office.layout, furniture=office.layout.furniture[:2])
    few = {name: office.given[name] for name in ("mug1", "book1")}
    office = replace(office, layout=bare, given=few, placed=few)
    arranged = draw_arranged(office, size)
    np.testing.assert_array_equal(arranged, draw_arranged(office, size))
    nobody = draw_arranged(replace(office, users=()), size)
    assert (arranged != nobody).any(axis=2).sum() > 200
    assert draw_people(office, size).shape[0] > arranged.shape[0] + size[1]


def test_recordings_hold_what_the_figures_show(tmp_path, office):
    four, five = tmp_path / "figure4.rrd", tmp_path / "figure5.rrd"
    write_people(four, office)
    write_arranged(five, office)
    bodies = {f"/world/{name}/bodies" for name in ("random", "sampled")}
    assert {"/world/room", "/world/given", "/world/density", *bodies} <= set(
        count_rows(four)
    )
    assert {"/world/room", "/world/placed", "/world/users/bodies"} <= set(
        count_rows(five)
    )
    verify = [RERUN, "rrd", "verify", four, five]
    assert subprocess.run(verify, check=False, capture_output=True).returncode == 0
    assert four.stat().st_size < 2.5e6


def test_heat_lies_on_the_places_of_the_room(office):
    low, high = heat_of(office).bounds
    assert (low >= office.places.min(axis=0) - 0.026).all()
    assert (high <= office.places.max(axis=0) + 0.026).all()

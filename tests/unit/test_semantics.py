"""Objects are learned to belong where labellers put things that look like them."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from study import SETTINGS, area, placement, plane, study_scene
from test_area_descriptors import cloud_of

from placing.artifacts.semantics import read_semantics, write_semantics
from placing.errors import BadArtifact
from placing.places import find_candidates
from placing.psi.area_descriptors import AREA_DESCRIPTORS, describe_areas
from placing.psi.labelled_areas import carrying_areas, label_scene, label_shares
from placing.psi.object_descriptors import describe_objects
from placing.psi.semantics import (
    LabelledScene,
    SemanticsConfig,
    learn_semantics,
    log_odds,
    log_psi_semantics,
    unaware,
)
from placing.scene import Arrangement, Scene, SceneObject
from placing.seeds import generator

CONFIG = SemanticsConfig(80, (1.0,), (10.0, 100.0), 2)
DRINKS = (
    SceneObject("bottle1", "food", "bottle", (0.075, 0.075, 0.3), 0.9, False, True),
    SceneObject("can1", "food", "soda_can", (0.066, 0.066, 0.122), 0.36, False, True),
    SceneObject("mug1", "dishware", "mug", (0.084, 0.118, 0.098), 0.33, True, True),
)
CUSHIONS = (
    SceneObject("c1", "cushion", "cushion", (0.45, 0.45, 0.15), 0.6, False, True),
    SceneObject("c2", "cushion", "cushion", (0.3, 0.5, 0.13), 0.5, False, True),
)
OTHER_DRINKS = (
    SceneObject("milk", "food", "milk_carton", (0.07, 0.07, 0.235), 1.0, False, True),
    SceneObject("spray", "x", "spray_bottle", (0.115, 0.075, 0.265), 0.6, True, True),
    SceneObject("vase", "decoration", "vase", (0.15, 0.15, 0.28), 1.1, False, True),
)
FLOOR, TABLE, COUCH = 0, 1, 2


def livingroom(number, softness=1.0):
    """Return a floor, a coffee table and a couch seat of alike heights and sizes."""
    rng = generator(number, "livingroom")
    heights = 0.42 + rng.uniform(-0.04, 0.04, 2)
    depth, width = rng.uniform(0.55, 0.75), rng.uniform(1.0, 1.6)
    sides = (1.0, 1 + depth), (0.5, 0.5 + width)
    other = (2.2, 2.2 + depth), (0.5, 0.5 + width)
    parts = [plane((0, 4), (0, 3), 0), plane(*sides, heights[0])]
    known = None if softness is None else 0.0
    areas = (
        replace(area("floor", (0, 4), (0, 3), 0.0, is_floor=True), softness=known),
        replace(area("area1", *sides, heights[0]), softness=known),
        replace(area("area2", *other, heights[1]), softness=softness),
    )
    cloud = cloud_of(*parts, plane(*other, heights[1]))
    return areas, cloud, find_candidates(cloud, areas, SETTINGS.candidates)


def labelled(number, objects=DRINKS + CUSHIONS):
    """Return a living room whose labellers put drinks on tables, cushions on seats."""
    areas, cloud, candidates = livingroom(number)
    shares = np.zeros((len(objects), len(areas)))
    for row, item in zip(shares, objects, strict=True):
        soft = item.category == "cushion"
        row[[FLOOR, TABLE, COUCH]] = (0.1, 0.0, 0.9) if soft else (0.0, 0.9, 0.1)
    described = describe_areas(cloud, areas, candidates)
    return LabelledScene(
        f"livingroom{number}", describe_objects(objects, 0.01), described, shares
    )


@cache
def model(objects=DRINKS + CUSHIONS):
    """Return what is learned from eight living rooms."""
    rooms = [labelled(number, objects) for number in range(8)]
    return learn_semantics(generator(0, "test"), rooms, CONFIG)


def log_psi(learned, item, softness, number=50):
    """Return the log probability of an object on floor, table and couch."""
    areas, cloud, candidates = livingroom(number, softness)
    described = describe_areas(cloud, areas, candidates)
    (of_object,) = describe_objects([item], 0.01)
    return log_psi_semantics(learned, of_object, described)


@pytest.mark.parametrize("item", DRINKS, ids=lambda item: item.object_id)
def test_a_bottle_belongs_on_the_coffee_table_and_not_on_the_couch(item):
    found = log_psi(model(), item, softness=1.0)
    assert found[TABLE] > found[COUCH] + 1


def test_an_unseen_bottle_belongs_on_the_table_as_cans_and_cartons_do():
    found = log_psi(
        model(DRINKS[1:] + OTHER_DRINKS + CUSHIONS), DRINKS[0], softness=1.0
    )
    assert found[TABLE] > found[COUCH] + 0.5


@pytest.mark.parametrize("item", CUSHIONS, ids=lambda item: item.object_id)
def test_a_cushion_belongs_on_the_couch_and_not_on_the_coffee_table(item):
    found = log_psi(model(), item, softness=1.0)
    assert found[COUCH] > found[TABLE] + 1


@pytest.mark.parametrize("item", DRINKS + CUSHIONS, ids=lambda item: item.object_id)
def test_without_known_softness_seats_and_tables_of_one_height_are_alike(item):
    found = log_psi(model(), item, softness=None)
    assert np.isfinite(found).all()
    assert abs(found[TABLE] - found[COUCH]) < 1


def test_probabilities_are_those_of_the_labels():
    fresh = [labelled(number) for number in range(50, 56)]
    found = [1 / (1 + np.exp(-log_odds(model(), s.objects, s.areas))) for s in fresh]
    for shares in (0.0, 0.1, 0.9):
        said = [p[s.shares == shares].mean() for p, s in zip(found, fresh, strict=True)]
        assert np.mean(said) == pytest.approx(shares, abs=0.07)
    assert all((log_psi(model(), item, 1.0) <= 0).all() for item in DRINKS)


def test_log_odds_are_the_sum_over_landmarks():
    learned, scene = model(), labelled(60)
    fast = log_odds(learned, scene.objects, scene.areas)
    for i, thing in enumerate(scene.objects):
        for k, place in enumerate(scene.areas):
            pair = (np.concatenate([thing, place]) - learned.mean) / learned.scale
            odds = learned.intercept
            for landmark, weight in zip(
                learned.landmarks, learned.weights, strict=True
            ):
                odds += weight * np.exp(-np.sum((pair - landmark) ** 2))
            assert fast[i, k] == pytest.approx(odds, abs=1e-6)


def test_the_same_seed_learns_the_same():
    rooms = [labelled(number) for number in range(4)]
    one, two = (learn_semantics(generator(1, "t"), rooms, CONFIG) for _ in range(2))
    np.testing.assert_array_equal(one.weights, two.weights)
    np.testing.assert_array_equal(unaware(rooms[0]).areas[:, -2:], 0)
    assert AREA_DESCRIPTORS[-2:] == ("softness", "is_softness_known")


def test_a_single_scene_is_enough_to_learn_from():
    one = labelled(3)
    model = learn_semantics(generator(0, "one"), [one], CONFIG)
    odds = log_odds(model, one.objects, one.areas)
    assert odds[0, TABLE] > odds[0, COUCH]


def test_what_stands_on_an_object_counts_for_the_area_below():
    scene, _ = study_scene()
    book = SceneObject("b", "book", "book", (0.2, 0.2, 0.04), 0.5, True, True)
    items = [replace(book, object_id=f"book{i}") for i in range(4)]
    on = [
        replace(placement("book0", 1.0, 2.4, 0.82, 0.7), area=""),  # on book1
        placement("book1", 1.0, 2.4, 0.78, 0.0),
        replace(placement("book2", 1.0, 2.4, 0.76, 0.0), area="area2"),
        replace(placement("book3", 2.9, 0.1, 1.5, 0.0), area=""),  # in the air
    ]
    on[1] = replace(on[1], area="")
    stacked = Scene("s", "office", scene.areas, tuple(items), ())
    arrangement = Arrangement("labeller1", "", tuple(on))
    found = carrying_areas(stacked, arrangement)
    assert found == {"book0": "area2", "book1": "area2", "book2": "area2", "book3": ""}
    shares = label_shares(replace(stacked, arrangements=(arrangement,)))
    assert shares.tolist() == [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 0]]


def test_shares_are_those_of_the_labellers():
    scene, cloud = study_scene()
    places = find_candidates(cloud, scene.areas, SETTINGS.candidates)
    scene = replace(
        scene,
        objects=DRINKS[:1],
        arrangements=tuple(
            Arrangement(
                f"l{i}", "", (replace(placement("bottle1", 1, 2.4, 1, 0), area=name),)
            )
            for i, name in enumerate(("area1", "area2", "area2", "area2"))
        ),
    )
    found = label_scene(scene, cloud, places, 0.01)
    np.testing.assert_allclose(found.shares, [[0, 0.25, 0.75]])
    assert found.objects.shape[0] == 1
    assert found.areas.shape == (3, len(AREA_DESCRIPTORS))


@pytest.fixture
def path(tmp_path):
    """Return a written model."""
    write_semantics(tmp_path / "fold0.json", model(), ["livingroom1"])
    return tmp_path / "fold0.json"


def test_what_was_learned_comes_back(path):
    scene = labelled(61)
    before, after = (
        log_odds(m, scene.objects, scene.areas) for m in (model(), read_semantics(path))
    )
    np.testing.assert_allclose(before, after, atol=1e-5)


@pytest.mark.parametrize(
    ("field", "value", "shown"),
    [
        ("descriptors", {}, "descriptors: value {}"),
        ("weights", [], "weights: value []"),
        ("weights", None, "weights: value None"),
        ("intercept", "0", "intercept: value '0'"),
        ("intercept", float("nan"), "intercept: value nan"),
        ("mean", [0.0], "mean: value [0.0]"),
        ("landmarks", [[1.0], [1.0, 2.0]], "landmarks: value [[1.0]"),
        ("scale", "zeros", "scale[0]: value 0.0"),
    ],
)
def test_what_is_out_of_place_is_named_in_one_line(path, field, value, shown):
    document = json.loads(path.read_text())
    zeros = [0.0] * len(document["scale"])
    document[field] = zeros if value == "zeros" else value
    path.write_text(json.dumps(document))
    with pytest.raises(BadArtifact) as caught:
        read_semantics(path)
    assert str(caught.value).startswith(f"{path}: {shown}")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_no_model_is_told(path):
    path.write_text("[]")
    with pytest.raises(BadArtifact, match="the document: value"):
        read_semantics(path)

"""Areas too small for anything, and objects that fit nowhere: a reason for each."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import trimesh
from study import SETTINGS, area, study_model, study_scene
from test_areas import AREAS, block, find

from placing.areas.finder import find_areas
from placing.candidates import Candidates, fits
from placing.clouds.ply import Cloud
from placing.learning.learned import Choices
from placing.methods.answering import NO_PLACE, Asked
from placing.methods.names import METHODS
from placing.methods.scene_model import SceneModel
from placing.places import find_candidates
from placing.psi.object_clouds import ObjectCloud
from placing.psi.orientations import OrientationsConfig, orientations
from placing.scene import PlacingArea
from placing.seeds import generator
from placing.tasks import questions

WAYS = OrientationsConfig(8, 3, 12.0, 5.0, (12.0, 25.0), 0.4, 0.025)
TINY = area("area1", (1.01, 1.04), (1.01, 1.04), 0.4)
"""Narrower than the lattice of places: it holds none."""
SMALL = area("area1", (0.9, 1.1), (0.9, 1.1), 0.4)
"""It holds places, but nothing as wide as an object of the study but a mouse."""


def places_on(*areas: PlacingArea) -> Candidates:
    return find_candidates(study_scene()[1], areas, SETTINGS.candidates)


@pytest.fixture(scope="module")
def model() -> SceneModel:
    return study_model()


def test_a_post_too_narrow_for_an_area_is_none_and_hides_no_other() -> None:
    wide, post = (
        block((0.3, 0.8), (0.3, 0.8), (0, 0.5)),
        block((-1, -0.94), (0, 0.06), (0, 0.7)),
    )
    heights = [a.height_m for a in find(wide, post)]
    assert heights == pytest.approx([0.0, 0.5], abs=0.01)


@pytest.mark.parametrize("n", [1, 3, 200])
def test_a_cloud_without_a_wide_level_patch_has_no_areas(n: int) -> None:
    rng = np.random.default_rng(n)
    points = (rng.random((n, 3)) * np.array([0.05, 0.05, 2])).astype(np.float32)
    up = np.tile(np.array([0, 0, 1], np.float32), (n, 1))
    for normals in (up, up[:, [2, 1, 0]], 0 * up):
        colors = np.zeros((n, 3), np.uint8)
        assert find_areas(Cloud(points, normals, colors), AREAS) == ()


def test_an_area_narrower_than_the_lattice_has_no_places() -> None:
    floor = area("floor", (0, 3), (0, 3), 0.0, is_floor=True)
    both, alone = places_on(floor, TINY), places_on(floor)
    assert np.array_equal(both.location, alone.location)
    assert set(both.area) == {0}
    for areas in ((), (TINY,)):
        none = places_on(*areas)
        assert none.location.shape == (0, 3)
        assert none.area.shape == (0,)
        assert none.features.shape == (0, both.features.shape[1])
        item = study_scene()[0].objects[0]
        assert fits(none, item, 0.7).shape == (0,)


@pytest.mark.parametrize("areas", [(SMALL,), (TINY,), ()], ids=["small", "tiny", "no"])
@pytest.mark.parametrize("method", METHODS)
def test_each_object_of_a_scene_without_room_gets_a_reason(
    model: SceneModel, method: str, areas: tuple[PlacingArea, ...]
) -> None:
    wide = [replace(o, size_m=(0.4, 0.4, 0.3)) for o in model.scene.objects]
    # What is labelled stands somewhere: a scene without any place has no labels.
    has_place = len(places_on(*areas).location) > 0
    labels = model.scene.arrangements if has_place else ()
    scene = replace(model.scene, areas=areas, objects=tuple(wide), arrangements=labels)
    args = places_on(*areas), model.poses, model.learned, SETTINGS
    narrow = SceneModel(scene, *args)
    (question,) = questions(scene, "empty")
    stream = partial(generator, 0, "empty")
    answer = Asked(stream, narrow, question, Choices(2, 0.25)).answer(method)
    chosen = {chosen.item.object_id: chosen for chosen in answer.chosen}
    assert sorted(chosen) == sorted(o.object_id for o in scene.objects)
    for one in chosen.values():
        assert one.place is None
        assert one.placement is None
        assert one.reason == NO_PLACE
    for density in answer.densities.values():
        assert density.shape == (len(narrow.candidates.location),)
        assert not density.any()


@pytest.mark.parametrize("shape", ["ball", "needle"])
def test_an_object_that_rests_on_no_face_is_still_tried_upright(shape: str) -> None:
    """Whether it then stays is learned: it is not left out before."""
    ball = trimesh.creation.icosphere(3, 0.1)
    points = np.asarray(ball.vertices) * ([0.02, 0.02, 1] if shape == "needle" else 1)
    normals = np.asarray(ball.vertex_normals)
    cloud = ObjectCloud(shape, points, normals, np.zeros(3))
    tried = orientations(cloud, WAYS)
    assert tried[0].name == "upright"
    assert tried[0].quaternion.tolist() == [1, 0, 0, 0]

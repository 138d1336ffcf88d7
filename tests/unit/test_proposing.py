"""What is proposed stands on its area, upright where it can, and is scored by each."""

from functools import partial

import numpy as np
import pytest
from study import study_model, study_scene

from placing.artifacts.proposals import read_proposals, write_proposals
from placing.candidates import fits
from placing.errors import BadArtifact
from placing.joint.joint_options import DENSITIES, ProposalConfig
from placing.learning.learned import Choices
from placing.psi.area_descriptors import AREA_DESCRIPTORS
from placing.psi.contacts import STABILITY_FEATURES
from placing.psi.object_clouds import LookingConfig
from placing.psi.object_descriptors import OBJECT_DESCRIPTORS
from placing.psi.orientations import OrientationsConfig
from placing.psi.proposing import propose_for
from placing.psi.psi_object import PsiObject, PsiObjectConfig, box_of
from placing.psi.semantics import SemanticsModel
from placing.psi.stability import LEAF, StabilityModel
from placing.seeds import generator

ORIENTATIONS = OrientationsConfig(6, 3, 10.0, 5.0, (15.0,), 0.4, 0.03)
LOOKING = LookingConfig(0.01, 0.01)
CONFIG = PsiObjectConfig(0.1, 0.5, 0.936)


def stump(feature, threshold):
    """Return a model that believes in what has more of a feature than a threshold."""
    node = np.array([[STABILITY_FEATURES.index(feature), LEAF, LEAF]])
    return StabilityModel(
        *(STABILITY_FEATURES, 0.0, node, np.array([[threshold, 0.0, 0.0]])),
        *(np.array([[1, 0, 0]]), np.array([[2, 0, 0]])),
        *(np.array([[0.0, -4.0, 4.0]]), 1.0, 0.0),
    )


def tables_only():
    """Return semantics by which everything belongs at the height of a desk."""
    n_object, n = len(OBJECT_DESCRIPTORS), len(OBJECT_DESCRIPTORS + AREA_DESCRIPTORS)
    landmark, scale = np.zeros((1, n)), np.full(n, 1e6)
    at = n_object + AREA_DESCRIPTORS.index("height_m")
    landmark[0, at], scale[at] = 0.74 / 0.1, 0.1
    return SemanticsModel(np.zeros(n), scale, landmark, np.array([8.0]), -4.0)


@pytest.fixture(scope="module")
def model():
    return study_model()


@pytest.fixture(scope="module")
def psi(model):
    scene, cloud = study_scene()
    models = stump("margin_m", 0.01), tables_only()
    args = scene, cloud, model.candidates, models
    return PsiObject(*args, (CONFIG, LOOKING, ORIENTATIONS))


@pytest.fixture(scope="module")
def proposed(model, psi):
    stream = partial(generator, 0, "test")
    config = ProposalConfig(20, 10, 0.02, 0.03)
    return propose_for(stream, model, psi, Choices(2, 0.5), config)


def test_the_object_context_likes_areas_that_suit_and_carry(model, psi):
    (laptop, *_) = model.scene.objects
    allowed = fits(model.candidates, laptop, 0.7)
    density = psi.density(laptop, allowed, model.yaws)
    assert density.sum() == pytest.approx(1)
    assert (density[~allowed] == 0).all()
    on_desk = np.isclose(model.candidates.location[:, 2], 0.74)
    assert density[on_desk].max() > 40 * density[~on_desk].max()
    inside = model.candidates.feature("edge_distance_m") > 0.2
    assert density[on_desk & inside & allowed].min() > 0.5 * density.max()


def test_what_is_proposed_stands_on_its_area(model, proposed):
    found = proposed.proposals
    upright = found.orientation == "upright"
    bottom = found.box[:, 2] - found.box[:, 5] / 2
    height = model.candidates.location[found.place, 2]
    assert np.abs(bottom - height)[upright].max() < 0.01
    np.testing.assert_allclose(
        found.box[:, :2], model.candidates.location[found.place, :2], atol=0.02
    )


def test_every_place_is_tried_with_every_heading_and_by_every_context(model, proposed):
    found = proposed.proposals
    for i in range(len(model.scene.objects)):
        of = found.object == i
        places = np.unique(found.place[of])
        assert of.sum() == 8 * len(places)
        for name in DENSITIES:
            share = np.exp(getattr(found, f"log_{name}")[of]).sum()
            assert 0 < share <= 1 + 1e-9
        for name, densities in proposed.densities.items():
            assert densities[i].sum() == pytest.approx(1), name


def test_only_objects_alike_are_stacked(model, proposed):
    pairs = {tuple(sorted(map(int, row[:2]))) for row in proposed.stacks}
    names = [item.object_id for item in model.scene.objects]
    assert pairs == {(names.index("mouse1"), names.index("mouse2"))}


def test_the_box_of_a_turned_object_holds_all_of_it(model, psi):
    for item in model.scene.objects:
        for way in psi.ways(item):
            centre, size = box_of(psi.cloud(item), way.quaternion)
            assert size.min() > 0
            assert np.sort(size)[-1] <= np.linalg.norm(item.size_m) + 1e-9
            if way.name == "upright":
                np.testing.assert_allclose(size, item.size_m, rtol=0.2, atol=0.02)
                np.testing.assert_allclose(centre, 0, atol=0.02)


def test_proposals_survive_a_file_and_damage_is_refused(proposed, tmp_path):
    path = tmp_path / "office1.npz"
    write_proposals(path, proposed)
    again = read_proposals(path)
    np.testing.assert_array_equal(again.proposals.place, proposed.proposals.place)
    np.testing.assert_allclose(
        again.densities["dp"], proposed.densities["dp"], atol=1e-6
    )
    proposed.proposals.box[0, 0] = np.nan
    write_proposals(path, proposed)
    with pytest.raises(BadArtifact, match="box: expected finite numbers"):
        read_proposals(path)

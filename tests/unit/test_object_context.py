"""Given objects say where others lie, as the labelled arrangements taught."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from study import study

from placing import rigid
from placing.candidates import Candidates
from placing.methods.object_context import (
    BROAD_RELATION,
    Given,
    ObjectContextConfig,
    Relations,
    given_object,
    learn_relations,
    mix,
    pair_density,
)
from placing.people.potential import Theta
from placing.scene import Arrangement, Placement, Scene, SceneObject

CONFIG = ObjectContextConfig(1.0, 50.0, 0.1, 0.05, 2.0)
THETA = Theta(-0.2, 0.4, 0.7, 3.0, 0.1, 0.2, 0.0, 0.0)
OTHER = Theta(0.5, 0.3, 2.0, 8.0, -0.3, 0.1, 0.0, 0.0)
KEYBOARD = SceneObject("keyboard", "keyboard", "x", (0.15, 0.45, 0.03), 1, True, True)
MOUSE = SceneObject("mouse", "mouse", "x", (0.1, 0.06, 0.04), 0.1, True, True)
PEN = SceneObject("pen", "pen", "x", (0.01, 0.15, 0.01), 0.1, False, True)


def density_of(relations, category, given, candidates, half_height_m):
    """Return the density of a category over the places, with every relation anew."""
    args = candidates, half_height_m
    parts = [pair_density(relations, category, one, *args) for one in given]
    return mix(parts, len(candidates.location), relations.sharpness)


def places(n=400, seed=0):
    """Return places at random on two heights of a room of 4 x 4 m."""
    rng = np.random.default_rng(seed)
    xyz = np.column_stack([rng.uniform(-2, 2, (n, 2)), rng.choice([0.0, 0.7], n)])
    return Candidates(xyz, np.zeros(n, np.int32), np.zeros((n, 4)))


def desk(name, xy, yaw):
    """Return a scene with a mouse 0.3 m right of the keyboard's user, and a pen."""
    # The user sits in front of the keyboard and looks back at it, along -x.
    right = np.array([-np.sin(yaw), np.cos(yaw)])
    at = [(KEYBOARD, xy), (MOUSE, xy + 0.3 * right), (PEN, xy - 0.4 * right)]
    placements = tuple(
        Placement(
            item.object_id,
            "desk",
            np.array([*where, 0.7 + item.size_m[2] / 2]),
            rigid.yaw_quaternion(yaw),
        )
        for item, where in at
    )
    labelled = Arrangement("labeller1", "tidy", placements)
    items = (KEYBOARD, MOUSE, PEN)
    return Scene(name, "office", (), items, (labelled,)), labelled


@pytest.fixture(scope="module")
def desks():
    """Return what twelve desks at random teach."""
    rng = np.random.default_rng(3)
    scenes = [
        desk(f"office{i}", rng.uniform(-2, 2, 2), rng.uniform(-np.pi, np.pi))
        for i in range(12)
    ]
    return learn_relations(scenes, CONFIG)


def moved(location, angle, shift):
    """Return points (..., 3) after a turn about z and a shift."""
    return location @ rigid.matrix(rigid.yaw_quaternion(angle)).T + shift


def explicit(theta, given, candidates, half_height_m):
    """Return the density of one given object from the families of `scipy.stats`."""
    density = []
    for x, y, z in candidates.location - given.location:
        d = max(np.hypot(x, y), 0.05)
        bearing = np.arctan2(y, x) - given.yaw_rad - theta.bearing_mean_rad
        scale = np.exp(theta.log_distance_mean)
        psi = stats.lognorm.pdf(d, theta.log_distance_sigma, scale=scale) / d
        if np.isfinite(given.yaw_rad):
            psi *= stats.vonmises.pdf(bearing, theta.bearing_kappa)
        height = z + half_height_m - theta.height_mean_m
        density.append(psi * stats.norm.pdf(height, scale=theta.height_sigma_m))
    return np.array(density) / np.sum(density)


@pytest.mark.parametrize("yaw", [0.4, -3.0, np.nan])
def test_a_given_object_says_what_the_formula_says(yaw):
    relations = Relations(BROAD_RELATION, {"mug": {"tv": THETA}}, 2.0)
    given = Given("tv", np.array([0.3, -0.2, 0.5]), yaw)
    density, entropy = pair_density(relations, "mug", given, places(), 0.05)
    expected = explicit(THETA, given, places(), 0.05)
    np.testing.assert_allclose(density, expected, rtol=2e-4, atol=1e-7)
    assert entropy == pytest.approx(stats.entropy(expected), abs=1e-4)


def test_given_objects_are_mixed_by_what_they_say():
    table = {"mug": {"tv": THETA, "book": OTHER}}
    relations = Relations(BROAD_RELATION, table, 1.5)
    given = [
        Given("tv", np.array([0.3, -0.2, 0.5]), 1.0),
        Given("book", np.array([-1.0, 0.2, 0.7]), np.nan),
        Given("never seen", np.array([1.0, 1.0, 0.7]), 2.0),
    ]
    parts = [
        explicit(theta, one, places(), 0.1)
        for theta, one in zip((THETA, OTHER, BROAD_RELATION), given, strict=True)
    ]
    weight = [np.exp(-1.5 * stats.entropy(part)) for part in parts]
    expected = np.average(parts, axis=0, weights=weight)
    density = density_of(relations, "mug", given, places(), 0.1)
    np.testing.assert_allclose(density, expected, rtol=1e-3, atol=1e-7)
    assert density.sum() == pytest.approx(1, abs=1e-12)


def test_nothing_given_is_uniform(desks):
    density = density_of(desks, "mouse", [], places(), 0.02)
    np.testing.assert_array_equal(density, np.full(400, 1 / 400))


def test_no_places_have_an_empty_density(desks):
    given = [Given("keyboard", np.zeros(3), 0.0)]
    none = places(0)
    assert density_of(desks, "mouse", given, none, 0.02).shape == (0,)
    assert density_of(desks, "mouse", [], none, 0.02).shape == (0,)


def test_a_far_object_leaves_a_density_that_sums_to_one(desks):
    given = [Given("keyboard", np.array([1e4, 0.0, 50.0]), 0.0)]
    density = density_of(desks, "mouse", given, places(), 0.02)
    assert density.sum() == pytest.approx(1)


def test_the_mouse_goes_to_the_right_of_the_user_of_a_keyboard(desks):
    candidates = places(4000)
    keyboard = Given("keyboard", np.array([0.5, 0.5, 0.715]), np.pi / 2)
    density = density_of(desks, "mouse", [keyboard], candidates, 0.02)
    best = candidates.location[np.argmax(density)]
    # The user is at +y and looks along -y: right of the user is -x.
    np.testing.assert_allclose(best, [0.2, 0.5, 0.7], atol=0.12)
    left = candidates.location[:, 0] > 0.5
    assert density[left].sum() < 0.15


def test_the_side_of_an_object_without_a_front_does_not_matter(desks):
    pen = np.array([0.0, 0.0, 0.705])
    relations = replace(desks, pairs={"mouse": {"pen": THETA}})
    densities = [
        pair_density(relations, "mouse", given_object(PEN, placement), places(), 0.02)
        for placement in (
            Placement("pen", "desk", pen, rigid.yaw_quaternion(yaw))
            for yaw in (0.0, 2.0)
        )
    ]
    np.testing.assert_array_equal(densities[0][0], densities[1][0])


def test_pairs_are_ordered_and_learned_in_the_frame_of_the_given_object(desks):
    seen = desks.pairs["mouse"]["keyboard"]
    assert seen.bearing_mean_rad == pytest.approx(np.pi / 2, abs=0.1)
    assert np.exp(seen.log_distance_mean) == pytest.approx(0.3, rel=0.15)
    back = desks.pairs["keyboard"]["mouse"]
    assert back.bearing_mean_rad == pytest.approx(-np.pi / 2, abs=0.1)
    assert "keyboard" not in desks.pairs["keyboard"]


def test_the_relation_of_a_pair_is_that_of_its_objects_and_the_prior():
    scene, labelled = study()[0], study()[0].arrangements
    relations = learn_relations([(scene, one) for one in labelled], CONFIG)
    distances, heights, bearings = [], [], []
    for arrangement in labelled:
        at = {p.object_id: p for p in arrangement.placements}
        given = at["laptop1"]
        for name in ("mouse1", "mouse2"):
            x, y, z = at[name].location - given.location
            distances.append(np.log(np.hypot(x, y)))
            bearings.append(np.exp(1j * (np.arctan2(y, x) + np.pi / 2)))
            heights.append(z)
    draws = np.random.default_rng(0).normal(size=(2, 100_000))
    common, found = relations.common, relations.pairs["mouse"]["laptop"]
    # Two arrangements of two mice weigh two; the prior weighs one.
    for values, mean, sigma, m, s in (
        (
            distances,
            common.log_distance_mean,
            common.log_distance_sigma,
            found.log_distance_mean,
            found.log_distance_sigma,
        ),
        (
            heights,
            common.height_mean_m,
            common.height_sigma_m,
            found.height_mean_m,
            found.height_sigma_m,
        ),
    ):
        pool = np.concatenate([np.repeat(values, 50_000), mean + sigma * draws[0]])
        assert m == pytest.approx(pool.mean(), abs=0.01)
        assert s == pytest.approx(pool.std(), abs=0.01)
    assert np.cos(found.bearing_mean_rad - np.angle(np.sum(bearings))) > 0.9


def test_arrangements_of_one_scene_count_as_one():
    one, two = desk("office1", np.zeros(2), 0.0), desk("office2", np.ones(2), 1.0)
    single = learn_relations([one, two], CONFIG)
    again = learn_relations([one, one, one, two], CONFIG)
    np.testing.assert_allclose(
        again.pairs["mouse"]["keyboard"].vector(),
        single.pairs["mouse"]["keyboard"].vector(),
        atol=1e-9,
    )


def test_a_mouse_belongs_to_the_nearest_keyboard():
    scene, labelled = desk("office1", np.zeros(2), 0.3)
    spare = replace(KEYBOARD, object_id="spare")
    far = np.array([5.0, 5.0, 0.715])
    shelf = Placement("spare", "shelf", far, rigid.yaw_quaternion(1.0))
    more = replace(labelled, placements=(*labelled.placements, shelf))
    both = replace(scene, objects=(*scene.objects, spare))
    bounds = replace(CONFIG, prior_strength=1e-9)
    one = learn_relations([(scene, labelled)], bounds)
    two = learn_relations([(both, more)], bounds)
    np.testing.assert_allclose(
        two.pairs["mouse"]["keyboard"].vector()[:6],
        one.pairs["mouse"]["keyboard"].vector()[:6],
        atol=1e-6,
    )
    assert np.exp(two.pairs["keyboard"]["keyboard"].log_distance_mean) > 6


def test_nothing_to_learn_from_leaves_the_broad_relation():
    relations = learn_relations([], CONFIG)
    assert relations.pairs == {}
    np.testing.assert_allclose(relations.common.vector(), BROAD_RELATION.vector())


def test_density_moves_with_the_room(desks):
    angle, shift = 2.1, np.array([3.0, -7.0, 0.0])
    given = [
        Given("keyboard", np.array([0.3, -0.2, 0.7]), 1.0),
        Given("pen", np.array([-1.0, 0.2, 0.7]), np.nan),
    ]
    after = [
        Given(one.category, moved(one.location, angle, shift), one.yaw_rad + angle)
        for one in given
    ]
    here = places()
    there = replace(here, location=moved(here.location, angle, shift))
    np.testing.assert_allclose(
        density_of(desks, "mouse", after, there, 0.02),
        density_of(desks, "mouse", given, here, 0.02),
        rtol=1e-3,
        atol=1e-7,
    )


def test_equal_parts_have_equal_shares():
    a, b = np.float32([0.5, 0.5, 0, 0]), np.float32([0, 0, 0.5, 0.5])
    entropy = float(np.log(2))
    np.testing.assert_allclose(mix([(a, entropy), (b, entropy)], 4, 3.0), 0.25)

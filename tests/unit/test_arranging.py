"""Transformed and cumulated sums equal sums of the potential written out in full."""

import numpy as np
import pytest

from placing.candidates import FEATURES, Candidates
from placing.methods import arranging
from placing.methods.arranging import UseOfObject
from placing.people.correlation import separate
from placing.people.human import HumanPoses
from placing.people.lattice import ArrangingConfig, Lattice
from placing.people.potential import Theta, height_factor, log_psi_human, log_psi_ori

THETA = Theta(-0.4, 0.5, 0.3, 2.0, -0.2, 0.3, 3.0, 1.5)
HALF_HEIGHT = 0.1
YAWS = np.arange(8) * np.pi / 4


def random_scene(seed, n_places=300, n_poses=80):
    """Return places and poses anywhere, some above or at each other."""
    rng = np.random.default_rng(seed)
    xy = rng.integers([-37, -11], [45, 60], (n_places, 2)) * 0.05
    z = rng.choice([0.0, 0.45, 0.75], n_places)
    location = np.unique(np.column_stack([xy, z]).round(6), axis=0)
    features = np.zeros((len(location), len(FEATURES)))
    candidates = Candidates(location, np.zeros(len(location), np.int32), features)
    kind = rng.integers(0, 6, n_poses).astype(np.uint8)
    xy = rng.integers([-14, -8], [22, 31], (n_poses, 2)) * 0.1
    place = np.column_stack([xy, rng.choice([0.4, 0.45], n_poses)])
    place[n_poses // 2 :, :2] = place[: n_poses - n_poses // 2, :2]
    yaw = np.append(np.arange(8), rng.integers(0, 8, n_poses - 8)) * np.pi / 4
    prior = rng.dirichlet(np.ones(n_poses))
    return candidates, HumanPoses(kind, place, yaw, prior)


@pytest.fixture(params=range(3))
def scene(request):
    return random_scene(request.param)


def use_of(scene, row_spacing_m=0.1, radius_m=5.0, theta=THETA):
    config = ArrangingConfig(radius_m, row_spacing_m)
    return UseOfObject(theta, Lattice(*scene, 0.05, config), HALF_HEIGHT)


def direct(scene, radius_m=5.0, theta=THETA):
    """Return Psi_loc of every place with every pose, shape (p, q)."""
    candidates, poses = scene
    objects = np.column_stack([candidates.location, np.zeros(len(candidates.area))])
    objects[:, 2] += HALF_HEIGHT
    references = poses.references()
    has_front = np.zeros(len(objects), bool)
    logs = log_psi_human(theta, objects, has_front, references)
    psi = np.exp(logs.astype(float))
    offset = objects[:, None, :2] - references[:, :2]
    distance = np.linalg.norm(offset, axis=2)
    return np.where(distance > radius_m + 1e-9, 0, psi)


def on_coarse(scene):
    """Return which places lie on the lattice of the rows."""
    cells = np.round(scene[0].location[:, :2] / 0.05)
    return (cells % 2 == 0).all(1)


def expected_density(scene, weight, radius_m=5.0, theta=THETA):
    psi = direct(scene, radius_m, theta)
    density = psi @ (weight / psi[on_coarse(scene)].sum(0))
    return density / density.sum()


def test_row_sums_the_places_of_the_coarse_lattice(scene):
    expected = direct(scene)[on_coarse(scene)].sum(0)
    np.testing.assert_allclose(use_of(scene).row(), expected, rtol=1e-4)


def test_row_sums_every_place_when_the_lattices_are_one(scene):
    expected = direct(scene).sum(0)
    np.testing.assert_allclose(use_of(scene, 0.05).row(), expected, rtol=1e-4)


@pytest.mark.parametrize("radius_m", [1.0, 2.5, 5.0])
def test_density_mixes_the_potentials_of_all_poses_over_their_sums(scene, radius_m):
    weight = np.random.default_rng(1).dirichlet(np.full(80, 0.3))
    found = use_of(scene, radius_m=radius_m).density(weight)
    expected = expected_density(scene, weight, radius_m)
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-8)
    assert found.sum() == pytest.approx(1)


def test_density_holds_for_a_sharp_theta(scene):
    theta = Theta(-0.4, 0.1, 0.3, 50.0, -0.2, 0.05, 3.0, 1.5)
    weight = np.full(80, 1 / 80)
    row = direct(scene, theta=theta)[on_coarse(scene)].sum(0)
    weight[row < 1e-9 * row.max()] = 0
    expected = expected_density(scene, weight / weight.sum(), theta=theta)
    found = use_of(scene, theta=theta).density(weight / weight.sum())
    np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-8)


def test_density_reads_no_place_from_the_other_end_of_the_scene():
    places = np.array([[x, 0.0, 0.75] for x in np.arange(0, 8.01, 0.1)])
    features = np.zeros((len(places), len(FEATURES)))
    candidates = Candidates(places, np.zeros(len(places), np.int32), features)
    poses = HumanPoses(np.uint8([4]), np.array([[8.0, 0, 0]]), np.zeros(1), np.ones(1))
    density = use_of((candidates, poses), radius_m=3.0).density(np.ones(1))
    assert density[places[:, 0] < 4.9].max() < 1e-12


def test_new_person_is_drawn_from_the_prior_times_the_row(scene):
    expected = scene[1].prior * direct(scene)[on_coarse(scene)].sum(0)
    found = use_of(scene).new_person()
    np.testing.assert_allclose(found, expected / expected.sum(), rtol=1e-4)


def test_histograms_count_the_coarse_places_per_square_and_level(scene):
    weights = np.random.default_rng(2).dirichlet(np.full(80, 0.2), 3)
    weights[2] = 0
    weights[2, 5] = 1
    kept = on_coarse(scene)
    places = scene[0].location[kept]
    squares = np.floor(places[:, :2] / 0.5 + 1e-9).astype(int)
    keys = np.column_stack([places[:, 2], squares])
    bins, of_bin = np.unique(keys, axis=0, return_inverse=True)
    psi = direct(scene)[kept]
    expected = np.zeros((3, len(bins)))
    for r in range(3):
        np.add.at(expected[r], of_bin, psi / psi.sum(0) @ weights[r])
    found = use_of(scene).histograms(weights)
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-9)
    np.testing.assert_allclose(found.sum(1), 1)


def test_heading_probability_mixes_the_poses_near_a_place(scene):
    weight = np.random.default_rng(3).dirichlet(np.full(80, 0.3))
    psi = direct(scene)
    near = psi[7] * weight / psi[on_coarse(scene)].sum(0)
    expected = np.exp(log_psi_ori(THETA, YAWS[:, None], scene[1].yaw)) @ near
    found = use_of(scene).heading_probability(7, weight, YAWS)
    np.testing.assert_allclose(found, expected / expected.sum(), rtol=1e-4)


def test_likeliest_heading_turns_the_front_as_learned(scene):
    weight = np.zeros(80)
    weight[11] = 1.0
    place = int(np.argmax(direct(scene)[:, 11]))
    share = use_of(scene).heading_probability(place, weight, YAWS)
    wanted = scene[1].yaw[11] + THETA.orientation_mean_rad
    off = np.angle(np.exp(1j * (YAWS[np.argmax(share)] - wanted)))
    assert abs(off) <= np.pi / 8 + 1e-9


def test_shares_of_the_poses_add_up_to_the_density(scene):
    use = use_of(scene)
    weight = np.random.default_rng(4).dirichlet(np.full(80, 0.3))
    sums = [use.shares(p, weight).sum() for p in range(len(scene[0].area))]
    expected = np.array(sums) / np.sum(sums)
    found = use.density(weight)
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-8)


def test_density_has_the_same_bytes_every_time(scene):
    weight = np.full(80, 1 / 80)
    assert use_of(scene).density(weight).tobytes() == (
        use_of(scene).density(weight).tobytes()
    )


def test_pose_off_the_lattice_is_an_error(scene):
    scene[1].location[3, 0] += 0.05
    with pytest.raises(ValueError, match="poses must lie on multiples"):
        use_of(scene)


def test_scene_without_a_place_gives_zeros():
    use = use_of(random_scene(0, n_places=0))
    assert not use.row().any()
    assert use.density(np.full(80, 1 / 80)).shape == (0,)
    assert not use.new_person().any()
    assert use.histograms(np.full((2, 80), 1 / 80)).shape == (2, 0)


def test_scene_without_a_pose_gives_zeros():
    candidates, _ = random_scene(0)
    none = np.empty(0)
    poses = HumanPoses(none.astype(np.uint8), np.empty((0, 3)), none, none)
    use = use_of((candidates, poses))
    assert use.row().shape == (0,)
    assert not use.density(none).any()
    np.testing.assert_allclose(use.heading_probability(0, none, YAWS), 1 / 8)


def test_separated_height_factor_multiplies_back():
    z = np.linspace(0, 2, 20)
    height = height_factor(THETA, z, np.linspace(0.6, 1.2, 40))
    of_level, of_reference = separate(height, 1e-10)
    np.testing.assert_allclose(of_level @ of_reference, height, atol=1e-9)
    assert len(of_reference) < 16


def test_a_new_user_adds_to_the_density_what_the_new_person_would(scene):
    use = use_of(scene)
    rng = np.random.default_rng(3)
    seen = np.where(rng.random(len(scene[1].kind)) < 0.05, 1.0, 0.0)
    seen *= 0.6 / seen.sum()
    whole = use.density(seen + 0.4 * use.new_person())
    np.testing.assert_allclose(use.density(seen, 0.4), whole, rtol=1e-6, atol=1e-12)
    rows = np.stack([seen, seen]), np.array([0.4, 0.4])
    counted = use.histograms(rows[0] + 0.4 * use.new_person())
    np.testing.assert_allclose(use.histograms(*rows), counted, atol=1e-12)


def test_sums_over_few_and_over_many_poses_agree(scene, monkeypatch):
    weight = np.random.default_rng(4).random(len(scene[1].kind))
    direct = use_of(scene).density(weight)
    monkeypatch.setattr(arranging, "MANY_SITES", 0)
    np.testing.assert_allclose(use_of(scene).density(weight), direct, rtol=1e-6)

"""The terms of an explanation add up to the score, and the right one is decisive."""

from dataclasses import replace

import numpy as np
import pytest

from placing.candidates import FEATURES, Candidates
from placing.methods.arranging import UseOfObject
from placing.methods.explanation import (
    EXPLANATION_COLUMNS,
    TERMS,
    Field,
    explain,
    explanation_rows,
)
from placing.people.human import HumanPoses
from placing.people.lattice import ArrangingConfig, Lattice
from placing.people.potential import Theta, log_psi_human
from placing.people.skeleton import KINDS

THETA = Theta(-0.4, 0.5, 0.0, 2.0, -0.2, 0.3, 3.0, 1.5)
YAWS = np.arange(8) * np.pi / 4
CONFIG = ArrangingConfig(5.0, 0.1)
KEY = ("office1", "filled", "dp", "mouse1", "mouse1", "mouse")


def candidates_at(location, area=None):
    location = np.array(location, float)
    area = np.zeros(len(location)) if area is None else np.array(area)
    features = np.zeros((len(location), len(FEATURES)))
    return Candidates(location, area.astype(np.int32), features)


def random_case(seed):
    """Return candidates, how people use the object, who does, and its field."""
    rng = np.random.default_rng(seed)
    xy = rng.integers(0, 60, (200, 2)) * 0.05
    z = rng.choice([0.0, 0.45, 0.75], 200)
    candidates = candidates_at(np.column_stack([xy, z]))
    place = np.column_stack([rng.integers(0, 30, (50, 2)) * 0.1, np.full(50, 0.45)])
    kind, yaw = rng.integers(0, 6, 50).astype(np.uint8), YAWS[np.arange(50) % 8]
    poses = HumanPoses(kind, place, yaw, np.full(50, 1 / 50))
    use = UseOfObject(THETA, Lattice(candidates, poses, 0.05, CONFIG), 0.1)
    weight = rng.dirichlet(np.full(50, 0.3))
    density = use.density(weight)
    smooth = density * rng.uniform(0.5, 2, 200)
    return candidates, use, weight, Field(density, smooth, density, 1.0)


def explained(case, place, p_heading=0.3, is_fitting=None):
    candidates, use, weight, field = case
    is_fitting = np.ones(200, np.bool_) if is_fitting is None else is_fitting
    places = candidates.location, is_fitting
    return explain(use, weight, field, (place, p_heading), YAWS, places)


def score(field, place, p_heading):
    return np.log(field.smooth[place]) + np.log(p_heading)


@pytest.mark.parametrize("seed", range(5))
def test_terms_add_up_to_the_score(seed):
    case = random_case(seed)
    place = int(np.argmax(case[3].smooth))
    found = explained(case, place)
    total = sum(found.chosen.terms.values())
    assert total == pytest.approx(score(case[3], place, 0.3), abs=1e-9)
    other = found.alternative
    likeliest = case[1].heading_probability(other.place, case[2], YAWS).max()
    total = sum(other.terms.values())
    assert total == pytest.approx(score(case[3], other.place, likeliest), abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_terms_add_up_when_object_context_is_mixed_in(seed):
    candidates, use, weight, field = random_case(seed)
    other = np.random.default_rng(seed).dirichlet(np.ones(200))
    density = 0.7 * field.density + 0.3 * other
    mixed = Field(density, density * 1.1, field.density, 0.7)
    found = explained((candidates, use, weight, mixed), 17)
    assert sum(found.chosen.terms.values()) == pytest.approx(
        score(mixed, 17, 0.3), abs=1e-9
    )
    gain = np.log(density[17] / (0.7 * field.density[17]))
    assert found.chosen.terms["objects"] == pytest.approx(gain, abs=1e-9)


def test_objects_say_nothing_in_a_method_without_them():
    assert explained(random_case(0), 3).chosen.terms["objects"] == 0


@pytest.mark.parametrize("omega", [0.0, 1.0])
def test_terms_add_up_where_people_have_no_say(omega):
    candidates, use, weight, field = random_case(0)
    human = field.density.copy()
    human[4] = 0
    mixed = np.full(200, 1 / 200)
    case = candidates, use, weight, Field(mixed, mixed, human, omega)
    terms = explained(case, 4).chosen.terms
    assert np.isfinite(list(terms.values())).all()
    assert sum(terms.values()) == pytest.approx(score(case[3], 4, 0.3), abs=1e-9)


def test_person_is_the_likeliest_user_at_the_place():
    case = random_case(1)
    candidates, use, weight, _ = case
    at = np.append(candidates.location[9] + [0, 0, 0.1], 0)[None]
    psi = np.exp(
        log_psi_human(THETA, at, np.zeros(1, bool), use.lattice.people)[0].astype(float)
    )
    r = weight * psi / use.row()
    chosen = explained(case, 9).chosen
    assert chosen.pose == np.argmax(r)
    assert chosen.share == pytest.approx(r.max() / r.sum(), rel=1e-4)
    rest = np.log(r.sum() / r.max())
    assert chosen.terms["other_people"] == pytest.approx(rest, abs=1e-4)
    factors = sum(chosen.terms[name] for name in ("distance", "bearing", "height"))
    assert factors == pytest.approx(np.log(psi[chosen.pose]), abs=1e-4)


@pytest.mark.parametrize("seed", range(10))
def test_decisive_term_is_the_largest_loss(seed):
    found = explained(random_case(seed), seed)
    loss = {t: found.chosen.terms[t] - found.alternative.terms[t] for t in TERMS}
    assert loss[found.decisive()] == max(loss.values())


def test_alternative_is_the_best_fitting_place_half_a_metre_away():
    case = random_case(2)
    location, smooth = case[0].location, case[3].smooth
    place = int(np.argmax(smooth))
    is_fitting = np.random.default_rng(0).random(200) < 0.5
    far = np.linalg.norm(location - location[place], axis=1) >= 0.5
    found = explained(case, place, is_fitting=is_fitting).alternative.place
    assert (is_fitting & far)[found]
    assert smooth[found] == smooth[is_fitting & far].max()


def one_person(places, kind="standing", theta=THETA):
    """Return the case of one person at the origin who looks along x."""
    candidates = candidates_at(places, range(len(places)))
    poses = HumanPoses(
        np.uint8([KINDS.index(kind)]), np.zeros((1, 3)), np.zeros(1), np.ones(1)
    )
    use = UseOfObject(theta, Lattice(candidates, poses, 0.05, CONFIG), 0.1)
    density = use.density(np.ones(1))
    field = Field(density, density, density, 1.0)
    is_fitting = np.ones(len(places), np.bool_)
    spot = int(np.argmax(density)), 0.5
    places = candidates.location, is_fitting
    return candidates, use, explain(use, np.ones(1), field, spot, YAWS, places)


@pytest.mark.parametrize(
    ("alternative", "term"),
    [
        ((0.5, -0.4, 0.1), "height"),
        ((2.5, -2.0, 0.8), "distance"),
        ((-0.5, -0.4, 0.8), "bearing"),
    ],
)
def test_what_differs_between_two_places_decides(alternative, term):
    _, _, found = one_person([(0.5, 0.4, 0.8), alternative])
    assert found.chosen.place == 0
    assert found.decisive() == term


def test_rows_name_the_person_the_alternative_and_one_decisive_term():
    candidates, use, found = one_person([(0.5, 0.4, 0.8), (0.5, -0.4, 0.1)])
    rows = explanation_rows(KEY, found, use, candidates, ["desk", "shelf"])
    table = [dict(zip(EXPLANATION_COLUMNS, row, strict=True)) for row in rows]
    assert [row["term"] for row in table] == list(TERMS)
    assert [row["term"] for row in table if row["is_decisive"]] == ["height"]
    assert {row["person_kind"] for row in table} == {"standing"}
    assert {row["person_share"] for row in table} == {1.0}
    assert {row["alternative_area"] for row in table} == {"shelf"}
    at = [table[0][f"alternative_{axis}_m"] for axis in "xyz"]
    np.testing.assert_allclose(at, [0.5, -0.4, 0.1])


def test_without_an_alternative_nothing_is_decisive():
    candidates, use, found = one_person([(0.5, 0.4, 0.8), (0.5, 0.3, 0.8)])
    assert found.alternative is None
    rows = explanation_rows(KEY, found, use, candidates, ["desk", "shelf"])
    table = [dict(zip(EXPLANATION_COLUMNS, row, strict=True)) for row in rows]
    assert not any(row["is_decisive"] for row in table)
    assert np.isnan([row["alternative_value"] for row in table]).all()
    assert {row["alternative_area"] for row in table} == {""}


def test_place_out_of_everybodys_reach_is_explained_all_the_same():
    candidates, use, weight, field = random_case(3)
    empty = replace(field, density=np.zeros(200), smooth=np.zeros(200))
    terms = explained((candidates, use, weight, empty), 5).chosen.terms
    assert np.isfinite(list(terms.values())).all()

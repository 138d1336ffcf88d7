"""Trials find what stays and what falls, the same however many processes try."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from placing import rigid
from placing.clouds.cloud import CloudConfig
from placing.physics.choosing import features_of, settle_chosen
from placing.physics.cutting import bodies_of
from placing.physics.fixtures import INSTANCES, KINDS, fixture_of
from placing.physics.grounds import grounds_of, pieces_of_fixtures
from placing.physics.running import run_trials, with_outcomes
from placing.physics.settling import SettleConfig, settle, unrest
from placing.physics.things import thing_of
from placing.physics.trials import (
    MEASURED,
    POSE,
    TRIAL_COLUMNS,
    TrialsConfig,
    draw_trials,
    lowered,
)
from placing.physics.watching import watch
from placing.psi.object_clouds import LookingConfig
from placing.psi.orientations import OrientationsConfig
from placing.rooms.catalogue import read_catalogue

FOLDER = Path(__file__).parents[2] / "config"
STUDY = yaml.safe_load((FOLDER / "config.yaml").read_text())
LOOKING = LookingConfig(**STUDY["looking"])
TRIALS = replace(TrialsConfig(**STUDY["trials"]), n_trials=24)
WAYS = OrientationsConfig(**STUDY["orientations"])
SETTLING = SettleConfig(**STUDY["settling"])
REACH_M = STUDY["putting_down"]["reach_m"]
TOP_M = INSTANCES["table"][0][0][1][2]
BOOK_M = (0.24, 0.17, 0.03)


@cache
def grounds():
    cloud = CloudConfig(**STUDY["cloud"])
    return grounds_of(5, TRIALS.noise_m, LOOKING.cell_m, cloud, 0.02, ["table"])


@cache
def things():
    catalogue = read_catalogue(FOLDER / "objects.csv")
    names = "book1", "cereal_box", "phone1"
    return {name: thing_of(catalogue[name], 0.01, WAYS) for name in names}


@cache
def bodies():
    return bodies_of([t.item for t in things().values()], SETTLING.margin_m)


@cache
def fixed():
    return pieces_of_fixtures(grounds(), SETTLING.margin_m)


@cache
def drawn():
    return draw_trials(5, grounds(), things(), TRIALS)


def on_table(*places, is_noisy=False, name="book1"):
    """Return a table of placements of a thing, upright on the first table."""
    rows = [
        {
            "fixture": "table",
            "instance": 0,
            "is_noisy": is_noisy,
            "object": name,
            "orientation": "upright",
            "area_height_m": TOP_M,
            **dict(zip(POSE, (*rigid.IDENTITY, x, y, 0.0), strict=True)),
        }
        for x, y in places
    ]
    return lowered(pd.DataFrame(rows), grounds(), things())


@pytest.mark.parametrize("kind", KINDS)
def test_every_fixture_has_placing_areas_above_its_floor(kind):
    for instance in range(len(INSTANCES[kind])):
        fixture = fixture_of(kind, instance, 0.7)
        assert fixture.areas
        floor = fixture.meshes["floor"].bounds
        for area in fixture.areas:
            assert area.height_m >= 0
            assert np.all(area.polygon_m > floor[0, :2])
            assert np.all(area.polygon_m < floor[1, :2])


@pytest.mark.parametrize("is_noisy", [False, True])
def test_objects_are_lowered_onto_the_top_of_the_table(is_noisy):
    table = on_table((0, 0), (0.1, 0.3), is_noisy=is_noisy)
    bottom = table["z_m"] - BOOK_M[2] / 2
    assert np.all(np.abs(bottom - TOP_M) < (0.012 if is_noisy else 0.005))


def test_a_box_falls_once_its_centre_is_beyond_the_edge():
    edge_m = INSTANCES["table"][0][0][1][0] / 2
    table = on_table((0, 0), (edge_m - 0.015, 0), (edge_m + 0.015, 0))
    outcomes = list(run_trials(table, fixed(), bodies(), SETTLING, REACH_M, 1))
    assert [outcome.stays for outcome in outcomes] == [True, True, False]
    again = settle_chosen(table, fixed(), bodies(), SETTLING, REACH_M, 1)
    assert again == [True, True, False]


def test_what_is_watched_for_a_short_time_stays_as_if_it_settled_for_long():
    for row in drawn().itertuples():
        pose = np.array([getattr(row, column) for column in POSE])
        furniture, body = fixed()[f"table{row.instance}"], bodies()[row.object]
        short = watch(furniture, body, pose, SETTLING, REACH_M)
        long = settle(furniture, {"it": (body, pose)}, SETTLING, REACH_M)["it"]
        assert short.stays == (not unrest(long, SETTLING))
        assert short.penetration_m == pytest.approx(long.penetration_m, abs=1e-9)


def test_trials_are_the_same_for_one_and_two_workers():
    outcomes = [
        with_outcomes(
            drawn(), list(run_trials(drawn(), fixed(), bodies(), SETTLING, REACH_M, n))
        )
        for n in (1, 2)
    ]
    pd.testing.assert_frame_equal(*outcomes)
    assert list(outcomes[0].columns) == list(TRIAL_COLUMNS)
    assert 0 < outcomes[0]["stays"].mean() < 1
    assert np.isfinite(outcomes[0][[*POSE, *MEASURED]].to_numpy(float)).all()


def test_a_trial_draws_the_same_whatever_is_tried_before_it():
    fewer = draw_trials(5, grounds(), things(), replace(TRIALS, n_trials=7))
    pd.testing.assert_frame_equal(fewer, drawn().head(7))


def test_features_are_those_of_their_row():
    table = drawn()
    backwards = table.iloc[::-1].reset_index(drop=True)
    one_by_one = [
        features_of(table.iloc[[i]].reset_index(drop=True), grounds(), things())
        for i in range(4)
    ]
    features = features_of(table, grounds(), things())
    assert np.array_equal(features[:4], np.concatenate(one_by_one))
    assert np.array_equal(features_of(backwards, grounds(), things()), features[::-1])

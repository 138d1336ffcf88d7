"""Physics carries out a certificate: what is let go ends where it was to end."""

import numpy as np
import pytest
from certified import (
    BLOCK,
    CAN,
    CONFIG,
    SETTLING,
    bodies,
    certificate,
    fixed,
    settings,
)

from placing.artifacts.films import read_film, write_film
from placing.errors import BadArtifact
from placing.physics.cutting import bodies_of
from placing.rigid import difference
from placing.robot.executing import WAIT, ExecutionConfig, execute
from placing.robot.film import PlaybackConfig

GOOD, BODIES = certificate(), bodies()
CONFIGS = (
    ExecutionConfig(**CONFIG["executing"]),
    PlaybackConfig(**CONFIG["playback"]),
    SETTLING,
)


def run(pieces=None, others=()):
    objects = {
        CAN.object_id: (BODIES[CAN.object_id], GOOD.T_world_start),
        **dict(others),
    }
    return execute([GOOD], settings(), pieces or fixed(), objects, CONFIGS)


@pytest.fixture(scope="module")
def film():
    return run()


def test_the_object_comes_to_rest_where_it_was_to_end(film):
    error_m, error_deg = difference(film.T_world_objects[-1, 0], GOOD.T_world_object)
    assert error_m < 2e-3
    assert error_deg < 1


def test_the_object_stays_in_the_hand_while_it_is_held(film):
    held = np.flatnonzero(film.held == 0)
    assert len(held) > 5
    lifted = film.T_world_objects[held, 0, 6]
    assert lifted.max() > GOOD.T_world_start[6] + 0.09


def test_the_film_waits_at_both_ends_and_names_what_happens(film):
    assert film.phase[0] == film.phase[-1] == WAIT
    assert {"pick approach", "pick lift", "put lower", "put retreat"} <= set(film.phase)
    assert (np.diff(film.time_s) > 0).all()


def test_an_object_that_nothing_carries_falls_to_the_floor():
    pieces = {name: some for name, some in fixed().items() if name != "pillar2"}
    seen = run(pieces)
    assert seen.T_world_objects[-1, 0, 6] < 0.1


def test_an_object_in_the_way_is_pushed():
    where = GOOD.T_world_object - np.array([0, 0, 0, 0, 0, 0, 0.011])
    block = bodies_of((BLOCK,), SETTLING.margin_m)[BLOCK.object_id]
    seen = run(others={BLOCK.object_id: (block, where)}.items())
    assert (
        difference(seen.T_world_objects[0, 1], seen.T_world_objects[-1, 1])[0] > 0.003
    )


def test_a_film_comes_back_as_it_was_written(film, tmp_path):
    write_film(tmp_path / "film.npz", film)
    found = read_film(tmp_path / "film.npz")
    for name, values in vars(film).items():
        np.testing.assert_array_equal(getattr(found, name), values)
    assert found.phase == film.phase


def test_a_film_of_another_shape_is_refused(film, tmp_path):
    path = tmp_path / "film.npz"
    write_film(path, film)
    arrays = dict(np.load(path))
    for name, value in {
        "q": arrays["q"][:-1],
        "held": arrays["held"] + 5,
        "time_s": arrays["time_s"] * np.nan,
        "T_world_objects": arrays["T_world_objects"][..., :6],
    }.items():
        np.savez(path, **arrays | {name: value})
        with pytest.raises(BadArtifact, match="expected"):
            read_film(path)

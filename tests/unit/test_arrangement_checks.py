"""A placement that is not possible is named with its reason."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from placing import rigid
from placing.physics.arrangements import check_arrangements, complaints_about, lacks
from placing.physics.cutting import bodies_of
from placing.physics.settling import SettleConfig
from placing.scene import Arrangement, Furniture, Layout, Placement, SceneObject

STUDY = Path(__file__).parents[2] / "config" / "config.yaml"
CONFIG = SettleConfig(**yaml.safe_load(STUDY.read_text())["settling"])
BOOK_M = (0.24, 0.17, 0.03)
DESK_TOP_M = 0.74


def book(name):
    return SceneObject(name, "book", "book", BOOK_M, 0.5, True, True)


def layout(*placements):
    outline = np.array([[0, 0], [3, 0], [3, 3], [0, 3]], float)
    desk = Furniture(
        "desk1", "desk", (0.8, 1.6, DESK_TOP_M), rigid.from_yaw(0, (1.5, 1.5, 0))
    )
    objects = (book("book1"), book("book2"))
    answers = (Arrangement("labeller1", "none", placements),) if placements else ()
    return Layout("office1", "office", outline, 2.6, (), (desk,), objects, answers)


def on(name, area, x, y, bottom_m):
    at = np.array([x, y, bottom_m + BOOK_M[2] / 2])
    return Placement(name, area, at, np.array(rigid.IDENTITY))


@pytest.fixture(scope="module")
def bodies():
    return bodies_of(layout().objects, CONFIG.margin_m)


SOUND = on("book1", "desk1", 1.5, 1.5, DESK_TOP_M)
"""A placement with which nothing is wrong."""


def second_of(bodies, placement):
    """Check a room with a sound placement and another, return the other's check."""
    return check_arrangements(layout(SOUND, placement), bodies, CONFIG)[1]


@pytest.mark.parametrize(
    ("placement", "support"),
    [
        (on("book2", "desk1", 1.5, 1.7, DESK_TOP_M), "desk1"),
        (on("book2", "book1", 1.5, 1.5, DESK_TOP_M + 0.03), "book1"),
        (on("book2", "floor", 0.5, 0.5, 0.0), "floor"),
        (on("book2", "floor", 0.12, 0.5, 0.0), "floor"),
    ],
)
def test_what_lies_as_it_says_stays(bodies, placement, support):
    check = second_of(bodies, placement)
    assert check.stays
    assert (check.reason, check.support) == ("", support)


@pytest.mark.parametrize(
    ("placement", "reason"),
    [
        (on("book2", "floor", 0.11, 0.5, 0.0), "outside the room"),
        (on("book2", "desk1", 1.5, 1.66, DESK_TOP_M), "penetrates book1 by 10 mm"),
        (
            on("book2", "desk1", 1.5, 1.1, DESK_TOP_M - 0.01),
            "penetrates desk1 by 10 mm",
        ),
        (on("book2", "desk1", 1.95, 1.1, DESK_TOP_M), "fell 7"),
        (on("book2", "desk1", 1.5, 1.1, DESK_TOP_M + 0.03), "moved 30 mm"),
        (
            on("book2", "floor", 1.5, 1.1, DESK_TOP_M),
            "not supported by floor but by des",
        ),
    ],
)
def test_what_is_wrong_is_said(bodies, placement, reason):
    check = second_of(bodies, placement)
    assert not check.stays
    assert check.reason.startswith(reason)


def test_a_sound_placement_beside_a_wrong_one_is_not_blamed(bodies):
    wrong = on("book2", "desk1", 1.95, 1.1, DESK_TOP_M)
    assert check_arrangements(layout(SOUND, wrong), bodies, CONFIG)[0].stays


def test_a_room_without_enough_arrangements_is_named():
    complaints = complaints_about(layout(), CONFIG)
    assert complaints[0] == "office1: has 0 arrangements, expected 3 to 5"


def test_an_object_that_is_not_placed_is_named():
    complaints = complaints_about(layout(SOUND), CONFIG)
    assert complaints[-1] == "office1 labeller1 book2: not placed"


def test_a_room_without_what_its_kind_needs_is_named():
    said = lacks(layout(SOUND))
    assert any("no object of category pen, as every office needs" in s for s in said)
    assert not any("category book" in line for line in said)


def test_what_is_too_small_for_its_shape_is_a_block_of_its_size():
    egg = SceneObject("egg1", "food", "bread", (0.063, 0.072, 0.052), 0.06, True, True)
    body = bodies_of([egg], 0.001)["egg1"]
    assert np.allclose(np.ptp(body.corners_m, axis=0) + 0.002, egg.size_m, atol=1e-4)

"""Questions hide what is to be placed and show the rest."""

import numpy as np
import pytest

from placing.errors import UnknownName
from placing.scene import Arrangement, Placement, Scene, SceneObject
from placing.tasks import questions

IDENTITY = np.array([1.0, 0, 0, 0])


def item(name, category):
    return SceneObject(name, category, "mug", (0.1, 0.1, 0.1), 0.3, False, True)


def arrangement(name, objects):
    places = [Placement(o, "floor", np.zeros(3), IDENTITY) for o in objects]
    return Arrangement(name, "tidy", tuple(places))


@pytest.fixture
def scene():
    objects = (item("mug1", "dishware"), item("cup", "dishware"), item("tv1", "tv"))
    ids = [o.object_id for o in objects]
    labelled = (arrangement("labeller1", ids), arrangement("labeller2", ids))
    return Scene("office1", "office", (), objects, labelled)


def test_filled_asks_for_each_category_given_each_arrangement(scene):
    asked = questions(scene, "filled")
    names = [q.name for q in asked]
    assert names == [f"labeller{k}/{c}" for k in (1, 2) for c in ("dishware", "tv")]
    for question in asked:
        wanted = {o.object_id for o in question.wanted}
        given = {p.object_id for p in question.given}
        assert not wanted & given
        assert wanted | given == {"mug1", "cup", "tv1"}


def test_empty_asks_for_everything_and_gives_nothing(scene):
    (question,) = questions(scene, "empty")
    assert question.given == ()
    assert len(question.wanted) == 3


def test_unknown_task_is_named_with_what_exists(scene):
    with pytest.raises(UnknownName, match="'half'; known are empty, filled"):
        questions(scene, "half")

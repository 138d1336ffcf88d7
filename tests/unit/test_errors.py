"""An unknown name is answered with those that were meant."""

from placing.errors import unknown


def test_few_known_names_are_all_told():
    assert str(unknown("task", "ful", ["filled", "empty"])) == (
        "unknown task 'ful'; known are empty, filled"
    )


def test_of_many_known_names_the_nearest_are_told():
    rooms = [f"FloorPlan{n}" for n in range(1, 190)]
    message = str(unknown("scene", "FlorPlan17", rooms))
    assert "of 189 that are known the nearest are FloorPlan17" in message
    assert len(message) < 160
